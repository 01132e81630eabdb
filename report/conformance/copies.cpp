// SPDX-License-Identifier: MIT
// Copies: clones, compaction, files.
#include <algorithm>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/vulkan.h"
#include "report/conformance/case_run.h"
#include "report/conformance/suite.h"

namespace twinray::conformance {
namespace {

constexpr VkBuildAccelerationStructureFlagsKHR can_compact = VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_COMPACTION_BIT_KHR;

SceneInput copyable(CaseRun& run, VkBuildAccelerationStructureFlagsKHR flags = 0) {
    SceneInput scene = scene_of(random_triangles(run.draws(), usual_triangle_count));
    scene.bottoms[0].flags |= flags;
    scene.top.flags |= flags;
    scene.top.instances.resize(3);
    for (std::size_t i = 1; i < 3; ++i) scene.top.instances[i].to_world = random_instance_transform(run.draws());
    return scene;
}

void check_bottom(CaseRun& run, const SceneInput& scene, const Bottom& bottom) {
    const Top top = run.driver().build(scene.top, std::span(&bottom, 1));
    run.check_hits(scene, top, random_shots(run.draws(), run.rays()));
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
    const std::vector<Shot> shots = random_shots(run.draws(), run.rays() / 2 + 1);
    run.check_hits(scene, run.driver().copied(built.top, Driver::Copy::clone), shots);
    run.check_hits(scene, run.driver().copied(built.top, Driver::Copy::compact), shots);
}

void updated_clone(CaseRun& run) {
    SceneInput scene = copyable(run, can_update);
    const Bottom source = run.driver().build(scene.bottoms[0]);
    Bottom copy = run.driver().copied(source, Driver::Copy::clone);
    check_bottom(run, scene, copy);
    scene.bottoms[0].geometries[0].positions = random_triangles(run.draws(), usual_triangle_count).positions;
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
    moved.geometries[0].positions = random_triangles(run.draws(), usual_triangle_count).positions;
    driver.rebuild(built.bottoms[0], moved);
    file.set_handles(addresses_of(file.handles(), before, bottom.structure.address()));
    const Top top = driver.deserialize(file, scene.top, {bottom.ref()});
    run.check_hits(scene, top, random_shots(run.draws(), run.rays()));
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

}  // namespace

std::vector<Case> copy_cases() {
    using enum Misdeed;
    const std::string same = "hits are those of float64";
    return {
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
