// SPDX-License-Identifier: MIT
// Self-intersection and arithmetic.
#include "cli/suite/case_run.h"

namespace twinray::suite {

std::vector<SuiteCase> arithmetic_cases() {
    return {
        {"F01", "outward rays from 1e6 surface points of a convex sphere",
         "0 self-hits; without offset about 50 % (control)", "0 self-hits; without offset about 50 % (control)",
         nullptr, "not written yet"},
        {"F02", "the ten settings of the note on self-intersection", "0", "0", nullptr, "not written yet"},
        {"F03", "light leak: two plates 1e-3..1e-7 apart, spawn between", "offset < gap, or flagged",
         "offset < gap, or flagged", nullptr, "not written yet"},
        {"F04", "terminator on coarse sphere (shading vs geometric normal)",
         "no black triangles with terminator fix; energy change < 1 %",
         "no black triangles with terminator fix; energy change < 1 %", nullptr, "not written yet"},
        {"F05", "concave corner (dihedral 1 degrees..179 degrees)", "0 leaks, 0 false occlusion",
         "0 leaks, 0 false occlusion", nullptr, "not written yet"},
        {"F06", "contraction on/off/`precise` builds, RTE mode on/off", "identical decisions with `precise`",
         "identical decisions with `precise`", nullptr, "not written yet"},
        {"F07", "float probe", "recorded", "recorded", nullptr, "not written yet"},
        {"F08", "denormal flush on/off", "no decision changes", "no decision changes", nullptr, "not written yet"},
        {"F09", "GPU vs CPU C++ same kernel (-ffp-contract=off)",
         "bit-identical ids, u,v,t where division is correctly rounded; else <=3 ulp",
         "bit-identical ids, u,v,t where division is correctly rounded; else <=3 ulp", nullptr, "not written yet"},
    };
}

}  // namespace twinray::suite
