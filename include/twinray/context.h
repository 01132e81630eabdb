// SPDX-License-Identifier: MIT
// A Vulkan device with its memory, its queue and its timeline, made here or adopted from an application.
//
//     twinray::Context context;                        // the best device that there is
//     twinray::Context guest(adopted);                 // an application's: fill AdoptedDevice
//     twinray::DeviceRequirements needs(properties);   // to enable on such a device
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

// Receives warnings and validation messages, one sentence per call.
using Log = std::function<void(std::string_view)>;

// The values of VkPhysicalDeviceType.
enum class DeviceKind : std::uint8_t { discrete, integrated, virtual_gpu, cpu, other };

// The properties of a device that twinray reads; query_device_properties() fills them.
struct DeviceProperties {
    std::string name;
    std::string driver;
    DeviceKind kind = DeviceKind::other;
    std::uint32_t api_version = 0;  // as VK_MAKE_API_VERSION
    // Limits of a compute group; the defaults are the minima that Vulkan guarantees.
    std::uint32_t shared_bytes = 16384, group_invocations = 128, push_constant_bytes = 128;
    std::uint32_t driver_id = 0;          // VkDriverId
    std::array<std::uint8_t, 16> uuid{};  // identifies the device to other APIs
    std::uint32_t cpu_threads = 0;        // for a CPU device: the threads that run the groups of a dispatch; else 0
    std::uint32_t subgroup_size = 0;
    bool has_compute_queue = false;
    bool timeline_semaphore = false;
    bool buffer_device_address = false;
    bool scalar_block_layout = false;
    bool shader_int64 = false;  // for the application's kernels; twinray's own do not need it
    bool shader_float64 = false;
    bool acceleration_structure = false;
    bool ray_query = false;
    bool ray_tracing_pipeline = false;
    bool primitive_culling = false;  // rays can skip triangles or boxes
    bool device_fault = false;       // reports why the device was lost
    bool external_memory = false;    // memory can be shared with other programs and APIs: Buffer::exportable
    bool runtime_descriptor_array = false;
    bool variable_descriptor_count = false;
    bool nonuniform_sampled_images = false;
    bool update_after_bind_images = false;

    // Returns whether kernels can reach any number of images through one array of descriptors.
    bool has_image_arrays() const {
        return runtime_descriptor_array && variable_descriptor_count && nonuniform_sampled_images &&
               update_after_bind_images;
    }
};

// Lists the features that the device lacks and that the software accelerator and the rest of twinray need.
std::vector<std::string> missing_for_software(const DeviceProperties& device);
// The same for the hardware accelerator, which needs these features too.
std::vector<std::string> missing_for_hardware(const DeviceProperties& device);

const char* name_of(DeviceKind kind);  // "discrete GPU", "CPU", ...

// The result of choose_device().
struct DeviceChoice {
    int index = -1;                       // into the given span; -1 = none fits
    std::vector<std::string> rejections;  // one sentence for each device that was not chosen
};

// request: "" = best (hardware ray tracing first, then discrete > integrated > virtual > cpu, then order),
// a decimal index, or a part of the device's name (case-insensitive).
DeviceChoice choose_device(std::span<const DeviceProperties> devices, const std::string& request);

// Lists every Vulkan device with its properties. Throws Error if there is no Vulkan at all. Null: the system's loader.
std::vector<DeviceProperties> list_devices(PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr);

// Queries a physical device of the application's instance. Throws Error for an instance below Vulkan 1.1.
DeviceProperties query_device_properties(PFN_vkGetInstanceProcAddr get_instance_proc_addr, VkInstance instance,
                                         VkPhysicalDevice device);

// Returns the properties of a device that the application created with `info`: only the features that it enabled, not
// all that the driver supports. Use it to fill AdoptedDevice::enabled.
DeviceProperties enabled_properties(PFN_vkGetInstanceProcAddr get_instance_proc_addr, VkInstance instance,
                                    VkPhysicalDevice device, const VkDeviceCreateInfo& info);

// Lists the features and extensions that twinray enables on a device, before the device is created. Features that the
// device lacks are left out; only those of hardware ray tracing may be lacking.
class DeviceRequirements {
  public:
    // `supported` comes from query_device_properties().
    explicit DeviceRequirements(const DeviceProperties& supported);
    ~DeviceRequirements();
    DeviceRequirements(const DeviceRequirements&) = delete;
    DeviceRequirements& operator=(const DeviceRequirements&) = delete;

