// One body for every accelerator: the software one, the hardware one through each way of tracing, and the reference.
// Long because it is the contract, row by row: one fact a test, in one place. docs/contract.md lists them.
#include "engine/accel/world_bound.h"
#include "validation/reference/aimed_rays.h"
#include "tests/accel/accel_fixture.h"
#include "tests/validation/reference/meshes.h"

namespace twinray {
namespace {

using test::down;
using test::error_if_any;
using test::expect_error;
using test::square;

class Accel : public test::AccelTest {};
TWINRAY_OVER_EVERY_ACCEL_AND_THE_REFERENCE(Accel);

TEST_P(Accel, FindsTheClosestHitAndFillsEveryField) {
    accel().push(square(1));
    accel().push(square(2), Transform{}, {.custom_index = 77});
    const Hit hit = closest(down(0.25f, 0.5f));
    EXPECT_EQ(hit.hit, 1u);
    EXPECT_EQ(hit.t, 8.0f);
    EXPECT_EQ(hit.instance_index, 1u);
    EXPECT_EQ(hit.custom_index, 77u);
    EXPECT_EQ(hit.flags, HIT_FRONT);
    const Mesh mesh = square(2);
    const uvec3 corners = mesh.triangles[hit.primitive_index];
    const vec3 point = (1 - hit.u - hit.v) * mesh.positions[corners.x] + hit.u * mesh.positions[corners.y] +
                       hit.v * mesh.positions[corners.z];
    EXPECT_NEAR(point.x, 0.25f, 1e-6f);
    EXPECT_NEAR(point.y, 0.5f, 1e-6f);
}

TEST_P(Accel, AMissHasNoOtherField) {
    accel().push(square(0));
    for (const Hit& hit : {closest(down(2, 2)), any(down(2, 2))}) {
        EXPECT_EQ(hit.hit, 0u);
        EXPECT_EQ(hit.t, -1.0f);
        EXPECT_EQ(hit.primitive_index | hit.custom_index | hit.instance_index | hit.flags, 0u);
        EXPECT_EQ(hit.u, 0.0f);
        EXPECT_EQ(hit.v, 0.0f);
    }
}

TEST_P(Accel, TheIntervalIsOpenAtBothEnds) {
    accel().push(square(0));
    Ray ray = down(0.3f, 0.6f);
    ray.t_min = 10;
    EXPECT_EQ(closest(ray).hit, 0u);
    EXPECT_EQ(any(ray).hit, 0u);
    ray.t_min = std::nextafter(10.0f, 0.0f);
    EXPECT_EQ(closest(ray).hit, 1u);
    EXPECT_EQ(any(ray).hit, 1u);
    ray.t_min = 0;
    ray.t_max = 10;
    EXPECT_EQ(closest(ray).hit, 0u);
    ray.t_max = std::nextafter(10.0f, 11.0f);
    EXPECT_EQ(closest(ray).hit, 1u);
}

TEST_P(Accel, ANegativeStartIsZero) {
    accel().push(square(0));
    Ray ray = down(0.3f, 0.6f);
    ray.t_min = -100;
    EXPECT_EQ(closest(ray).t, 10.0f);
    ray.origin.z = -1;
    EXPECT_EQ(closest(ray).hit, 0u);
}

TEST_P(Accel, DistancesAreInUnitsOfTheGivenDirection) {
    accel().push(square(0));
    Ray ray = down(0.3f, 0.6f);
    ray.direction *= 4.0f;
    EXPECT_EQ(closest(ray).t, 2.5f);
}

TEST_P(Accel, TrianglesAreSeenFromBothSides) {
    accel().push(square(0));
    EXPECT_EQ(closest({vec3(0.3f, 0.6f, -10), 0, vec3(0, 0, 1), INFINITY}).hit, 1u);
}

TEST_P(Accel, InvalidRaysMiss) {
    accel().push(square(0));
    const float inf = INFINITY;
    const Ray rays[] = {
        {vec3(NAN, 0.5f, 10), 0, vec3(0, 0, -1), inf},    {vec3(0.5f, 0.5f, inf), 0, vec3(0, 0, -1), inf},
        {vec3(0.5f, 0.5f, 10), 0, vec3(0), inf},          {vec3(0.5f, 0.5f, 10), 0, vec3(0, NAN, -1), inf},
        {vec3(0.5f, 0.5f, 10), 5, vec3(0, 0, -1), 5},     {vec3(0.5f, 0.5f, 10), NAN, vec3(0, 0, -1), inf},
        {vec3(0.5f, 0.5f, 10), 0, vec3(0, 0, -1), -1},    {vec3(0.5f, 0.5f, 10), 0, vec3(0, 0, -1), NAN},
        {vec3(0.5f, 0.5f, 10), 0, vec3(0, 0, -inf), inf}, {vec3(0.5f, 0.5f, 10), -2, vec3(0, 0, -1), -1},
        {vec3(0.5f, 0.5f, 10), inf, vec3(0, 0, -1), inf}};
    for (const Hit& hit : accel().closest_hits(rays)) EXPECT_EQ(hit.hit, 0u);
    for (const Hit& hit : accel().any_hits(rays)) EXPECT_EQ(hit.hit, 0u);
}

TEST_P(Accel, AnEmptyAcceleratorAndEmptyMeshesMiss) {
    EXPECT_EQ(closest(down(0.5f, 0.5f)).hit, 0u);
    EXPECT_TRUE(accel().world_bound().is_empty());
    accel().push(Mesh{});
    EXPECT_EQ(closest(down(0.5f, 0.5f)).hit, 0u);
    accel().push(square(0));
    const Hit hit = closest(down(0.5f, 0.25f));
    EXPECT_EQ(hit.hit, 1u);
    EXPECT_EQ(hit.instance_index, 1u);
}

TEST_P(Accel, DegenerateTrianglesAreNeverHitAndKeepTheirIndex) {
    Mesh mesh = square(0);
    mesh.triangles.insert(mesh.triangles.begin(), {uvec3(0, 0, 0), uvec3(0, 1, 1), uvec3(0, 2, 2)});
    accel().push(mesh);
    const Hit hit = closest(down(0.25f, 0.5f));
    EXPECT_EQ(hit.hit, 1u);
    EXPECT_GE(hit.primitive_index, 3u);
    EXPECT_EQ(closest({vec3(-1, -1, 0), 0, vec3(1, 1, 0), INFINITY}).hit, 0u) << "in the plane of the square";
}

TEST_P(Accel, NonFiniteVerticesHideNothingElse) {
    Mesh mesh = make_grid(8, 8);
    mesh.uvs.clear();
    for (const float bad : {NAN, INFINITY}) {
        const uint first = static_cast<uint>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), {vec3(bad, 0, 0), vec3(0, bad, 0), vec3(0, 0, 1)});
        mesh.triangles.insert(mesh.triangles.begin(), uvec3(first, first + 1, first + 2));
    }
    accel().push(mesh);
    for (int i = 0; i < 64; ++i) {
        const vec3 origin((static_cast<float>(i % 8) + 0.4f) / 8, 5, (static_cast<float>(i / 8) + 0.3f) / 8);
        const Hit hit = closest({origin, 0, vec3(0, -1, 0), INFINITY});
        EXPECT_EQ(hit.hit, 1u);
        EXPECT_GE(hit.primitive_index, 2u);
    }
    EXPECT_TRUE(was_logged("2 of 130 triangles have a non-finite vertex and are inactive"));
}

