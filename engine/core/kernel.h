// SPDX-License-Identifier: MIT
// Compute kernels whose only input is a block of push constants.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/core/commands.h"
#include "engine/core/frozen_spirv.h"

namespace twinray {

struct KernelDesc {
    std::string name = {};                 // folder_stem: the label, the timing and the twin have this name too
    std::span<const std::uint32_t> spirv;  // embedded at build time
    std::uint32_t group_size = 64;         // local_size_x of the shader
    std::vector<SpecializationConstant> constants = {};
    bool compiles_when_used =
        false;                // by the first dispatch, which then throws what the constructor would; spirv stays valid
    bool has_images = false;  // it reads an ImageArray, which each dispatch then takes
};

// A compute pipeline whose only input is one push-constant block and, where it has images, an ImageArray, shared with
// all others of the context that are made from the same. Use Kernel<Args>.
class ComputePipeline {
  public:
    ComputePipeline(Context& context, const KernelDesc& desc, std::uint32_t args_bytes);
    ~ComputePipeline();
    ComputePipeline(const ComputePipeline&) = delete;
    ComputePipeline& operator=(const ComputePipeline&) = delete;

    void dispatch_groups(Commands& commands, const void* args, std::uint64_t group_count,
                         VkDescriptorSet images = VK_NULL_HANDLE) const;
    // As many groups as the VkDispatchIndirectCommand at `offset` of `counts` says.
    void dispatch_indirect(Commands& commands, const void* args, const Buffer& counts, std::uint64_t offset) const;

    const std::string& name() const { return desc_.name; }
    std::uint32_t group_size() const { return desc_.group_size; }

  private:
    void bind(Commands& commands, const void* args, VkDescriptorSet images) const;

    Context& context_;
    KernelDesc desc_;
    std::uint32_t args_bytes_;
    mutable std::shared_ptr<CompiledKernel> compiled_;  // null: not compiled yet
};

// A compute kernel that takes one Args struct, shared with its GLSL, as push constants (128 bytes are guaranteed).
template <class Args>
class Kernel {
    static_assert(sizeof(Args) <= KernelLimits::push_constant_bytes && sizeof(Args) % 4 == 0);

  public:
    Kernel(Context& context, const KernelDesc& desc) : pipeline_(context, desc, sizeof(Args)) {}

    // Runs at least `count` invocations; the shader must ignore global_index() >= count. Opens a pass with the
    // kernel's name unless one is open.
    // `images`: of a TextureStore, for kernels made with KernelDesc::has_images.
    void dispatch(Commands& commands, const Args& args, std::uint64_t count,
                  VkDescriptorSet images = VK_NULL_HANDLE) const {
        dispatch_groups(commands, args, (count + pipeline_.group_size() - 1) / pipeline_.group_size(), images);
    }
    void dispatch_groups(Commands& commands, const Args& args, std::uint64_t group_count,
                         VkDescriptorSet images = VK_NULL_HANDLE) const {
        pipeline_.dispatch_groups(commands, &args, group_count, images);
    }
    void dispatch_indirect(Commands& commands, const Args& args, const Buffer& counts, std::uint64_t offset) const {
        pipeline_.dispatch_indirect(commands, &args, counts, offset);
    }
    const std::string& name() const { return pipeline_.name(); }

  private:
    ComputePipeline pipeline_;
};

// Shared with the ray tracing pipeline.
VkShaderModule create_shader_module(Context& context, std::span<const std::uint32_t> spirv, const std::string& name);
VkPipelineLayout create_push_constant_layout(Context& context, VkShaderStageFlags stages, std::uint32_t bytes,
                                             VkDescriptorSetLayout images = VK_NULL_HANDLE);

}  // namespace twinray
