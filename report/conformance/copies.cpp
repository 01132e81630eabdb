// Updates: moved vertices and boxes, transforms, instances; builds into memory that held another. Copies: clones,
// compaction, files.
#include <algorithm>

#include "engine/core/error.h"
#include "engine/core/vulkan.h"
#include "report/conformance/case_run.h"

namespace twinray::conformance {
namespace {

constexpr VkBuildAccelerationStructureFlagsKHR can_compact = VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_COMPACTION_BIT_KHR;

SceneInput copyable(CaseRun& run, VkBuildAccelerationStructureFlagsKHR flags = 0) {
    SceneInput scene = usual_scene(run.draws());
    scene.bottoms[0].flags |= flags;
    scene.top.flags |= flags;
    scene.top.instances.resize(3);
    for (std::size_t i = 1; i < 3; ++i) scene.top.instances[i].to_world = random_instance_transform(run.draws());
    return scene;
}

void check_bottom(CaseRun& run, const SceneInput& scene, const Bottom& bottom, std::span<const Shot> shots) {
    run.check_hits(scene, run.driver().build(scene.top, std::span(&bottom, 1)), shots);
}
void check_bottom(CaseRun& run, const SceneInput& scene, const Bottom& bottom) {
    check_bottom(run, scene, bottom, run.shots());
}

// The source is destroyed before the copy is used.
void cloned_bottom(CaseRun& run) {
    const SceneInput scene = copyable(run);
    const Bottom copy = run.driver().copied(run.driver().build(scene.bottoms[0]), Driver::Copy::clone);
    run.driver().context().wait_for_gpu();
    check_bottom(run, scene, copy);
}

void compacted_bottom(CaseRun& run) {
    const SceneInput scene = copyable(run, can_compact);
    Bottom source = run.driver().build(scene.bottoms[0]);
    const std::uint64_t bytes = source.structure.bytes();
    const Bottom copy = run.driver().copied(std::exchange(source, {}), Driver::Copy::compact);
    run.driver().context().wait_for_gpu();
    run.expect(copy.structure.bytes() <= bytes,
               text("the compacted structure takes ", copy.structure.bytes(), " bytes, the source ", bytes));
    check_bottom(run, scene, copy);
}

void copied_tops(CaseRun& run) {
    const SceneInput scene = copyable(run, can_compact);
    const DriverScene built = run.driver().build(scene);
    const std::vector<Shot> shots = run.shots(2);
    run.check_hits(scene, run.driver().copied(built.top, Driver::Copy::clone), shots);
    run.check_hits(scene, run.driver().copied(built.top, Driver::Copy::compact), shots);
}

void updated_clone(CaseRun& run) {
    SceneInput scene = copyable(run, can_update);
    const Bottom source = run.driver().build(scene.bottoms[0]);
    Bottom copy = run.driver().copied(source, Driver::Copy::clone);
    check_bottom(run, scene, copy);
    scene.bottoms[0].geometries[0].positions = random_triangles(run.draws()).positions;
    if (copy.input.geometries[0].triangles.size() < usual_triangle_count) return;  // a control's copy is incomplete
    run.driver().update(copy, scene.bottoms[0]);
    check_bottom(run, scene, copy);
}

void bottom_file(CaseRun& run) {
    const SceneInput scene = copyable(run);
    const Serialized file = run.driver().serialize(run.driver().build(scene.bottoms[0]).structure);
    check_bottom(run, scene, run.driver().deserialize(file, scene.bottoms[0]));
}

std::vector<std::uint64_t> addresses_of(const std::vector<std::uint64_t>& handles, std::uint64_t before,
                                        std::uint64_t after) {
    std::vector<std::uint64_t> addresses = handles;
    std::ranges::replace(addresses, before, after);
    return addresses;
}

// The old bottom level stays, with other triangles: a top level that still refers to it gives wrong hits and
// harms nothing.
void files_of_both_levels(CaseRun& run) {
    const SceneInput scene = copyable(run);
    Driver& driver = run.driver();
    DriverScene built = driver.build(scene);
    const std::uint64_t before = built.bottoms[0].structure.address();
    const Bottom bottom = driver.deserialize(driver.serialize(built.bottoms[0].structure), scene.bottoms[0]);
    Serialized file = driver.serialize(built.top.structure);
    BottomInput moved = scene.bottoms[0];
    moved.geometries[0].positions = random_triangles(run.draws()).positions;
    driver.rebuild(built.bottoms[0], moved);
    file.set_handles(addresses_of(file.handles(), before, bottom.structure.address()));
    const Top top = driver.deserialize(file, scene.top, {bottom.ref()});
    run.check_hits(scene, top, run.shots());
}

void headers(CaseRun& run) {
    const SceneInput scene = copyable(run);
    Driver& driver = run.driver();
    const DriverScene built = driver.build(scene);
    VkPhysicalDeviceIDProperties id{};
    id.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &id;
    driver.context().state().vk().vkGetPhysicalDeviceProperties2(driver.context().physical_device(), &properties);
    for (const AccelerationStructure* structure : {&built.bottoms[0].structure, &built.top.structure}) {
        const Serialized file = driver.serialize(*structure);
        const std::string which = structure == &built.top.structure ? "top level: " : "bottom level: ";
        run.expect(std::ranges::equal(file.driver_uuid(), id.driverUUID), which + "not the driver's UUID");
        run.expect(file.serialized_bytes() == file.bytes.size(),
                   text(which, "says ", file.serialized_bytes(), " bytes, the query ", file.bytes.size()));
        run.expect(file.deserialized_bytes() > 0, which + "needs no memory");
    }
    const std::vector<std::uint64_t> handles = driver.serialize(built.top.structure).handles();
    run.expect(driver.serialize(built.bottoms[0].structure).handle_count() == 0, "a bottom level has handles");
    run.expect(!handles.empty() &&
                   std::ranges::all_of(
                       handles, [&](std::uint64_t handle) { return handle == built.bottoms[0].structure.address(); }),
               "handles of a top level are not addresses of its bottom levels");
}

void own_file(CaseRun& run) {
    Driver& driver = run.driver();
    const Serialized file = driver.serialize(driver.build(copyable(run).bottoms[0]).structure);
    run.expect(driver.is_compatible(file), "the driver refuses its own file");
}

void files_of_others(CaseRun& run) {
    Driver& driver = run.driver();
    const Serialized file = driver.serialize(driver.build(copyable(run).bottoms[0]).structure);
    for (const std::size_t byte : {std::size_t{3}, std::size_t{VK_UUID_SIZE + 3}}) {
        Serialized other = file;
        other.bytes[byte] ^= std::byte{0x5a};
        run.expect(!driver.is_compatible(other), "the driver takes a file with another UUID");
    }
}

constexpr uint moved_triangles = 16;

SceneInput updatable(GeometryInput geometry) {
    SceneInput scene = scene_of(std::move(geometry));
    scene.bottoms[0].flags |= can_update;
    scene.top.flags |= can_update;
    return scene;
}

// Moves the triangles to another place; their number stays the same.
void move_triangles(CaseRun& run, SceneInput& scene) {
    for (GeometryInput& geometry : scene.bottoms[0].geometries)
        geometry.positions = random_triangles(run.draws(), moved_triangles).positions;
}

template <uint times>
void vertices_in_place(CaseRun& run) {
    SceneInput scene = updatable(random_triangles(run.draws(), moved_triangles));
    Bottom bottom = run.driver().build(scene.bottoms[0]);
    for (uint i = 0; i < times; ++i) {
        move_triangles(run, scene);
        run.driver().update(bottom, scene.bottoms[0]);
    }
    check_bottom(run, scene, bottom);
}

void vertices_elsewhere(CaseRun& run) {
    const SceneInput before = updatable(random_triangles(run.draws(), moved_triangles));
    SceneInput after = before;
    const Bottom source = run.driver().build(before.bottoms[0]);
    move_triangles(run, after);
    const Bottom updated = run.driver().updated(source, after.bottoms[0]);
    check_bottom(run, after, updated, run.shots(2));
    check_bottom(run, before, source, run.shots(2));
}

void boxes_in_place(CaseRun& run) {
    SceneInput scene = updatable(layered_boxes(5));
    Bottom bottom = run.driver().build(scene.bottoms[0]);
    const vec3 shift(4, run.draws().coordinate(1), 0);
    for (Bounds& box : scene.bottoms[0].geometries[0].boxes) box = {box.lo + shift, box.hi + shift};
    run.driver().update(bottom, scene.bottoms[0]);
    std::vector<Shot> shots = box_shots(run.draws(), run.rays());
    for (Shot& shot : shots) {
        shot.ray.origin = shot.ray.origin + shift;
        shot.refused = run.draws().below(32);
    }
    check_bottom(run, scene, bottom, shots);
}

void geometry_transforms(CaseRun& run) {
    GeometryInput geometry = random_triangles(run.draws(), moved_triangles);
    geometry.transform = Transform::translation(vec3(1, 0, 0));
    SceneInput scene = updatable(geometry);
    Bottom bottom = run.driver().build(scene.bottoms[0]);
    scene.bottoms[0].geometries[0].transform = Transform::translation(vec3(0, run.draws().coordinate(1), 0.5f));
    run.driver().update(bottom, scene.bottoms[0]);
    check_bottom(run, scene, bottom);
}

void instances_in_place(CaseRun& run) {
    SceneInput scene = updatable(random_triangles(run.draws(), moved_triangles));
    scene.top.instances.resize(4);
    DriverScene built = run.driver().build(scene);
    for (InstanceInput& instance : scene.top.instances) {
        instance.to_world = random_instance_transform(run.draws());
        instance.custom_index = run.draws().below(1u << 24);
        instance.mask = run.draws().below(256);
        instance.flags = run.draws().below(4);
    }
    run.driver().update(built.top, scene.top);
    std::vector<Shot> shots = run.shots();
    for (Shot& shot : shots) shot.cull_mask = run.draws().below(256);
    for (Shot& shot : shots) shot.flags = run.draws().chance(0.5) ? 0x10 : 0x20;  // culls one side
    run.check_hits(scene, built.top, shots);
}

void over_another(CaseRun& run) {
    SceneInput scene = scene_of(random_triangles(run.draws(), moved_triangles));
    Bottom bottom = run.driver().build(scene.bottoms[0]);
    scene.bottoms[0].geometries[0] = random_triangles(run.draws(), moved_triangles / 2);
    run.driver().rebuild(bottom, scene.bottoms[0]);
    check_bottom(run, scene, bottom);
}

}  // namespace

std::vector<Case> copy_cases() {
    using enum Misdeed;
    const std::string same = "hits are those of float64", updated = same + " after the update";
    return {
        {"K18", Topic::updates, "all vertices moved, in place", "VK-GL-CTS updates, slang-rhi refit", updated,
         forgets_updates, vertices_in_place<1>},
        {"K19", Topic::updates, "all vertices moved, into another structure", "VK-GL-CTS updates",
         updated + ", and the source's are as before", forgets_updates, vertices_elsewhere},
        {"K20", Topic::updates, "eight updates in a row", "VK-GL-CTS updates", updated, forgets_updates,
         vertices_in_place<8>},
        {"K21", Topic::updates, "boxes moved, in place", "VK-GL-CTS updates", updated, forgets_updates, boxes_in_place},
        {"K22", Topic::updates, "another transform of a geometry", "VK-GL-CTS updates", updated, forgets_updates,
         geometry_transforms},
        {"K23", Topic::updates, "transforms, masks, indices and flags of instances, in place", "VK-GL-CTS updates",
         updated, forgets_updates, instances_in_place},
        {"K24", Topic::updates, "another build into the same memory", "VK-GL-CTS builds", updated, forgets_updates,
         over_another},
        {"K25", Topic::copies, "a clone of a bottom level", "VK-GL-CTS copies", same, copies_in_part, cloned_bottom},
        {"K26", Topic::copies, "a compacted bottom level", "VK-GL-CTS compaction, slang-rhi compaction",
         same + ", and it is no larger", copies_in_part, compacted_bottom},
        {"K27", Topic::copies, "a clone and a compacted copy of a top level", "VK-GL-CTS copies", same, copies_in_part,
         copied_tops},
        {"K28", Topic::copies, "a clone, then an update of the clone", "VK-GL-CTS copies", same, copies_in_part,
         updated_clone},
        {"K29", Topic::serialization, "a bottom level to bytes and back", "VK-GL-CTS serialization", same,
         copies_in_part, bottom_file},
        {"K30", Topic::serialization, "both levels to bytes and back, with new addresses", "VK-GL-CTS serialization",
         same, copies_in_part, files_of_both_levels},
        {"K31", Topic::serialization, "contents of the header", "VK-GL-CTS header of serialized structures",
         "the driver's UUID, the sizes, the bottom levels", garbles_headers, headers},
        {"K32", Topic::serialization, "bytes from the same driver", "VK-GL-CTS compatibility", "they are compatible",
         garbles_headers, own_file},
        {"K33", Topic::serialization, "bytes with another UUID", "VK-GL-CTS compatibility", "they are not compatible",
         takes_any_file, files_of_others, Demand::should},
    };
}

}  // namespace twinray::conformance
