// SPDX-License-Identifier: MIT
// Points and normals of hits on instances with unequally scaled axes.
#include <twinray/geometry.h>

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "report/suite/scenes.h"
#include "report/suite/sections.h"
#include "report/suite/spawning.h"

namespace twinray::suite {
namespace {

constexpr double most_angle = 1e-5, most_length_error = 1e-6;

// A function that returns the matrix by which normals go through a transform.
using NormalRule = glm::dmat3 (*)(const Transform&);

double angle_between(const dvec3& a, const dvec3& b) {
    const dvec3 u = normalize(a), v = normalize(b);
    return std::atan2(length(cross(u, v)), dot(u, v));
}

// A sphere with normals, under another transform for each ray.
struct Scaled {
    Mesh mesh;
    std::vector<Transform> transforms;
    std::vector<Ray> rays;
};

Scaled scaled_spheres(float most, std::size_t count, std::uint64_t seed) {
    Random random(seed);
    Scaled made{make_icosphere(2), {}, {}};
    made.mesh.normals = made.mesh.positions;
    for (std::size_t i = 0; i < count; ++i) {
        const ScaledPlace placed = scaled_place(random, most);
        made.transforms.push_back(placed.transform);
        made.rays.push_back(placed.ray);
    }
    return made;
}

struct Errors {
    std::vector<double> angles;
    std::uint64_t faults = 0;
    std::string first;
};

void compare(const Scaled& scaled, std::size_t i, const Surface& surface, NormalRule rule, Errors& errors) {
    const auto fault = [&](const std::string& what) {
        if (errors.faults++ == 0) errors.first = text(what, ": ", hexadecimal(scaled.rays[i]));
    };
    if (!surface.is_hit) return fault("a miss");
    const glm::dmat3 to_world = rule(scaled.transforms[i]);
    const auto corner = [&](std::size_t k) { return dvec3(scaled.mesh.positions[surface.vertices[k]]); };
    const dvec3 geometric = dvec3(to_world * cross(corner(1) - corner(0), corner(2) - corner(0)));
    const double u = surface.uv.x, v = surface.uv.y;  // normals of the sphere are its vertices
    const dvec3 shading = dvec3(to_world * ((1 - u - v) * corner(0) + u * corner(1) + v * corner(2)));
    const double angle =
        std::max(angle_between(dvec3(surface.point.normal), geometric), angle_between(dvec3(surface.normal), shading));
    const double length_error =
        std::max(std::abs(length(dvec3(surface.point.normal)) - 1), std::abs(length(dvec3(surface.normal)) - 1));
    errors.angles.push_back(angle);
    if (!(angle <= most_angle)) return fault(text("a normal is off by ", angle));
    if (!(length_error <= most_length_error)) return fault(text("a normal's length is off by ", length_error));
    if (!surface.is_front) fault("the back of a triangle that shows its front");
}

std::vector<Surface> surfaces_of(AbstractAccel& accel, const Scaled& scaled) {
    const AccelHandle handle = accel.push(scaled.mesh);
    std::vector<Surface> surfaces;
    for (std::size_t i = 0; i < scaled.rays.size(); ++i) {
        accel.update_transform(handle, scaled.transforms[i]);
        const std::span<const Ray> ray(&scaled.rays[i], 1);
        surfaces.push_back(accel.surfaces(ray, accel.closest_hits(ray)).front());
    }
    return surfaces;
}

CaseRun::Outcome outcome_of(const Scaled& scaled, std::span<const Surface> surfaces, float most, NormalRule rule) {
    Errors errors;
    for (std::size_t i = 0; i < surfaces.size(); ++i) compare(scaled, i, surfaces[i], rule, errors);
    const double largest = errors.angles.empty() ? 0 : std::ranges::max(errors.angles);
    return {.params = {{"exponent", most}},
            .results = {{"largest_angle", largest}},
            .n = surfaces.size(),
            .faults = errors.faults,
            .what = errors.first,
            .reference = "f64",
            .fault_of = "twinray"};
}

}  // namespace

void surfaces_of_scaled_instances(CaseRun& run) {
    for (const float most : {1.0f, 5.0f, 9.0f}) {
        const Scaled scaled = scaled_spheres(most, run.amount(24, 2'000), run.seed());
        for (const Configuration& configuration : run.one_configuration_each()) {
            AccelOptions options = run.devices().options(configuration, run.devices().trees().layout);
            options.keeps_surfaces = true;
            Context& context = run.devices().context(configuration.backend);
            const auto accel = Devices::make_accel(context, configuration.backend, options);
            const std::vector<Surface> surfaces = surfaces_of(*accel, scaled);
            run.expect(configuration, outcome_of(scaled, surfaces, most, normals_of));
            CaseRun::Outcome control = outcome_of(scaled, surfaces, most, linear_of);
            control.control = "normals by the matrix itself";
            run.expect(configuration, control);
        }
    }
}

}  // namespace twinray::suite