TEST_P(Accel, InstancesMoveScaleRotateAndMirror) {
    const Transform rotated{{vec4(0, -1, 0, 0), vec4(1, 0, 0, 0), vec4(0, 0, 1, 0)}};
    accel().push(square(0), Transform::translation({10, 0, 3}) * Transform::scaling({2, 2, -1}));
    accel().push(square(0), Transform::translation({0, 20, 1}) * rotated);
    EXPECT_EQ(closest(down(11.5f, 1.5f)).t, 7.0f);
    EXPECT_EQ(closest(down(-0.5f, 20.5f)).t, 9.0f);
    EXPECT_EQ(closest(down(0.5f, 20.5f)).hit, 0u);
}

TEST_P(Accel, MasksHideInstances) {
    accel().push(square(1), Transform{}, {.mask = 0x01});
    accel().push(square(2), Transform{}, {.mask = 0x02});
    accel().push(square(3), Transform{}, {.mask = 0x00});
    const Ray ray = down(0.5f, 0.25f);
    for (const auto& [mask, t] : {std::pair<std::uint8_t, float>{1, 9}, {2, 8}, {3, 8}, {4, -1}, {0xff, 8}})
        EXPECT_EQ(accel().closest_hits(std::span(&ray, 1), {.mask = mask}).front().t, t) << "mask " << int{mask};
}

TEST_P(Accel, ManyInstancesOfOneMeshKeepTheirOptions) {
    std::vector<Transform> transforms;
    std::vector<InstanceOptions> options;
    for (uint i = 0; i < 200; ++i) {
        transforms.push_back(Transform::translation({2.0f * static_cast<float>(i), 0, 0}));
        options.push_back({.custom_index = 1000 + i});
    }
    const AccelHandle handle = accel().push(square(0), transforms, options);
    EXPECT_EQ(accel().n_instances(handle), 200u);
    for (const uint i : {0u, 57u, 199u}) {
        const Hit hit = closest(down(2.0f * static_cast<float>(i) + 0.5f, 0.25f));
        EXPECT_EQ(hit.instance_index, i);
        EXPECT_EQ(hit.custom_index, 1000 + i);
    }
    accel().update_transform_at(handle, 57, Transform::translation({-5, -5, 0}));
    EXPECT_EQ(closest(down(-4.5f, -4.75f)).custom_index, 1057u);
    EXPECT_EQ(closest(down(114.5f, 0.25f)).hit, 0u);
}

TEST_P(Accel, PushCopiesTheMesh) {
    Mesh mesh = square(0);
    accel().push(mesh);
    for (vec3& position : mesh.positions) position.z = 3;
    mesh = {};
    EXPECT_EQ(closest(down(0.5f, 0.25f)).t, 10.0f);
}

TEST_P(Accel, AGeometryMayHaveNoInstances) {
    const AccelHandle handle = accel().push(square(0), std::span<const Transform>{});
    EXPECT_EQ(closest(down(0.5f, 0.25f)).hit, 0u);
    EXPECT_TRUE(accel().world_bound().is_empty());
    EXPECT_TRUE(accel().is_valid(handle));
    EXPECT_EQ(accel().n_instances(), 0u);
    EXPECT_EQ(accel().n_geometries(), 1u);
    EXPECT_TRUE(accel().get_instances(handle).empty());
    EXPECT_EQ(accel().instance_buffer(handle).count, 0u);
}

TEST_P(Accel, CustomIndicesHave24Bits) {
    accel().push(square(0), Transform{}, {.custom_index = 0xffffff, .mask = 0x80});
    EXPECT_EQ(closest(down(0.5f, 0.25f)).custom_index, 0xffffffu);
}

TEST_P(Accel, EraseKeepsTheOrderOfTheOthers) {
    const AccelHandle first = accel().push(square(0));
    const AccelHandle second = accel().push(square(1));
    accel().push(square(2));
    accel().sync();
    EXPECT_TRUE(accel().erase(second));
    EXPECT_FALSE(accel().erase(second));
    EXPECT_FALSE(accel().is_valid(second));
    EXPECT_TRUE(accel().is_valid(first));
    const Hit hit = closest(down(0.5f, 0.25f));
    EXPECT_EQ(hit.t, 8.0f);
    EXPECT_EQ(hit.instance_index, 1u);
    EXPECT_EQ(accel().n_instances(), 2u);
    EXPECT_EQ(accel().n_geometries(), 2u);
}

TEST_P(Accel, ErasingEverythingLeavesAnEmptyAcceleratorThatFillsAgain) {
    std::vector<AccelHandle> handles;
    for (int i = 0; i < 40; ++i) handles.push_back(accel().push(square(static_cast<float>(i) / 10)));
    EXPECT_EQ(closest(down(0.5f, 0.25f)).instance_index, 39u);
    for (const AccelHandle handle : handles) EXPECT_TRUE(accel().erase(handle));
    EXPECT_EQ(closest(down(0.5f, 0.25f)).hit, 0u);
    EXPECT_TRUE(accel().world_bound().is_empty());
    EXPECT_EQ(accel().n_instances() + accel().n_geometries(), 0u);
    accel().push(square(2));
    EXPECT_EQ(closest(down(0.5f, 0.25f)).t, 8.0f);
}

