#include "hwtlas/tlas.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "hwtlas_gather_instances.spv.h"
#include "hwtlas_instance_areas.spv.h"
#include "hwtlas_instance_codes.spv.h"

namespace twinray {
namespace {

// The driver reads the accelerator's records in the same layout.
static_assert(sizeof(InstanceRecord) == sizeof(VkAccelerationStructureInstanceKHR));
static_assert(offsetof(VkAccelerationStructureInstanceKHR, transform) == offsetof(InstanceRecord, object_to_world));
static_assert(offsetof(VkAccelerationStructureInstanceKHR, accelerationStructureReference) ==
              offsetof(InstanceRecord, geometry));

constexpr std::uint64_t record_alignment = 16;  // of the device address of an array of instances
constexpr std::uint32_t group_size = 256;       // of all kernels

StructureBuild build_of(std::uint64_t driver_records, std::size_t count, bool can_update) {
    StructureBuild build =
        structure_build("tlas", VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, VK_GEOMETRY_TYPE_INSTANCES_KHR, count);
    if (can_update) build.flags |= VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_UPDATE_BIT_KHR;
    build.geometry.geometry.instances.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR;
    build.geometry.geometry.instances.data.deviceAddress = driver_records;
    return build;
}

// Writes the same as the kernel that gathers many instances.
void write_sole(Commands& commands, const Tlas& tlas, const AccelBackend::SoleInstance& sole) {
    const HwGeometry geometry = static_cast<const Blas&>(sole.geometry).block(commands.context());
    const auto pass = commands.pass("hwtlas instance");
    InstanceRecord record = sole.record;
    record.geometry = geometry.blas;
    record.sbt_offset_flags |= geometry.kind;
    commands.write(tlas.driver_records, record);
    if (tlas.instances.bytes()) commands.write(tlas.instances, HwInstance{geometry.triangles, 0, 0});
}

RadixSort::Scratch order_scratch(std::uint64_t address, std::size_t count) { return {address, count, 16}; }

}  // namespace

TlasBuilder::TlasBuilder(Context& context, bool reorder)
    : context_(context),
      reorder_(reorder),
      sort_(context),
      areas_(context),
      codes_(context, lazy_kernel("hwtlas_instance_codes", hwtlas_instance_codes_spirv, group_size)),
      gather_(context, lazy_kernel("hwtlas_gather_instances", hwtlas_gather_instances_spirv, group_size)),
      boxes_(context, lazy_kernel("hwtlas_instance_areas", hwtlas_instance_areas_spirv, group_size)) {}

// Room for either kind of build keeps the structure's address at the first move.
TlasBuilder::Sizes TlasBuilder::sizes(std::size_t capacity) const {
    const VkAccelerationStructureBuildSizesInfoKHR fixed = sizes_of(context_, build_of(0, capacity, false)),
                                                   moving = sizes_of(context_, build_of(0, capacity, true));
    return {std::max(fixed.accelerationStructureSize, moving.accelerationStructureSize),
            std::max({fixed.buildScratchSize, moving.buildScratchSize, moving.updateScratchSize})};
}

BuildBytes TlasBuilder::bytes(std::size_t count, std::size_t capacity) const {
    const Sizes sizes = this->sizes(capacity);
    const std::uint64_t sort = reorder_ && count > 1 ? order_scratch(0, count).bytes(context_.state().tuning()) : 0;
    const AreaWork areas{count, {}, {}, false};
    return {sizes.structure + (reorder_ ? capacity * sizeof(HwInstance) : 0) + sizeof(HwTlasHeader),
            sizes.scratch + capacity * sizeof(InstanceRecord) + sort + areas.bytes()};
}

std::unique_ptr<Tlas> TlasBuilder::make(Commands& commands, std::size_t capacity, const AccelHeader& header) const {
    auto tlas = std::make_unique<Tlas>();
    tlas->capacity = capacity;
    tlas->driver_records = Buffer(
        context_, {.name = "tlas records", .bytes = capacity * sizeof(InstanceRecord), .alignment = record_alignment});
    tlas->instances =
        Buffer(context_, {.name = "tlas instances", .bytes = reorder_ ? capacity * sizeof(HwInstance) : 0});
    tlas->scene = Buffer(context_, {.name = "hw scene", .bytes = sizeof(HwTlasHeader)});
    const Sizes sizes = this->sizes(capacity);
    tlas->structure =
        AccelerationStructure(context_, "tlas", VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, sizes.structure);
    tlas->scratch = make_build_scratch(context_, "tlas scratch", sizes.scratch);
    const auto pass = commands.pass("hwtlas scene");
    HwTlasHeader scene{header, tlas->structure.address(), tlas->instances.ref<HwInstance>()};
    context_.fill_absent(scene.instances);
    commands.write(tlas->scene, scene);
    tlas->address = tlas->scene.address();
    tlas->bytes = tlas->structure.bytes() + tlas->instances.bytes() + tlas->scene.bytes();
    tlas->scratch_bytes = tlas->driver_records.bytes() + tlas->scratch.bytes();
    return tlas;
}

Uints TlasBuilder::record_order(Commands& commands, const TlasInput& input) const {
    if (!reorder_ || input.count < 2) return {};
    Buffer scratch(context_, {.name = "tlas sort scratch",
                              .bytes = order_scratch(0, input.count).bytes(context_.state().tuning())});
    const RadixSort::Scratch sort = order_scratch(scratch.address(), input.count);
    codes_.dispatch(commands, {input.records, input.bound->on_device(), sort.pairs().keys, input.count, 0},
                    input.count);
    const RadixSort::Pairs sorted = sort_.record_iota(commands, sort, morton_bits);
    commands.retain(std::move(scratch));
    return sorted.values;
}

// Runs after the instances are gathered.
void TlasBuilder::record_areas(Commands& commands, const Tlas& tlas, const TlasInput& input, bool is_build) const {
    if (!input.cost.result.address) return;
    std::vector<AreaWork> areas{{input.count, {input.bound->on_device().address}, input.cost, is_build}};
    SurfaceArea::place(commands, areas);
    boxes_.dispatch(commands, {input.records, tlas.instances.ref<HwInstance>(), areas[0].items, input.count, 0},
                    input.count);
    areas_.record(commands, std::move(areas));
}

void TlasBuilder::record_measure(Commands& commands, const Tlas& tlas, const TlasInput& input) const {
    record_areas(commands, tlas, input, true);
}

void TlasBuilder::record_instances(Commands& commands, const Tlas& tlas, const TlasInput& input, Uints order) const {
    if (input.sole) return write_sole(commands, tlas, *input.sole);
    gather_.dispatch(commands,
                     {input.records, order, tlas.driver_records.ref<InstanceRecord>(), tlas.instances.ref<HwInstance>(),
                      input.count, 0},
                     input.count);
}

void TlasBuilder::record_build(Commands& commands, const Tlas& tlas, const TlasInput& input) const {
    record_instances(commands, tlas, input, record_order(commands, input));
    record_areas(commands, tlas, input, true);
    const StructureWork work{build_of(tlas.driver_records.address(), input.count, input.will_move), BuildMode::build,
                             &tlas.structure};
    record_builds(commands, "hwtlas_build_tlas", std::span(&work, 1), tlas.scratch.address());
}

void TlasBuilder::record_update(Commands& commands, const Tlas& tlas, const TlasInput& input) const {
    record_instances(commands, tlas, input, {});
    record_areas(commands, tlas, input, false);
    const StructureWork work{build_of(tlas.driver_records.address(), input.count, true), BuildMode::update,
                             &tlas.structure};
    record_builds(commands, "hwtlas_update_tlas", std::span(&work, 1), tlas.scratch.address());
}

}  // namespace twinray
