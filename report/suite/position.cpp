// SPDX-License-Identifier: MIT
// Position: meshes far from the origin, and cameras far from meshes.
#include <algorithm>
#include <cmath>
#include <random>

#include "report/suite/demands.h"
#include "report/suite/sections.h"
#include "report/suite/scenes.h"
#include "engine/core/error.h"
#include <twinray/geometry.h>
#include <twinray/world.h>

namespace twinray::suite {

// From 1e7 on, the cells are smaller than the spacing of floats: after rounding, they are a mesh like any other.
void far_from_the_origin(CaseRun& run) {
    for (const float offset : {1.0f, 1e2f, 1e4f, 1e6f, 1e7f, 1e8f}) {
        const Mesh grid = moved(scaled(make_grid(16, 16, 0.02f, 5), 16), vec3(offset, -offset, offset));
        const World world = world_of(grid);
        run.measure(world, mixed_rays(world, bounds_of(grid), run.amount(1'024, 200'000), run.seed()),
                    {.params = {{"offset", offset}}});
    }
}

namespace {

// Returns a ray from about `distance` away and above. It takes the fewest steps of the direction's last places with
// which the line passes within `tolerance` of the target, although the origin is rounded to units far larger than that.
Ray far_ray(Random& random, const dvec3& target, double distance, double tolerance) {
    vec3 direction = random.direction();
    direction.y = -std::max(std::abs(direction.y), 0.3f);
    vec3 origin(0);
    origin.y = static_cast<float>(target.y - distance * direction.y);
    const double t = (target.y - double{origin.y}) / direction.y;
    for (const int axis : {0, 2}) {
        const auto offset = [&] {
            const double exact = target[axis] - t * direction[axis];
            origin[axis] = static_cast<float>(exact);
            return std::abs(origin[axis] - exact);
        };
        while (offset() > tolerance) direction[axis] = std::nextafter(direction[axis], 2.0f);
    }
    return {origin, 0, direction, inf};
}

dvec3 point_of(const Mesh& mesh, uint primitive, double u, double v) {
    const uvec3& triangle = mesh.triangles[primitive];
    const dvec3 a(mesh.positions[triangle.x]), b(mesh.positions[triangle.y]), c(mesh.positions[triangle.z]);
    return (1 - u - v) * a + u * b + v * c;
}

// At far cameras, the triangle is lost, and so is the point that u and v give without the coarse t. From level refined
// on, u and v are rounded once (2^-24 each) from float64, which itself rounds by 2^-53 each at the distance. Another
// triangle than the reference's is right within what float32 rounding does to a ray that begins two sizes of the field
// away, by ErrorBounds, on a surface that it meets at a slope of up to 4.
void expect_right_points(CaseRun& run, const Measured& measured, const Mesh& mesh, std::span<const Ray> rays,
                         double distance, double size) {
    const double same_bound = 0x1p-22 + distance * 0x1p-50, other_bound = 4 * 16 * 0x1p-24 * 3 * size;
    for (const Traced& traced : measured.traces) {
        double largest = 0, wrong = 0, missed = 0;
        CaseRun::Outcome outcome = ask_each(traced, rays, [&](std::size_t i, const Hit& hit) -> std::string {
            const ReferenceHit& reference = measured.references[i];
            if (!hit.hit) {
                ++missed;
                return "missed";
            }
            if (hit.primitive_index != reference.primitive) ++wrong;
            const double error = length(point_of(mesh, hit.primitive_index, double{hit.u}, double{hit.v}) -
                                        point_of(mesh, reference.primitive, reference.u, reference.v));
            largest = std::max(largest, error);
            const bool is_same = hit.primitive_index == reference.primitive;
            return error <= (is_same ? same_bound : other_bound) ? ""
                                                                 : text("a point ", error, " cells from the right one");
        });
        outcome.params = {{"cells_away", distance}, {"measured", "points"}};
        outcome.results = {{"wrong_triangles", wrong}, {"missed", missed}, {"point_error_cells_max", largest}};
        outcome.reference = "f64";
        if (traced.configuration.level < Level::refined) outcome.only_measured = "origins are advanced from refined on";
        if (distance > 1e9) outcome.only_measured = "float64 itself is no more exact than the bound";
        run.expect(traced.configuration, outcome);
    }
}

}  // namespace

void far_camera(CaseRun& run) {
    constexpr float half = 8;  // of the field, in cells
    const Mesh field = moved(scaled(make_grid(16, 16, 0.02f, 7), 2 * half), vec3(-half, 0, -half));
    const World world = world_of(field);
    for (int exponent = 1; exponent <= 12; exponent += static_cast<int>(run.amount(2, 1))) {
        const double distance = std::pow(10.0, exponent);
        Random random(run.seed());
        std::vector<Ray> rays;
        for (std::size_t i = 0; i < run.amount(96, 20'000); ++i)
            rays.push_back(far_ray(random, dvec3(random.in_box(half / 2)) * dvec3(1, 0, 1), distance, 1));
        const Measured measured = run.measure(world, rays, {.params = {{"cells_away", distance}}});
        expect_right_points(run, measured, field, rays, distance, half);
    }
}

// Traces rays in float64 that begin within 1e-4 of a plane, where float32 has steps of 6e-5 and more: the rounded ones
// begin on its other side, or far along it. A second plane lies behind.
void rays_of_double(CaseRun& run) {
    const Mesh plane = make_quad(vec3(-100, -100, 0), vec3(200, 0, 0), vec3(0, 200, 0));
    for (const double height : {1e3, 1e6, 1e9}) {
        std::mt19937_64 random(run.seed());
        const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
        std::vector<Ray64> rays;
        for (std::size_t i = 0; i < run.amount(2'000, 200'000); ++i) {
            const dvec3 origin(50 * unit(), 50 * unit(), height + 1e-4 * unit());
            rays.push_back({origin, i % 2 ? 0.0 : 1e-5, dvec3(unit(), unit(), (i % 3 ? 1e-5 : 1.0) * unit()),
                            i % 5 ? double{inf} : 20.0});
        }
        for (const Configuration& configuration : run.configurations()) {
            if (configuration.level < Level::refined) continue;
            AbstractAccel& accel = run.devices().empty_accel(configuration);
            WorldAccel world(accel, dvec3(0));
            const double heights[] = {height, height + 1e-3 * height};
            for (const double z : heights) world.push(plane, Transform64::translation({0, 0, z}));
            const std::vector<HitExact> hits = world.exact_hits(rays);
            CaseRun::Outcome outcome{.params = {{"height", height}}, .n = rays.size(), .reference = "analytic"};
            for (std::size_t i = 0; i < rays.size(); ++i) {
                if (!hits[i].hit) continue;
                const Ray64& ray = rays[i];
                const double z = double{static_cast<float>(heights[hits[i].instance_index])};
                const double t = (z - ray.origin.z) / ray.direction.z;
                const bool is_within = hits[i].t > ray.t_min && hits[i].t < ray.t_max;
                if (is_within && std::abs(hits[i].t - t) <= 1e-9 * std::abs(t)) continue;
                if (outcome.faults++ == 0) outcome.what = text("t = ", hits[i].t, " in place of ", t);
            }
            run.expect(configuration, outcome);
        }
    }
}

}  // namespace twinray::suite
