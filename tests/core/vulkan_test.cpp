// SPDX-License-Identifier: MIT
#include "engine/core/vulkan.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>

namespace twinray {
namespace {

VkLayerProperties layer(const char* name, std::uint32_t patch) {
    VkLayerProperties properties{};
    std::strcpy(properties.layerName, name);
    properties.specVersion = VK_MAKE_API_VERSION(0, 1, 3, patch);
    return properties;
}

TEST(DebugLabels, AreLeftOutBesideAValidationLayerThatTheyCrash) {
    const VkLayerProperties old_validation = layer("VK_LAYER_KHRONOS_validation", 242);
    const VkLayerProperties first_mended = layer("VK_LAYER_KHRONOS_validation", 243);
    const VkLayerProperties old_other = layer("VK_LAYER_MESA_overlay", 211);
    EXPECT_TRUE(labels_are_safe({}));
    EXPECT_TRUE(labels_are_safe(std::array{old_other, first_mended}));
    EXPECT_FALSE(labels_are_safe(std::array{old_other, old_validation}));
}

}  // namespace
}  // namespace twinray
