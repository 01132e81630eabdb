#define GLFW_INCLUDE_NONE
#include <vulkan/vulkan.h>

#include <GLFW/glfw3.h>

#include "viewer/screen.h"

#include <vector>

#include "engine/core/error.h"

namespace twinray::viewer {
namespace {

constexpr std::uint32_t api_version = VK_API_VERSION_1_2;

template <class Function>
Function instance_function(VkInstance instance, const char* name) {
    return reinterpret_cast<Function>(vkGetInstanceProcAddr(instance, name));
}

// Returns a queue family that draws, computes and shows there; -1 if there is none.
int family_of(VkPhysicalDevice device, VkSurfaceKHR surface) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    constexpr VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (std::uint32_t i = 0; i < count; ++i) {
        VkBool32 shows = VK_FALSE;
        if (vkGetPhysicalDeviceSurfaceSupportKHR(device, i, surface, &shows) != VK_SUCCESS) continue;
        if (shows && (families[i].queueFlags & wanted) == wanted) return static_cast<int>(i);
    }
    return -1;
}

}  // namespace

void require(VkResult result, const char* action) {
    if (result != VK_SUCCESS) fail("window: ", action, ": VkResult ", static_cast<int>(result));
}

// It delegates, so that the destructor runs if anything here throws.
ScreenDevice::ScreenDevice(GLFWwindow* window, const ContextDesc& desc) : ScreenDevice() {
    most_submission_seconds_ = desc.most_submission_seconds;
    log_ = desc.log;
    create_instance(desc);
    require(glfwCreateWindowSurface(instance_, window, nullptr, &surface_), "make a surface");
    choose(desc.device);
    create_device(desc);
}

ScreenDevice::~ScreenDevice() {
    if (device_) vkDestroyDevice(device_, nullptr);
    if (surface_) vkDestroySurfaceKHR(instance_, surface_, nullptr);
    if (messenger_)
        instance_function<PFN_vkDestroyDebugUtilsMessengerEXT>(instance_, "vkDestroyDebugUtilsMessengerEXT")(
            instance_, messenger_, nullptr);
    if (instance_) vkDestroyInstance(instance_, nullptr);
}

VkBool32 VKAPI_PTR ScreenDevice::on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                            const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    auto& screen = *static_cast<ScreenDevice*>(user);
    ++screen.message_count_;
    if (screen.log_) screen.log_(data->pMessage);
    return VK_FALSE;
}

void ScreenDevice::create_instance(const ContextDesc& desc) {
    std::uint32_t count = 0;
    const char** needed = glfwGetRequiredInstanceExtensions(&count);
    if (!needed) fail("window: no Vulkan driver of this system can present pictures");
    std::vector<const char*> extensions(needed, needed + count);
    const char* layer = "VK_LAYER_KHRONOS_validation";
    if (desc.validation)
        extensions.insert(extensions.end(),
                          {VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME});
    auto application = of_type<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
    application.pApplicationName = "twinray view";
    application.apiVersion = api_version;
    const VkValidationFeatureEnableEXT synchronisation = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    auto features = of_type<VkValidationFeaturesEXT>(VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT);
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = &synchronisation;
    auto info = of_type<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
    info.pNext = desc.validation ? &features : nullptr;
    info.pApplicationInfo = &application;
    info.enabledLayerCount = desc.validation ? 1 : 0;
    info.ppEnabledLayerNames = &layer;
    info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    require(vkCreateInstance(&info, nullptr, &instance_), "make an instance");
    if (!desc.validation) return;
    auto listen = of_type<VkDebugUtilsMessengerCreateInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT);
    listen.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    listen.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    listen.pfnUserCallback = on_message;
    listen.pUserData = this;
    const auto create =
        instance_function<PFN_vkCreateDebugUtilsMessengerEXT>(instance_, "vkCreateDebugUtilsMessengerEXT");
    require(create(instance_, &listen, nullptr, &messenger_), "listen to the validation layer");
}

void ScreenDevice::choose(const std::string& request) {
    std::uint32_t count = 0;
    require(vkEnumeratePhysicalDevices(instance_, &count, nullptr), "list the devices");
    std::vector<VkPhysicalDevice> devices(count);
    require(vkEnumeratePhysicalDevices(instance_, &count, devices.data()), "list the devices");
    std::vector<DeviceProperties> properties;
    for (VkPhysicalDevice device : devices) {
        properties.push_back(query_device_properties(vkGetInstanceProcAddr, instance_, device));
        properties.back().has_compute_queue = family_of(device, surface_) >= 0;
    }
    const DeviceChoice choice = choose_device(properties, request);
    if (choice.index < 0) {
        std::string why;
        for (const std::string& rejection : choice.rejections) why += "\n  " + rejection;
        fail("window: no device both runs twinray and presents pictures here", why);
    }
    physical_ = devices[static_cast<std::size_t>(choice.index)];
    family_ = static_cast<std::uint32_t>(family_of(physical_, surface_));
    choose_format();
}

// Chooses a format that takes 8 bits a channel as they are.
void ScreenDevice::choose_format() {
    std::uint32_t count = 0;
    require(vkGetPhysicalDeviceSurfaceFormatsKHR(physical_, surface_, &count, nullptr), "list formats");
    std::vector<VkSurfaceFormatKHR> formats(count);
    require(vkGetPhysicalDeviceSurfaceFormatsKHR(physical_, surface_, &count, formats.data()), "list formats");
    for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM})
        for (const VkSurfaceFormatKHR& format : formats)
            if (format.format == wanted && format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) {
                format_ = wanted;
                return;
            }
    fail("window: it has no format with 8 bits per channel");
}

void ScreenDevice::create_device(const ContextDesc& desc) {
    const float priority = 1;
    auto queue = of_type<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
    queue.queueFamilyIndex = family_;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    const char* own = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    auto info = of_type<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = 1;
    info.ppEnabledExtensionNames = &own;
    DeviceProperties wanted = query_device_properties(vkGetInstanceProcAddr, instance_, physical_);
    wanted.ray_query &= desc.use_ray_query;
    wanted.ray_tracing_pipeline &= desc.use_ray_tracing_pipeline;
    DeviceRequirements requirements(wanted);
    requirements.add_to(info);
    require(vkCreateDevice(physical_, &info, nullptr, &device_), "make a device");
    enabled_ = enabled_properties(vkGetInstanceProcAddr, instance_, physical_, info);
    vkGetDeviceQueue(device_, family_, 0, &queue_);
}

AdoptedDevice ScreenDevice::adopted() const {
    AdoptedDevice adopted;
    adopted.instance = instance_;
    adopted.physical_device = physical_;
    adopted.device = device_;
    adopted.queue = queue_;
    adopted.queue_family = family_;
    adopted.get_instance_proc_addr = vkGetInstanceProcAddr;
    adopted.api_version = api_version;
    adopted.enabled = enabled_;
    adopted.most_submission_seconds = most_submission_seconds_;
    adopted.log = log_;
    return adopted;
}

}  // namespace twinray::viewer
