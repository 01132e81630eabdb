// The ray tracing pipeline, for drivers without ray queries.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/accel/trace_desc.h"
#include "engine/core/kernel.h"

namespace twinray {

struct RayTracingPipelineDesc {
    std::string name;
    std::span<const std::uint32_t> ray_generation;
    std::span<const std::uint32_t> miss;
    std::span<const std::uint32_t> closest_hit;
    std::span<const std::uint32_t> any_hit;         // of all geometry that is not opaque; empty: none
    std::span<const std::uint32_t> intersection;    // of boxes; empty: none
    std::vector<SpecializationConstant> constants;  // of all stages
    std::uint32_t launch_limit = UINT32_MAX;        // invocations in one launch, if the device allows more
};

// A pipeline of a few shaders with its shader binding table, whose only input is TraceArgs as push constants. Instances
// of triangles take the first hit record, those of boxes the second.
class RayTracingPipeline {
  public:
    RayTracingPipeline(Context& context, const RayTracingPipelineDesc& desc);
    ~RayTracingPipeline();
    RayTracingPipeline(const RayTracingPipeline&) = delete;
    RayTracingPipeline& operator=(const RayTracingPipeline&) = delete;

    // Launches args.count invocations, in several launches if the device's limit requires it. Opens a pass.
    void trace(Commands& commands, const TraceArgs& args) const;

  private:
    void create_pipeline(const RayTracingPipelineDesc& desc);
    void create_shader_binding_table();

    Context& context_;
    std::string name_;
    VkPhysicalDeviceRayTracingPipelinePropertiesKHR limits_{};
    std::uint32_t launch_limit_;
    std::vector<KernelAddress> addresses_;  // among TraceArgs
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
    Buffer table_;
    std::uint64_t record_bytes_ = 0;  // from one record of the table to the next
};

}  // namespace twinray
