#include "engine/core/context.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <vulkan/vulkan_core.h>

#include "engine/core/device_properties.h"
#include "engine/core/error.h"
#include "engine/core/platform.h"
#include "engine/core/vulkan.h"
#include "twinray/glsl/cpp.h"

namespace twinray {
namespace {

VkInstance new_instance(const VulkanTable& vk, const std::string& name, bool validation) {
    VkApplicationInfo application = OfType{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.pApplicationName = name.c_str();
    application.pEngineName = "twinray";
    application.apiVersion = VK_API_VERSION_1_3;  // device-level 1.2 is enough; the validation layer knows 1.3

    const VkValidationFeatureEnableEXT synchronisation = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkValidationFeaturesEXT validation_features = OfType{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
    validation_features.enabledValidationFeatureCount = 1;
    validation_features.pEnabledValidationFeatures = &synchronisation;

    const char* layer = "VK_LAYER_KHRONOS_validation";
    const char* extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
    VkInstanceCreateInfo info = OfType{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pApplicationInfo = &application;
    if (validation) {
        info.pNext = &validation_features;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &layer;
        info.enabledExtensionCount = 2;
        info.ppEnabledExtensionNames = extensions;
    }
    VkInstance instance = VK_NULL_HANDLE;
    vk_check(vk.vkCreateInstance(&info, nullptr, &instance),
             validation ? "create a Vulkan instance with VK_LAYER_KHRONOS_validation" : "create a Vulkan instance");
    return instance;
}

std::vector<DeviceProperties> facts_of(const VulkanTable& vk, const std::vector<VkPhysicalDevice>& devices) {
    std::vector<DeviceProperties> properties;
    for (VkPhysicalDevice device : devices) properties.push_back(query_device_properties(vk, device));
    return properties;
}

std::string no_device_message(const DeviceChoice& choice) {
    std::string message = "no usable Vulkan device";
    for (const std::string& reason : choice.rejections) message += "\n  device " + reason;
    if (choice.rejections.empty()) message += ": the loader found none (Debian: apt-get install mesa-vulkan-drivers)";
    return message;
}

std::optional<TuningRow> asked_tuning() {
    const char* name = std::getenv("TWINRAY_TUNING");
    return parse_tuning_row(name ? name : "");
}

}  // namespace

void disable_features(ContextDesc& desc, const std::string& list) {
    std::istringstream names(list);
    for (std::string name; std::getline(names, name, ',');) {
        if (name == "ray_query")
            desc.use_ray_query = false;
        else if (name == "ray_tracing_pipeline")
            desc.use_ray_tracing_pipeline = false;
        else
            fail("disabled features: '", name, "' is not ray_query or ray_tracing_pipeline");
    }
}

Context::State::State(const ContextDesc& desc)
    : table_(std::make_unique<VulkanTable>()),
      vk_(*table_),
      log_(desc.log),
      watch_(desc.watch_kernels),
      process_(platform::process_id()),
      most_wait_seconds_(desc.most_wait_seconds) {
    vk_.load_global(desc.get_instance_proc_addr);
    try {
        create_instance(desc);
        create_device(desc);
        create_own_objects(watch_ ? memoryless_allocator() : AllocatorHooks{}, desc.pipeline_folder);
    } catch (...) {
        destroy_everything();
        throw;
    }
}

Context::State::State(const AdoptedDevice& adopted)
    : table_(std::make_unique<VulkanTable>()),
      vk_(*table_),
      log_(adopted.log),
      process_(platform::process_id()),
      owns_device_(false),
      instance_(adopted.instance),
      physical_device_(adopted.physical_device),
      device_(adopted.device),
      queue_(adopted.queue),
      queue_family_(adopted.queue_family),
      api_version_(adopted.api_version),
      lock_queue_(adopted.lock_queue),
      unlock_queue_(adopted.unlock_queue),
      pipeline_cache_(adopted.pipeline_cache) {
    if (!adopted.instance || !adopted.physical_device || !adopted.device || !adopted.queue ||
        !adopted.get_instance_proc_addr)
        fail("adopted device: instance, physical_device, device, queue and get_instance_proc_addr must all be set");
    vk_.load_global(adopted.get_instance_proc_addr);
    vk_.load_instance(instance_);
    vk_.load_device(device_);
    properties_ = check_adoption(adopted, vk_);
    set_tuning(asked_tuning(), adopted.most_submission_seconds);
    try {
        create_own_objects(adopted.allocator, {});
    } catch (...) {
        destroy_everything();
        throw;
    }
}

Context::State::~State() {
    finish();
    keep_pipelines();
    if (!is_hung_ || reached(timeline_) >= submitted_) {
        destroy_everything();
        return;
    }
    // Destroying resources that a hung device still uses would wait for it, or take its memory away: they are left.
    static_cast<void>(allocator_.release());
    static_cast<void>(new std::deque<Retired>(std::move(retired_)));
}

void Context::State::create_instance(const ContextDesc& desc) {
    instance_ = new_instance(vk_, desc.name, desc.validation);
    vk_.load_instance(instance_);
    if (!desc.validation) return;
    VkDebugUtilsMessengerCreateInfoEXT info = OfType{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    info.pfnUserCallback = on_message;
    info.pUserData = this;
    vk_check(vk_.vkCreateDebugUtilsMessengerEXT(instance_, &info, nullptr, &messenger_), "create a debug messenger");
}

void Context::State::create_device(const ContextDesc& desc) {
    const std::vector<VkPhysicalDevice> devices = physical_devices(vk_, instance_);
    const std::vector<DeviceProperties> properties = facts_of(vk_, devices);
    const DeviceChoice choice = choose_device(properties, desc.device);
    if (choice.index < 0) fail(no_device_message(choice));
    physical_device_ = devices[static_cast<std::size_t>(choice.index)];
    properties_ = properties[static_cast<std::size_t>(choice.index)];
    properties_.ray_query &= desc.use_ray_query;
    properties_.ray_tracing_pipeline &= desc.use_ray_tracing_pipeline;
    set_tuning(desc.tuning ? desc.tuning : asked_tuning(), desc.most_submission_seconds);
    queue_family_ = static_cast<std::uint32_t>(compute_queue_family(vk_, physical_device_));
    api_version_ = std::min(properties_.api_version, std::uint32_t{VK_API_VERSION_1_3});

    const DeviceRequirements requirements(properties_);
    const float priority = 1;
    VkDeviceQueueCreateInfo queue = OfType{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueFamilyIndex = queue_family_;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo info = OfType{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
    info.pNext = requirements.features();
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    std::vector<const char*> extensions = requirements.extensions();
    // A watched driver also reports on pipelines, if it can.
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR statistics =
        OfType{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR};
    constexpr std::string_view of_statistics = VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME;
    const auto is_that = [&](const VkExtensionProperties& extension) {
        return extension.extensionName == of_statistics;
    };
    if (watch_ && std::ranges::any_of(device_extensions(vk_, physical_device_), is_that)) {
        statistics.pipelineExecutableInfo = VK_TRUE;
        statistics.pNext = const_cast<void*>(info.pNext);
        info.pNext = &statistics;
        extensions.push_back(of_statistics.data());
    }
    info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    vk_check(vk_.vkCreateDevice(physical_device_, &info, nullptr, &device_), "create a Vulkan device");
    state_features(info, properties_);
    vk_.load_device(device_);
    vk_.vkGetDeviceQueue(device_, queue_family_, 0, &queue_);
    if (watch_) run_nothing(vk_);
}

void Context::State::set_tuning(std::optional<TuningRow> row, std::optional<double> most_submission_seconds) {
    tuning_ = tuning_for(properties_, row);
    if (most_submission_seconds) tuning_.most_submission_seconds = std::max(*most_submission_seconds, 0.0);
}

void Context::State::create_own_objects(const AllocatorHooks& allocator, const std::filesystem::path& pipeline_folder) {
    VkPhysicalDeviceProperties2 properties = OfType{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    vk_.vkGetPhysicalDeviceProperties2(physical_device_, &properties);
    const std::vector<VkQueueFamilyProperties> families = queue_families(vk_, physical_device_);
    if (queue_family_ < families.size() && families[queue_family_].timestampValidBits > 0)
        timestamp_period_ns_ = properties.properties.limits.timestampPeriod;
    const bool has_hooks = allocator.allocate || allocator.free;
    allocator_ = has_hooks ? std::make_unique<Allocator>(allocator)
                           : std::make_unique<Allocator>(vk_, instance_, physical_device_, device_, api_version_,
                                                         tuning_.memory_block_bytes);

    timeline_ = new_timeline("twinray timeline");
    create_absent();
    if (!pipeline_cache_) create_pipeline_cache(PipelineStore(pipeline_folder, properties.properties));
}

// Each pair of words is the address again, so that absent data has only absent parts.
void Context::State::create_absent() {
    absent_memory_ = allocator_->allocate(
        {"absent", absent_bytes, VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
         Memory::upload, 16});
    VkBufferDeviceAddressInfo address = OfType{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO};
    address.buffer = absent_memory_.buffer;
    absent_ = absent_near(vk_.vkGetBufferDeviceAddress(device_, &address));
    auto* const bytes = static_cast<std::byte*>(absent_memory_.mapped);
    for (std::uint64_t at = 1; at + sizeof(absent_) <= absent_bytes; at += sizeof(absent_))
        std::memcpy(bytes + at, &absent_, sizeof(absent_));
}

void Context::State::create_pipeline_cache(const PipelineStore& store) {
    const Bytes kept = store.load([&](std::string_view sentence) { warn(sentence); });
    VkPipelineCacheCreateInfo cache = OfType{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    cache.initialDataSize = kept.size();
    cache.pInitialData = kept.data();
    pipeline_cache_ = created(vk_.vkCreatePipelineCache, device_, cache, "create the pipeline cache");
    owns_pipeline_cache_ = true;
    pipeline_store_ = store;
    kept_pipeline_bytes_ = kept.size();
}

// Caches only grow: an equal size means equal contents.
void Context::State::keep_pipelines() noexcept {
    std::size_t size = 0;
    if (pipeline_store_.file().empty() || !owns_pipeline_cache_ || is_lost_) return;
    if (vk_.vkGetPipelineCacheData(device_, pipeline_cache_, &size, nullptr) != VK_SUCCESS) return;
    // From Mesa 26.2 on, lavapipe's data are shorter than the header with which they must begin.
    if (size == kept_pipeline_bytes_ || size < sizeof(VkPipelineCacheHeaderVersionOne)) return;
    try {
        std::vector<std::byte> data(size);
        vk_check(vk_.vkGetPipelineCacheData(device_, pipeline_cache_, &size, data.data()), "read the pipeline cache");
        pipeline_store_.save(std::span(data).first(size), [&](std::string_view sentence) { warn(sentence); });
    } catch (const std::exception& failure) {
        warn(failure.what());
    }
}

void Context::State::destroy_everything() noexcept {
    for (Retired& retired : retired_) retired.destroy();
    retired_.clear();
    pipelines_.clear();
    if (image_array_layout_) vk_.vkDestroyDescriptorSetLayout(device_, image_array_layout_, nullptr);
    if (owns_pipeline_cache_) vk_.vkDestroyPipelineCache(device_, pipeline_cache_, nullptr);
    for (const VkSemaphore timeline : {timeline_, promised_timeline_})
        if (timeline) vk_.vkDestroySemaphore(device_, timeline, nullptr);
    if (absent_memory_.buffer) allocator_->free(absent_memory_, absent_bytes);
    allocator_.reset();
    if (!owns_device_) return;
    if (device_) vk_.vkDestroyDevice(device_, nullptr);
    if (messenger_) vk_.vkDestroyDebugUtilsMessengerEXT(instance_, messenger_, nullptr);
    if (instance_) vk_.vkDestroyInstance(instance_, nullptr);
}

VkPipelineStageFlags Context::State::stages() const {
    VkPipelineStageFlags stages =
        VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    if (properties_.acceleration_structure) stages |= VK_PIPELINE_STAGE_ACCELERATION_STRUCTURE_BUILD_BIT_KHR;
    if (properties_.ray_tracing_pipeline) stages |= VK_PIPELINE_STAGE_RAY_TRACING_SHADER_BIT_KHR;
    return stages;
}

void Context::State::warn(std::string_view message) const {
    if (log_)
        log_(message);
    else
        std::fprintf(stderr, "twinray: %.*s\n", static_cast<int>(message.size()), message.data());
}

std::vector<std::string> Context::State::validation_messages() const {
    const std::lock_guard lock(messages_mutex_);
    return messages_;
}

void Context::State::set_name(VkObjectType type, std::uint64_t handle, const std::string& name) const {
    if (!vk_.vkSetDebugUtilsObjectNameEXT) return;
    VkDebugUtilsObjectNameInfoEXT info = OfType{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
    info.objectType = type;
    info.objectHandle = handle;
    info.pObjectName = name.c_str();
    vk_.vkSetDebugUtilsObjectNameEXT(device_, &info);
}

void Context::State::add_validation_message(const std::string& message) {
    {
        const std::lock_guard lock(messages_mutex_);
        messages_.push_back(message);
    }
    warn(message);
}

VkBool32 VKAPI_PTR Context::State::on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                              const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    static_cast<State*>(user)->add_validation_message(data->pMessage);
    return VK_FALSE;
}

std::vector<DeviceProperties> list_devices(PFN_vkGetInstanceProcAddr get_instance_proc_addr) {
    VulkanTable vk;
    vk.load_global(get_instance_proc_addr);
    const VkInstance instance = new_instance(vk, "twinray devices", false);
    vk.load_instance(instance);
    const auto destroy = [&vk](VkInstance made) { vk.vkDestroyInstance(made, nullptr); };
    const std::unique_ptr<VkInstance_T, decltype(destroy)> owner(instance, destroy);
    return facts_of(vk, physical_devices(vk, instance));
}

}  // namespace twinray