TEST_P(Accel, HandlesAreNeverReused) {
    const AccelHandle first = accel().push(square(0));
    EXPECT_TRUE(accel().erase(first));
    const AccelHandle second = accel().push(square(0));
    EXPECT_NE(first, second);
    EXPECT_FALSE(accel().is_valid(first));
    EXPECT_FALSE(accel().is_valid(AccelHandle{})) << "the default is dead";
}

TEST_P(Accel, ADeadHandleIsRefusedByEveryCallThatNeedsALiveOne) {
    const AccelHandle dead = accel().push(square(0));
    accel().sync();
    accel().erase(dead);
    const std::vector<Transform> one(1);
    const Buffer source = device_copy(one);
    const std::function<void()> calls[] = {
        [&] { accel().update(dead, square(1)); },
        [&] { accel().update_transform(dead, {}); },
        [&] { accel().update_transforms(dead, one); },
        [&] { accel().update_transforms(dead, source.ref<Transform>(), 1); },
        [&] { accel().update_transform_at(dead, 0, {}); },
        [&] { static_cast<void>(accel().instance_buffer(dead)); },
        [&] { accel().mark_transforms_dirty(dead); },
        [&] { static_cast<void>(accel().get_instance(dead, 0)); },
        [&] { static_cast<void>(accel().get_instances(dead)); },
    };
    for (const std::function<void()>& call : calls) expect_error(text("handle ", dead.id, " is not alive"), call);
    EXPECT_FALSE(accel().erase(dead));
    EXPECT_EQ(accel().n_instances(dead), 0u);
}

TEST_P(Accel, TheRevisionCountsChangesOfStructureOnly) {
    const AccelHandle handle = accel().push(square(0));
    accel().sync();
    const std::uint64_t built = accel().revision();
    accel().sync();
    EXPECT_EQ(accel().revision(), built);
    accel().update_transform(handle, Transform::translation({1, 0, 0}));
    accel().sync();
    accel().update_transform(handle, {});
    accel().sync();
    EXPECT_EQ(accel().revision(), built) << "moves";
    accel().update(handle, square(1));
    EXPECT_EQ(accel().revision(), built) << "not before the sync";
    accel().sync();
    EXPECT_EQ(accel().revision(), built + 1);
    accel().push(square(2));
    accel().erase(handle);
    accel().sync();
    EXPECT_EQ(accel().revision(), built + 2) << "one sync, one step";
}

TEST_P(Accel, WaitingForTheGpuReachesTheLastSync) {
    accel().push(square(0));
    const SyncPoint done = accel().sync();
    accel().wait_for_gpu();
    EXPECT_TRUE(context().is_reached(done));
}

TEST_P(Accel, ACleanSyncDoesNothing) {
    accel().push(square(0));
    const SyncPoint first = accel().sync();
    const std::uint64_t revision = accel().revision();
    const SyncPoint submitted = context().last_submission();
    EXPECT_EQ(accel().sync().value, first.value);
    EXPECT_EQ(accel().revision(), revision);
    EXPECT_EQ(context().last_submission().value, submitted.value);
}

TEST_P(Accel, TheWorldBoundHoldsAllInstances) {
    const AccelHandle handle = accel().push(square(0), Transform::translation({3, 4, 5}));
    accel().sync();
    EXPECT_EQ(accel().world_bound().lo, vec3(3, 4, 5));
    EXPECT_EQ(accel().world_bound().hi, vec3(4, 5, 5));
    accel().update_transform(handle, Transform::translation({-1, 0, 0}));
    accel().sync();
    EXPECT_EQ(accel().world_bound().lo, vec3(-1, 0, 0));
}

TEST_P(Accel, WrongUseNamesTheObjectTheValueAndTheLimitAndChangesNothing) {
    const AccelHandle pair = accel().push(square(0), std::vector<Transform>(2));
    accel().sync();
    const AccelView view = accel().view();
    Mesh wild = square(0);
    wild.name = "wild";
    wild.triangles[1].z = 9;
    const std::vector<InstanceOptions> three(3);
    const std::pair<std::function<void()>, const char*> cases[] = {
        {[&] { accel().push(wild); }, "mesh 'wild': triangle 1"},
        {[&] { accel().push(square(0), Transform{}, {.custom_index = 1u << 24}); }, "16777216"},
        {[&] {
             accel().push(square(0), Transform::scaling({1, 1, 0}));
         },
         "singular"},
        {[&] {
             accel().push(square(0), Transform::translation({NAN, 0, 0}));
         },
         "not finite"},
        {[&] {
             accel().push(square(0), Transform::scaling({1e-39f, 1, 1}));
         },
         "no inverse in float32"},
        {[&] { accel().push(square(0), std::vector<Transform>(2), three); }, "3 instance options for 2 transforms"},
        {[&] { accel().update_transform(pair, {}); }, "2 instances, not 1"},
        {[&] { accel().update_transforms(pair, std::vector<Transform>(5)); }, "5 transforms for the 2 instances"},
        {[&] { accel().update_transform_at(pair, 2, {}); }, "index 2 of the 2"},
        {[&] { accel().update_transforms(pair, {18}, 2); }, "device address 18 must be a multiple of 4 and not 0"},
        {[&] { accel().update_transforms(pair, {16}, 3); }, "3 transforms for the 2 instances"},
        {[&] {
             accel().update_transforms(pair, std::vector<Transform>{{}, Transform::scaling({0, 1, 1})});
         },
         "instance 1: transform is singular"},
        {[&] { accel().update(pair, wild); }, "mesh 'wild': triangle 1"},
        {[&] { accel().update_transform({~0ull}, {}); }, "handle 18446744073709551615 is not alive"},
    };
    for (const auto& [action, expected] : cases) expect_error(expected, action);
    EXPECT_EQ(accel().n_instances(), 2u);
    EXPECT_EQ(accel().view().revision, view.revision) << "no edit is pending";
    EXPECT_EQ(accel().get_instance(pair, 0).transform, Transform{});
    EXPECT_EQ(trace(view, down(0.5f, 0.25f)).t, 10.0f);
}

TEST_P(Accel, StaleViewsAreRefused) {
    const AccelHandle handle = accel().push(square(0));
    expect_error("sync", [&] { accel().view(); });
    accel().sync();
    const AccelView stale = accel().view();
    accel().update(handle, square(1));
    accel().sync();
    Commands commands(context(), "stale");
    expect_error("stale", [&] { accel().trace(commands, stale, {.rays = {16}, .hits = {16}, .count = 1}); });
}

