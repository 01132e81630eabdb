// SPDX-License-Identifier: MIT
#include "hwtlas/compaction.h"

#include <cstring>

#include "engine/core/error.h"
#include "engine/core/vulkan.h"

namespace twinray {

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