    const DeviceProperties& supported() const;  // as given
    // Returns a sentence for each: "twinray needs timelineSemaphore because ...; this device has it".
    std::vector<std::string> sentences() const;

    // Use these two for a device that enables nothing else: features() is its VkDeviceCreateInfo::pNext.
    const std::vector<const char*>& extensions() const;
    const void* features() const;  // the first struct of the chain

    // For a device on which the application enables features of its own: adds both to `info`. Each feature is set in
    // the struct of the chain that contains it (for that feature or a Vulkan version); that struct is written to. If
    // there is none, a struct of this object is put before the chain, and pEnabledFeatures moves into it. `info` refers
    // to this object while vkCreateDevice and enabled_properties() read it. Call it once.
    void add_to(VkDeviceCreateInfo& info);

  private:
    struct State;
    std::unique_ptr<State> state_;
};
// The kind of memory of a buffer, by its writers and readers.
enum class Memory : std::uint8_t {
    device,    // fastest for the GPU, not mapped
    upload,    // host writes once, GPU reads
    readback,  // GPU writes, host reads
};

// A request to an allocator: one buffer bound to memory of its own.
struct BufferRequest {
    const char* name = "";         // for debugging; valid during the call
    std::uint64_t bytes = 0;       // not 0
    VkBufferUsageFlags usage = 0;  // with SHADER_DEVICE_ADDRESS, the memory needs VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT
    Memory memory = Memory::device;
    std::uint64_t alignment = 1;  // of the device address; a power of two
};

// The allocator's answer to a BufferRequest.
struct AllocatedBuffer {
    VkBuffer buffer = VK_NULL_HANDLE;
    // Memory::upload and readback: where the host reads and writes it, coherently, until it is freed.
    void* mapped = nullptr;
    void* allocation = nullptr;  // the allocator's own; twinray only hands it back
};

// A request to an allocator for a texture: one image bound to memory of its own.
struct ImageRequest {
    const char* name = "";  // for debugging; valid during the call
    const VkImageCreateInfo* info = nullptr;
};

// The allocator's answer to an ImageRequest.
struct AllocatedImage {
    VkImage image = VK_NULL_HANDLE;
    std::uint64_t bytes = 0;     // of its memory
    void* allocation = nullptr;  // the allocator's own; twinray only hands it back
};

// The application's allocator. It consists of plain functions and plain data, so that no types of an allocator cross
// the library's interface; twinray/vma_adapter.h makes it from a VmaAllocator. The functions are called on the thread
// that uses the Context and must not throw.
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

// A device that the application created and keeps. twinray uses its objects but never changes them, waits for them to
// be idle or destroys them. All of them, and what the functions capture, must outlive the Context.
struct AdoptedDevice {
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical_device = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;  // must support compute
    std::uint32_t queue_family = 0;
    PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;  // required
    std::uint32_t api_version = 0;  // VkApplicationInfo::apiVersion of the instance; at least 1.2
    // The features that were *enabled* on the device; twinray never guesses them. enabled_properties() makes this from
    // the VkDeviceCreateInfo that the device was created with.
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
    gpu,        // every device that has no row of its own
    cpu_driver  // Mesa's lavapipe: runs groups one after the other on each core, and has no memory of its own
};
const char* name_of(TuningRow row);  // the spelling that TWINRAY_TUNING uses

// A value that a timeline semaphore reaches when the work submitted up to here is done.
struct SyncPoint {
    VkSemaphore semaphore = VK_NULL_HANDLE;
    std::uint64_t value = 0;
};

// Receives each kernel that is made and the size of its push constants. Any thread may call it.
using KernelWatch = std::function<void(const KernelDesc& kernel, std::uint32_t args_bytes)>;

