#include <mutex>
#include <string>

#include <twinray/twinray.h>
#include <vk_mem_alloc.h>
#include <twinray/vma_adapter.h>

void log(const std::string& sentence);

// Names of a renderer in which twinray is embedded.
void lines_of_a_page(VkInstance instance, VkPhysicalDevice physical_device, VkDevice device,
                     VkDeviceCreateInfo device_create_info, PFN_vkGetInstanceProcAddr get_instance_proc_addr,
                     std::mutex& mutex, VmaAllocator your_vma_allocator, twinray::Context& context,
                     twinray::AbstractAccel& accel, VkCommandBuffer command_buffer, VkSemaphore your_timeline,
                     uint64_t value, twinray::Ref<twinray::Ray> rays, twinray::Ref<twinray::Hit> hits, uint64_t count) {
    using namespace twinray;
    { BLOCK }
}
