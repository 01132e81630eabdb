// Boxes, filters and kernels of users: the same GLSL on every accelerator.
#include "engine/accel/trace_desc.h"
#include "validation/reference/aimed_rays.h"
#include "tests/accel/accel_fixture.h"
#include "test_kernel_hw.spv.h"
#include "test_kernel_sw.spv.h"
#include "test_program.trace_program.h"

namespace twinray {
namespace {

using test::down;
using test::error_if_any;
using test::expect_error;
using test::square;

struct Sphere {
    vec3 center;
    float radius;

    Bounds bounds() const { return {center - radius, center + radius}; }
};

class Program : public test::AccelTest {
  protected:
    std::vector<Sphere> random_spheres(std::size_t count) {
        std::vector<Sphere> spheres;
        for (std::size_t i = 0; i < count; ++i)
            spheres.push_back({vec3(unit_(random_), unit_(random_), unit_(random_)), 0.05f + 0.05f * unit_(random_)});
        return spheres;
    }
    static std::vector<Bounds> boxes_of(std::span<const Sphere> spheres) {
        std::vector<Bounds> boxes;
        for (const Sphere& sphere : spheres) boxes.push_back(sphere.bounds());
        return boxes;
    }
    // Returns rays down onto the unit square.
    std::vector<Ray> rays_down(std::size_t count) {
        std::vector<Ray> rays;
        for (std::size_t i = 0; i < count; ++i)
            rays.push_back(down(0.5f + 0.5f * unit_(random_), 0.5f + 0.5f * unit_(random_)));
        return rays;
    }