TEST_P(Accel, ViewsOfAnotherAcceleratorAreRefused) {
    const std::unique_ptr<AbstractAccel> other = make_accel();
    for (AbstractAccel* each : {&accel(), other.get()}) {
        each->push(square(0));
        each->sync();
    }
    Commands commands(context(), "foreign");
    const TraceDesc desc{.rays = {16}, .hits = {16}, .count = 1};
    expect_error("another accelerator", [&] { accel().trace(commands, other->view(), desc); });
}

TEST_P(Accel, TraceRefusesAddressesAndCountsItCannotServe) {
    accel().push(square(0));
    accel().sync();
    const AccelView view = accel().view();
    Commands commands(context(), "refused");
    const std::pair<TraceDesc, const char*> cases[] = {
        {{.rays = {18}, .hits = {16}, .count = 1}, "rays at 18"},
        {{.rays = {20}, .hits = {16}, .count = 1}, "rays at 20 and hits at 16 must be aligned to 8 bytes"},
        {{.rays = {16}, .hits = {20}, .count = 1}, "hits at 20"},
        {{.rays = {16}, .hits = {16}, .count = 1, .indirect_count = {2}}, "indirect count at 2"},
        {{.rays = {0}, .hits = {16}, .count = 1}, "address of rays or hits is 0"},
        {{.rays = {16}, .hits = {0}, .count = 1}, "address of rays or hits is 0"},
        {{.rays = {64}, .hits = {88}, .count = 1}, "32 bytes of rays at 64 and of hits at 88 must not overlap"},
        {{.rays = {88}, .hits = {32}, .count = 2}, "64 bytes of rays at 88 and of hits at 32 must not overlap"},
        {{.rays = {16}, .hits = {16}, .count = 1ull << 32}, "4294967296 rays; at most 4294967295"},
    };
    for (const auto& [desc, expected] : cases)
        expect_error(expected, [&, refused = desc] { accel().trace(commands, view, refused); });
    accel().trace(commands, view, {.rays = {}, .hits = {}, .count = 0});
    commands.submit();
    EXPECT_TRUE(accel().closest_hits({}).empty());
}

TEST_P(Accel, HitsAreVisibleToLaterPassesOfTheSameCommands) {
    accel().push(square(0));
    accel().sync();
    const Buffer rays = device_copy(std::vector<Ray>{down(0.5f, 0.25f)}), hits = device_copy(std::vector<Hit>(1)),
                 copy = device_copy(std::vector<Hit>(1));
    Commands commands(context(), "trace and use");
    accel().trace(commands, accel().view(), {.rays = rays.ref<Ray>(), .hits = hits.ref<Hit>(), .count = 1});
    {
        const auto pass = commands.pass("use");
        commands.copy(hits, 0, copy, 0, sizeof(Hit));
    }
    commands.submit();
    EXPECT_EQ(download<Hit>(context(), copy, 1).front().t, 10.0f);
}

// If hardware finds two triangles at one distance, the driver chooses.
TEST_P(Accel, EqualDistancesAreDecidedByInstanceThenPrimitive) {
    Mesh twice = square(0);
    for (const uvec3 triangle : square(0).triangles) twice.triangles.push_back(triangle);
    accel().push(twice, Transform::translation({0, 0, -1}));
    accel().push(twice, std::vector<Transform>(9));
    for (const vec3 at : {vec3(0.7f, 0.2f, 0), vec3(0.2f, 0.7f, 0)}) {
        const Hit hit = closest(down(at.x, at.y));
        EXPECT_EQ(hit.t, 10.0f);
        if (!is_ours()) continue;
        EXPECT_EQ(hit.instance_index, 1u);
        EXPECT_LT(hit.primitive_index, 2u);
    }
}

TEST_P(Accel, MovesKeepTheViewAndShowInIt) {
    const AccelHandle handle = accel().push(square(0), std::vector<Transform>(3));
    accel().sync();
    const AccelView view = accel().view();
    for (int step = 1; step <= 3; ++step) {
        accel().update_transform_at(handle, 1, Transform::translation({0, 0, static_cast<float>(step)}));
        accel().sync();
        EXPECT_EQ(accel().revision(), view.revision);
        EXPECT_EQ(accel().view().scene, view.scene);
        const Hit hit = trace(view, down(0.5f, 0.25f));
        EXPECT_EQ(hit.t, 10.0f - static_cast<float>(step));
        EXPECT_EQ(hit.instance_index, 1u);
    }
}

TEST_P(Accel, UpdateReplacesTheMeshOfAllInstancesOfItsHandle) {
    const Transform places[] = {Transform{}, Transform::translation({5, 0, 0})};
    const InstanceOptions options[] = {{.custom_index = 3}, {.custom_index = 4}};
    const AccelHandle handle = accel().push(square(0), places, options);
    accel().sync();
    accel().update(handle, make_icosphere(3));
    EXPECT_EQ(closest(down(0.1f, 0.2f)).custom_index, 3u);
    const Hit hit = closest(down(5.1f, 0.2f));
    EXPECT_EQ(hit.custom_index, 4u);
    EXPECT_NEAR(hit.t, 9.0f, 0.1f);
    EXPECT_LT(accel().world_bound().lo.x, -0.9f);
    accel().update(handle, Mesh{});
    EXPECT_EQ(closest(down(0.1f, 0.2f)).hit, 0u);
    EXPECT_TRUE(accel().world_bound().is_empty());
    accel().update(handle, square(2));
    EXPECT_EQ(closest(down(5.5f, 0.25f)).t, 8.0f);
}

