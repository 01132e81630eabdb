// SPDX-License-Identifier: MIT
// Self-intersection and arithmetic.
#include "report/suite/floats.h"
#include "report/suite/pictures.h"
#include "report/suite/spawning.h"

namespace twinray::suite {

std::vector<SuiteCase> arithmetic_cases() {
    return {
        {"F01",
         "outward rays from points of a convex sphere, by twinray/glsl/spawn.glsl, without offset, and otherwise",
         "hits of the sphere", "0 self-hits; without offset about half (control)", leave_a_sphere},
        {"F02", "separate triangles: ten settings of size, position, shape and instance, and four more",
         "rays that meet the triangle they leave", "0", leave_triangles_of_all_kinds},
        {"F03", "two plates 1e-3 to 1e-7 apart, rays from the lower one", "rays that miss the upper one",
         "0 where the gap is wider than twice the offset that the point tells; else flagged", leave_between_plates},
        {"F04", "shadow terminator: coarse spheres with smooth normals under a small far light, beside a fine one",
         "black pixels where the fine one is lit, energy",
         "none: measured; the path tracer leaves by the geometric normal and corrects nothing", shadow_terminator},
        {"F05", "a concave corner of 1 to 179 degrees, rays that end on its wall or lead away from it",
         "leaks, false occlusion", "0 where the wall and its edges are farther than twice the offset; else flagged",
         leave_a_concave_corner},
        {"F06",
         "rays at the edges of a grid far from the origin; kernels with and without `precise`, and the CPU reference",
         "decisions other than the CPU reference's", "0 with `precise`, where the device divides as IEEE 754 does",
         contraction},
        {"F07", "float probe: roundings, contraction, NaN, denormals", "what watertightness rests on and is not so",
         "0, else the robust levels cannot be claimed", float_probe},
        {"F08", "rays with denormal coordinates, on the device, and on its CPU reference with denormals flushed",
         "classes of both; triangles that change by flushing", "0 SW_LEAK, SW_FALSE, T_ERR", denormals},
        {"F09", "random and aimed rays on SwTlas and on its CPU reference, the same code compiled for the CPU",
         "hits that differ in a bit: ids, t, u, v",
         "0 where the device divides as IEEE 754 does; elsewhere measured only", device_against_cpu},
    };
}

}  // namespace twinray::suite
