#include "report/faults/fault_injection.h"

#include <cstdlib>
#include <tuple>

#include "engine/core/error.h"
#include "engine/core/vulkan.h"

namespace twinray::faults {
namespace {

// The functions that twinray and VMA call, each once, with the error that a driver would most likely return.
#define TWINRAY_FALLIBLE(F)                                                     \
    F(vkEnumeratePhysicalDevices, VK_ERROR_INITIALIZATION_FAILED, false)        \
    F(vkEnumerateDeviceExtensionProperties, VK_ERROR_OUT_OF_HOST_MEMORY, false) \
    F(vkMapMemory, VK_ERROR_MEMORY_MAP_FAILED, false)                           \
    F(vkFlushMappedMemoryRanges, VK_ERROR_OUT_OF_HOST_MEMORY, false)            \
    F(vkInvalidateMappedMemoryRanges, VK_ERROR_OUT_OF_HOST_MEMORY, false)       \
    F(vkBindBufferMemory, VK_ERROR_OUT_OF_DEVICE_MEMORY, false)                 \
    F(vkBindBufferMemory2, VK_ERROR_OUT_OF_DEVICE_MEMORY, false)                \
    F(vkAllocateCommandBuffers, VK_ERROR_OUT_OF_DEVICE_MEMORY, false)           \
    F(vkAllocateDescriptorSets, VK_ERROR_OUT_OF_POOL_MEMORY, false)             \
    F(vkBeginCommandBuffer, VK_ERROR_OUT_OF_HOST_MEMORY, false)                 \
    F(vkEndCommandBuffer, VK_ERROR_OUT_OF_DEVICE_MEMORY, false)                 \
    F(vkQueueSubmit, VK_ERROR_OUT_OF_DEVICE_MEMORY, true)                       \
    F(vkWaitSemaphores, VK_ERROR_OUT_OF_HOST_MEMORY, true)                      \
    F(vkGetSemaphoreCounterValue, VK_ERROR_OUT_OF_HOST_MEMORY, true)            \
    F(vkGetQueryPoolResults, VK_ERROR_OUT_OF_HOST_MEMORY, true)                 \
    F(vkGetRayTracingShaderGroupHandlesKHR, VK_ERROR_OUT_OF_HOST_MEMORY, false)

// The other functions that make an object, with its type.
#define TWINRAY_MAKING(F)                                                         \
    F(vkAllocateMemory, VK_ERROR_OUT_OF_DEVICE_MEMORY, false, VkDeviceMemory)     \
    F(vkCreateComputePipelines, VK_ERROR_OUT_OF_DEVICE_MEMORY, false, VkPipeline) \
    F(vkCreateRayTracingPipelinesKHR, VK_ERROR_OUT_OF_DEVICE_MEMORY, false, VkPipeline)

// Objects of the type Vk... with functions vkCreate... and vkDestroy...
#define TWINRAY_OBJECTS(F)                                        \
    F(Instance, VK_ERROR_INCOMPATIBLE_DRIVER, false)              \
    F(DebugUtilsMessengerEXT, VK_ERROR_OUT_OF_HOST_MEMORY, false) \
    F(Device, VK_ERROR_INITIALIZATION_FAILED, true)               \
    F(Buffer, VK_ERROR_OUT_OF_DEVICE_MEMORY, false)               \
    F(Image, VK_ERROR_OUT_OF_DEVICE_MEMORY, false)                \
    F(ImageView, VK_ERROR_OUT_OF_HOST_MEMORY, false)              \
    F(Sampler, VK_ERROR_TOO_MANY_OBJECTS, false)                  \
    F(DescriptorSetLayout, VK_ERROR_OUT_OF_HOST_MEMORY, false)    \
    F(DescriptorPool, VK_ERROR_OUT_OF_DEVICE_MEMORY, false)       \
    F(Semaphore, VK_ERROR_OUT_OF_HOST_MEMORY, false)              \
    F(CommandPool, VK_ERROR_OUT_OF_HOST_MEMORY, false)            \
    F(QueryPool, VK_ERROR_OUT_OF_DEVICE_MEMORY, false)            \
    F(ShaderModule, VK_ERROR_OUT_OF_HOST_MEMORY, false)           \
    F(PipelineCache, VK_ERROR_OUT_OF_HOST_MEMORY, false)          \
    F(PipelineLayout, VK_ERROR_OUT_OF_HOST_MEMORY, false)         \
    F(AccelerationStructureKHR, VK_ERROR_OUT_OF_HOST_MEMORY, false)

FaultInjector* active = nullptr;
PFN_vkGetInstanceProcAddr real_instance_proc_addr = nullptr;
PFN_vkGetDeviceProcAddr real_device_proc_addr = nullptr;

// One wrapper per function; `Tag` names and describes the function.
template <class Tag, class Pointer>
struct Wrapper;

template <class Tag, class... Args>
struct Wrapper<Tag, VkResult(VKAPI_PTR*)(Args...)> {
    inline static VkResult(VKAPI_PTR* next)(Args...) = nullptr;
    static VkResult VKAPI_PTR call(Args... args) {
        if (const VkResult fault = active->enter(Tag::function); fault != VK_SUCCESS) return fault;
        const VkResult result = next(args...);
        // The handle comes last, and twinray creates one object per call.
        if constexpr (!Tag::makes.empty())
            if (result == VK_SUCCESS)
                active->created(Tag::makes.data(), *std::get<sizeof...(Args) - 1>(std::tuple(args...)));
        return result;
    }
};

template <class Tag, class... Args>
struct Wrapper<Tag, void(VKAPI_PTR*)(Args...)> {
    inline static void(VKAPI_PTR* next)(Args...) = nullptr;
    static void VKAPI_PTR call(Args... args) {
        // The handle comes before the allocation callbacks.
        active->destroyed(Tag::destroys, std::get<sizeof...(Args) - 2>(std::tuple(args...)));
        next(args...);
    }
};

template <class Tag, class Pointer>
PFN_vkVoidFunction wrapped(PFN_vkVoidFunction real) {
    using Wrapping = Wrapper<Tag, Pointer>;
    Wrapping::next = reinterpret_cast<Pointer>(real);
    return reinterpret_cast<PFN_vkVoidFunction>(&Wrapping::call);
}

#define TWINRAY_TAG(name, error, may_lose_device, ...)                                       \
    struct Tag_##name {                                                                      \
        static constexpr FaultInjector::Function function = {#name, error, may_lose_device}; \
        static constexpr std::string_view makes = "" #__VA_ARGS__;                           \
    };
#define TWINRAY_DESTROYING_TAG(name, type)             \
    struct Tag_##name {                                \
        static constexpr const char* destroys = #type; \
    };
#define TWINRAY_OBJECT_TAGS(name, error, may_lose_device)         \
    TWINRAY_TAG(vkCreate##name, error, may_lose_device, Vk##name) \
    TWINRAY_DESTROYING_TAG(vkDestroy##name, Vk##name)
TWINRAY_FALLIBLE(TWINRAY_TAG)
TWINRAY_MAKING(TWINRAY_TAG)
TWINRAY_OBJECTS(TWINRAY_OBJECT_TAGS)
TWINRAY_DESTROYING_TAG(vkFreeMemory, VkDeviceMemory)
TWINRAY_DESTROYING_TAG(vkDestroyPipeline, VkPipeline)

PFN_vkGetAccelerationStructureBuildSizesKHR real_build_sizes = nullptr;
PFN_vkCreateAccelerationStructureKHR wrapped_create_structure = nullptr;

// Returns more than the driver wants. The driver does not know this, and finds that a compacted copy needs less.
void VKAPI_PTR generous_build_sizes(VkDevice device, VkAccelerationStructureBuildTypeKHR type,
                                    const VkAccelerationStructureBuildGeometryInfoKHR* info,
                                    const std::uint32_t* counts, VkAccelerationStructureBuildSizesInfoKHR* sizes) {
    real_build_sizes(device, type, info, counts, sizes);
    sizes->accelerationStructureSize = active->with_slack(sizes->accelerationStructureSize);
}

VkResult VKAPI_PTR create_structure_without_slack(VkDevice device, const VkAccelerationStructureCreateInfoKHR* info,
                                                  const VkAllocationCallbacks* callbacks,
                                                  VkAccelerationStructureKHR* structure) {
    VkAccelerationStructureCreateInfoKHR real = *info;
    real.size = active->without_slack(info->size);
    return wrapped_create_structure(device, &real, callbacks, structure);
}

// Returns the wrapper of a function, or the function itself if it has no wrapper.
PFN_vkVoidFunction around(std::string_view name, PFN_vkVoidFunction real) {
    if (!real) return nullptr;
    if (name == "vkCreateAccelerationStructureKHR") {
        wrapped_create_structure = reinterpret_cast<PFN_vkCreateAccelerationStructureKHR>(
            wrapped<Tag_vkCreateAccelerationStructureKHR, PFN_vkCreateAccelerationStructureKHR>(real));
        return reinterpret_cast<PFN_vkVoidFunction>(&create_structure_without_slack);
    }
#define TWINRAY_WRAP(function, ...) \
    if (name == #function) return wrapped<Tag_##function, PFN_##function>(real);
#define TWINRAY_WRAP_OBJECT(object, ...) TWINRAY_WRAP(vkCreate##object) TWINRAY_WRAP(vkDestroy##object)
    TWINRAY_FALLIBLE(TWINRAY_WRAP)
    TWINRAY_MAKING(TWINRAY_WRAP)
    TWINRAY_OBJECTS(TWINRAY_WRAP_OBJECT)
    TWINRAY_WRAP(vkFreeMemory)
    TWINRAY_WRAP(vkDestroyPipeline)
    if (name == "vkGetAccelerationStructureBuildSizesKHR") {
        real_build_sizes = reinterpret_cast<PFN_vkGetAccelerationStructureBuildSizesKHR>(real);
        return reinterpret_cast<PFN_vkVoidFunction>(&generous_build_sizes);
    }
    return real;
}

PFN_vkVoidFunction VKAPI_PTR device_proc_addr(VkDevice device, const char* name) {
    return around(name, real_device_proc_addr(device, name));
}

PFN_vkVoidFunction VKAPI_PTR instance_proc_addr(VkInstance instance, const char* name) {
    const PFN_vkVoidFunction real = real_instance_proc_addr(instance, name);
    if (std::string_view(name) == "vkGetInstanceProcAddr")
        return reinterpret_cast<PFN_vkVoidFunction>(&instance_proc_addr);
    if (std::string_view(name) == "vkGetDeviceProcAddr") {
        real_device_proc_addr = reinterpret_cast<PFN_vkGetDeviceProcAddr>(real);
        return reinterpret_cast<PFN_vkVoidFunction>(&device_proc_addr);
    }
    return around(name, real);
}

}  // namespace

FaultInjector::FaultInjector() {
    if (active) std::abort();
    active = this;
    real_instance_proc_addr = open_system_loader();
}

FaultInjector::~FaultInjector() { active = nullptr; }

PFN_vkGetInstanceProcAddr FaultInjector::entry() const { return &instance_proc_addr; }

void FaultInjector::inject(const Fault& fault) {
    fault_ = fault;
    function_ = fault.function;
    armed_ = true;
    calls_ = injected_ = 0;
    failed_.clear();
}

bool FaultInjector::is_picked(const Function& function) const {
    if (!function_.empty() && function_ != function.name) return false;
    return fault_.result != VK_ERROR_DEVICE_LOST || function.may_lose_device;
}

VkResult FaultInjector::enter(const Function& function) {
    if (!armed_ || !is_picked(function)) return VK_SUCCESS;
    ++calls_;
    if (calls_ < fault_.first || calls_ - fault_.first >= fault_.count) return VK_SUCCESS;
    ++injected_;
    failed_ = function.name;
    if (fault_.result == VK_ERROR_DEVICE_LOST) wait_for_devices();
    return fault_.result == VK_ERROR_UNKNOWN ? function.error : fault_.result;
}

std::uint64_t FaultInjector::with_slack(std::uint64_t bytes) {
    if (structure_slack_) generous_.insert(bytes + structure_slack_);
    return bytes + structure_slack_;
}

std::uint64_t FaultInjector::without_slack(std::uint64_t bytes) const {
    return generous_.contains(bytes) ? bytes - structure_slack_ : bytes;
}

void FaultInjector::wait_for_devices() const {
    for (const auto& [type, handle] : live_) {
        if (type != "VkDevice") continue;
        const auto device = static_cast<VkDevice>(handle);
        reinterpret_cast<PFN_vkDeviceWaitIdle>(real_device_proc_addr(device, "vkDeviceWaitIdle"))(device);
    }
}

void FaultInjector::created(const char* type, void* handle) {
    live_.emplace(type, handle);
    if (std::string_view(type) == "VkInstance") instance_ = static_cast<VkInstance>(handle);
}

void FaultInjector::destroyed(const char* type, void* handle) {
    if (!handle) return;
    if (!live_.erase({type, handle})) ++wrong_destructions_;
    // There is one device at a time: it is destroyed after everything that was made from it.
    if (std::string_view(type) == "VkDevice")
        for (const auto& [other, count] : live())
            wrong_destructions_ += other != "VkInstance" && other != "VkDebugUtilsMessengerEXT";
}

Counts FaultInjector::live() const {
    Counts counts;
    for (const auto& [type, handle] : live_) ++counts[type];
    return counts;
}

Counts FaultInjector::live_objects() const {
    Counts counts = live();
    counts.erase("VkDeviceMemory");
    return counts;
}

bool may_be_harmless(const std::string& function) {
    return function == "vkAllocateMemory" || function == "vkMapMemory" || function == "vkGetSemaphoreCounterValue";
}

Outcome outcome_of(const std::function<void()>& action, std::string* what) {
    try {
        action();
    } catch (const DeviceLost& error) {
        if (what) *what = error.what();
        return Outcome::lost;
    } catch (const Error& error) {
        if (what) *what = error.what();
        return Outcome::error;
    }
    return Outcome::done;
}

std::string what_is_thrown_by(const std::function<void()>& action) {
    std::string what;
    outcome_of(action, &what);
    return what;
}

}  // namespace twinray::faults
