// SPDX-License-Identifier: MIT
// Scale and position.
#include "cli/suite/case_run.h"

namespace twinray::suite {

std::vector<SuiteCase> scale_cases() {
    return {
        {"S01", "mesh x2^k, k=-100..100", "bit identity of id,u,v; t*2^-k", "identical (with normalisation)", nullptr,
         "not written yet"},
        {"S02", "mesh x10^k, k=-18..18", "miss, t ulp", "0 leaks; refined t <=1 ulp", nullptr, "not written yet"},
        {"S03", "mesh extents 1e-38, 1e38 (denormal/overflow rim)", "accepted or error",
         "defined: normalised hit or a named error; no NaN out", nullptr, "not written yet"},
        {"S04", "offset 10^k, k=0..8, unit cells, ray near", "miss, t", "0 leaks", nullptr, "not written yet"},
        {"S05", "\"teapot in a stadium\": unit mesh, camera at 10^k cells, k=1..12", "wrong triangle, absd t cells",
         "0 wrong to 1e9, absd t <= 2e-6 cells at level 2 (naive: 21 % wrong at 1e7)", nullptr, "not written yet"},
        {"S06", "1e-6 gear on 1e6 floor in one BLAS", "false/miss near gear", "0 leaks; t within its bound", nullptr,
         "not written yet"},
        {"S07", "coordinates mixing 1e-6..1e6 in one triangle", "t ulp, bary",
         "sign decisions exact; refined t <=1 ulp", nullptr, "not written yet"},
        {"S08", "len(d) = 1e+-6, +-12, +-20, +-30, +-38", "t*len(d) vs len(d)=1", "identical for 2^k; <=1 ulp for 10^k",
         nullptr, "not written yet"},
        {"S09", "d with one component 1e-30..1e-45 of the others", "miss vs d_i=0", "0 leaks", nullptr,
         "not written yet"},
        {"S10", "hit at t = 3e38, tmax=Inf", "t", "hit; no overflow to Inf", nullptr, "not written yet"},
        {"S11", "origin denormal, vertices denormal", "class", "defined result, same under FTZ", nullptr,
         "not written yet"},
        {"S12", "1e-18 triangle beside 1e18 triangle, same scene", "both hit",
         "both hit as two BLASes; documented loss if one BLAS", nullptr, "not written yet"},
    };
}

}  // namespace twinray::suite
