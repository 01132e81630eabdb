// SPDX-License-Identifier: MIT
// One device with its memory, its queue and its timeline, made here or adopted from a host.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/adopted_device.h"
#include "engine/core/in_flight.h"
#include "engine/core/kernel_tuning.h"
#include "engine/core/pipeline_store.h"
#include "engine/core/pipeline_table.h"

namespace twinray {

// A value that a timeline semaphore reaches when the work submitted up to here is done.
struct SyncPoint {
    VkSemaphore semaphore = VK_NULL_HANDLE;
    std::uint64_t value = 0;
};

// A primary command buffer, and what it records.
struct Submission {
    VkCommandBuffer commands = VK_NULL_HANDLE;
    std::vector<PassWork> passes = {};  // for the error of a lost device, as the name with which it is submitted
};

// A kernel that is made, and the size of its push constants. Any thread.
using KernelWatch = std::function<void(const KernelDesc& kernel, std::uint32_t args_bytes)>;

struct ContextDesc {
    std::string name = "twinray";
    std::string device = {};  // "" = best; an index or a part of the name, see choose_device
    bool validation = false;  // the Khronos layer, with synchronisation validation; messages go to the log and are kept
    bool use_ray_query = true;             // false: leave the extension disabled although the device has it
    bool use_ray_tracing_pipeline = true;  // likewise
    std::optional<TuningRow> tuning = {};  // none: what TWINRAY_TUNING names, else by device
    // None: by device, as KernelTuning has it; 0: no limit.
    std::optional<double> most_submission_seconds = {};
    PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;  // null: open the system's loader
    std::filesystem::path pipeline_folder =
        {};        // keeps compiled pipelines between runs, see PipelineStore; empty: none does
    Log log = {};  // warnings and validation messages; empty = stderr
    // For tools that ask what a driver makes of kernels (engine/core/kernel_statistics.h): if set, nothing runs. Each
    // kernel is told to it and not compiled, what is submitted is done at once, and what is read back is 0. A driver
    // without its hardware will do; where it can tell of pipelines (VK_KHR_pipeline_executable_properties), it does.
    KernelWatch watch_kernels = {};
};

// Leaves features of the device unused: `list` holds ray_query and ray_tracing_pipeline, separated by commas. For
// programs that take it from their user, as TWINRAY_DISABLE. Throws Error naming anything else in the list.
void disable_features(ContextDesc& desc, const std::string& list);

// One device with its memory allocator, one queue and one timeline. Not copyable; used by one thread at a time.
class Context {
  public:
    // Throws Error with the reason why each device was rejected if none fits.
    explicit Context(const ContextDesc& desc = {});
    // Throws Error where check_adoption does.
    explicit Context(const AdoptedDevice& adopted);
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    const VulkanFunctions& vk() const { return vk_; }
    VkDevice device() const { return device_; }
    VkPhysicalDevice physical_device() const { return physical_device_; }
    Allocator& allocator() const { return *allocator_; }
    VkPipelineCache pipeline_cache() const { return pipeline_cache_; }
    PipelineTable& pipelines() { return pipelines_; }
    // Of all descriptor sets of images (engine/core/image_array.h); made by the first call. Any thread. Throws Error
    // where the device has no image arrays.
    VkDescriptorSetLayout image_array_layout();
    std::uint32_t queue_family() const { return queue_family_; }
    const KernelWatch& watch() const { return watch_; }  // ContextDesc::watch_kernels
    const DeviceFacts& facts() const { return facts_; }  // what is enabled, not merely supported
    const KernelTuning& tuning() const { return tuning_; }
    float timestamp_period_ns() const { return timestamp_period_ns_; }  // 0: the queue has no timestamps

    // Stages and accesses of everything that twinray records; used by its barriers.
    VkPipelineStageFlags stages() const;

