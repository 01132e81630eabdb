#include "engine/core/vulkan.h"

#include <algorithm>
#include <mutex>

#include "engine/core/error.h"
#include "engine/core/platform.h"

#define VOLK_IMPLEMENTATION
#include <volk.h>

namespace twinray {
namespace {

std::vector<VkLayerProperties> installed_layers(const VulkanTable& vk) {
    if (!vk.vkEnumerateInstanceLayerProperties) return {};  // a host's lookup may know its own instance only
    return listed<VkLayerProperties>(vk.vkEnumerateInstanceLayerProperties);
}

}  // namespace

PFN_vkGetInstanceProcAddr open_system_loader() {
    const auto [library, hint] = platform::vulkan_loader;
    void* const loader = platform::open_library(library);
    if (!loader) fail("no Vulkan loader: ", library, " cannot be opened (", hint, ")");
    return reinterpret_cast<PFN_vkGetInstanceProcAddr>(platform::symbol_of(loader, "vkGetInstanceProcAddr"));
}

void VulkanTable::load_global(PFN_vkGetInstanceProcAddr get_instance_proc_addr) {
    vkGetInstanceProcAddr = get_instance_proc_addr ? get_instance_proc_addr : open_system_loader();
    vkCreateInstance = reinterpret_cast<PFN_vkCreateInstance>(vkGetInstanceProcAddr(nullptr, "vkCreateInstance"));
    vkEnumerateInstanceLayerProperties = reinterpret_cast<PFN_vkEnumerateInstanceLayerProperties>(
        vkGetInstanceProcAddr(nullptr, "vkEnumerateInstanceLayerProperties"));
}

void VulkanTable::load_instance(VkInstance instance) {
#define TWINRAY_LOAD(name) name = reinterpret_cast<PFN_##name>(vkGetInstanceProcAddr(instance, #name));
    TWINRAY_INSTANCE_FUNCTIONS(TWINRAY_LOAD)
#undef TWINRAY_LOAD
    if (!vkCmdBeginDebugUtilsLabelEXT || labels_are_safe(installed_layers(*this))) return;
    vkCmdBeginDebugUtilsLabelEXT = nullptr;
    vkCmdEndDebugUtilsLabelEXT = nullptr;
}

bool labels_are_safe(std::span<const VkLayerProperties> layers) {
    return std::ranges::none_of(layers, [](const VkLayerProperties& layer) {
        return std::string_view(layer.layerName) == "VK_LAYER_KHRONOS_validation" &&
               layer.specVersion < VK_MAKE_API_VERSION(0, 1, 3, 243);
    });
}

// volk looks functions up by a global variable, which only one context at a time may set.
void VulkanTable::load_device(VkDevice device) {
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    ::vkGetDeviceProcAddr = vkGetDeviceProcAddr;
    volkLoadDeviceTable(this, device);
}

void vk_check(VkResult result, const char* action) {
    if (result == VK_ERROR_DEVICE_LOST) throw DeviceLost(text(action, ": ", name_of(result)));
    if (result != VK_SUCCESS) fail(action, ": ", name_of(result));
}

const char* name_of(VkResult result) {
    switch (result) {
        case VK_SUCCESS: return "success";
        case VK_ERROR_OUT_OF_HOST_MEMORY: return "out of host memory";
        case VK_ERROR_OUT_OF_DEVICE_MEMORY: return "out of device memory; use a smaller scene or batch";
        case VK_ERROR_INITIALIZATION_FAILED: return "the driver could not initialise";
        case VK_ERROR_DEVICE_LOST: return "the device was lost; create a new context";
        case VK_ERROR_LAYER_NOT_PRESENT: return "a layer is not installed";
        case VK_ERROR_EXTENSION_NOT_PRESENT: return "an extension is not supported";
        case VK_ERROR_FEATURE_NOT_PRESENT: return "a feature is not supported";
        case VK_ERROR_INCOMPATIBLE_DRIVER:
            return "no compatible Vulkan driver (Debian: apt-get install mesa-vulkan-drivers)";
        case VK_ERROR_TOO_MANY_OBJECTS: return "too many objects";
        case VK_TIMEOUT: return "timed out";
        default: return "Vulkan reported an unexpected result";
    }
}

}  // namespace twinray
