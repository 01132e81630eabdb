// SPDX-License-Identifier: MIT
// Self-intersection and arithmetic.
#include "cli/suite/spawning.h"

namespace twinray::suite {

std::vector<SuiteCase> arithmetic_cases() {
    return {
        {"F01", "outward rays from points of a convex sphere, by twinray/spawn.glsl, without offset, and otherwise",
         "hits of the sphere", "0 self-hits; without offset about half (control)", leave_a_sphere},
        {"F02", "separate triangles: ten settings of size, position, shape and instance, and four more",
         "rays that meet the triangle they leave", "0", leave_triangles_of_all_kinds},
        {"F03", "two plates 1e-3 to 1e-7 apart, rays from the lower one", "rays that miss the upper one",
         "0 where the gap is wider than twice the offset that the point tells; else flagged", leave_between_plates},
        {"F04", "terminator on coarse sphere (shading vs geometric normal)",
         "no black triangles with terminator fix; energy change < 1 %",
         "no black triangles with terminator fix; energy change < 1 %", nullptr,
         "the path tracer has no fix for terminators: rays leave by the geometric normal, so coarse meshes show "
         "facets"},
        {"F05", "a concave corner of 1 to 179 degrees, rays that end on its wall or lead away from it",
         "leaks, false occlusion", "0 where the wall is farther than twice the offset; else flagged",
         leave_a_concave_corner},
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
