// Scale: lengths of directions, distances of hits, and denormals.
#include "report/suite/sections.h"

#include <twinray/world.h>

namespace twinray::suite {
namespace {

std::vector<Ray> stretched(std::vector<Ray> rays, float length) {
    for (Ray& ray : rays) ray.direction *= length;
    return rays;
}

// Returns rays with directions that keep all their bits at a length of 2^-100.
std::vector<Ray> rays_of_any_length(const World& world, const Bounds& bounds, std::size_t count, std::uint64_t seed) {
    std::vector<Ray> rays = mixed_rays(world, bounds, count, seed);
    std::erase_if(rays, [](const Ray& ray) {
        for (int axis = 0; axis < 3; ++axis)
            if (ray.direction[axis] != 0 && std::abs(ray.direction[axis]) < 0x1p-26f) return true;
        return false;
    });
    return rays;
}

// Leaves out hits at a t that is not a normal float when directions are this long: devices may flush it to 0, where a
// ray has not begun.
std::vector<Ray> with_normal_t(std::span<const Ray> rays, std::span<const ReferenceHit> references, float length) {
    std::vector<Ray> kept;
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (!references[i].hit || references[i].t >= 2 * double{std::numeric_limits<float>::min()} * double{length})
            kept.push_back(rays[i]);
    return kept;
}

void lengths_by_powers_of_two(CaseRun& run, const World& world, std::span<const Ray> rays) {
    const std::vector<Traced> expected = run.trace(world, rays);
    for (const int exponent : {-100, -60, -20, 20, 60, 100}) {
        const std::vector<Ray> long_rays = stretched({rays.begin(), rays.end()}, std::ldexp(1.0f, exponent));
        expect_each(run, run.trace(world, long_rays), rays,
                    {.params = {{"length", text("2^", exponent)}}, .reference = "invariance"},
                    [&](std::size_t k, std::size_t i, Hit hit) {
                        if (hit.hit) hit.t = std::ldexp(hit.t, exponent);
                        return same_bits(hit, expected[k].hits[i]) ? "" : "differs from length 1";
                    });
    }
}

// Compares answers to `rays` with `expected`, the answers with zeros in place of denormal numbers.
void expect_those_of_zeros(CaseRun& run, const Measured& measured, std::span<const Traced> expected,
                           std::span<const Ray> rays, Values params) {
    params.insert_or_assign("measured", "beside zeros");
    expect_each(run, measured.traces, rays, {.params = params, .reference = "invariance"},
                [&](std::size_t k, std::size_t i, const Hit& hit) {
                    const Hit& zero = expected[k].hits[i];
                    return hit.hit == zero.hit && std::abs(hit.t - zero.t) <= 0x1p-20f * std::abs(zero.t)
                               ? ""
                               : text("t = ", hit.t, ", with zeros ", zero.t);
                });
}

// Returns a flat fan with its hub at (hub, -hub, 0).
Mesh fan_about(float hub) {
    Mesh fan;
    fan.positions.push_back(vec3(hub, -hub, 0));
    constexpr std::array<vec2, 7> rim = {vec2(1, 0),      vec2(0.75f, 1), vec2(-0.25f, 1),    vec2(-1, 0.5f),
                                         vec2(-1, -0.5f), vec2(0, -1),    vec2(0.75f, -0.75f)};
    for (uint i = 0; i < rim.size(); ++i) {
        fan.positions.push_back(vec3(rim[i], 0));
        fan.triangles.push_back({0, 1 + i, 1 + (i + 1) % static_cast<uint>(rim.size())});
    }
    return fan;
}

}  // namespace

void lengths_of_directions(CaseRun& run) {
    const Mesh sphere = make_icosphere(3);
    const World world = world_of(sphere);
    const std::vector<Ray> rays = rays_of_any_length(world, bounds_of(sphere), run.amount(512, 100'000), run.seed());
    lengths_by_powers_of_two(run, world, rays);
    const std::vector<ReferenceHit> references = references_of(world.reference, rays);
    for (const float length : {1e-30f, 1e-20f, 1e-12f, 1e-6f, 1e6f, 1e12f, 1e20f, 1e30f, 1e36f}) {
        const std::vector<Ray> long_rays = stretched(with_normal_t(rays, references, length), length);
        const Measured measured = run.measure(world, long_rays, {.params = {{"length", length}}, .reps = 1});
        expect_refined_t(run, measured, long_rays, 1, {{"length", length}});
    }
    // Directions, or distances, are denormal.
    for (const float length : {1e-38f, 1e38f})
        expect_defined(run, world, stretched(rays, length), {{"length", length}});
}

// Rays go down at the vertices and edges of a grid, whose x they keep, and between them.
void nearly_zero_components(CaseRun& run) {
    const Mesh grid = scaled(make_grid(16, 16), 16);
    const World world = world_of(grid);
    Random random(run.seed());
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < run.amount(1'024, 100'000); ++i) {
        const float x = i % 4 ? 1 + std::floor(random.between(0, 15)) : random.between(1, 15);
        const float z = i % 2 ? 1 + std::floor(random.between(0, 15)) : random.between(1, 15);
        rays.push_back({vec3(x, 4, z + 1), 0, vec3(0, -4, -1), inf});
    }
    const Measured at_zero = run.measure(world, rays, {.params = {{"component", 0}}});
    for (const float component : {1e-30f, -1e-38f, 1e-42f, -1e-45f}) {
        for (Ray& ray : rays) ray.direction.x = component;
        const Measured measured = run.measure(world, rays, {.params = {{"component", component}}, .reps = 1});
        expect_each(run, measured.traces, rays,
                    {.params = {{"component", component}, {"measured", "beside 0"}}, .reference = "invariance"},
                    [&](std::size_t k, std::size_t i, const Hit& hit) {
                        return hit.hit == at_zero.traces[k].hits[i].hit ? ""
                                                                        : "hit or miss differs from a component of 0";
                    });
    }
}

// The square lies across the ray at `depth` and is as wide as that; the ray covers `speed` along z in a unit of t.
void largest_distances(CaseRun& run) {
    struct Setting {
        float depth, speed;
    };
    for (const auto& [depth, speed] :
         {Setting{3e38f, 1}, {3e30f, 1e-8f}, {3e8f, 1e-30f}, {3e38f, 0.5f}, {3e8f, 1e-31f}}) {
        const Mesh square = make_quad(depth * vec3(-0.5f, -0.5f, 1), vec3(depth, 0, 0), vec3(0, depth, 0));
        const double t = double{depth} / double{speed};
        const bool is_float = t <= double{std::numeric_limits<float>::max()};
        Random random(run.seed());
        std::vector<Ray> rays;
        for (std::size_t i = 0; i < run.amount(512, 50'000); ++i) {
            const float x = random.between(-0.2f, 0.2f), y = random.between(-0.2f, 0.2f);
            rays.push_back({vec3(0), 0, speed * vec3(x, y, 1), i % 2 ? inf : std::numeric_limits<float>::max()});
        }
        Values params = {{"depth", depth}, {"speed", speed}};
        const Measured measured = run.measure(world_of(square), rays, {.params = params});
        if (is_float) expect_refined_t(run, measured, rays, 1, params);
        params.insert_or_assign("measured", "hits");
        expect_each(run, measured.traces, rays, {.params = params, .reference = "analytic"},
                    [&](std::size_t, std::size_t, const Hit& hit) -> std::string {
                        if (hit.hit == (is_float ? 1u : 0u)) return "";
                        return is_float ? "missed" : text("hit at t = ", hit.t, ", which is ", t);
                    });
    }
}

void denormal_coordinates(CaseRun& run) {
    const std::size_t count = run.amount(512, 50'000);
    const Mesh sphere = make_icosphere(3);
    const World world = world_of(sphere);
    Random random(run.seed());
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i)
        rays.push_back({vec3(0), 0, i % 4 ? random.direction() : sphere.positions[i % sphere.positions.size()], inf});
    const std::vector<Traced> from_zero = run.trace(world, rays);
    for (const float size : {1e-38f, 1e-42f, 1e-45f}) {
        for (Ray& ray : rays) ray.origin = vec3(size, -size, size);
        const Measured measured = run.measure(world, rays, {.params = {{"origin", size}}, .reps = 1});
        expect_those_of_zeros(run, measured, from_zero, rays, {{"origin", size}});
    }
    for (std::size_t i = 0; i < count; ++i)
        rays[i] = ray_to(dvec3(i % 2 ? random.in_box(0.4f) : vec3(0)) * dvec3(1, 1, 0),
                         dvec3(random.in_box(0.5f) + vec3(0, 0, 2)));
    const std::vector<Traced> at_zero = run.trace(world_of(fan_about(0)), rays);
    for (const float size : {1e-38f, 1e-42f, 1e-45f}) {
        const Measured measured =
            run.measure(world_of(fan_about(size)), rays, {.params = {{"vertex", size}}, .reps = 1});
        expect_those_of_zeros(run, measured, at_zero, rays, {{"vertex", size}});
    }
}

// ---- Position: meshes far from the origin, and cameras far from meshes.

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
    const auto [a, b, c] = corners_of(mesh, mesh.triangles[primitive]);
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
        CaseRun::Outcome outcome{.params = {{"cells_away", distance}, {"measured", "points"}}, .reference = "f64"};
        if (traced.configuration.level < Level::refined) outcome.only_measured = "origins are advanced from refined on";
        if (distance > 1e9) outcome.only_measured = "float64 itself is no more exact than the bound";
        outcome = ask_each(traced, rays, outcome, [&](std::size_t i, const Hit& hit) -> std::string {
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
        outcome.results = {{"wrong_triangles", wrong}, {"missed", missed}, {"point_error_cells_max", largest}};
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
