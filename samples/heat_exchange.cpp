// SPDX-License-Identifier: MIT
// The heat that two grey spheres exchange by radiation, one inside the other, compared with the formula.
#include <twinray/analysis.h>

#include <cmath>
#include <iostream>

#include <twinray/tlas.h>

namespace {

using namespace twinray;

constexpr double stefan_boltzmann = 5.670374419e-8;                      // W / (m^2 K^4)
constexpr double temperature[] = {600, 300}, emissivity[] = {0.5, 0.8};  // of the inner sphere and the outer one

// Makes spheres with radii of 1 and 2 m, each of 5120 faces; the outer one looks inwards.
Scene concentric_spheres() {
    Scene scene;
    scene.materials.resize(1);
    scene.meshes = {make_icosphere(4, 1), make_icosphere(4, 2)};
    for (uvec3& triangle : scene.meshes[1].triangles) std::swap(triangle.y, triangle.z);
    scene.instances = {{"inner", 0, {}}, {"outer", 1, {}}};
    return scene;
}

std::vector<ViewFactorRow> view_factors_of(Context& context, const Scene& scene, std::vector<double>& areas) {
    SwTlas accel(context);
    push_scene(accel, scene);
    const Faces faces(context, scene);
    ViewFactors factors(accel, faces, {.grouping = FaceGrouping::instance, .rays = 1 << 21});
    areas = factors.areas();
    std::vector<ViewFactorRow> rows = factors.rows(0, factors.row_count());
    project(rows, areas);
    return rows;
}

}  // namespace

int main() try {
    Context context;
    std::vector<double> areas, emission, reflectance;
    const std::vector<ViewFactorRow> rows = view_factors_of(context, concentric_spheres(), areas);
    for (int i = 0; i < 2; ++i) {
        emission.push_back(emissivity[i] * stefan_boltzmann * std::pow(temperature[i], 4));
        reflectance.push_back(1 - emissivity[i]);
    }
    const Radiosity light = solve_radiosity(rows, emission, reflectance);
    const double heat = areas[0] * (light.values[0] - light.incident[0]);
    // Two surfaces, one of which sees only the other: Howell, Menguc, Siegel, "Thermal Radiation Heat Transfer", 5.3.
    const double known = areas[0] * stefan_boltzmann * (std::pow(temperature[0], 4) - std::pow(temperature[1], 4)) /
                         (1 / emissivity[0] + areas[0] / areas[1] * (1 / emissivity[1] - 1));
    std::cout << "the inner sphere loses " << heat << " W; by the formula " << known << " W, a difference of "
              << 100 * std::abs(heat / known - 1) << " %\n"
              << "residual " << light.relative_residual << ", forward error " << light.forward_error << '\n';
    return std::abs(heat / known - 1) < 1e-3 ? 0 : 1;
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
