// Instances: transforms that are hard on the ray, on the box and on the inverse.
#include "report/suite/sections.h"

#include <set>

#include "report/faults/fault_injection.h"

namespace twinray::suite {
namespace {

void measure_instances(CaseRun& run, const Scene& scene, std::size_t rays, const Values& params = {}) {
    const World world = world_of(scene);
    run.measure(world, mixed_rays(world, bounds_of(scene), rays, run.seed()), {.params = params});
}

// Returns random rotations, moved to places in a box.
std::vector<Transform> rotations(std::uint64_t seed, std::size_t count, float extent) {
    Random random(seed);
    std::vector<Transform> transforms(count);
    for (Transform& transform : transforms)
        transform = Transform::translation(random.in_box(extent)) * random.rotation();
    return transforms;
}

// Returns scales between two rotations.
std::vector<Transform> stretches(std::uint64_t seed, std::size_t count, vec3 factors) {
    Random random(seed);
    std::vector<Transform> transforms(count);
    for (Transform& transform : transforms)
        transform = Transform::translation(random.in_box(5)) * random.rotation() * Transform::scaling(factors) *
                    random.rotation();
    return transforms;
}

void random_rigid(CaseRun& run) {
    const std::vector<Transform> transforms = rotations(run.seed(), run.amount(500, 10'000), 10);
    measure_instances(run, instances_of(make_icosphere(2), transforms), run.amount(4'096, 500'000));
}

void instances_stretched(CaseRun& run) {
    for (const float ratio : {1e3f, 1e6f}) {
        const vec3 factors(1, 1 / std::sqrt(ratio), std::sqrt(ratio));
        measure_instances(run, instances_of(make_icosphere(2), stretches(run.seed(), 64, factors)),
                          run.amount(2'048, 500'000), {{"ratio", ratio}});
    }
}

// The front is decided in object space: mirroring an instance does not exchange the sides.
void mirrored(CaseRun& run) {
    const Mesh sphere = make_icosphere(2);
    std::vector<Transform> transforms;
    for (uint i = 0; i < 8; ++i) {
        const auto sign = [&](uint axis) { return i >> axis & 1 ? -1.0f : 1.0f; };
        transforms.push_back(Transform::translation({3 * static_cast<float>(i), 0, 0}) *
                             Transform::scaling({sign(0), sign(1), sign(2)}));
    }
    const Scene scene = instances_of(sphere, transforms);
    const World world = world_of(scene);
    const std::vector<Ray> rays = random_rays(bounds_of(scene), run.amount(2'048, 200'000), run.seed());
    for (const Configuration& configuration : run.configurations()) {
        AbstractAccel& accel = run.devices().empty_accel(configuration);
        world.fill(accel);
        for (const Cull cull : {Cull::none, Cull::back, Cull::front}) {
            const std::vector<Hit> hits = accel.closest_hits(rays, {.cull = cull, .level = configuration.level});
            CaseRun::Outcome outcome{.params = {{"cull", cull == Cull::none   ? "none"
                                                         : cull == Cull::back ? "back"
                                                                              : "front"}},
                                     .n = rays.size(),
                                     .reference = "f64"};
            for (std::size_t i = 0; i < rays.size(); ++i) {
                const ReferenceHit expected = world.reference.closest_hit(rays[i], {0xff, flags_of(cull)});
                // The primitive does not count, because it may differ for rays at an edge.
                const bool is_right = (hits[i].hit != 0) == expected.hit &&
                                      (!expected.hit || hits[i].instance_index == expected.instance) &&
                                      (!expected.hit || std::abs(hits[i].t - expected.t) < 1e-3 * expected.t + 1e-4);
                if (!is_right && outcome.faults++ == 0) outcome.what = "differs: " + hexadecimal(rays[i]);
            }
            run.expect(configuration, outcome);
        }
    }
}

void nearly_singular(CaseRun& run) {
    for (const float condition : {1e2f, 1e4f, 1e6f, 1e8f, 1e10f, 1e12f})
        measure_instances(run, instances_of(make_icosphere(2), stretches(run.seed(), 16, {1, 1, 1 / condition})),
                          run.amount(256, 100'000), {{"condition", condition}});
}

void refused_transforms(CaseRun& run) {
    const std::vector<std::pair<const char*, Transform>> bad = {
        {"zero", Transform::scaling(vec3(0))},
        {"flat", Transform::scaling({1, 0, 1})},
        {"NaN", Transform::scaling({1, nan, 1})},
        {"infinite", Transform::translation({inf, 0, 0})},
        {"inverse beyond float32", Transform::scaling(vec3(1e-39f))},
        {"denormal", Transform::scaling(vec3(1e-38f))},
    };
    for (const Configuration& configuration : run.one_configuration_each()) {
        CaseRun::Outcome outcome{.n = bad.size(), .fault_of = "twinray"};
        for (const auto& [what, transform] : bad) {
            const std::string error = faults::what_is_thrown_by([&, &placed = transform] {
                run.devices().empty_accel(configuration).push(make_box(vec3(0), vec3(1)), placed);
            });
            if (error.find("instance") == std::string::npos && outcome.faults++ == 0)
                outcome.what = text(what, ": ", error.empty() ? "not refused" : error);
        }
        run.expect(configuration, outcome);
    }
}

// A ray meets the cube at t = 2.
void axes_far_apart(CaseRun& run) {
    const Mesh cube = make_box(vec3(-1), vec3(1));
    for (const float most : {14.0f, 20.0f, 36.0f}) {
        Random random(run.seed());
        std::vector<Transform> transforms;
        std::vector<Ray> rays;
        for (std::size_t i = 0; i < run.amount(12, 500); ++i) {
            const ScaledPlace placed = scaled_place(random, most);
            transforms.push_back(placed.transform);
            rays.push_back(placed.ray);
        }
        for (const Configuration& configuration : run.configurations()) {
            AbstractAccel& accel = run.devices().empty_accel(configuration);
            const AccelHandle handle = accel.push(cube);
            CaseRun::Outcome outcome{.params = {{"exponent", most}}, .n = rays.size(), .reference = "analytic"};
            if (!is_robust(configuration)) outcome.only_measured = "fast promises nothing at edges";
            if (configuration.level >= Level::refined)
                outcome.only_measured = "float64 in world space holds for conditions up to 10^9";
            for (std::size_t i = 0; i < rays.size(); ++i) {
                accel.update_transform(handle, transforms[i]);
                const Hit hit = accel.closest_hits(std::span(&rays[i], 1), {.level = configuration.level}).front();
                if (hit.hit && std::abs(hit.t - 2) < 1e-5f) continue;
                if (outcome.faults++ == 0)
                    outcome.what = text(hit.hit ? text("t = ", hit.t) : "a miss", ": ", hexadecimal(rays[i]));
            }
            run.expect(configuration, outcome);
        }
    }
}

// The upper and the lower half of a sphere as separate meshes, and the edges that they share.
struct Halves {
    Mesh upper, lower;
    std::vector<std::pair<uint, uint>> seam;  // vertices of both
};

Halves halves_of(const Mesh& sphere) {
    Halves halves;
    halves.upper.positions = halves.lower.positions = sphere.positions;
    std::set<std::pair<uint, uint>> of_upper, of_lower;
    for (const uvec3& t : sphere.triangles) {
        const bool is_upper = sphere.positions[t.x].z + sphere.positions[t.y].z + sphere.positions[t.z].z > 0;
        (is_upper ? halves.upper : halves.lower).triangles.push_back(t);
        for (int k = 0; k < 3; ++k) (is_upper ? of_upper : of_lower).insert(std::minmax({t[k], t[(k + 1) % 3]}));
    }
    std::ranges::set_intersection(of_upper, of_lower, std::back_inserter(halves.seam));
    return halves;
}

Transform transposed(const Transform& rotation) {
    Transform result;
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column) result.rows[row][column] = rotation.rows[column][row];
    return result;
}

// Traces rays from the middle to the seam, at its vertices and along its edges. Each half sees a ray rounded by its own
// transform: if both are the same, so is the ray, and none passes between.
void shared_seam(CaseRun& run) {
    const Halves halves = halves_of(make_icosphere(3));
    const std::size_t count = run.amount(2'048, 200'000);
    for (const bool is_same : {true, false}) {
        Random random(run.seed());
        Scene scene;
        const Transform place = Transform::translation(random.in_box(3)) * random.rotation();
        const Transform turn = is_same ? Transform() : random.rotation();
        Mesh lower = halves.lower;  // the same in the world, but for rounding
        for (vec3& position : lower.positions) position = transform_point(turn, position);
        scene.meshes = {halves.upper, lower};
        scene.instances = {{"", 0, place, {}}, {"", 1, place * transposed(turn), {}}};
        std::vector<Ray> rays;
        for (std::size_t i = 0; i < count; ++i) {
            const auto& [a, b] = halves.seam[random.below(halves.seam.size())];
            const float share = i % 2 ? 0 : random.between(0, 1);
            const vec3 target = (1 - share) * halves.upper.positions[a] + share * halves.upper.positions[b];
            rays.push_back({transform_point(place, vec3(0)), 0, transform_vector(place, target), inf});
        }
        expect_each(run, run.trace(world_of(scene), rays), rays,
                    {.params = {{"transforms", is_same ? "equal" : "different"}},
                     .reference = "analytic",
                     .only_measured = is_same ? "" : "transforms that differ round a ray apart"},
                    [](std::size_t, std::size_t, const Hit& hit) { return hit.hit ? "" : "missed"; });
    }
}

// Every ray meets every box; the lowest instance counts.
void identical_boxes(CaseRun& run) {
    const std::size_t count = run.amount(5'000, 100'000);
    const Scene scene = instances_of(make_icosphere(0), std::vector<Transform>(count));
    run.measure(world_of(scene), random_rays(bounds_of(scene), run.amount(32, 256), run.seed()),
                {.params = {{"instances", count}}, .reps = 1});
}

void many_instances(CaseRun& run) {
    const std::size_t count = run.amount(10'000, 1'000'000);
    const std::size_t rays = run.amount(1'024, 16'384);
    const Mesh tiny = make_icosphere(0, 0.01f);
    Random random(run.seed());
    std::vector<Transform> line, shell;
    for (std::size_t i = 0; i < count; ++i) {
        line.push_back(Transform::translation({static_cast<float>(i) * 0.03f, 0, 0}));
        shell.push_back(random.rotation() * Transform::translation({0, 0, 3}));
    }
    measure_instances(run, instances_of(tiny, line), rays, {{"instances", count}, {"placed", "in a line"}});
    measure_instances(run, instances_of(tiny, shell), rays, {{"instances", count}, {"placed", "on a shell"}});
}

// The camera is a few units beside the instance.
void instances_far_away(CaseRun& run) {
    for (const float distance : {1e3f, 1e5f, 1e7f}) {
        const Scene scene =
            instances_of(make_icosphere(3), {Transform::translation(vec3(distance, -distance, distance))});
        measure_instances(run, scene, run.amount(2'048, 500'000), {{"translation", distance}});
    }
}

// A flat geometry's box has no thickness until it is rotated; if rounding takes any of it away, rays are lost.
void flat_and_rotated(CaseRun& run) {
    measure_instances(run, instances_of(make_grid(4, 4), rotations(run.seed(), 100, 20)), run.amount(8'192, 1'000'000));
}

void box_touched_by_rounding(CaseRun& run) {
    const Mesh square = make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0));
    Scene scene = instances_of(square, rotations(run.seed() + 1, 100, 20));
    // Two halves of one plane share an edge within the geometry: rays at it may not slip through the box's rim.
    const World world = world_of(scene);
    run.measure(world, edge_aimed_rays(world.reference, run.amount(8'192, 1'000'000), run.seed()));
}

// Scaling instance and rays by a power of two changes only the unit: ids, u, v and t are the same to the bit.
void instances_by_powers_of_two(CaseRun& run) {
    const Mesh sphere = make_icosphere(3);
    const Scene unit = instances_of(sphere, {Transform()});
    const World world = world_of(unit);
    const std::vector<Ray> rays = mixed_rays(world, bounds_of(unit), run.amount(1'024, 100'000), run.seed());
    for (const Configuration& configuration : run.configurations()) {
        const auto hits_at = [&](int exponent) {
            return hits_at_scale(run, configuration, rays, exponent, [&](AbstractAccel& accel, float scale) {
                accel.push(sphere, Transform::scaling(vec3(scale)));
            });
        };
        const std::vector<Hit> expected = hits_at(0);
        for (const int exponent : {-60, -20, -3, 3, 20, 60})
            expect_same_bits(run, configuration, rays, hits_at(exponent), expected,
                             {.params = {{"exponent", exponent}}, .what = "differs from the unit scale: "});
    }
}

// An empty second instance makes a top level.
void with_and_without_top_level(CaseRun& run) {
    const Mesh mesh = make_soup(static_cast<uint>(run.amount(2'000, 100'000)), 23, 0.1f);
    const World world = world_of(mesh);
    const std::vector<Ray> rays = mixed_rays(world, bounds_of(mesh), run.amount(4'096, 500'000), run.seed());
    for (const Configuration& configuration : run.configurations()) {
        AbstractAccel& accel = run.devices().empty_accel(configuration);
        accel.push(mesh);
        const std::vector<Hit> alone = accel.closest_hits(rays, {.level = configuration.level});
        accel.push(Mesh{});
        const std::vector<Hit> below_top = accel.closest_hits(rays, {.level = configuration.level});
        CaseRun::Outcome outcome{
            .n = rays.size(), .what = "a hit differs where there is a top level", .reference = "invariance"};
        for (std::size_t i = 0; i < rays.size(); ++i) outcome.faults += !same_bits(alone[i], below_top[i]);
        run.expect(configuration, outcome);
    }
}

}  // namespace

std::vector<SuiteCase> instance_cases() {
    return {
        {"I01", "an identity instance beside a path without a top level", "hits", "equal to the last bit",
         with_and_without_top_level},
        {"I02", "random rotations and translations", "hits, t", "0 SW_LEAK, SW_FALSE, T_ERR", random_rigid},
        {"I03", "scales that differ by 1e3 and 1e6, between rotations", "hits, t", "0 SW_LEAK, SW_FALSE, T_ERR",
         instances_stretched},
        {"I04", "mirrored instances, culled by either side", "hits", "the front is decided in object space", mirrored},
        {"I05", "transforms of condition 1e2 to 1e12", "hits, t",
         "0 SW_LEAK, SW_FALSE, T_ERR within what the condition does to rounding", nearly_singular},
        {"I06", "singular, NaN and infinite transforms", "errors",
         "each is refused by an Error that names the instance", refused_transforms},
        {"I07", "many instances with identical boxes", "hits, time", "0 faults; the lowest instance counts",
         identical_boxes},
        {"I08", "many instances in a line and on a shell", "hits, time", "0 faults", many_instances},
        {"I09", "a translation of up to 1e7, the camera beside it", "hits, t", "0 SW_LEAK, SW_FALSE, T_ERR",
         instances_far_away},
        {"I10", "an object offset of 10^3 to 10^5 that the instance cancels",
         "rays of twinray/glsl/spawn.glsl that meet the triangle they leave", "0", leave_cancelled_offsets},
        {"I11", "flat geometries, rotated", "hits", "0 SW_LEAK, SW_FALSE, T_ERR", flat_and_rotated},
        {"I12", "boxes that a ray touches only by rounding: edges of rotated squares", "hits",
         "0 SW_LEAK, SW_FALSE, T_ERR", box_touched_by_rounding},
        {"I13", "uniform scales 2^-60 to 2^60 of instance and rays", "ids, u, v, t", "equal to the last bit, t scaled",
         instances_by_powers_of_two},
        {"I14", "axes scaled by 10^-36 to 10^36, then turned", "hits, t", "watertight: all hit, at t = 2",
         axes_far_apart},
        {"I15", "surfaces of instances with axes scaled by 10^-9 to 10^9, then turned", "normals",
         "within 1e-5 rad of float64's, of length 1", surfaces_of_scaled_instances},
        {"I16", "two halves of a sphere as instances, of equal transforms and of such as agree but for rounding",
         "rays lost where they meet", "0 of equal transforms; of others it is measured", shared_seam},
    };
}

}  // namespace twinray::suite
