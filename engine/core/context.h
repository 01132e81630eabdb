// The parts of a Context that the library itself needs: Vulkan's functions, memory, pipelines, submissions.
#pragma once

#include <deque>
#include <mutex>
#include <set>

#include "engine/core/device_fault.h"
#include "engine/core/kernel_tuning.h"
#include "engine/core/pipelines.h"

typedef struct VmaAllocator_T* VmaAllocator;

namespace twinray {

// Returns what twinray may use of a device that an application created: the features of `adopted.enabled`, all other
// properties from the driver. Throws Error, naming what the application has to change, unless twinray can run on the
// device: a needed feature is not enabled, the queue family has no compute, or `enabled` claims what the device does
// not support or the VkDevice was not created with. The handles must be set and the functions of all levels loaded.
DeviceProperties check_adoption(const AdoptedDevice& adopted, const VulkanTable& vk);

// Make and destroy twinray's own allocator. `block_bytes`: KernelTuning::memory_block_bytes.
VmaAllocator create_vma(const VulkanTable& vk, VkInstance instance, VkPhysicalDevice physical_device, VkDevice device,
                        std::uint32_t api_version, std::uint64_t block_bytes);
void destroy_vma(VmaAllocator allocator);
AllocatorHooks vma_hooks(VmaAllocator allocator);

// Makes and frees all buffers and images, by an allocator of twinray's own or by the application's two functions.
class Allocator {
  public:
    // Uses the application's allocator. Throws Error if one hook is missing.
    explicit Allocator(const AllocatorHooks& hooks);
    // Uses twinray's own.
    Allocator(const VulkanTable& vk, VkInstance instance, VkPhysicalDevice physical_device, VkDevice device,
              std::uint32_t api_version, std::uint64_t block_bytes);
    ~Allocator();  // every buffer must have been freed
    Allocator(const Allocator&) = delete;
    Allocator& operator=(const Allocator&) = delete;

    // Throws Error naming the buffer and its size if there is no memory or the application's hook breaks its promise.
    AllocatedBuffer allocate(const BufferRequest& request);
    void free(const AllocatedBuffer& buffer, std::uint64_t bytes) noexcept;

    bool has_images() const { return hooks_.allocate_image && hooks_.free_image; }
    // The same for images; has_images() must be true.
    AllocatedImage allocate(const ImageRequest& request);
    void free(const AllocatedImage& image) noexcept;

    std::uint64_t live_bytes() const { return live_bytes_; }

  private:
    VmaAllocator own_ = nullptr;  // null: the host's
    AllocatorHooks hooks_;
    std::uint64_t live_bytes_ = 0;
};

// Points of a timeline that commands will reach which are not submitted yet. Pure.
// A timeline may only grow, so commands are submitted, or given up, in the order in which their points were promised.
class PromisedPoints {
  public:
    std::uint64_t promise() { return ++promised_; }
    // Returns whether no other commands are to be submitted before.
    bool is_due(std::uint64_t point) const { return point == passed_ + 1; }
    bool is_passed(std::uint64_t point) const { return point <= passed_; }
    std::uint64_t last_passed() const { return passed_; }
    // Returns the value that due commands signal: it includes those behind them that nobody will submit.
    std::uint64_t value_of(std::uint64_t point) const {
        while (given_up_.contains(point + 1)) ++point;
        return point;
    }
    void pass(std::uint64_t point) {
        passed_ = value_of(point);
        given_up_.erase(given_up_.begin(), given_up_.upper_bound(passed_));
    }
    void give_up(std::uint64_t point) {
        given_up_.insert(point);
        lost_.insert(point);
    }
    // Returns whether its commands were given up: work that relied on them never happened.
    bool is_lost(std::uint64_t point) const { return lost_.contains(point); }

  private:
    std::uint64_t promised_ = 0, passed_ = 0;
    std::set<std::uint64_t> given_up_;  // not passed yet
    std::set<std::uint64_t> lost_;
};

// A primary command buffer, and its passes.
struct Submission {
    VkCommandBuffer commands = VK_NULL_HANDLE;
    std::vector<PassWork> passes = {};  // for the error of a lost device, as the name with which it is submitted
};

struct Context::State {
  public:
    static constexpr std::uint64_t absent_bytes = 4096;  // of the memory at Context::absent

    explicit State(const ContextDesc& desc);
    // Throws Error if check_adoption does.
    explicit State(const AdoptedDevice& adopted);
    ~State();
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    const VulkanTable& vk() const { return vk_; }
    VkDevice device() const { return device_; }
    VkPhysicalDevice physical_device() const { return physical_device_; }
    Allocator& allocator() const { return *allocator_; }
    VkPipelineCache pipeline_cache() const { return pipeline_cache_; }
    PipelineTable& pipelines() { return pipelines_; }
    // Returns the layout of all descriptor sets of images (engine/core/image_array.h); the first call makes it. Any
    // thread. Throws Error if the device has no image arrays.
    VkDescriptorSetLayout image_array_layout();
    std::uint32_t queue_family() const { return queue_family_; }
    const KernelWatch& watch() const { return watch_; }                 // ContextDesc::watch_kernels
    const DeviceProperties& properties() const { return properties_; }  // enabled, not merely supported
    const KernelTuning& tuning() const { return tuning_; }
    float timestamp_period_ns() const { return timestamp_period_ns_; }   // 0: the queue has no timestamps
    bool is_validating() const { return messenger_ != VK_NULL_HANDLE; }  // ContextDesc::validation
    std::uint64_t absent() const { return absent_; }                     // Context::absent

