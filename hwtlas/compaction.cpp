// SPDX-License-Identifier: MIT
#include "hwtlas/compaction.h"

#include <utility>

#include "engine/core/error.h"

namespace twinray {

CompactedSizes::CompactedSizes(Commands& commands, std::span<const AccelerationStructure* const> structures)
    : context_(commands.context()), bytes_(structures.size()) {
    const VulkanFunctions& vk = context_.vk();
    std::vector<VkAccelerationStructureKHR> handles;
    for (const AccelerationStructure* structure : structures) handles.push_back(structure->handle());
    const auto count = static_cast<std::uint32_t>(handles.size());
    VkQueryPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    info.queryType = VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR;
    info.queryCount = count;
    vk_check(vk.vkCreateQueryPool(context_.device(), &info, nullptr, &queries_), "create a pool of compacted sizes");
    const auto pass = commands.pass("hwtlas compacted sizes");
    vk.vkCmdResetQueryPool(commands.handle(), queries_, 0, count);
    vk.vkCmdWriteAccelerationStructuresPropertiesKHR(commands.handle(), count, handles.data(), info.queryType, queries_,
                                                     0);
}

CompactedSizes::~CompactedSizes() {
    if (!queries_) return;
    context_.retire([&vk = context_.vk(), device = context_.device(), queries = queries_] {
        vk.vkDestroyQueryPool(device, queries, nullptr);
    });
}

std::optional<std::uint64_t> CompactedSizes::of(std::size_t place, SyncPoint built) {
    if (queries_) {
        if (!context_.is_reached(built)) return std::nullopt;
        context_.check(context_.vk().vkGetQueryPoolResults(
                           context_.device(), queries_, 0, static_cast<std::uint32_t>(bytes_.size()),
                           bytes_.size() * sizeof bytes_[0], bytes_.data(), sizeof bytes_[0], VK_QUERY_RESULT_64_BIT),
                       "read compacted sizes");
        context_.vk().vkDestroyQueryPool(context_.device(), std::exchange(queries_, VK_NULL_HANDLE), nullptr);
    }
    return bytes_[place];
}

AccelerationStructure record_compaction(Commands& commands, const std::string& name,
                                        const AccelerationStructure& structure, std::uint64_t bytes) {
    AccelerationStructure compacted(commands.context(), name, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, bytes);
    VkCopyAccelerationStructureInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_COPY_ACCELERATION_STRUCTURE_INFO_KHR;
    info.src = structure.handle();
    info.dst = compacted.handle();
    info.mode = VK_COPY_ACCELERATION_STRUCTURE_MODE_COMPACT_KHR;
    commands.context().vk().vkCmdCopyAccelerationStructureKHR(commands.handle(), &info);
    return compacted;
}

}  // namespace twinray
