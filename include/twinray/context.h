// SPDX-License-Identifier: MIT
// A Vulkan device with its memory, its queue and its timeline, made here or adopted from an application.
//
//     twinray::Context context;                        // the best device that there is
//     twinray::Context guest(adopted);                 // an application's: fill AdoptedDevice
//     twinray::DeviceRequirements needs(properties);   // what such a device should have enabled
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <twinray/geometry.h>
#include <vulkan/vulkan_core.h>

namespace twinray {

struct KernelDesc;

// Warnings and validation messages, a sentence each.
using Log = std::function<void(std::string_view)>;

// As VkPhysicalDeviceType.
enum class DeviceKind : std::uint8_t { discrete, integrated, virtual_gpu, cpu, other };

// What twinray wants to know of a device; filled by query_device_properties.
struct DeviceProperties {
    std::string name;
    std::string driver;
    DeviceKind kind = DeviceKind::other;
    std::uint32_t api_version = 0;  // as VK_MAKE_API_VERSION
    // Of a compute group; until the device is asked, what Vulkan guarantees.
    std::uint32_t shared_bytes = 16384, group_invocations = 128, push_constant_bytes = 128;
    std::uint32_t driver_id = 0;          // VkDriverId
    std::array<std::uint8_t, 16> uuid{};  // by which other APIs know the device
    std::uint32_t cpu_threads = 0;        // of a CPU, which run the groups of a dispatch; else 0
    std::uint32_t subgroup_size = 0;
    bool has_compute_queue = false;
    bool timeline_semaphore = false;
    bool buffer_device_address = false;
    bool scalar_block_layout = false;
    bool shader_int64 = false;  // for kernels of hosts; none of ours needs it
    bool shader_float64 = false;
    bool acceleration_structure = false;
    bool ray_query = false;
    bool ray_tracing_pipeline = false;
    bool primitive_culling = false;   // rays can skip triangles or boxes
    bool device_fault = false;        // it tells why it was lost
    bool external_memory_fd = false;  // memory can be shared with other programs and APIs: Buffer::exportable
    bool runtime_descriptor_array = false;
    bool variable_descriptor_count = false;
    bool nonuniform_sampled_images = false;
    bool update_after_bind_images = false;

    // Whether kernels can reach any number of images through one array of descriptors.
    bool has_image_arrays() const {
        return runtime_descriptor_array && variable_descriptor_count && nonuniform_sampled_images &&
               update_after_bind_images;
    }
};

// What the software accelerator and everything else of twinray needs and this device lacks.
std::vector<std::string> missing_for_software(const DeviceProperties& device);
// The same for the hardware accelerator (includes what software needs).
std::vector<std::string> missing_for_hardware(const DeviceProperties& device);

const char* name_of(DeviceKind kind);  // "discrete GPU", "CPU", ...

// What choose_device() found.
struct DeviceChoice {
    int index = -1;                       // into the given span; -1 = none fits
    std::vector<std::string> rejections;  // one sentence for each device that was not chosen
};

// request: "" = best (hardware ray tracing first, then discrete > integrated > virtual > cpu, then order),
// a decimal index, or a part of the device's name (case-insensitive).
DeviceChoice choose_device(std::span<const DeviceProperties> devices, const std::string& request);

// Every Vulkan device with what it offers. Throws Error when there is no Vulkan at all. Null: the system's loader.
std::vector<DeviceProperties> list_devices(PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr);

// Of a physical device of a host's instance. Throws Error for an instance below Vulkan 1.1.
DeviceProperties query_device_properties(PFN_vkGetInstanceProcAddr get_instance_proc_addr, VkInstance instance,
                                         VkPhysicalDevice device);

// The properties of a device that a host created with `info`: what it enabled, not what else the driver supports. For
// AdoptedDevice::enabled.
DeviceProperties enabled_properties(PFN_vkGetInstanceProcAddr get_instance_proc_addr, VkInstance instance,
                                    VkPhysicalDevice device, const VkDeviceCreateInfo& info);

// What twinray enables on a device, told before the device is created. What the device lacks is left out; only hardware
// ray tracing may be lacking.
class DeviceRequirements {
  public:
    // `supported`: from query_device_properties.
    explicit DeviceRequirements(const DeviceProperties& supported);
    ~DeviceRequirements();
    DeviceRequirements(const DeviceRequirements&) = delete;
    DeviceRequirements& operator=(const DeviceRequirements&) = delete;

    const DeviceProperties& supported() const;  // as given
    // A sentence each: "twinray needs timelineSemaphore because ...; this device has it".
    std::vector<std::string> sentences() const;

