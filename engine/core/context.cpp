// Forwards applications' calls to Context::State, and checks a device that an application created.
#include "engine/core/context.h"

#include <algorithm>

#include "engine/core/device_properties.h"
#include "engine/core/error.h"
#include "engine/core/platform.h"
#include "engine/core/requirement.h"
#include "engine/core/vulkan.h"

namespace twinray {
namespace {

void check_queue_family(const AdoptedDevice& adopted, const VulkanTable& vk) {
    const std::vector<VkQueueFamilyProperties> families = queue_families(vk, adopted.physical_device);
    if (adopted.queue_family >= families.size())
        fail("adopted device: queue family ", adopted.queue_family, " does not exist; the device has ",
             families.size());
    if (!(families[adopted.queue_family].queueFlags & VK_QUEUE_COMPUTE_BIT))
        fail("adopted device: queue family ", adopted.queue_family, " does not support compute");
}

void check_needs(const DeviceProperties& enabled) {
    std::string lacking;
    for (const Requirement& requirement : requirements_of(enabled))
        if (!requirement.is_met && requirement.of == Requirement::Of::everything)
            lacking += text("\n  twinray needs ", requirement.what, " because ", requirement.why);
    if (!lacking.empty())
        fail("adopted device '", enabled.name,
             "': not enabled (see DeviceRequirements::add_to and enabled_properties):", lacking);
}

// Detects, where possible, an application that states what the driver supports instead of what it enabled.
void check_claims(const DeviceProperties& told, const DeviceProperties& supported, const VulkanTable& vk,
                  VkDevice device) {
    if (const char* feature = feature_beyond(told, supported))
        fail("adopted device '", told.name, "': ", feature,
             " is listed as enabled, but the device does not support it");
    const auto check_function = [&](bool is_told, const void* function, const char* extension) {
        if (is_told && !function)
            fail("adopted device '", told.name, "': ", extension,
                 " is listed as enabled, but the VkDevice was created without it");
    };
    check_function(told.acceleration_structure, reinterpret_cast<const void*>(vk.vkCreateAccelerationStructureKHR),
                   VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME);
    check_function(told.ray_tracing_pipeline, reinterpret_cast<const void*>(vk.vkCreateRayTracingPipelinesKHR),
                   VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME);
    const platform::SharedMemory& memory = platform::shared_memory;
    check_function(told.external_memory,
                   reinterpret_cast<const void*>(vk.vkGetDeviceProcAddr(device, memory.get_handle)), memory.extension);
}

}  // namespace

DeviceProperties check_adoption(const AdoptedDevice& adopted, const VulkanTable& vk) {
    if (!vk.vkGetPhysicalDeviceFeatures2)
        fail("adopted device: its VkInstance was created for less than Vulkan 1.1; twinray needs 1.2");
    check_queue_family(adopted, vk);
    const DeviceProperties supported = query_device_properties(vk, adopted.physical_device);
    DeviceProperties properties = supported;
    properties.has_compute_queue = true;
    properties.api_version = std::min(supported.api_version, adopted.api_version);
    for (const FeatureBit& bit : feature_bits()) properties.*bit.fact = adopted.enabled.*bit.fact;
    properties.external_memory = adopted.enabled.external_memory;
    check_needs(properties);
    check_claims(properties, supported, vk, adopted.device);
    return properties;
}

Context::Context(const ContextDesc& desc) : state_(std::make_unique<State>(desc)) {}
Context::Context(const AdoptedDevice& adopted) : state_(std::make_unique<State>(adopted)) {}
Context::~Context() {
    if (!state_->is_of_this_process()) static_cast<void>(state_.release());
}
VkDevice Context::device() const { return state_->device(); }
VkPhysicalDevice Context::physical_device() const { return state_->physical_device(); }
std::uint32_t Context::queue_family() const { return state_->queue_family(); }
const DeviceProperties& Context::properties() const { return state_->properties(); }
std::uint64_t Context::allocated_bytes() const { return state_->allocator().live_bytes() - State::absent_bytes; }
std::uint64_t Context::absent() const { return state_->absent(); }
void Context::wait_before_next_submission(SyncPoint point, VkPipelineStageFlags stages) {
    state_->wait_before_next_submission(point, stages);
}
SyncPoint Context::last_submission() const { return state_->last_submission(); }
bool Context::is_reached(SyncPoint point) const { return state_->is_reached(point); }
void Context::wait(SyncPoint point) const { state_->wait(point); }
void Context::wait_for_gpu() { state_->wait_for_gpu(); }
void Context::announce(SyncPoint point) { state_->announce(point); }
std::vector<std::string> Context::validation_messages() const { return state_->validation_messages(); }

}  // namespace twinray