TEST_P(Accel, TransformsComeFromDeviceMemory) {
    const AccelHandle other = accel().push(square(-5));
    const AccelHandle handle = accel().push(square(0), std::vector<Transform>(3),
                                            std::vector<InstanceOptions>{{.custom_index = 1}, {.custom_index = 2}, {}});
    const std::vector<Transform> moved = {Transform::translation({2, 0, 1}), Transform::translation({4, 0, 2}),
                                          Transform::translation({6, 0, 3})};
    const Buffer source = device_copy(moved);
    accel().update_transforms(handle, source.ref<Transform>(), 3);
    EXPECT_EQ(closest(down(2.5f, 0.25f)).t, 9.0f);
    EXPECT_EQ(closest(down(4.5f, 0.25f)).custom_index, 2u);
    EXPECT_EQ(accel().get_instance(handle, 2).transform, moved[2]);
    // A later host edit wins, but only where it was made.
    accel().update_transforms(handle, source.ref<Transform>(), 3);
    accel().update_transform_at(handle, 0, Transform::translation({0, 0, 5}));
    EXPECT_EQ(closest(down(0.5f, 0.25f)).t, 5.0f);
    EXPECT_EQ(closest(down(6.5f, 0.25f)).t, 7.0f);
    accel().update_transforms(handle, source.ref<Transform>(), 3);
    accel().update_transform_at(handle, 0, Transform{});
    accel().update_transform_at(handle, 2, moved[2]);
    EXPECT_EQ(closest(down(4.5f, 0.25f)).t, 8.0f) << "between two host edits";
    // The contents of the device survive a change of structure.
    accel().erase(other);
    accel().push(square(-3));
    EXPECT_EQ(closest(down(4.5f, 0.25f)).t, 8.0f);
    EXPECT_EQ(closest(down(4.5f, 0.25f)).instance_index, 1u);
    EXPECT_EQ(accel().get_instances(handle)[1].transform, moved[1]);
    accel().update_transforms(handle, std::vector<Transform>(3));
    EXPECT_EQ(closest(down(0.5f, 0.25f)).t, 10.0f);
    EXPECT_EQ(closest(down(4.5f, 0.25f)).hit, 0u);
}

TEST_P(Accel, NewTransformsKeepCustomIndicesMasksAndFlags) {
    const std::vector<InstanceOptions> options = {
        {.custom_index = 5, .mask = 0x11},
        {.custom_index = 6, .mask = 0x22, .disable_culling = true, .flip_facing = true}};
    const AccelHandle pair = accel().push(square(0), std::vector<Transform>(2), options);
    const std::vector<Transform> moved = {Transform::translation({0, 0, 1}), Transform::translation({0, 0, 2})};
    const auto expect_kept = [&] {
        accel().sync();
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_EQ(accel().get_instance(pair, i).transform, moved[i]);
            EXPECT_EQ(accel().get_instance(pair, i).options, options[i]);
        }
        EXPECT_EQ(closest(down(0.5f, 0.25f)).custom_index, 6u);
    };
    accel().update_transforms(pair, moved);
    expect_kept();
    accel().update_transforms(pair, std::vector<Transform>(2));
    for (std::size_t i = 0; i < 2; ++i) accel().update_transform_at(pair, i, moved[i]);
    expect_kept();
    const Buffer source = device_copy(moved);
    accel().update_transforms(pair, source.ref<Transform>(), 2);
    expect_kept();
}

TEST_P(Accel, InstancesComeAndGoOneByOne) {
    const Transform places[] = {Transform{}, Transform::translation({2, 0, 0}), Transform::translation({4, 0, 0})};
    const AccelHandle handle = accel().push(square(0), std::span(places, 1));
    const AccelHandle other = accel().push(square(5), Transform::translation({20, 0, 0}));
    EXPECT_EQ(closest(down(0.5f, 0.25f)).t, 10.0f);
    const InstanceOptions options[] = {{.custom_index = 7}, {.custom_index = 8}};
    EXPECT_EQ(accel().append_instances(handle, std::span(places).subspan(1), options), 1u);
    EXPECT_EQ(accel().n_instances(handle), 3u);
    EXPECT_EQ(closest(down(4.5f, 0.25f)).custom_index, 8u);
    EXPECT_EQ(accel().index_in_handle(closest(down(2.5f, 0.25f))), 1u);
    EXPECT_EQ(accel().handle_of(closest(down(20.5f, 0.25f))), other);
    accel().erase_instance(handle, 1);
    EXPECT_EQ(closest(down(2.5f, 0.25f)).hit, 0u);
    EXPECT_EQ(accel().index_in_handle(closest(down(4.5f, 0.25f))), 1u);
    EXPECT_EQ(closest(down(20.5f, 0.25f)).t, 5.0f);
    EXPECT_EQ(accel().get_instance(handle, 1).options, options[1]);
    expect_error("index 2 of the 2 instances", [&] { accel().erase_instance(handle, 2); });
    expect_error("2 instance options for 3", [&] { accel().append_instances(handle, places, options); });
    accel().erase_instance(handle, 1);
    accel().erase_instance(handle, 0);
    EXPECT_EQ(closest(down(0.5f, 0.25f)).hit, 0u);
    accel().append_instances(handle, places);
    EXPECT_EQ(closest(down(4.5f, 0.25f)).t, 10.0f);
}

TEST_P(Accel, HandlesShareAGeometry) {
    const Transform here[] = {Transform{}},
                    there[] = {Transform::translation({2, 0, 0}), Transform::translation({4, 0, 0})};
    const AccelHandle first = accel().push(make_icosphere(4), here);
    accel().sync();
    const std::uint64_t built = accel().memory_usage().geometries;
    const InstanceOptions options[] = {{.custom_index = 5}, {.custom_index = 6}};
    const AccelHandle second = accel().push_instances_of(first, there, options);
    EXPECT_EQ(accel().n_geometries(), 1u);
    EXPECT_NEAR(closest(down(4.0f, 0.0f)).t, 9.0f, 0.1f);
    EXPECT_LE(accel().memory_usage().geometries, built) << "less where a driver compacts it";
    EXPECT_EQ(closest(down(4.0f, 0.0f)).custom_index, 6u);
    EXPECT_EQ(accel().handle_of(closest(down(2.0f, 0.0f))), second);
    EXPECT_EQ(accel().handle_of(closest(down(0.0f, 0.0f))), first);
    EXPECT_EQ(accel().index_in_handle(closest(down(4.0f, 0.0f))), 1u);
    // A change applies to all instances, and the geometry lives as long as one of its handles.
    accel().update(first, square(3));
    EXPECT_EQ(closest(down(4.5f, 0.25f)).t, 7.0f);
    EXPECT_TRUE(accel().erase(first));
    EXPECT_EQ(closest(down(0.5f, 0.25f)).hit, 0u);
    EXPECT_EQ(closest(down(2.5f, 0.25f)).t, 7.0f);
    accel().update_vertices(second, square(4).positions);
    EXPECT_EQ(closest(down(2.5f, 0.25f)).t, 6.0f);
    accel().update_transforms(second, std::array{Transform{}, Transform::translation({4, 0, 1})});
    EXPECT_EQ(closest(down(0.5f, 0.25f)).t, 6.0f);
    EXPECT_EQ(closest(down(4.5f, 0.25f)).t, 5.0f);
    expect_error("is not alive", [&] { accel().push_instances_of(first, here); });
    EXPECT_TRUE(accel().erase(second));
    EXPECT_EQ(closest(down(0.5f, 0.25f)).hit, 0u);
    EXPECT_EQ(accel().n_geometries(), 0u);
}