    // For a device that enables nothing else: features() is its VkDeviceCreateInfo::pNext.
    const std::vector<const char*>& extensions() const;
    const void* features() const;  // the first struct of the chain

    // For a device of a host that enables things of its own: adds both to `info`. A feature is switched on in the
    // struct of the host's chain that has it (of the feature alone or of a Vulkan version; that struct is written to);
    // where there is none, one of ours is put before the chain, into which pEnabledFeatures moves. `info`
    // refers to this object for as long as it is read, by vkCreateDevice and enabled_properties. Once.
    void add_to(VkDeviceCreateInfo& info);

  private:
    struct State;
    std::unique_ptr<State> state_;
};
// Where a buffer lies, by who writes and reads it.
enum class Memory : std::uint8_t {
    device,    // fastest for the GPU, not mapped
    upload,    // host writes once, GPU reads
    readback,  // GPU writes, host reads
};

// What twinray asks of an allocator: a buffer bound to memory of its own.
struct BufferRequest {
    const char* name = "";         // for debugging; valid during the call
    std::uint64_t bytes = 0;       // not 0
    VkBufferUsageFlags usage = 0;  // with SHADER_DEVICE_ADDRESS: the memory needs VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT
    Memory memory = Memory::device;
    std::uint64_t alignment = 1;  // of the device address; a power of two
};

// What it gets.
struct AllocatedBuffer {
    VkBuffer buffer = VK_NULL_HANDLE;
    // Memory::upload and readback: where the host reads and writes it, coherently, until it is freed.
    void* mapped = nullptr;
    void* allocation = nullptr;  // the allocator's own; twinray only hands it back
};

// What twinray asks of an allocator for textures: an image bound to memory of its own.
struct ImageRequest {
    const char* name = "";  // for debugging; valid during the call
    const VkImageCreateInfo* info = nullptr;
};

// What it gets.
struct AllocatedImage {
    VkImage image = VK_NULL_HANDLE;
    std::uint64_t bytes = 0;     // of its memory
    void* allocation = nullptr;  // the allocator's own; twinray only hands it back
};

// The host's allocator. Plain functions and plain data, so that no version of any allocator's types crosses the border
// of the library; twinray/vma_adapter.h makes them of a VmaAllocator. They are called on the thread that uses the
// Context and must not throw.
struct AllocatorHooks {
    // Returns VK_SUCCESS and fills `result`, or the error and leaves nothing behind.
    VkResult (*allocate)(void* user, const BufferRequest& request, AllocatedBuffer& result) = nullptr;
    // The GPU no longer uses the buffer.
    void (*free)(void* user, const AllocatedBuffer& buffer) = nullptr;
    void* user = nullptr;
    // The same for images in the device's memory. Both may be null: then textures are kept in buffers.
    VkResult (*allocate_image)(void* user, const ImageRequest& request, AllocatedImage& result) = nullptr;
    void (*free_image)(void* user, const AllocatedImage& image) = nullptr;
};

// A device that the host created and keeps. Its objects are used, never changed, waited idle on or destroyed; all of
// them, what the functions capture included, must outlive the Context.
struct AdoptedDevice {
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical_device = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;  // must support compute
    std::uint32_t queue_family = 0;
    PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;  // required
    std::uint32_t api_version = 0;  // VkApplicationInfo::apiVersion of the instance; at least 1.2
    // What was *enabled* on the device: told by the host, never guessed. enabled_properties() makes it of the
    // VkDeviceCreateInfo that the device was created with.
    DeviceProperties enabled;
    std::function<void()> lock_queue;  // held around each submission; may be empty
    std::function<void()> unlock_queue;
    AllocatorHooks allocator;                         // none: memory comes from an allocator of twinray's own
    VkPipelineCache pipeline_cache = VK_NULL_HANDLE;  // null: one of twinray's own
    std::optional<double> most_submission_seconds;    // as in ContextDesc
    Log log;
};

// How kernels are shaped for a device.
enum class TuningRow : std::uint8_t {
    gpu,        // what any device gets that is not known to want another
    cpu_driver  // Mesa's lavapipe: groups one after the other on each core, and no memory of their own
};
const char* name_of(TuningRow row);  // as TWINRAY_TUNING names it

// A value that a timeline semaphore reaches when the work submitted up to here is done.
struct SyncPoint {
    VkSemaphore semaphore = VK_NULL_HANDLE;
    std::uint64_t value = 0;
};

// A kernel that is made, and the size of its push constants. Any thread.
using KernelWatch = std::function<void(const KernelDesc& kernel, std::uint32_t args_bytes)>;

// How a context is made that has a device of its own.
struct ContextDesc {
    std::string name = "twinray";
    // "": the best (hardware ray tracing first, then discrete > integrated > virtual > cpu, then order); or a decimal
    // index, or a part of the device's name (case-insensitive).
    std::string device = {};
    bool validation = false;  // the Khronos layer, with synchronisation validation; messages go to the log and are kept
    bool use_ray_query = true;             // false: leave the extension disabled although the device has it
    bool use_ray_tracing_pipeline = true;  // likewise
    std::optional<TuningRow> tuning = {};  // none: what TWINRAY_TUNING names, else by device
    // None: by device, as KernelTuning has it; 0: no limit.
    std::optional<double> most_submission_seconds = {};
    // A device that ends none of its submissions for so long while it is waited for counts as lost: DeviceLost. 0: it
    // is waited for as long as it takes, as a hung one is for ever where no driver watches.
    double most_wait_seconds = 0;
    PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;  // null: open the system's loader
    std::filesystem::path pipeline_folder =
        {};        // keeps compiled pipelines between runs, a file for each device and driver; empty: none does
    Log log = {};  // warnings and validation messages; empty = stderr
    // For tools that ask what a driver makes of kernels (`twinray kernels`): if set, nothing runs. Each
    // kernel is told to it and not compiled, what is submitted is done at once, and what is read back is 0. A driver
    // without its hardware will do; where it can tell of pipelines (VK_KHR_pipeline_executable_properties), it does.
    KernelWatch watch_kernels = {};
};

// Leaves features of the device unused: `list` holds ray_query and ray_tracing_pipeline, separated by commas. For
// programs that take it from their user, as TWINRAY_DISABLE. Throws Error naming anything else in the list.
void disable_features(ContextDesc& desc, const std::string& list);

// "twinray" in the user's folder for caches: $XDG_CACHE_HOME, else .cache in $HOME; empty where neither is set.
std::filesystem::path user_pipeline_folder();

// One device with its memory allocator, one queue and one timeline. Not copyable; used by one thread at a time.
class Context {
  public:
    // Throws Error with the reason why each device was rejected if none fits.
    explicit Context(const ContextDesc& desc = {});
    // Throws Error, naming what the host has to change, unless twinray can run on the device: something needed is not
    // enabled, the queue family has no compute, or `enabled` claims what the device does not support or was not
    // created with.
    explicit Context(const AdoptedDevice& adopted);
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    VkDevice device() const;                     // made here or adopted
    VkPhysicalDevice physical_device() const;    // of the device
    std::uint32_t queue_family() const;          // of the one queue
    const DeviceProperties& properties() const;  // what is enabled, not merely supported
    std::uint64_t allocated_bytes() const;       // of the buffers and images made with it
    // The address that kernels get for something absent. It is odd, and there is memory at it, since some drivers read
    // before they know that they need not. is_absent() of twinray/glsl/common.glsl tells it in a kernel. Kernel<Args>
    // puts it in place of 0; a struct that a host uploads needs it in each member that kernels ask for.
    std::uint64_t absent() const;
    // Puts it into those of the addresses that are 0.
    template <class... T>
    void fill_absent(Ref<T>&... refs) const {
        ((refs.address = refs.address ? refs.address : absent()), ...);
    }