    std::mt19937 random_{5};
    std::uniform_real_distribution<float> unit_{-1, 1};
};
TWINRAY_OVER_EVERY_ACCEL(Program);

// Computes, in float64, the hit of spheres under one transform that scales and moves.
Hit expected_sphere(std::span<const Sphere> spheres, const Ray& ray, double scale, dvec3 offset) {
    Hit best = miss();
    double best_t = INFINITY;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        const dvec3 center = dvec3(spheres[i].center) * scale + offset, d(ray.direction);
        const double radius = spheres[i].radius * scale, a = dot(d, d);
        const dvec3 to_center = center - dvec3(ray.origin);
        const double middle = dot(to_center, d) / a;
        const dvec3 miss_by = to_center - middle * d;
        const double square = radius * radius - dot(miss_by, miss_by);
        if (square < 0) continue;
        const double half_chord = std::sqrt(square / a), near = middle - half_chord, far = middle + half_chord;
        const double t = near > 0 ? near : far;
        if (t <= 0 || t >= best_t) continue;
        best_t = t;
        best.hit = 1;
        best.t = static_cast<float>(t);
        best.primitive_index = static_cast<uint>(i);
    }
    return best;
}

TEST_P(Program, BoxesAreWhatTheProgramMakesOfThem) {
    const std::vector<Sphere> spheres = random_spheres(300);
    const std::vector<Bounds> boxes = boxes_of(spheres);
    const Buffer user = device_copy(spheres);
    accel().push(BoxesView{"spheres", boxes}, Transform::translation({3, 0, 0}) * Transform::scaling({2, 2, 2}),
                 {.custom_index = 9});
    const auto program = accel().make_program(test_program);
    const std::vector<Ray> rays = random_rays({vec3(1, -2, -2), vec3(5, 2, 2)}, 20'000, 7);
    const TraceDesc desc{.program = program.get(), .user_data = user.address()};
    const std::vector<Hit> hits = accel().closest_hits(rays, desc), any = accel().any_hits(rays, desc);
    std::size_t hit_count = 0, different = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Hit expected = expected_sphere(spheres, rays[i], 2, {3, 0, 0});
        EXPECT_EQ(any[i].hit, hits[i].hit);
        hit_count += expected.hit;
        if (hits[i].hit != expected.hit || hits[i].primitive_index != expected.primitive_index) {
            ++different;  // rays that graze a sphere
            continue;
        }
        if (!expected.hit) continue;
        EXPECT_NEAR(hits[i].t, expected.t, 1e-3f + 1e-4f * expected.t);
        EXPECT_EQ(hits[i].custom_index, 9u);
        EXPECT_EQ(hits[i].v, 9.0f) << "a value of the intersection's own";
    }
    EXPECT_GT(hit_count, 2000u);
    EXPECT_LE(different, 3u);
}

TEST_P(Program, TheHitThatTheFilterAcceptsIsTheClosest) {
    const std::unique_ptr<AbstractAccel> opaque = make_accel();
    for (uint i = 0; i < 6; ++i) {
        accel().push(square(static_cast<float>(i)), Transform{}, {.custom_index = i, .non_opaque = i != 3});
        opaque->push(square(static_cast<float>(i)), Transform{},
                     {.custom_index = i, .mask = static_cast<std::uint8_t>(1u << i)});
    }
    const auto program = accel().make_program(test_program);
    const std::vector<Ray> rays = rays_down(5000);
    const std::vector<Hit> hits = accel().closest_hits(rays, {.program = program.get()});
    std::vector<std::vector<Hit>> layers;
    for (uint i = 0; i < 6; ++i)
        layers.push_back(opaque->closest_hits(rays, {.mask = static_cast<std::uint8_t>(1u << i)}));
    std::array<int, 6> counts{};
    for (std::size_t r = 0; r < rays.size(); ++r) {
        Hit expected = miss();
        for (uint i = 0; i < 6; ++i) {
            const Hit& layer = layers[i][r];
            const float stripe = layer.u * 5.0f + static_cast<float>(i) * 0.3f;
            if (layer.hit && (i == 3 || stripe - std::floor(stripe) < 0.5f)) expected = layer;
        }
        ASSERT_EQ(hits[r].hit, expected.hit);
        ASSERT_EQ(hits[r].t, expected.t);
        ASSERT_EQ(hits[r].custom_index, expected.custom_index);
        ASSERT_EQ(hits[r].primitive_index, expected.primitive_index);
        ++counts[expected.custom_index];
    }
    for (const int i : {3, 4, 5}) EXPECT_GT(counts[static_cast<std::size_t>(i)], 100);
}

TEST_P(Program, AnyHitTakesOnlyWhatTheFilterAccepts) {
    accel().push(square(0), Transform{}, {.non_opaque = true});
    const auto program = accel().make_program(test_program);
    const std::vector<Ray> rays = rays_down(2000);
    const std::vector<Hit> any = accel().any_hits(rays, {.program = program.get()});
    const std::vector<Hit> closest = accel().closest_hits(rays, {.program = program.get()});
    for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(any[i].hit, closest[i].hit);
    const auto hits = std::ranges::count(any, 1u, &Hit::hit);
    EXPECT_TRUE(hits > 500 && hits < 1500) << hits;
}

TEST_P(Program, BoxesCanBeNonOpaqueToo) {
    const Sphere sphere{vec3(0.5f, 0.5f, 0), 0.4f};
    const Bounds box = sphere.bounds();
    const Buffer user = device_copy(std::vector<Sphere>{sphere});
    accel().push(BoxesView{"sphere", std::span(&box, 1)}, Transform{}, {.non_opaque = true});
    accel().push(square(-1));
    const auto program = accel().make_program(test_program);
    const std::vector<Ray> rays = rays_down(2000);
    std::size_t through = 0, stopped = 0;
    for (const Hit& hit : accel().closest_hits(rays, {.program = program.get(), .user_data = user.address()})) {
        ASSERT_EQ(hit.hit, 1u);
        (hit.instance_index == 0 ? stopped : through)++;
        if (hit.instance_index != 0) continue;
        ASSERT_LT(hit.u * 5.0f - std::floor(hit.u * 5.0f), 0.5f);
    }
    EXPECT_GT(stopped, 200u);
    EXPECT_GT(through, 200u);
}

TEST_P(Program, TrianglesAndBoxesShareAScene) {
    const std::vector<Sphere> spheres = {{vec3(0.5f, 0.5f, 2), 0.25f}, {vec3(5), 1}};
    const std::vector<Bounds> boxes = boxes_of(spheres);
    const Buffer user = device_copy(spheres);
    accel().push(square(0));
    const AccelHandle handle = accel().push(BoxesView{"spheres", boxes});
    const auto program = accel().make_program(test_program);
    const TraceDesc desc{.program = program.get(), .user_data = user.address()};
    const std::vector<Ray> rays = {down(0.5f, 0.5f), down(0.1f, 0.1f)};
    EXPECT_EQ(accel().closest_hits(rays, desc)[0].t, 7.75f);
    EXPECT_EQ(accel().closest_hits(rays, desc)[0].instance_index, 1u);
    EXPECT_EQ(accel().closest_hits(rays, desc)[1].t, 10.0f);
    accel().update_transform(handle, Transform::translation({0, 0, 1}));
    EXPECT_EQ(accel().closest_hits(rays, desc)[0].t, 6.75f);
    accel().update(handle, square(1));
    EXPECT_EQ(accel().closest_hits(rays)[0].t, 8.0f) << "triangles again, and no program is needed";
}

TEST_P(Program, WhatNoProgramCanMeetIsRefused) {
    const Bounds box{vec3(0), vec3(1)};
    const AccelHandle handle = accel().push(BoxesView{"box", std::span(&box, 1)});
    const Ray ray = down(0.5f, 0.5f);
    const auto trace = [&](const TraceDesc& desc) { accel().closest_hits(std::span(&ray, 1), desc); };
    expect_error("the scene has boxes", [&] { trace({}); });
    const auto filters_only = accel().make_program(test_program, FEATURE_FILTERS);
    expect_error("'test_program' is not specialised", [&] { trace({.program = filters_only.get()}); });
    const std::unique_ptr<AbstractAccel> other = make_accel();
    const auto foreign = other->make_program(test_program);
    expect_error("made by another accelerator", [&] { trace({.program = foreign.get()}); });
    accel().erase(handle);
    accel().push(square(0), Transform{}, {.non_opaque = true});
    expect_error("non-opaque instances", [&] { trace({}); });
}

TEST_P(Program, BoxesMustBeFiniteAndNotEmpty) {
    const std::vector<Bounds> boxes = {{vec3(0), vec3(1)}, {vec3(0, 2, 0), vec3(1, 1, 1)}};
    expect_error("box 1 from (0, 2, 0) to (1, 1, 1)", [&] { accel().push(BoxesView{"b", boxes}); });
    const std::vector<Bounds> wild = {{vec3(0), vec3(1, 1, INFINITY)}};
    expect_error("must be finite", [&] { accel().push(BoxesView{"b", wild}); });
    EXPECT_EQ(accel().n_geometries(), 0u);
}

TEST_P(Program, TheFilterSeesTheDistanceOfTheGivenRayAtEveryLevel) {
    const Ray ray{vec3(0.3f, 0.6f, 1e6f), 0, vec3(0, 0, -1), INFINITY};  // far: refined moves it
    for (const Level level : {Level::watertight, Level::refined, Level::certified}) {
        if (accel().capability(feature_of(level)).support == Support::unsupported) continue;
        const std::unique_ptr<AbstractAccel> here = make_accel({.level = level});
        here->push(square(0), Transform{}, {.custom_index = 2'000'000, .non_opaque = true});
        here->push(square(1), Transform{}, {.custom_index = 1000, .non_opaque = true});
        const auto program = here->make_program(test_program);
        const Hit hit = here->closest_hits({&ray, 1}, {.level = level, .program = program.get()}).front();
        EXPECT_EQ(hit.custom_index, 2'000'000u) << "level " << static_cast<int>(level);
        EXPECT_EQ(hit.t, 1e6f);
    }
}

TEST_P(Program, LevelsThatAreUnsupportedAreRefused) {
    accel().push(square(0));
    const Ray ray = down(0.3f, 0.6f);
    for (const Level level : all_levels) {
        const bool is_unsupported = accel().capability(feature_of(level)).support == Support::unsupported;
        const std::string error = error_if_any(
            [&] { EXPECT_EQ(accel().closest_hits(std::span(&ray, 1), {.level = level}).front().t, 10.0f); });
        EXPECT_EQ(error.find("is unsupported") != std::string::npos, is_unsupported) << error;
        EXPECT_EQ(error.empty(), level <= accel().options().level) << error;
    }
    EXPECT_EQ(accel().capabilities().size(), feature_count);
}

struct KernelArgs {
    std::uint64_t accel;
    Ref<Ray> rays;
    Ref<Hit> hits;
    Uints blocked;
    uint count, mask;
};

TEST_P(Program, KernelsOfUsersTraceAsTheBatchDoes) {
    const Capability queries = accel().capability(Feature::kernel_queries);
    if (GetParam() == test::Kind::pipeline) {
        EXPECT_EQ(queries.support, Support::unsupported);
        EXPECT_EQ(queries.note, "the device has no ray queries");
        return;
    }
    ASSERT_EQ(queries.support, Support::native);
    accel().push(make_icosphere(3), Transform{}, {.mask = 1});
    accel().push(make_soup(200, 3), Transform::scaling({2, 2, 2}), {.custom_index = 4, .mask = 2});
    accel().sync();
    const std::vector<Ray> rays = random_rays({vec3(-2), vec3(2)}, 20'000, 3);
    const Buffer ray_buffer = device_copy(rays), hits(context(), {.name = "hits", .bytes = rays.size() * sizeof(Hit)}),
                 blocked(context(), {.name = "blocked", .bytes = rays.size() * 4});
    for (const uint features : {FEATURES_ALL, accel().view().features}) {
        const Kernel<KernelArgs> kernel(context(),
                                        {.name = "user kernel",
                                         .spirv = accel().is_software() ? std::span<const uint>(test_kernel_sw_spirv)
                                                                        : std::span<const uint>(test_kernel_hw_spirv),
                                         .constants = {{FEATURES_CONSTANT, features}}});
        for (const std::uint8_t mask : {std::uint8_t{0xff}, std::uint8_t{2}}) {
            Commands commands(context(), "user");
            kernel.dispatch(commands,
                            {accel().view().scene, ray_buffer.ref<Ray>(), hits.ref<Hit>(), blocked.ref<uint>(),
                             static_cast<uint>(rays.size()), mask},
                            rays.size());
            commands.submit();
            const std::vector<Hit> found = download<Hit>(context(), hits, rays.size());
            const std::vector<uint> any = download<uint>(context(), blocked, rays.size());
            const std::vector<Hit> expected =
                accel().closest_hits(rays, {.mask = mask, .cull = mask == 0xff ? Cull::none : Cull::back});
            for (std::size_t i = 0; i < rays.size(); ++i) {
                ASSERT_EQ(std::memcmp(&found[i], &expected[i], sizeof(Hit)), 0) << "ray " << i;
                ASSERT_EQ(any[i], expected[i].hit);
            }
        }
    }
}

}  // namespace
}  // namespace twinray