    // Stages and accesses of everything that twinray records; used by its barriers.
    VkPipelineStageFlags stages() const;

    // Submits them one after the other, all or none; returns the point at which the last is done. Frees resources that
    // the GPU has passed.
    // `promised`: the point from promise(), or 0.
    SyncPoint submit(const std::string& name, std::vector<Submission> submissions, std::uint64_t promised = 0);
    // Returns a point that commands will reach which are not submitted yet. They must be submitted with it, in the
    // order of the promises, or given up.
    SyncPoint promise();
    void give_up(std::uint64_t promised) noexcept;
    // Returns whether no other commands are to be submitted before.
    bool is_due(std::uint64_t promised) const { return promised_.is_due(promised); }
    // Throws Error for a promised point whose commands are not submitted yet, or never will be.
    void check_submitted(SyncPoint point) const;
    // See Context.
    void wait_before_next_submission(SyncPoint point, VkPipelineStageFlags stages = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT);
    SyncPoint last_submission() const { return {timeline_, submitted_}; }
    bool is_reached(SyncPoint point) const;
    void wait(SyncPoint point) const;
    void wait_for_gpu();

    void announce(SyncPoint point);

    // Runs `destroy` when everything submitted or announced so far is done.
    void retire(std::function<void()> destroy);

    // A device does not outlive a fork: a child process must leave it alone. Its threads are the parent's, and so may
    // be the memory that a driver frees. Any thread.
    bool is_of_this_process() const noexcept;
    // Throws Error unless it is.
    void check_process() const;
    // Throws as check_process, and DeviceLost, with the work in flight and the driver's report, once the device has
    // been lost.
    void check_alive() const;
    // Checks like vk_check, for calls that may report the loss of the device, which is remembered.
    void check(VkResult result, const char* action) const;

    void warn(std::string_view message) const;
    std::vector<std::string> validation_messages() const;
    void add_validation_message(const std::string& message);  // any thread
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
    void create_absent();
    void create_pipeline_cache(const PipelineStore& store);
    void keep_pipelines() noexcept;
    VkSemaphore new_timeline(const char* name);
    void wait_for(SyncPoint point) const;
    VkResult wait_for(const VkSemaphoreWaitInfo& info) const;
    VkResult wait_patiently(const VkSemaphoreWaitInfo& info, std::uint64_t most) const;
    VkResult enqueue(std::span<const Submission> submissions, std::uint64_t promised) const;
    VkResult enqueue(std::span<const VkSubmitInfo> infos) const;
    std::string words_of_loss() const;
    void finish() noexcept;
    std::uint64_t reached(VkSemaphore semaphore) const noexcept;  // 0 when it cannot be read
    void collect() noexcept;
    void destroy_everything() noexcept;

    std::unique_ptr<VulkanTable> table_;
    VulkanTable& vk_;
    DeviceProperties properties_;
    KernelTuning tuning_;
    Log log_;
    KernelWatch watch_;
    int process_;
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
    AllocatedBuffer absent_memory_;
    std::uint64_t absent_ = 0;
    VkPipelineCache pipeline_cache_ = VK_NULL_HANDLE;
    bool owns_pipeline_cache_ = false;
    PipelineTable pipelines_;
    std::mutex image_array_mutex_;
    VkDescriptorSetLayout image_array_layout_ = VK_NULL_HANDLE;
    PipelineStore pipeline_store_;
    std::size_t kept_pipeline_bytes_ = 0;
    VkSemaphore timeline_ = VK_NULL_HANDLE;
    std::uint64_t submitted_ = 0;
    mutable SubmissionLog submission_log_;
    VkSemaphore promised_timeline_ = VK_NULL_HANDLE;  // made by the first promise
    PromisedPoints promised_;
    // The driver's report on a lost device, once it was asked.
    mutable std::optional<std::string> fault_;
    std::vector<Wait> awaited_;  // by the next submission
    float timestamp_period_ns_ = 0;
    std::deque<Retired> retired_;
    std::vector<SyncPoint> announced_;  // the latest by semaphore, not known to be reached
    mutable bool is_lost_ = false;
    mutable bool is_hung_ = false;  // and so lost
    double most_wait_seconds_ = 0;  // as in ContextDesc
    mutable std::mutex messages_mutex_;
    std::vector<std::string> messages_;
};

// A device may be one on which nothing runs, so that its driver need not have the hardware: it only makes pipelines.

// Replaces the functions that record, submit, wait or allocate memory: every semaphore has passed every value, query
// results stay as they are, and addresses are aligned and distinct without memory. Objects have no names in debuggers.
void run_nothing(VulkanTable& vk);

// The work recorded on such devices by this thread since its last query.
struct RecordedWork {
    std::uint64_t dispatches = 0, barriers = 0;
    std::uint64_t copies = 0;  // and fills, and updates
};
RecordedWork take_recorded_work();

// Returns the allocator for them: null handles, and zeros in buffers that the host maps. No images.
AllocatorHooks memoryless_allocator();

}  // namespace twinray