    // Submits them one after the other, all or none; returns the point at which the last is done. Frees what has been
    // passed.
    SyncPoint submit(const std::string& name, std::vector<Submission> submissions);
    // The next submission, whichever call makes it (Commands::submit, AbstractAccel::sync, ...), runs its `stages`, and
    // all that is submitted later does, only once the GPU has reached `point`, on a timeline semaphore of the host, and
    // sees what was written before it; one that fails leaves it to the one after. The host may submit the work that
    // signals it later, on another queue; until it is signalled, whoever waits for that submission, this context's end
    // included, waits too.
    void wait_before_next_submission(SyncPoint point, VkPipelineStageFlags stages = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT);
    SyncPoint last_submission() const { return {timeline_, submitted_}; }
    bool is_reached(SyncPoint point) const;
    void wait(SyncPoint point) const;
    // Waits for everything submitted or announced so far, then frees what was retired.
    void wait_for_gpu();

    // Tells of work that the host submits itself and that uses what this context owns: nothing that is retired from
    // now on is freed before `point`. Its timeline semaphore must live until a later wait_for_gpu() or this context's
    // end, at which the host's own work must be done.
    void announce(SyncPoint point);

    // Runs `destroy` when everything submitted or announced so far is done.
    void retire(std::function<void()> destroy);

    // Throws DeviceLost, which says what was in flight and what the driver says of it, once the device has been lost.
    void check_alive() const;
    // vk_check for what may report the loss of the device, which is remembered.
    void check(VkResult result, const char* action) const;

    void warn(std::string_view message) const;
    // Messages of the validation layer so far.
    std::vector<std::string> validation_messages() const;
    void set_name(VkObjectType type, std::uint64_t handle, const std::string& name) const;

  private:
    struct Retired {
        std::uint64_t submitted;
        std::vector<SyncPoint> announced;
        std::function<void()> destroy;
    };
    struct Wait {
        SyncPoint point;
        VkPipelineStageFlags stages;
    };
    static VkBool32 VKAPI_PTR on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT*, void*);
    void create_instance(const ContextDesc& desc);
    void create_device(const ContextDesc& desc);
    void set_tuning(std::optional<TuningRow> row, std::optional<double> most_submission_seconds);
    void create_own_objects(const AllocatorHooks& allocator, const std::filesystem::path& pipeline_folder);
    void create_timeline();
    void create_pipeline_cache(const PipelineStore& store);
    void keep_pipelines() noexcept;
    VkResult enqueue(std::span<const Submission> submissions) const;
    std::string words_of_loss() const;
    void finish() noexcept;
    std::uint64_t reached(VkSemaphore semaphore) const noexcept;  // 0 when it cannot be read
    void collect() noexcept;
    void destroy_everything() noexcept;

    VulkanFunctions vk_;
    DeviceFacts facts_;
    KernelTuning tuning_;
    Log log_;
    KernelWatch watch_;
    bool owns_device_ = true;
    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_device_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    std::uint32_t queue_family_ = 0;
    std::uint32_t api_version_ = VK_API_VERSION_1_2;
    std::function<void()> lock_queue_, unlock_queue_;
    std::unique_ptr<Allocator> allocator_;
    VkPipelineCache pipeline_cache_ = VK_NULL_HANDLE;
    bool owns_pipeline_cache_ = false;
    PipelineTable pipelines_;
    std::mutex image_array_mutex_;
    VkDescriptorSetLayout image_array_layout_ = VK_NULL_HANDLE;
    PipelineStore pipeline_store_;
    std::size_t kept_pipeline_bytes_ = 0;
    VkSemaphore timeline_ = VK_NULL_HANDLE;
    std::uint64_t submitted_ = 0;
    mutable InFlight in_flight_;
    // What the driver says of a lost device, once it was asked.
    mutable std::optional<std::string> fault_;
    std::vector<Wait> awaited_;  // by the next submission
    float timestamp_period_ns_ = 0;
    std::deque<Retired> retired_;
    std::vector<SyncPoint> announced_;  // the latest by semaphore, not known to be reached
    mutable bool is_lost_ = false;
    mutable std::mutex messages_mutex_;
    std::vector<std::string> messages_;
};

// Every Vulkan device with what it offers. Throws Error when there is no Vulkan at all. Null: the system's loader.
std::vector<DeviceFacts> list_devices(PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr);

}  // namespace twinray
