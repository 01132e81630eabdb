#include "engine/core/requirement.h"

#include <algorithm>
#include <tuple>

#include "engine/core/error.h"

namespace twinray {
namespace {

constexpr std::uint32_t version_1_2 = (1u << 22) | (2u << 12);

// Capabilities, of the SPIR-V specification.
enum SpirvCapability : std::uint32_t {
    Shader = 1,
    Float64 = 10,
    Int64 = 11,
    ImageQuery = 50,
    RayQueryKHR = 4472,
    RayTraversalPrimitiveCullingKHR = 4478,
    RayTracingKHR = 4479,
    ShaderNonUniform = 5301,
    RuntimeDescriptorArray = 5302,
    SampledImageArrayNonUniformIndexing = 5307,
    PhysicalStorageBufferAddresses = 5347
};

struct Part {
    const char* name;
    const char* title;
    const char* who;      // begins a sentence
    const char* without;  // ends it where the device lacks something
};

// Indexed by Requirement::Of.
constexpr Part parts[] = {
    {"everything",
     "Everything. SwTlas below Level::refined, textures in buffers, animation, view factors, illumination, "
     "centroids, collisions of boxes and the path tracer need nothing more",
     "twinray needs ", ""},
    {"hardware", "HwTlas", "HwTlas needs ", ", SwTlas works without"},
    {"ray_queries", "Kernels that query HwTlas themselves (twinray/glsl/query.glsl, all hits of a ray)",
     "Kernels that query HwTlas need ", ", batches of rays work without"},
    {"ray_pipelines", "HwTlas on a device without ray queries", "HwTlas without ray queries needs ",
     ", SwTlas works without"},
    {"refinement", "Level::refined, and Level::certified of SwTlas", "Level::refined and above need ",
     ", Level::watertight works without"},
    {"points", "Closest points, distances and winding numbers (PointQuery)", "PointQuery needs ",
     ", all else works without"},
    {"contacts", "Contacts of triangles (NarrowPhase)", "NarrowPhase needs ", ", BroadPhase works without"},
    {"int64_kernels", "Kernels with 64-bit integers, of a host or chosen by KernelTuning",
     "Kernels with 64-bit integers need ", ", the others work without"},
    {"primitive_culling", "Rays that skip triangles or boxes, in `twinray verify --suite conformance`",
     "Rays that skip triangles or boxes need ", ", the other cases run without"},
    {"images", "Textures as images (TextureStore)", "Textures as images need ", ", textures in buffers work without"},
};
const Part& part_of(Requirement::Of part) { return parts[static_cast<std::size_t>(part)]; }

bool is_requested(const DeviceProperties& device, std::size_t index, const std::string& request) {
    if (request.empty()) return true;
    if (request.find_first_not_of("0123456789") == request.npos) return std::to_string(index) == request;
    return lowered(device.name).find(lowered(request)) != std::string::npos;
}

// Returns what it lacks of the parts up to one.
std::vector<std::string> missing(const DeviceProperties& device, Requirement::Of last) {
    std::vector<std::string> missing;
    for (const Requirement& requirement : requirements_of(device))
        if (!requirement.is_met && requirement.of <= last) missing.push_back(requirement.what);
    return missing;
}

// Larger is better.
auto rank(const DeviceProperties& device) {
    return std::tuple(missing_for_hardware(device).empty(), -static_cast<int>(device.kind));
}

}  // namespace

const char* name_of(Requirement::Of part) { return part_of(part).name; }
const char* title_of(Requirement::Of part) { return part_of(part).title; }

std::string Requirement::sentence() const {
    const Part& part = part_of(of);
    return text(part.who, what, " because ", why, is_met ? "; this device has it" : "; this device lacks it",
                is_met ? "" : part.without);
}

const char* never_required() {
    return "64-, 16- or 8-bit integers, 16-bit floats, subgroup operations, a known subgroup size, "
           "and Vulkan above 1.2";
}

std::vector<Requirement> requirements_of(const DeviceProperties& device) {
    using enum Requirement::Of;
    using Limits = KernelLimits;
    return {
        {"Vulkan 1.2", "its kernels and its timeline semaphore use it", everything, device.api_version >= version_1_2},
        {"a compute queue", "all its work runs in compute shaders", everything, device.has_compute_queue, {Shader}},
        {"timelineSemaphore", "it never waits for the GPU: a timeline shows what may be freed", everything,
         device.timeline_semaphore},
        {"bufferDeviceAddress",
         "its kernels reach all data by address, without descriptor sets",
         everything,
         device.buffer_device_address,
         {PhysicalStorageBufferAddresses}},
        {"scalarBlockLayout", "structs have the same bytes on the host and on the GPU", everything,
         device.scalar_block_layout},
        {text("groups of ", Limits::group_invocations,
              " invocations (maxComputeWorkGroupInvocations, maxComputeWorkGroupSize)"),
         "its builds distribute work to groups of that size; Vulkan guarantees 128", everything,
         device.group_invocations >= Limits::group_invocations},
        {text(Limits::shared_bytes, " bytes of shared memory (maxComputeSharedMemorySize)"),
         "its sort counts digits there and traversals keep their stacks there; Vulkan guarantees this", everything,
         device.shared_bytes >= Limits::shared_bytes},
        {text(Limits::push_constant_bytes, " bytes of push constants (maxPushConstantsSize)"),
         "kernels get their arguments in them; Vulkan guarantees this", everything,
         device.push_constant_bytes >= Limits::push_constant_bytes},
        {"VK_KHR_acceleration_structure", "the driver builds its structures", hardware, device.acceleration_structure},
        {"VK_KHR_ray_query or VK_KHR_ray_tracing_pipeline", "it traces with one of them", hardware,
         device.ray_query || device.ray_tracing_pipeline},
        {"VK_KHR_ray_query",
         "a compute kernel has no other way to the driver's structures",
         ray_queries,
         device.ray_query,
         {RayQueryKHR},
         {"SPV_KHR_ray_query"}},
        {"VK_KHR_ray_tracing_pipeline",
         "its batches then go through the stages of such a pipeline",
         ray_pipelines,
         device.ray_tracing_pipeline,
         {RayTracingKHR},
         {"SPV_KHR_ray_tracing"}},
        {"shaderFloat64", "they compute the final hit again in float64", refinement, device.shader_float64, {Float64}},
        {"shaderFloat64", "it computes all distances in float64", points, device.shader_float64, {Float64}},
        {"shaderFloat64", "it decides in float64 which triangles meet", contacts, device.shader_float64, {Float64}},
        {"shaderInt64",
         "they compute with such integers; twinray's own kernels also have variants without",
         int64_kernels,
         device.shader_int64,
         {Int64}},
        {"rayTraversalPrimitiveCulling",
         "the ray flags for this need it",
         primitive_culling,
         device.primitive_culling,
         {RayTraversalPrimitiveCullingKHR}},
        {"descriptor indexing (runtimeDescriptorArray, shaderSampledImageArrayNonUniformIndexing, "
         "descriptorBindingVariableDescriptorCount and descriptorBindingSampledImageUpdateAfterBind)",
         "kernels reach all of them through one array",
         images,
         device.has_image_arrays(),
         {ImageQuery, ShaderNonUniform, RuntimeDescriptorArray, SampledImageArrayNonUniformIndexing}},
    };
}

std::vector<std::string> missing_for_software(const DeviceProperties& device) {
    return missing(device, Requirement::Of::everything);
}
std::vector<std::string> missing_for_hardware(const DeviceProperties& device) {
    return missing(device, Requirement::Of::hardware);
}

DeviceChoice choose_device(std::span<const DeviceProperties> devices, const std::string& request) {
    DeviceChoice choice;
    std::vector<std::string> reasons(devices.size());
    for (std::size_t i = 0; i < devices.size(); ++i) {
        const std::vector<std::string> missing = missing_for_software(devices[i]);
        if (!is_requested(devices[i], i, request))
            reasons[i] = text("does not match the request '", request, "'");
        else if (!missing.empty())
            reasons[i] = "lacks " + joined(missing);
        else if (choice.index < 0 || rank(devices[i]) > rank(devices[static_cast<std::size_t>(choice.index)]))
            choice.index = static_cast<int>(i);
    }
    for (std::size_t i = 0; i < devices.size(); ++i) {
        if (static_cast<int>(i) == choice.index) continue;
        if (reasons[i].empty())
            reasons[i] = "ranks behind '" + devices[static_cast<std::size_t>(choice.index)].name + "'";
        choice.rejections.push_back(text(i, " '", devices[i].name, "': ", reasons[i]));
    }
    return choice;
}

const char* name_of(DeviceKind kind) {
    constexpr const char* names[] = {"discrete GPU", "integrated GPU", "virtual GPU", "CPU", "other"};
    return names[static_cast<std::size_t>(kind)];
}

}  // namespace twinray
