// SPDX-License-Identifier: MIT
// The compute pipelines of a device; equal kernels share one.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <vulkan/vulkan_core.h>

namespace twinray {

class Context;
struct KernelDesc;
struct VulkanTable;

// An address in the push constants of a kernel: see engine/core/kernel_addresses.h.
struct KernelAddress {
    std::string name;  // of the member, as "mesh.indices"
    std::uint32_t offset = 0;
};

// Destroys its pipeline when its last owner releases it: not before the GPU is done with it.
struct CompiledKernel {
    CompiledKernel(const VulkanTable& functions, VkDevice owner) : vk(functions), device(owner) {}
    ~CompiledKernel();
    CompiledKernel(const CompiledKernel&) = delete;
    CompiledKernel& operator=(const CompiledKernel&) = delete;

    const VulkanTable& vk;
    VkDevice device;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkPipeline pipeline = VK_NULL_HANDLE;
    std::vector<KernelAddress> addresses = {};
};

enum class Telling : std::uint8_t {
    nothing,
    statistics,  // for vkGetPipelineExecutableStatisticsKHR, and beside the context's pipeline cache
};
// Throws Error naming the kernel if it cannot be compiled. Any thread.
std::shared_ptr<CompiledKernel> compile(Context& context, const KernelDesc& desc, std::uint32_t args_bytes,
                                        Telling telling);

// Keeps pipelines beyond the kernels that were made with them, so that, for example, the next accelerator compiles
// nothing. A driver may also compile a part at the first dispatch (Mesa's for CPUs does, about 1 ms per kernel), which
// no pipeline cache avoids.
class PipelineTable {
  public:
    static constexpr std::size_t most_unused = 256;

    // Returns the pipeline for this SPIR-V, these constants and this size of push constants; compiles the first. Throws
    // Error naming the kernel if it cannot be compiled. Any thread.
    std::shared_ptr<CompiledKernel> get(Context& context, const KernelDesc& desc, std::uint32_t args_bytes);
    // Takes the pipeline of a destroyed kernel. Those unused for longest are destroyed if there are more than
    // most_unused. Called by the thread that uses the context.
    void give_back(Context& context, std::shared_ptr<CompiledKernel> kernel);
    std::size_t size() const;
    void clear();

  private:
    struct Entry {
        std::shared_ptr<CompiledKernel> kernel;
        std::uint64_t given_back = 0;  // how many were given back before it
    };
    std::shared_ptr<CompiledKernel> find(const std::string& key) const;
    std::shared_ptr<CompiledKernel> take_oldest_unused();

    mutable std::mutex mutex_;
    std::map<std::string, Entry> entries_;  // by the bytes of all that a pipeline is compiled from
    std::uint64_t given_back_ = 0;
};

}  // namespace twinray
