#include "hwtlas/acceleration_structure.h"

#include <cstring>
#include <utility>

#include "engine/accel/batches.h"
#include "engine/core/error.h"
#include "engine/core/vulkan.h"

namespace twinray {
namespace {

// VkAccelerationStructureCreateInfoKHR: offset must be a multiple of 256; here it is 0 in a buffer aligned likewise.
constexpr std::uint64_t storage_alignment = 256;

constexpr std::uint64_t primitives_of_group = 64;

std::uint64_t round_up(std::uint64_t value, std::uint64_t multiple) {
    return (value + multiple - 1) / multiple * multiple;
}

std::uint64_t scratch_alignment(const Context& context) {
    VkPhysicalDeviceAccelerationStructurePropertiesKHR structure{};
    structure.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &structure;
    context.state().vk().vkGetPhysicalDeviceProperties2(context.physical_device(), &properties);
    return structure.minAccelerationStructureScratchOffsetAlignment;
}

VkAccelerationStructureBuildGeometryInfoKHR build_info(const StructureBuild& build) {
    VkAccelerationStructureBuildGeometryInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR;
    info.type = build.type;
    info.flags = build.flags;
    info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
    info.geometryCount = 1;
    info.pGeometries = &build.geometry;
    return info;
}

VkAccelerationStructureBuildGeometryInfoKHR build_info(const StructureWork& work, std::uint64_t scratch) {
    VkAccelerationStructureBuildGeometryInfoKHR info = build_info(work.build);
    info.dstAccelerationStructure = work.target->handle();
    info.scratchData.deviceAddress = scratch;
    if (work.mode == BuildMode::update) {
        info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_UPDATE_KHR;
        info.srcAccelerationStructure = work.target->handle();
    }
    return info;
}

}  // namespace

StructureBuild structure_build(const std::string& name, VkAccelerationStructureTypeKHR type, VkGeometryTypeKHR geometry,
                               std::size_t primitive_count) {
    StructureBuild build{};
    build.name = name;
    build.type = type;
    build.primitive_count = static_cast<std::uint32_t>(primitive_count);
    build.geometry.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR;
    build.geometry.geometryType = geometry;
    build.geometry.flags = VK_GEOMETRY_OPAQUE_BIT_KHR;
    return build;
}

VkAccelerationStructureBuildSizesInfoKHR sizes_of(const Context& context, const StructureBuild& build) {
    const VkAccelerationStructureBuildGeometryInfoKHR info = build_info(build);
    VkAccelerationStructureBuildSizesInfoKHR sizes{};
    sizes.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR;
    context.state().vk().vkGetAccelerationStructureBuildSizesKHR(
        context.device(), VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &info, &build.primitive_count, &sizes);
    return sizes;
}

Buffer make_build_scratch(Context& context, const std::string& name, std::uint64_t bytes) {
    return Buffer(context, {.name = name, .bytes = bytes, .alignment = scratch_alignment(context)});
}

AccelerationStructure::AccelerationStructure(Context& context, const std::string& name,
                                             VkAccelerationStructureTypeKHR type, std::uint64_t bytes)
    : context_(&context),
      storage_(context, {.name = name,
                         .bytes = bytes,
                         .usage = VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR,
                         .alignment = storage_alignment}) {
    const VulkanTable& vk = context.state().vk();
    VkAccelerationStructureCreateInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR;
    info.buffer = storage_.handle();
    info.size = bytes;
    info.type = type;
    const VkResult result = vk.vkCreateAccelerationStructureKHR(context.device(), &info, nullptr, &handle_);
    if (result != VK_SUCCESS) fail("acceleration structure '", name, "' of ", bytes, " bytes: ", name_of(result));
    VkAccelerationStructureDeviceAddressInfoKHR address{};
    address.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR;
    address.accelerationStructure = handle_;
    address_ = vk.vkGetAccelerationStructureDeviceAddressKHR(context.device(), &address);
    context.state().set_name(VK_OBJECT_TYPE_ACCELERATION_STRUCTURE_KHR, reinterpret_cast<std::uint64_t>(handle_), name);
}

AccelerationStructure::~AccelerationStructure() {
    if (!handle_) return;
    context_->state().retire([&vk = context_->state().vk(), device = context_->device(), handle = handle_] {
        vk.vkDestroyAccelerationStructureKHR(device, handle, nullptr);
    });
}

AccelerationStructure::AccelerationStructure(AccelerationStructure&& other) noexcept { *this = std::move(other); }

AccelerationStructure& AccelerationStructure::operator=(AccelerationStructure&& other) noexcept {
    std::swap(context_, other.context_);
    std::swap(storage_, other.storage_);
    std::swap(handle_, other.handle_);
    std::swap(address_, other.address_);
    return *this;
}

std::uint64_t scratch_bytes_of(const Context& context, const StructureWork& work) {
    const VkAccelerationStructureBuildSizesInfoKHR sizes = sizes_of(context, work.build);
    return round_up(work.mode == BuildMode::update ? sizes.updateScratchSize : sizes.buildScratchSize,
                    scratch_alignment(context));
}

void record_builds(Commands& commands, const std::string& pass_name, std::span<const StructureWork> work,
                   std::uint64_t scratch) {
    std::vector<VkAccelerationStructureBuildGeometryInfoKHR> infos;
    // Mesa's driver for CPUs applies firstVertex twice; offsets live in the addresses instead, and all of these stay 0.
    std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges;
    for (const StructureWork& one : work) {
        infos.push_back(build_info(one, scratch));
        ranges.push_back({one.build.primitive_count, 0, 0, 0});
        scratch += scratch_bytes_of(commands.context(), one);
    }
    std::vector<const VkAccelerationStructureBuildRangeInfoKHR*> range_of;
    for (const VkAccelerationStructureBuildRangeInfoKHR& range : ranges) range_of.push_back(&range);
    std::uint64_t primitives = 0;
    for (const StructureWork& one : work) primitives += one.build.primitive_count;
    const auto pass = commands.pass(pass_name);
    commands.count_work(primitives / primitives_of_group);
    commands.context().state().vk().vkCmdBuildAccelerationStructuresKHR(
        commands.handle(), static_cast<std::uint32_t>(infos.size()), infos.data(), range_of.data());
}

std::vector<AccelerationStructure> build_structures(Commands& commands, const std::string& pass_name,
                                                    std::span<const StructureBuild> builds, std::uint64_t budget) {
    Context& context = commands.context();
    std::vector<AccelerationStructure> structures;
    structures.reserve(builds.size());
    std::vector<StructureWork> work;
    std::vector<std::uint64_t> scratch_bytes;
    for (const StructureBuild& build : builds) {
        structures.emplace_back(context, build.name, build.type, sizes_of(context, build).accelerationStructureSize);
        work.push_back({build, BuildMode::build, &structures.back()});
        scratch_bytes.push_back(scratch_bytes_of(context, work.back()));
    }
    const Batches batches = cut_into_batches(scratch_bytes, budget);
    Buffer scratch = make_build_scratch(context, pass_name + " scratch", batches.scratch_bytes);
    for (const Batches::Run& run : batches.runs)
        record_builds(commands, pass_name, std::span(work).subspan(run.first, run.count), scratch.address());
    commands.retain(std::move(scratch));
    return structures;
}

CompactedSizes::CompactedSizes(Commands& commands, std::span<const AccelerationStructure* const> structures)
    : context_(commands.context()),
      bytes_(
          context_,
          {.name = "compacted sizes", .bytes = structures.size() * sizeof(std::uint64_t), .memory = Memory::readback}) {
    const VulkanTable& vk = context_.state().vk();
    std::vector<VkAccelerationStructureKHR> handles;
    for (const AccelerationStructure* structure : structures) handles.push_back(structure->handle());
    const auto count = static_cast<std::uint32_t>(handles.size());
    VkQueryPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    info.queryType = VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR;
    info.queryCount = count;
    vk_check(vk.vkCreateQueryPool(context_.device(), &info, nullptr, &queries_), "create a pool of compacted sizes");
    {
        const auto pass = commands.pass("hwtlas compacted sizes");
        vk.vkCmdResetQueryPool(commands.handle(), queries_, 0, count);
        vk.vkCmdWriteAccelerationStructuresPropertiesKHR(commands.handle(), count, handles.data(), info.queryType,
                                                         queries_, 0);
    }
    const auto pass = commands.pass("hwtlas compacted sizes readback");
    vk.vkCmdCopyQueryPoolResults(commands.handle(), queries_, 0, count, bytes_.handle(), 0, sizeof(std::uint64_t),
                                 VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
}

CompactedSizes::~CompactedSizes() {
    context_.state().retire([&vk = context_.state().vk(), device = context_.device(), queries = queries_] {
        vk.vkDestroyQueryPool(device, queries, nullptr);
    });
}

std::optional<std::uint64_t> CompactedSizes::of(std::size_t index, SyncPoint built) {
    is_told_ = is_told_ || context_.is_reached(built);
    return is_told_ ? std::optional(bytes_of(index)) : std::nullopt;
}

std::uint64_t CompactedSizes::bytes_of(std::size_t index) const {
    std::uint64_t bytes = 0;
    std::memcpy(&bytes, bytes_.mapped() + index * sizeof bytes, sizeof bytes);
    return bytes;
}

AccelerationStructure record_compaction(Commands& commands, const std::string& name,
                                        const AccelerationStructure& structure, std::uint64_t bytes) {
    AccelerationStructure compacted(commands.context(), name, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, bytes);
    VkCopyAccelerationStructureInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_COPY_ACCELERATION_STRUCTURE_INFO_KHR;
    info.src = structure.handle();
    info.dst = compacted.handle();
    info.mode = VK_COPY_ACCELERATION_STRUCTURE_MODE_COMPACT_KHR;
    commands.context().state().vk().vkCmdCopyAccelerationStructureKHR(commands.handle(), &info);
    return compacted;
}

}  // namespace twinray
