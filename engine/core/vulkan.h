// The Vulkan functions of one device. The library calls no global vk* function, and its copy of volk is its own, so
// that an application may link the Vulkan loader, volk or another copy beside it.
#pragma once

#include <volk.h>

#include <cstdint>
#include <span>
#include <vector>

// volk has these only among its globals: no device knows them.
#define TWINRAY_INSTANCE_FUNCTIONS(F)           \
    F(vkDestroyInstance)                        \
    F(vkEnumeratePhysicalDevices)               \
    F(vkEnumerateDeviceExtensionProperties)     \
    F(vkGetPhysicalDeviceProperties2)           \
    F(vkGetPhysicalDeviceFeatures2)             \
    F(vkGetPhysicalDeviceQueueFamilyProperties) \
    F(vkGetPhysicalDeviceMemoryProperties)      \
    F(vkGetPhysicalDeviceFormatProperties)      \
    F(vkCreateDevice)                           \
    F(vkGetDeviceProcAddr)                      \
    F(vkCreateDebugUtilsMessengerEXT)           \
    F(vkDestroyDebugUtilsMessengerEXT)          \
    F(vkSetDebugUtilsObjectNameEXT)             \
    F(vkCmdBeginDebugUtilsLabelEXT)             \
    F(vkCmdEndDebugUtilsLabelEXT)

namespace twinray {

// Filled from one vkGetInstanceProcAddr; a function of an extension that is not enabled stays null.
struct VulkanTable : VolkDeviceTable {
    PFN_vkGetInstanceProcAddr vkGetInstanceProcAddr = nullptr;
    PFN_vkCreateInstance vkCreateInstance = nullptr;
    PFN_vkEnumerateInstanceLayerProperties vkEnumerateInstanceLayerProperties = nullptr;
#define TWINRAY_MEMBER(name) PFN_##name name = nullptr;
    TWINRAY_INSTANCE_FUNCTIONS(TWINRAY_MEMBER)
#undef TWINRAY_MEMBER

    VulkanTable() : VolkDeviceTable{} {}

    // Loads the functions; null opens the system's Vulkan loader. Throws Error if the system has none.
    void load_global(PFN_vkGetInstanceProcAddr get_instance_proc_addr);
    // Leaves out debug labels if an installed validation layer would crash by them: see labels_are_safe.
    void load_instance(VkInstance instance);
    void load_device(VkDevice device);
};

// Opens the system's Vulkan loader, for the life of the process: drivers and layers do not survive being unloaded.
// Throws Error if the system has none.
PFN_vkGetInstanceProcAddr open_system_loader();

// Returns false if one of the layers is a Khronos validation layer older than 1.3.243. It forgets the labels of a
// destroyed command buffer on a thread of its own without its lock, by the handle, which a new command buffer may have
// by then: the heap is corrupted, seldom (KhronosGroup/Vulkan-ValidationLayers, 5172).
bool labels_are_safe(std::span<const VkLayerProperties> layers);

// Becomes any struct of Vulkan, of this type and with 0 in all other members.
struct OfType {
    VkStructureType type;
    template <class Struct>
    operator Struct() const {
        Struct made{};
        made.sType = type;
        return made;
    }
};

// Throws Error naming the action and the VkResult unless result is VK_SUCCESS.
void vk_check(VkResult result, const char* action);
const char* name_of(VkResult result);

// Returns the object that a function of the device creates. Throws as vk_check.
template <class Handle, class Info>
Handle created(VkResult(VKAPI_PTR* create)(VkDevice, const Info*, const VkAllocationCallbacks*, Handle*),
               VkDevice device, const Info& info, const char* action) {
    Handle handle = VK_NULL_HANDLE;
    vk_check(create(device, &info, nullptr, &handle), action);
    return handle;
}

// Returns what a function of Vulkan lists, which tells how many there are if it has no place to list them.
template <class Item, class List>
std::vector<Item> listed(const List& list) {
    std::uint32_t count = 0;
    list(&count, nullptr);
    std::vector<Item> items(count);
    list(&count, items.data());
    items.resize(count);
    return items;
}

}  // namespace twinray
