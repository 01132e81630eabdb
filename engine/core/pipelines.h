// The compute pipelines of a device, of which equal kernels share one, and the files that keep them beyond the process.
#pragma once

#include <map>
#include <memory>
#include <mutex>

#include <vulkan/vulkan_core.h>

#include "engine/core/files.h"

namespace twinray {

class Context;
struct KernelDesc;
struct VulkanTable;

// An address in the push constants of a kernel. Some drivers read through an address before they know that the branch
// around the read is not taken (lavapipe from Mesa 26.1 on), so a kernel never gets an unreadable one: it gets
// Context::absent if the host gives 0 for absent data.
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
    std::shared_ptr<CompiledKernel> take_oldest_unused();

    mutable std::mutex mutex_;
    std::map<std::string, Entry> entries_;  // by the bytes of all that a pipeline is compiled from
    std::uint64_t given_back_ = 0;
};

// Returns all members of type REF(T), by the names that glslang leaves in a module, but not those in arrays. Members of
// type Address cannot be told from other pairs of words; hosts never leave those 0.
std::vector<KernelAddress> kernel_addresses(std::span<const std::uint32_t> spirv);

// Returns the arguments with Context::absent in place of 0. With ContextDesc::validation, and on a CPU, whose addresses
// are those of the host, an unreadable address becomes a validation message that names kernel and argument. Throws
// Error for arguments that are shorter than the module's.
std::vector<std::byte> readable_args(Context& context, const std::string& kernel,
                                     std::span<const KernelAddress> addresses, std::span<const std::byte> args);

// Stores compiled pipelines: one file for each device and driver in a folder.
class PipelineStore {
  public:
    static constexpr std::size_t most_files = 8;            // the oldest of other drivers are removed
    static constexpr std::size_t most_bytes = 64ull << 20;  // larger ones are dropped, to begin anew

    // Has no folder: nothing is kept.
    PipelineStore() = default;
    PipelineStore(std::filesystem::path folder, const VkPhysicalDeviceProperties& driver);

    // Returns the data that an earlier run of this driver saved; empty if there is none, or if it belongs to another
    // driver or cannot be read: `log` gets a sentence then.
    Bytes load(const std::function<void(std::string_view)>& log) const;
    // Replaces it, whole or not at all; removes it if load() would refuse `pipelines`: Mesa 26.2's lavapipe gives 20
    // bytes, fewer than Vulkan's header has. The reason against it goes to `log`.
    void save(std::span<const std::byte> pipelines, const std::function<void(std::string_view)>& log) const noexcept;

    const std::filesystem::path& file() const { return file_; }

  private:
    std::filesystem::path file_;
    VkPhysicalDeviceProperties driver_{};
};

}  // namespace twinray