    // The next submission, whichever call makes it (Commands::submit, AbstractAccel::sync, ...), runs its `stages`, and
    // all that is submitted later does, only once the GPU has reached `point`, on a timeline semaphore of the host, and
    // sees what was written before it; one that fails leaves it to the one after. The host may submit the work that
    // signals it later, on another queue; until it is signalled, whoever waits for that submission, this context's end
    // included, waits too.
    void wait_before_next_submission(SyncPoint point, VkPipelineStageFlags stages = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT);
    SyncPoint last_submission() const;       // reached when all that was submitted so far is done
    bool is_reached(SyncPoint point) const;  // without waiting
    void wait(SyncPoint point) const;        // until it is reached; throws DeviceLost
    // Waits for everything submitted or announced so far, then frees what was retired.
    void wait_for_gpu();

    // Tells of work that the host submits itself and that uses what this context owns: nothing that is retired from
    // now on is freed before `point`. Its timeline semaphore must live until a later wait_for_gpu() or this context's
    // end, at which the host's own work must be done.
    void announce(SyncPoint point);

    // Messages of the validation layer so far.
    std::vector<std::string> validation_messages() const;

    // What the library itself needs of it.
    struct State;
    State& state() const { return *state_; }  // for twinray's own parts

  private:
    std::unique_ptr<State> state_;
};

}  // namespace twinray