TEST_P(Accel, AHandleHasTheBoxOfItsGeometry) {
    Mesh mesh = make_box(vec3(-1, -2, -3), vec3(4, 5, 6));
    mesh.normals.clear();
    mesh.uvs.clear();
    mesh.positions.push_back(vec3(100));  // no triangle uses it
    const AccelHandle handle = accel().push(mesh, Transform::translation({50, 0, 0})), empty = accel().push(Mesh{});
    expect_error("edits are pending", [&] { accel().object_bound(handle); });
    accel().sync();
    EXPECT_EQ(accel().object_bound(handle).lo, vec3(-1, -2, -3));
    EXPECT_EQ(accel().object_bound(handle).hi, vec3(4, 5, 6));
    EXPECT_TRUE(accel().object_bound(empty).is_empty());
}

TEST_P(Accel, KernelsMoveInstancesInTheirBuffer) {
    const AccelHandle handle = accel().push(square(0), std::vector<Transform>(2));
    expect_error("call sync() first", [&] { accel().instance_buffer(handle); });
    expect_error("call sync() first", [&] { accel().mark_transforms_dirty(handle); });
    accel().sync();
    const InstanceRange range = accel().instance_buffer(handle);
    EXPECT_EQ(range.count, 2u);
    const Transform up = Transform::translation({0, 0, 6});
    write_instances(range, sizeof(InstanceRecord), up);
    accel().mark_transforms_dirty(handle);
    EXPECT_EQ(closest(down(0.5f, 0.25f)).t, 4.0f);
    EXPECT_EQ(closest(down(0.5f, 0.25f)).instance_index, 1u);
    EXPECT_EQ(accel().get_instance(handle, 1).transform, up);
    EXPECT_EQ(accel().get_instance(handle, 0).transform, Transform{});
    EXPECT_EQ(accel().world_bound().hi.z, 6.0f);
}

TEST_P(Accel, KernelsMaskInstancesInTheirBuffer) {
    if (GetParam() == test::Kind::reference) return;  // it takes no options
    const std::unique_ptr<AbstractAccel> masked =
        make_accel({.masks_on_device = true, .compiles_in_background = false});
    const Transform places[] = {Transform{}, Transform::translation({0, 0, 1}), Transform::translation({0, 0, 2})};
    const AccelHandle handle = masked->push(square(0), places);
    masked->sync();
    const uint with_mask_2 = 2u << 24 | 77u;
    write_instances(masked->instance_buffer(handle),
                    2 * sizeof(InstanceRecord) + offsetof(InstanceRecord, custom_index_mask), with_mask_2);
    masked->mark_transforms_dirty(handle);
    const Ray ray = down(0.5f, 0.25f);
    const auto seen = [&](std::uint8_t mask) {
        return masked->closest_hits(std::span(&ray, 1), {.mask = mask}).front();
    };
    EXPECT_EQ(seen(1).t, 9.0f);
    EXPECT_EQ(seen(2).t, 8.0f);
    EXPECT_EQ(seen(2).custom_index, 77u);
    EXPECT_EQ(masked->get_instance(handle, 2).options.mask, 2u);
    masked->push(square(-5));  // the written instance moves along
    EXPECT_EQ(seen(1).t, 9.0f);
    masked->update_options(handle, 2, {.mask = 1});
    EXPECT_EQ(seen(1).t, 8.0f);
}

TEST_P(Accel, UnusableTransformsFromTheDeviceAreInactiveAndCounted) {
    const AccelHandle handle = accel().push(square(0), std::vector<Transform>(4));
    const Buffer source =
        device_copy(std::array{Transform::translation({0, 0, NAN}), Transform::scaling({1, 0, 1}),
                               Transform::translation({0, 0, 1}), Transform::translation({INFINITY, 0, 0})});
    accel().update_transforms(handle, source.ref<Transform>(), 4);
    EXPECT_EQ(closest(down(0.5f, 0.25f)).t, 9.0f);
    EXPECT_EQ(closest(down(0.5f, 0.25f)).instance_index, 2u);
    EXPECT_EQ(accel().world_bound().lo.z, 1.0f);
    accel().update_transform_at(handle, 2, Transform::translation({0, 0, 2}));
    accel().sync();
    EXPECT_TRUE(was_logged("3 instances have a transform that is singular or not finite"));
}

// Combines scales along axes with a rotation, in either order.
TEST_P(Accel, EveryTransformThatPushAcceptsIsActive) {
    std::mt19937 random(1);
    const AccelHandle base = accel().push(make_box(vec3(-1), vec3(1)));
    int accepted = 0;
    for (const double most : {14.0, 20.0, 36.0})
        for (int i = 0; i < 200; ++i)
            for (const auto made = test::scaled_and_turned(random, most); const Transform& transform : made.both)
                if (const std::string fault =
                        error_if_any([&] { accel().push_instances_of(base, std::span(&transform, 1)); });
                    fault.empty())
                    ++accepted;
                else
                    EXPECT_NE(fault.find("transform has no inverse in float32"), std::string::npos) << fault;
    EXPECT_GT(accepted, 1000) << "of 1200";
    for (const float tiny : {1e-38f, 1e-40f})
        expect_error("denormal", [&] { accel().push(square(0), Transform::scaling(vec3(tiny))); });
    accel().sync();
    accel().world_bound();  // counts inactive ones
    accel().update_transform_at(base, 0, Transform::translation({0, 0, 1}));
    accel().sync();
    EXPECT_FALSE(was_logged("inactive"));
}

