// Scale and position: sizes of meshes, and surfaces of instances with unequally scaled axes. Positions and rays are in
// scale_rays.cpp.
#include "report/suite/sections.h"

#include <numbers>

namespace twinray::suite {
namespace {

// Multiplying by a power of two is exact, so it may change nothing but t.
void powers_of_two(CaseRun& run) {
    const Mesh sphere = make_icosphere(3);
    const std::vector<Ray> rays =
        mixed_rays(world_of(sphere), bounds_of(sphere), run.amount(1'024, 20'000), run.seed());
    const int step = static_cast<int>(run.amount(25, 1));
    for (const Configuration& configuration : run.configurations()) {
        if (!is_robust(configuration)) continue;
        const auto hits_at = [&](int exponent) {
            return hits_at_scale(run, configuration, rays, exponent,
                                 [&](AbstractAccel& accel, float scale) { accel.push(scaled(sphere, scale)); });
        };
        const std::vector<Hit> expected = hits_at(0);
        CaseRun::Outcome outcome{
            .params = {{"exponents", text("-100 to 100 by ", step)}}, .n = 0, .reference = "invariance"};
        for (int exponent = -100; exponent <= 100; exponent += step) {
            const std::vector<Hit> hits = hits_at(exponent);
            outcome.n += hits.size();
            for (std::size_t i = 0; i < rays.size(); ++i)
                if (!same_bits(hits[i], expected[i]) && outcome.faults++ == 0)
                    outcome.what = text("differs at 2^", exponent, " from the unit scale: ", hexadecimal(rays[i]));
        }
        run.expect(configuration, outcome);
    }
}

void powers_of_ten(CaseRun& run) {
    for (int exponent = -18; exponent <= 18; exponent += static_cast<int>(run.amount(9, 1))) {
        const Mesh sphere = scaled(make_icosphere(3), std::pow(10.0f, static_cast<float>(exponent)));
        const World world = world_of(sphere);
        const std::vector<Ray> rays = mixed_rays(world, bounds_of(sphere), run.amount(1'024, 100'000), run.seed());
        const Measured measured = run.measure(world, rays, {.params = {{"exponent", exponent}}});
        expect_refined_t(run, measured, rays, 1, {{"exponent", exponent}});
    }
}

void ends_of_float32(CaseRun& run) {
    const std::size_t count = run.amount(1'024, 100'000);
    for (const float extent : {1e38f, 3.4e38f}) {
        const Mesh sphere = scaled(make_icosphere(2), extent);
        const World world = world_of(sphere);
        run.measure(world, vertex_aimed_rays(world.reference, count, run.seed()), {.params = {{"extent", extent}}});
    }
    for (const float extent : {1e-38f, 1e-41f, 1e-44f}) {
        const Mesh sphere = scaled(make_icosphere(2), extent);
        const World world = world_of(sphere);
        std::vector<Ray> rays = random_rays(bounds_of(sphere), count, run.seed());
        expect_defined(run, world, rays, {{"extent", extent}, {"length", 1}});
        for (Ray& ray : rays) ray.direction *= extent;
        expect_defined(run, world, rays, {{"extent", extent}, {"length", extent}});
    }
}

// Returns a closed, toothed disc about the y axis, of radius and height 1; its centre sees all of it.
Mesh make_gear(uint teeth) {
    Mesh gear;
    const uint vertices = 4 * teeth;
    for (const float y : {-0.5f, 0.5f}) {
        gear.positions.push_back(vec3(0, y, 0));
        for (uint i = 0; i < vertices; ++i) {
            const double angle = 2 * std::numbers::pi * i / vertices;
            const double radius = i % 4 < 2 ? 0.8 : 1.0;
            gear.positions.push_back(vec3(radius * std::cos(angle), y, radius * std::sin(angle)));
        }
    }
    const uint top = vertices + 1;
    for (uint i = 0; i < vertices; ++i) {
        const uint a = 1 + i, b = 1 + (i + 1) % vertices;
        for (const uvec3& triangle :
             {uvec3(0, a, b), uvec3(top, top + b, top + a), uvec3(a, top + a, b), uvec3(b, top + a, top + b)})
            gear.triangles.push_back(triangle);
    }
    return gear;
}

// Returns rays from around the middle of the gear, aimed at its vertices and edges.
std::vector<Ray> rays_inside(const Mesh& gear, std::size_t count, std::uint64_t seed) {
    Random random(seed);
    const vec3 middle = bounds_of(gear).center();
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i) {
        const uvec3& triangle = gear.triangles[i % gear.triangles.size()];
        const double along = i % 2 ? random.between(0, 1) : 0;
        const dvec3 a(gear.positions[triangle.x]), b(gear.positions[triangle.y]);
        rays.push_back(ray_to(a * (1 - along) + b * along, dvec3(middle + random.in_box(1e-7f))));
    }
    return rays;
}

void gear_on_a_floor(CaseRun& run) {
    const std::size_t count = run.amount(512, 50'000);
    const Mesh gear = moved(scaled(make_gear(24), 1e-6f), vec3(3e-6f, 1e-6f, -2e-6f));
    Mesh scene = gear;
    append(scene, make_quad(vec3(-1e6f, 0, -1e6f), vec3(0, 0, 2e6f), vec3(2e6f, 0, 0)));
    const World world = world_of(scene), only_gear = world_of(gear);
    run.measure(world, mixed_rays(only_gear, bounds_of(gear), count, run.seed()), {.params = {{"from", "beside"}}});
    for (const float height : {1.0f, 1e6f}) {
        Random random(run.seed());
        std::vector<Ray> rays;
        for (std::size_t i = 0; i < count; ++i)
            rays.push_back(ray_to(dvec3(gear.positions[i % gear.positions.size()]),
                                  dvec3(random.in_box(0.5f) + vec3(0, 1, 0)) * double{height}));
        run.measure(world, rays, {.params = {{"from", text("a height of ", height)}}});
    }
    const std::vector<Ray> inside = rays_inside(gear, count, run.seed());
    expect_each(run, run.measure(world, inside, {.params = {{"from", "inside"}}}).traces, inside,
                {.params = {{"from", "inside"}, {"measured", "leaks"}}, .reference = "analytic"},
                [&](std::size_t, std::size_t, const Hit& hit) {
                    return hit.hit && hit.primitive_index < gear.triangles.size() ? "" : "left the closed gear";
                });
}

// Each coordinate of each vertex has a size of its own.
void mixed_sizes(CaseRun& run) {
    Random random(run.seed());
    const auto coordinate = [&] {
        const float size = std::pow(10.0f, random.between(-6, 6));
        return random.between(-1, 1) < 0 ? -size : size;
    };
    const auto point = [&] {
        const float x = coordinate(), y = coordinate();
        return vec3(x, y, coordinate());
    };
    Mesh mesh;
    for (int i = 0; i < 64; ++i) {
        const vec3 a = point(), b = point();
        add_triangle(mesh, a, b, point());
    }
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < run.amount(4'096, 200'000); ++i) {
        const uint first = static_cast<uint>(3 * (i % mesh.triangles.size()));
        const dvec3 target = point_in(mesh, first, random.weights(0));
        rays.push_back(ray_to(target, dvec3(point())));
    }
    const Measured measured = run.measure(world_of(mesh), rays);
    expect_refined_t(run, measured, rays, 1, {});
}

// A triangle of 1e-18 lies above one of 1e18. Rays aim at the small one, then beside it.
void smallest_beside_largest(CaseRun& run) {
    Mesh small, large;
    add_triangle(small, vec3(-1e-18f, -1e-18f, 0), vec3(1e-18f, -1e-18f, 0), vec3(0, 1e-18f, 0));
    add_triangle(large, vec3(-1e18f, -1e18f, -1), vec3(1e18f, -1e18f, -1), vec3(0, 1e18f, -1));
    Random random(run.seed());
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < run.amount(512, 50'000); ++i) {
        vec3 target(0);
        const dvec3 weights = random.weights(0.01);
        for (uint k = 0; k < 3; ++k) target += static_cast<float>(weights[static_cast<int>(k)]) * small.positions[k];
        const float height = i % 2 ? 2e-18f : 0x1p-10f;
        rays.push_back({target + vec3(0, 0, height), 0, vec3(0, 0, -1), inf});
        rays.push_back({vec3(random.between(1, 2), random.between(1, 2), 1), 0, vec3(0, 0, -1), inf});
    }
    Scene two;
    two.meshes = {small, large};
    two.instances = {{"", 0, {}}, {"", 1, {}}};
    run.measure(world_of(two), rays, {.params = {{"meshes", 2}}});
    append(small, large);
    expect_each(run, run.trace(world_of(small), rays), rays,
                {.params = {{"meshes", 1}},
                 .reference = "analytic",
                 .only_measured = "sizes that differ by 1e36 in one mesh leave the range of float32 in its unit"},
                [](std::size_t, std::size_t i, const Hit& hit) {
                    return hit.hit && hit.primitive_index == i % 2 ? "" : "missed its triangle";
                });
}

// ---- Points and normals of hits on instances with unequally scaled axes.

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
            AccelOptions options = run.devices().options(configuration);
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

std::vector<SuiteCase> scale_cases() {
    return {
        {"S01", "a sphere times 2^k, k from -100 to 100", "ids, u, v, t", "equal to the last bit, t scaled",
         powers_of_two},
        {"S02", "a sphere times 10^k, k from -18 to 18", "hits, t",
         "0 SW_LEAK, SW_FALSE, T_ERR; refined t within 1 ulp", powers_of_ten},
        {"S03", "spheres of radius 1e38 and 3.4e38; of 1e-38 to 1e-44, where floats are denormal", "hits, errors",
         "large: 0 SW_LEAK, SW_FALSE, T_ERR; denormal: finite answers or an Error", ends_of_float32},
        {"S04", "unit cells at an offset of 10^k, k from 0 to 8, rays from near", "hits, t",
         "0 SW_LEAK, SW_FALSE, T_ERR", far_from_the_origin},
        {"S05", "unit cells seen from 10^k cells, k from 1 to 12", "wrong triangles, errors of the point in cells",
         "0 SW_LEAK, SW_FALSE, T_ERR; refined: the right point to 1e9", far_camera},
        {"S06", "a gear of 1e-6 on a floor of 1e6, in one mesh", "hits of the gear",
         "0 SW_LEAK, SW_FALSE, T_ERR; 0 rays leave the gear from inside", gear_on_a_floor},
        {"S07", "triangles whose coordinates differ by 1e12", "hits, t",
         "0 SW_LEAK, SW_FALSE, T_ERR; refined t within 1 ulp", mixed_sizes},
        {"S08", "directions of length 2^-100 to 2^100, 1e-30 to 1e36, 1e-38 and 1e38", "ids, u, v, t",
         "equal to the last bit for 2^k; 0 faults and refined t within 1 ulp for 10^k; denormal: finite answers",
         lengths_of_directions},
        {"S09", "directions with one component of 1e-30 to 1e-45", "hits beside those of a component of 0",
         "0 SW_LEAK, SW_FALSE, T_ERR; as many hits", nearly_zero_components},
        {"S10", "hits at t = 3e38, and beyond the largest float", "hits, t",
         "t within its bound; a t that is no float is a miss", largest_distances},
        {"S11", "denormal origins, denormal vertices", "hits beside those of zeros",
         "0 SW_LEAK, SW_FALSE, T_ERR; those of zeros", denormal_coordinates},
        {"S12", "a triangle of 1e-18 beside one of 1e18", "hits of either",
         "two meshes: 0 SW_LEAK, SW_FALSE, T_ERR; one mesh: measured", smallest_beside_largest},
        {"S13", "rays in float64 that begin within 1e-4 of a plane at 10^3 to 10^9", "t of exact_hits",
         "within the ray's interval, and right to 1e-9", rays_of_double},
    };
}

}  // namespace twinray::suite
