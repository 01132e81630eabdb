// SPDX-License-Identifier: MIT
#include "engine/core/statistics_feature.h"

#include <algorithm>
#include <cstring>

#include "engine/core/device_properties.h"
#include "engine/core/vulkan.h"

namespace twinray {
namespace {

constexpr const char* extension_name = VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME;

bool is_that(const VkExtensionProperties& extension) {
    return std::strcmp(extension.extensionName, extension_name) == 0;
}

}  // namespace

void StatisticsFeature::add_to(VkDeviceCreateInfo& info, const VulkanTable& vk, VkPhysicalDevice device) {
    if (std::ranges::none_of(device_extensions(vk, device), is_that)) return;
    feature_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR;
    feature_.pipelineExecutableInfo = VK_TRUE;
    feature_.pNext = const_cast<void*>(info.pNext);
    info.pNext = &feature_;
    extensions_.assign(info.ppEnabledExtensionNames, info.ppEnabledExtensionNames + info.enabledExtensionCount);
    extensions_.push_back(extension_name);
    info.enabledExtensionCount = static_cast<std::uint32_t>(extensions_.size());
    info.ppEnabledExtensionNames = extensions_.data();
}

}  // namespace twinray