// Describes a context that creates its own device.
struct ContextDesc {
    std::string name = "twinray";
    // "": the best (hardware ray tracing first, then discrete > integrated > virtual > cpu, then order); or a decimal
    // index, or a part of the device's name (case-insensitive).
    std::string device = {};
    bool validation = false;  // the Khronos layer, with synchronisation validation; messages go to the log and are kept
    bool use_ray_query = true;             // false: leave the extension disabled although the device has it
    bool use_ray_tracing_pipeline = true;  // likewise
    std::optional<TuningRow> tuning = {};  // none: as TWINRAY_TUNING names it, else by device
    // Not set: chosen by device, as KernelTuning has it; 0: no limit.
    std::optional<double> most_submission_seconds = {};
    // A device counts as lost (DeviceLost) if it finishes no submission for this many seconds while twinray waits for
    // it. 0: twinray waits without limit, which for a hung device is for ever unless a driver watches it.
    double most_wait_seconds = 0;
    PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;  // null: open the system's loader
    std::filesystem::path pipeline_folder =
        {};        // keeps compiled pipelines between runs, a file for each device and driver; empty: none does
    Log log = {};  // warnings and validation messages; empty = stderr
    // For tools that ask how a driver compiles kernels (`twinray kernels`). If set, nothing runs: each kernel is passed
    // to it instead of being compiled, submissions are done at once, and reads return 0. A driver without its hardware
    // will do; it reports on pipelines if it can (VK_KHR_pipeline_executable_properties).
    KernelWatch watch_kernels = {};
};

// Leaves features of the device unused: `list` holds ray_query and ray_tracing_pipeline, separated by commas. It is for
// programs that take the list from their user, as in TWINRAY_DISABLE. Throws Error naming any other entry.
void disable_features(ContextDesc& desc, const std::string& list);

// Returns "twinray" in the user's folder for caches: $XDG_CACHE_HOME, else .cache in $HOME; empty if neither is set.
std::filesystem::path user_pipeline_folder();

// One device with its memory allocator, one queue and one timeline. Not copyable; used by one thread at a time. It does
// not outlive a fork: in a child process all that was made with it throws Error and may be destroyed, which leaves the
// parent's alone; another Context of the child's own works where the driver's does.
class Context {
  public:
    // Throws Error with the reason why each device was rejected if none fits.
    explicit Context(const ContextDesc& desc = {});
    // Throws Error, naming what the application has to change, unless twinray can run on the device: a needed feature
    // is not enabled, the queue family has no compute, or `enabled` claims a feature that the device does not support
    // or was not created with.
    explicit Context(const AdoptedDevice& adopted);
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    VkDevice device() const;                     // created here or adopted
    VkPhysicalDevice physical_device() const;    // the one that device() was created on
    std::uint32_t queue_family() const;          // the family of the one queue
    const DeviceProperties& properties() const;  // the enabled features, not merely supported ones
    std::uint64_t allocated_bytes() const;       // size of the buffers and images made with it
    // Returns the address that kernels get for absent data. It is odd, and there is memory at it, because some drivers
    // read before they know that they need not. Kernels test it with is_absent() of twinray/glsl/common.glsl.
    // Kernel<Args> puts it in place of 0; a struct that the application uploads needs it in each member that is tested.
    std::uint64_t absent() const;
    // Replaces each of the addresses that is 0 by absent().
    template <class... T>
    void fill_absent(Ref<T>&... refs) const {
        ((refs.address = refs.address ? refs.address : absent()), ...);
    }

    // The next submission, whichever call makes it (Commands::submit, AbstractAccel::sync, ...), runs its `stages` only
    // once the GPU has reached `point` on a timeline semaphore of the application, and sees all that was written before
    // it. All later submissions wait too; if a submission fails, the wait passes to the next one. The application may
    // submit the work that signals the point later, on another queue; until then, every wait for that submission
    // blocks, including this context's destructor.
    void wait_before_next_submission(SyncPoint point, VkPipelineStageFlags stages = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT);
    SyncPoint last_submission() const;       // reached when all that was submitted so far is done
    bool is_reached(SyncPoint point) const;  // does not wait
    void wait(SyncPoint point) const;        // blocks until it is reached; throws DeviceLost
    // Waits for everything submitted or announced so far, then frees the retired resources.
    void wait_for_gpu();

    // Announces work that the application submits itself and that uses resources of this context: nothing that is
    // retired from now on is freed before `point`. Its timeline semaphore must live until a later wait_for_gpu() or
    // this context's end, by which the application's own work must be done.
    void announce(SyncPoint point);

    // Returns the messages of the validation layer so far.
    std::vector<std::string> validation_messages() const;

    // Internal: the library's own parts use it.
    struct State;
    State& state() const { return *state_; }  // for twinray's own parts

  private:
    std::unique_ptr<State> state_;
};

}  // namespace twinray
