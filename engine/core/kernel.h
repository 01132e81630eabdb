// The common part of kernels and the ray tracing pipeline.
#pragma once

#include "engine/core/commands.h"
#include "engine/core/error.h"
#include "engine/core/requirement.h"

namespace twinray {

static_assert(KernelLimits::push_constant_bytes == 128);

// Gives the driver only the part of the module that these specialisation constants leave. It takes a fraction of the
// time for that; some drivers compile even code that a constant switches off.
VkShaderModule create_shader_module(Context& context, std::span<const std::uint32_t> spirv,
                                    std::span<const SpecializationConstant> constants, const std::string& name);
VkPipelineLayout create_push_constant_layout(Context& context, VkShaderStageFlags stages, std::uint32_t bytes,
                                             VkDescriptorSetLayout images = VK_NULL_HANDLE);

// Describes a kernel that its first dispatch compiles.
inline KernelDesc lazy_kernel(const char* name, std::span<const std::uint32_t> spirv, std::uint32_t group_size = 64) {
    return {.name = name, .spirv = spirv, .group_size = group_size, .compiles_when_used = true};
}

// Returns the context. Throws Error, beginning with `what`, which needs it, if the device has no float64.
inline Context& with_float64(Context& context, std::string_view what) {
    if (!context.properties().shader_float64)
        fail(what, " need float64 (shaderFloat64), which device '", context.properties().name, "' has not enabled");
    return context;
}

}  // namespace twinray
