// SPDX-License-Identifier: MIT
// Solutions of the exercises of tutorial 5. Exits with 1 unless each gives the known result.
#include <cmath>
#include <iostream>
#include <numbers>
#include <utility>
#include <vector>

#include <twinray/analysis.h>
#include <twinray/tlas.h>

using namespace twinray;

namespace {

// [corner]
// A floor and a wall that share an edge, both unit squares: by contours.
double floor_to_wall(Context& context) {
    Scene scene;
    scene.materials.resize(1);
    scene.meshes = {make_quad(vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)),
                    make_quad(vec3(0, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1))};
    scene.instances = {{"floor", 0, {}}, {"wall", 1, {}}};
    SwTlas accel(context);
    push_scene(accel, scene);
    const Faces faces(context, scene);
    const ViewFactorOptions options{.grouping = FaceGrouping::instance};
    const PairExchanges pairs = exchanges_of_pairs(accel, faces, options, PairEstimator::contour);
    ViewFactors factors(accel, faces, options, pairs.known);
    return factors.rows(0, 1).front().factors.front().value;
}

// [spheres]
// A sphere of radius 1 within one of radius 2 that looks inwards: returns the view factor of the outer one to itself.
ViewFactor outer_to_outer(Context& context) {
    Scene scene;
    scene.materials.resize(1);
    scene.meshes = {make_icosphere(5, 1), make_icosphere(5, 2)};
    for (uvec3& triangle : scene.meshes[1].triangles) std::swap(triangle.y, triangle.z);
    scene.instances = {{"inner", 0, {}}, {"outer", 1, {}}};
    SwTlas accel(context);
    push_scene(accel, scene);
    const Faces faces(context, scene);
    ViewFactors factors(accel, faces, {.grouping = FaceGrouping::instance, .rays = 1 << 21});
    return factors.rows(1, 2).front().factors.back();
}

// [project]
// Returns how far the view factors between the faces of a box are from reciprocity, as counted and after project().
std::pair<double, double> reciprocity_of_box(Context& context) {
    Scene scene;
    scene.materials.resize(1);
    scene.meshes = {make_box(vec3(0), vec3(1, 2, 3))};
    for (uvec3& triangle : scene.meshes[0].triangles) std::swap(triangle.y, triangle.z);  // inwards
    scene.instances = {{"box", 0, {}}};
    SwTlas accel(context);
    push_scene(accel, scene);
    const Faces faces(context, scene);
    ViewFactors factors(accel, faces, {.rays = 4096});
    std::vector<ViewFactorRow> rows = factors.rows(0, factors.row_count());
    const double counted = residuals_of(rows, factors.areas()).reciprocity;
    project(rows, factors.areas());
    return {counted, residuals_of(rows, factors.areas()).reciprocity};
}
// [/project]

}  // namespace

int main() try {
    Context context;
    const double corner = floor_to_wall(context), root = std::sqrt(2.0);
    const double known = (2 * std::atan(1.0) - root * std::atan(1 / root) + std::log(3.0 / 4) / 4) / std::numbers::pi;
    std::cout << "1: F = " << corner << ", by the formula " << known << '\n';
    const ViewFactor outer = outer_to_outer(context);
    std::cout << "2: F = " << outer.value << " from " << outer.low << " to " << outer.high << ", by the formula 0.75\n";
    const auto [counted, projected] = reciprocity_of_box(context);
    std::cout << "3: reciprocity is off by " << counted << ", after project() by " << projected << '\n';
    if (std::abs(corner / known - 1) > 1e-6 || std::abs(outer.value - 0.75) > 0.001 || projected > 1e-6 ||
        counted < 1e-6)
        return 1;
    std::cout << "the solutions hold\n";
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