TEST_P(Accel, InstancesTellTheirState) {
    const Transform place = Transform::translation({1, 2, 3});
    const AccelHandle handle = accel().push(square(0), place, {.custom_index = 9, .mask = 0x0f});
    EXPECT_EQ(accel().get_instance(handle, 0).transform, place);
    EXPECT_EQ(accel().get_instance(handle, 0).options.custom_index, 9u);
    EXPECT_EQ(accel().get_instance(handle, 0).options.mask, 0x0f);
    accel().update_transform(handle, {});
    EXPECT_EQ(accel().get_instances(handle).size(), 1u);
    EXPECT_EQ(accel().get_instance(handle, 0).options.custom_index, 9u);
    expect_error("index 1 of the 1", [&] { accel().get_instance(handle, 1); });
}

// The square faces up: a ray down sees its front, the ray up its back.
TEST_P(Accel, OptionsOfAnInstanceChangeWhereItStands) {
    const std::vector<Transform> places = {Transform::translation({0, 0, 1}), Transform::translation({5, 0, 2})};
    const AccelHandle handle = accel().push(square(0), places);
    accel().sync();
    accel().update_options(handle, 1, {.custom_index = 77, .mask = 2});
    EXPECT_EQ(closest(down(5.5f, 0.25f)).custom_index, 77u);
    EXPECT_EQ(closest(down(5.5f, 0.25f)).t, 8.0f);
    EXPECT_EQ(closest(down(0.5f, 0.25f)).custom_index, 0u);
    const Ray ray = down(5.5f, 0.25f);
    EXPECT_EQ(accel().closest_hits(std::span(&ray, 1), {.mask = 4}).front().hit, 0u);
    EXPECT_EQ(accel().closest_hits(std::span(&ray, 1), {.mask = 2}).front().hit, 1u);
    if (GetParam() != test::Kind::reference) {  // moved by the device, it stays there
        const Buffer moved = device_copy(std::vector{places[0], Transform::translation({5, 0, 4})});
        accel().update_transforms(handle, moved.ref<Transform>(), 2);
        accel().sync();
        accel().update_options(handle, 1, {.custom_index = 78});
        EXPECT_EQ(accel().get_instance(handle, 1).options.custom_index, 78u);
        EXPECT_EQ(closest(ray).t, 6.0f);
        EXPECT_EQ(closest(ray).custom_index, 78u);
        const Buffer again = device_copy(std::vector{places[0], Transform::translation({5, 0, 3})});
        accel().update_transforms(handle, again.ref<Transform>(), 2);
        accel().update_options(handle, 1, {.custom_index = 79});  // before the sync that moves it
        EXPECT_EQ(closest(ray).t, 7.0f);
        EXPECT_EQ(closest(ray).custom_index, 79u);
        accel().update_options(handle, 1, {.custom_index = 80});
        accel().update_transform_at(handle, 1, Transform::translation({5, 0, 5}));
        EXPECT_EQ(closest(ray).t, 5.0f);
        EXPECT_EQ(closest(ray).custom_index, 80u);
    }
    expect_error("index 2 of the 2", [&] { accel().update_options(handle, 2, {}); });
    expect_error("24 bits", [&] { accel().update_options(handle, 0, {.custom_index = 1u << 24}); });
    accel().erase(handle);
    EXPECT_THROW(accel().update_options(handle, 0, {}), Error);
}

TEST_P(Accel, CullingHidesOneSideAndInstancesMayTurnOrRefuseIt) {
    const InstanceOptions options[] = {
        {}, {.flip_facing = true}, {.disable_culling = true}, {.disable_culling = true, .flip_facing = true}};
    std::vector<Transform> places;
    for (int i = 0; i < 4; ++i) places.push_back(Transform::translation({2.0f * static_cast<float>(i), 0, 0}));
    accel().push(square(0), places, options);
    const Transform mirrored = Transform::translation({9, 0, 0}) * Transform::scaling({-1, 1, 1});
    accel().push(square(0), mirrored);  // facing is decided in object space
    std::vector<Ray> rays;
    for (int i = 0; i < 5; ++i) {
        const float x = i == 4 ? 8.5f : 2.0f * static_cast<float>(i) + 0.5f;
        rays.push_back(down(x, 0.25f));
        rays.push_back({vec3(x, 0.25f, -10), 0, vec3(0, 0, 1), INFINITY});
    }
    const std::pair<Cull, std::vector<uint>> cases[] = {{Cull::none, {1, 1, 1, 1, 1, 1, 1, 1, 1, 1}},
                                                        {Cull::back, {1, 0, 0, 1, 1, 1, 1, 1, 1, 0}},
                                                        {Cull::front, {0, 1, 1, 0, 1, 1, 1, 1, 0, 1}}};
    const std::vector<uint> fronts = {1, 0, 0, 1, 1, 0, 0, 1, 1, 0};
    for (const auto& [cull, expected] : cases)
        for (const std::vector<Hit>& found :
             {accel().closest_hits(rays, {.cull = cull}), accel().any_hits(rays, {.cull = cull})})
            for (std::size_t i = 0; i < rays.size(); ++i) {
                EXPECT_EQ(found[i].hit, expected[i]) << "ray " << i << ", cull " << static_cast<int>(cull);
                EXPECT_EQ(found[i].flags, found[i].hit && fronts[i] ? HIT_FRONT : 0u) << "ray " << i;
            }
}

TEST_P(Accel, SixteenMillionRaysGoInOneCall) {
    accel().push(square(0));
    accel().sync();
    constexpr std::uint64_t count = 16'000'000;
    const Buffer rays(context(), {.name = "rays", .bytes = count * sizeof(Ray)}),
        hits(context(), {.name = "hits", .bytes = count * sizeof(Hit)});
    const Ray ray = down(0.5f, 0.25f);
    test::submit_pass(context(), "all rays are void",
                      [&](Commands& commands) { commands.fill(rays, 0, rays.bytes(), 0); });
    const std::uint64_t some[] = {0, 1, 8'388'608, 15'999'999};
    test::submit_pass(context(), "but these", [&](Commands& commands) {
        for (const std::uint64_t i : some) commands.write(rays, ray, i * sizeof(Ray));
    });
    Commands commands(context(), "one call");
    accel().trace(commands, accel().view(), {.rays = rays.ref<Ray>(), .hits = hits.ref<Hit>(), .count = count});
    commands.submit();
    for (const std::uint64_t i : some)
        EXPECT_EQ(download<Hit>(context(), hits, 1, i * sizeof(Hit)).front().t, 10.0f) << i;
    EXPECT_EQ(download<Hit>(context(), hits, 1, 2 * sizeof(Hit)).front().t, -1.0f);
    EXPECT_EQ(download<Hit>(context(), hits, 1, (count - 2) * sizeof(Hit)).front().t, -1.0f);
}

