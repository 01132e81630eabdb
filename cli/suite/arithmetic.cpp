// SPDX-License-Identifier: MIT
// Self-intersection and arithmetic.
#include "cli/suite/floats.h"

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
        {"F06", "rays at the edges of a grid far from the origin; kernels with and without `precise`, and the CPU twin",
         "decisions other than the twin's", "0 with `precise`", contraction},
        {"F07", "float probe: roundings, contraction, NaN, denormals", "what watertightness rests on and is not so",
         "0, else the robust levels cannot be claimed", float_probe},
        {"F08", "rays with denormal coordinates, on the device, and on its CPU twin with denormals flushed",
         "classes of both; triangles that change by flushing", "0 SW_LEAK, SW_FALSE, T_ERR", denormals},
        {"F09", "random and aimed rays on SwTlas and on its twin, the same code compiled for the CPU",
         "hits that differ in a bit: ids, t, u, v",
         "0 where the device divides as IEEE 754 does; elsewhere measured only", device_against_twin},
    };
}

}  // namespace twinray::suite
