#include <mutex>

#include <twinray/twinray.h>

// Names of a host with a Vulkan device of its own.
void lines_of_a_page(VkInstance instance, VkPhysicalDevice physical_device, VkDevice device, VkQueue queue,
                     uint32_t queue_family, VkDeviceCreateInfo device_create_info, VkPipelineCache pipeline_cache,
                     PFN_vkGetInstanceProcAddr get_instance_proc_addr, std::mutex& mutex) {
    using namespace twinray;
    BLOCK
}