TEST_P(Accel, TheWorldBoundIsThatOfFloat64RoundedOutward) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(-1, 1);
    const Mesh mesh = make_soup(20, 4);
    const Bounds local = bounds_of(mesh);
    const auto handle = accel().push(mesh, std::vector<Transform>(7));
    for (int round = 0; round < 20; ++round) {
        std::vector<Transform> transforms(7);
        dvec3 lo(INFINITY), hi(-INFINITY);
        for (Transform& transform : transforms) {
            for (vec4& row : transform.rows) row = vec4(unit(random), unit(random), unit(random), 30 * unit(random));
            for (int axis = 0; axis < 3; ++axis) {
                const vec4 row = transform.rows[static_cast<std::size_t>(axis)];
                double low = row.w, high = row.w;
                for (int i = 0; i < 3; ++i) {
                    const double a = double{row[i]} * local.lo[i], b = double{row[i]} * local.hi[i];
                    low += std::min(a, b);
                    high += std::max(a, b);
                }
                lo[axis] = std::min(lo[axis], low);
                hi[axis] = std::max(hi[axis], high);
            }
        }
        accel().update_transforms(handle, transforms);
        accel().sync();
        const Bounds bound = accel().world_bound();
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_LE(bound.lo[axis], lo[axis]);
            EXPECT_GT(std::nextafter(bound.lo[axis], INFINITY), lo[axis]);
            EXPECT_GE(bound.hi[axis], hi[axis]);
            EXPECT_LT(std::nextafter(bound.hi[axis], -INFINITY), hi[axis]);
        }
        EXPECT_EQ(accel().world_bound_if_ready()->lo, bound.lo);
    }
}

// The bound serves as the ray count of a trace, which reads it on the device.
TEST_P(Accel, KernelsReadTheWorldBoundOnTheDevice) {
    const AccelHandle handle = accel().push(square(0), std::vector<Transform>(3));
    const Buffer source =
        device_copy(std::array{Transform::scaling({0, 1, 1}), Transform{}, Transform::scaling({1, 1, 0})});
    accel().update_transforms(handle, source.ref<Transform>(), 3);
    accel().sync();
    const std::vector<Hit> found = test::traced(
        accel(), accel().view(), std::vector<Ray>(5, down(0.5f, 0.25f)),
        {.indirect_count = {accel().world_bound_on_device().address + offsetof(WorldBound, unusable_count)}});
    EXPECT_EQ(found[1].hit, 1u);
    EXPECT_EQ(found[2].hit, 0u) << "two instances are unusable";
}

TEST_P(Accel, AViewStaysGoodUntilTheNextSyncWhateverIsEdited) {
    const AccelHandle handle = accel().push(make_icosphere(6), Transform::translation({0.5f, 0.25f, 0}));
    accel().sync();
    const AccelView view = accel().view();
    accel().erase(handle);
    const Ray ray = down(0.5f, 0.25f);
    EXPECT_FLOAT_EQ(trace(view, ray).t, 9.0f);
    EXPECT_EQ(closest(ray).hit, 0u);
}

TEST_P(Accel, HandlesOfAnotherAcceleratorAreDead) {
    SwTlas other(context());
    const AccelHandle foreign = other.push(square(0));
    accel().push(square(0));
    EXPECT_FALSE(accel().is_valid(foreign));
    EXPECT_FALSE(accel().erase(foreign));
    EXPECT_THROW(accel().update_transform(foreign, {}), Error);
}

TEST_P(Accel, TinyAndHugeScenesAreHitLikeOrdinaryOnes) {
    const float tiny = smallest_scale();
    for (const float size : {tiny, std::sqrt(tiny), 1 / std::sqrt(tiny), 1 / tiny}) {
        Mesh sphere = make_icosphere(3);
        for (vec3& position : sphere.positions) position *= size;
        const AccelHandle scaled = accel().push(sphere);
        const Hit hit = closest({vec3(0.1f, 0.2f, 3) * size, 0, vec3(0, 0, -1), INFINITY});
        EXPECT_EQ(hit.hit, 1u) << size;
        EXPECT_NEAR(hit.t / size, 2.025f, 0.01f) << size;
        accel().erase(scaled);
    }
}

// Checks everything at once against the reference: ours has no leak and no false hit; whatever the driver does has a
// name.
TEST_P(Accel, AgreesWithTheReferenceOnRandomScenes) {
    std::mt19937 random(2026);
    std::uniform_real_distribution<float> unit(-1, 1);
    Scene scene;
    scene.meshes = {make_icosphere(3), make_soup(500, 9), make_box(vec3(-0.5f), vec3(0.5f)),
                    make_grid(10, 10, 0.2f, 1)};
    for (uint mesh = 0; mesh < scene.meshes.size(); ++mesh)
        for (int i = 0; i < 12; ++i) {
            Transform transform;
            for (vec4& row : transform.rows) row = vec4(unit(random), unit(random), unit(random), 3 * unit(random));
            scene.instances.push_back({"", mesh, transform});
        }
    std::vector<Transform> transforms;
    for (uint mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        transforms.clear();
        for (const Instance& instance : scene.instances)
            if (instance.mesh == mesh) transforms.push_back(instance.transform);
        accel().push(scene.meshes[mesh], transforms);
    }
    const ReferenceScene reference = ReferenceScene::of(scene);
    std::vector<Ray> rays = random_rays(bounds_of(scene), 20'000, 1);
    for (const Ray& ray : vertex_aimed_rays(reference, 5'000, 2)) rays.push_back(ray);
    for (const Ray& ray : edge_aimed_rays(reference, 5'000, 3)) rays.push_back(ray);

    const std::vector<Hit> hits = accel().closest_hits(rays);
    const HitClassCounts classes = classes_of(reference, rays, hits);
    EXPECT_EQ(classes.faults_of_ours(), 0u);
    EXPECT_EQ(classes[HitClass::hw_false] + classes[HitClass::hw_t_err] + classes[HitClass::hw_range], 0u);
    EXPECT_GT(classes[HitClass::agree], 25'000u);

    const std::vector<Hit> any = accel().any_hits(rays);
    for (std::size_t i = 0; i < rays.size(); ++i) EXPECT_EQ(any[i].hit, hits[i].hit) << "ray " << i;
}

}  // namespace
}  // namespace twinray
