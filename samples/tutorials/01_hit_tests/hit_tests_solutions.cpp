// SPDX-License-Identifier: MIT
// Solutions of the exercises of tutorial 1. Exits with 1 unless each gives the known result.
#include <cmath>
#include <iostream>
#include <numbers>
#include <vector>

#include <twinray/geometry.h>
#include <twinray/queries.h>
#include <twinray/tlas.h>

using namespace twinray;

namespace {

// [culling]
// Returns how many of two rays, one from each side of a triangle, hit it if backs are culled.
int fronts_hit(Context& context) {
    SwTlas accel(context);
    accel.push(make_quad(vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)));  // its front looks to +z
    const Ray rays[] = {{.origin = vec3(0.3f, 0.2f, 1), .t_min = 0, .direction = vec3(0, 0, -1), .t_max = INFINITY},
                        {.origin = vec3(0.3f, 0.2f, -1), .t_min = 0, .direction = vec3(0, 0, 1), .t_max = INFINITY}};
    int found = 0;
    for (const Hit& hit : accel.closest_hits(rays, {.cull = Cull::back})) found += int(hit.hit);
    return found;
}

// [area]
// The area of a sphere's outline: the part of parallel rays on a square of side 2 r that hit, times its area.
double outline_of_sphere(Context& context, float radius) {
    SwTlas accel(context);
    accel.push(make_icosphere(6, radius));
    constexpr int side = 500;
    std::vector<Ray> rays;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            rays.push_back({.origin = vec3(radius * (2 * (float(x) + 0.5f) / side - 1),
                                           radius * (2 * (float(y) + 0.5f) / side - 1), 2 * radius),
                            .t_min = 0,
                            .direction = vec3(0, 0, -1),
                            .t_max = INFINITY});
    double found = 0;
    for (const Hit& hit : accel.any_hits(rays, {.occlusion_only = true})) found += hit.hit;
    return found / (side * side) * 4 * radius * radius;
}

// [all]
// Returns the distances at which a ray enters and leaves spheres in a row.
std::vector<float> distances_through_spheres(Context& context) {
    SwTlas accel(context);
    const Transform places[] = {Transform::translation({0, 0, -3}), Transform::translation({0, 0, -6})};
    accel.push(make_icosphere(5), places);
    const Ray ray{.origin = vec3(0.1f, 0.2f, 0), .t_min = 0, .direction = vec3(0, 0, -1), .t_max = INFINITY};
    AllHits all_hits(accel);
    std::vector<float> distances;
    for (const Hit& hit : all_hits({&ray, 1}).hits) distances.push_back(hit.t);
    return distances;
}
// [/all]

}  // namespace

int main() try {
    Context context;
    const int fronts = fronts_hit(context);
    std::cout << "1: " << fronts << " of two rays meets a front\n";
    const double area = outline_of_sphere(context, 0.5f), known = std::numbers::pi / 4;
    std::cout << "2: the outline has an area of " << area << ", by the formula " << known << '\n';
    const std::vector<float> distances = distances_through_spheres(context);
    std::cout << "3: hits at t =";
    for (const float t : distances) std::cout << ' ' << t;
    std::cout << '\n';
    // A ray at a distance d from the middle of a unit sphere enters sqrt(1 - d^2) before it.
    const bool enters = distances.size() == 4 && std::abs(distances[0] - (3 - std::sqrt(0.95f))) < 0.001f;
    if (fronts != 1 || std::abs(area / known - 1) > 0.002 || !enters) return 1;
    std::cout << "the solutions hold\n";
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
