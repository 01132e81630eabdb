// SPDX-License-Identifier: MIT
// What kernels share with the ray tracing pipeline.
#pragma once

#include "engine/core/commands.h"
#include "engine/core/frozen_spirv.h"
#include "engine/core/requirement.h"

namespace twinray {

static_assert(KernelLimits::push_constant_bytes == 128);

// Shared with the ray tracing pipeline.
VkShaderModule create_shader_module(Context& context, std::span<const std::uint32_t> spirv, const std::string& name);
VkPipelineLayout create_push_constant_layout(Context& context, VkShaderStageFlags stages, std::uint32_t bytes,
                                             VkDescriptorSetLayout images = VK_NULL_HANDLE);

}  // namespace twinray
