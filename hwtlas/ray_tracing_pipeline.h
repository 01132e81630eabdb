// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/core/kernel.h"
#include "hwtlas/hw_scene.h"

namespace twinray {

struct RayTracingPipelineDesc {
    std::string name;
    std::span<const std::uint32_t> ray_generation;
    std::span<const std::uint32_t> miss;
    std::span<const std::uint32_t> closest_hit;
    std::vector<SpecializationConstant> constants;  // of all stages
};

// A pipeline of three shaders with its shader binding table, whose only input is HwTraceArgs as push constants.
class RayTracingPipeline {
  public:
    RayTracingPipeline(Context& context, const RayTracingPipelineDesc& desc);
    ~RayTracingPipeline();
    RayTracingPipeline(const RayTracingPipeline&) = delete;
    RayTracingPipeline& operator=(const RayTracingPipeline&) = delete;

    // Launches args.count invocations, in several launches where the device's limit asks for it. Opens a pass.
    void trace(Commands& commands, const HwTraceArgs& args) const;

  private:
    void create_pipeline(const RayTracingPipelineDesc& desc);
    void create_shader_binding_table();

    Context& context_;
    std::string name_;
    VkPhysicalDeviceRayTracingPipelinePropertiesKHR limits_{};
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
    Buffer table_;
    std::uint64_t record_bytes_ = 0;  // from one record of the table to the next
};

}  // namespace twinray
