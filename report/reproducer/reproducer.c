// SPDX-License-Identifier: MIT
// One ray that a Vulkan driver answers wrongly, or did. Plain C99 and Vulkan 1.2, made by twinray.
//
//     cc -std=c99 reproducer.c -lvulkan -o reproducer && ./reproducer [DEVICE [query|pipeline]]
//
// DEVICE is a device's number in the list of vkEnumeratePhysicalDevices; the default is the first that can trace. The ray
// is traced by a ray query in a compute shader or by a ray tracing pipeline, as it was when the fault was found unless
// the second argument says otherwise. Prints the answer and RIGHT (exit status 0) or WRONG (1), or exits with 2 if it
// cannot run here.
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <vulkan/vulkan.h>

// Each instance is its own bottom level over some of the triangles. `rows` are its transform, object to world.
typedef struct {
    uint32_t first_triangle, triangle_count;
    VkTransformMatrixKHR transform;
} Instance;

// A hit of this triangle is right if t, u and v lie between these bounds, which allow for all rounding in float32.
typedef struct {
    uint32_t instance, triangle;
    double t[2], u[2], v[2];
} RightHit;

// BEGIN OF DATA: an example, in place of which twinray writes a fault
static const char found_on[] = "no driver: this is a template";
static const char expected[] = "triangle 0 of instance 0 at t = 1";
static const int by_pipeline = 0;
static const float vertices[][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
static const uint32_t triangles[][3] = {{0, 1, 2}};
static const Instance instances[] = {{0, 1, {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}}};
static const float ray[8] = {0.25f, 0.25f, 1, /* t_min */ 0, 0, 0, -1, /* t_max */ INFINITY};
static const int is_miss_right = 0;
static const RightHit right_hits[] = {{0, 0, {0.9999, 1.0001}, {0.2499, 0.2501}, {0.2499, 0.2501}}};
static const uint32_t right_hit_count = 1;
static const uint32_t query_spirv[] = {0}, raygen_spirv[] = {0}, hit_spirv[] = {0}, miss_spirv[] = {0};
// END OF DATA

enum { instance_count = sizeof instances / sizeof *instances };

// The output of the shaders.
typedef struct {
    uint32_t is_hit, instance, triangle;
    float t, u, v;
} Answer;

static void check(int is_fine, const char* what) {
    if (is_fine) return;
    fprintf(stderr, "reproducer: cannot run here: %s\n", what);
    exit(2);
}
#define CHECK(call) check((call) == VK_SUCCESS, #call)

// ---- Device ----
static VkPhysicalDevice physical;
static VkDevice device;
static VkQueue queue;
static VkCommandPool pool;
static VkPhysicalDeviceRayTracingPipelinePropertiesKHR pipeline_limits;
static VkPhysicalDeviceAccelerationStructurePropertiesKHR structure_limits;

#define FUNCTIONS(F)                              \
    F(vkCreateAccelerationStructureKHR)           \
    F(vkGetAccelerationStructureBuildSizesKHR)    \
    F(vkGetAccelerationStructureDeviceAddressKHR) \
    F(vkCmdBuildAccelerationStructuresKHR)        \
    F(vkCreateRayTracingPipelinesKHR)             \
    F(vkGetRayTracingShaderGroupHandlesKHR)       \
    F(vkCmdTraceRaysKHR)
#define DECLARE(name) static PFN_##name p_##name;
#define LOAD(name) p_##name = (PFN_##name)vkGetDeviceProcAddr(device, #name);
FUNCTIONS(DECLARE)

static const char* const needed_by_query[] = {"VK_KHR_deferred_host_operations", "VK_KHR_acceleration_structure",
                                              "VK_KHR_ray_query"};
static const char* const needed_by_pipeline[] = {"VK_KHR_deferred_host_operations", "VK_KHR_acceleration_structure",
                                                 "VK_KHR_ray_tracing_pipeline"};

static int has_extensions(VkPhysicalDevice candidate, const char* const* needed) {
    uint32_t count = 0, found = 0;
    CHECK(vkEnumerateDeviceExtensionProperties(candidate, NULL, &count, NULL));
    VkExtensionProperties* all = malloc(count * sizeof *all);
    CHECK(vkEnumerateDeviceExtensionProperties(candidate, NULL, &count, all));
    for (uint32_t i = 0; i < count; ++i)
        for (int k = 0; k < 3; ++k) found += strcmp(all[i].extensionName, needed[k]) == 0;
    free(all);
    return found == 3;
}

static void choose_device(VkInstance instance, long number, const char* const* needed) {
    VkPhysicalDevice all[64];
    uint32_t count = 64;
    check(vkEnumeratePhysicalDevices(instance, &count, all) >= 0, "there is no device");
    check(number < (long)count, "there is no device of that number");
    for (uint32_t i = 0; i < count && !physical; ++i)
        if ((number < 0 || (long)i == number) && has_extensions(all[i], needed)) physical = all[i];
    check(physical != NULL, number < 0 ? "no device can trace this way" : "the device cannot trace this way");
}

static void create_device(long number, int is_pipeline) {
    const char* const* needed = is_pipeline ? needed_by_pipeline : needed_by_query;
    VkApplicationInfo app = {VK_STRUCTURE_TYPE_APPLICATION_INFO, NULL, "reproducer", 0, NULL, 0, VK_API_VERSION_1_2};
    VkInstanceCreateInfo instance_info = {VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, NULL, 0, &app, 0, NULL, 0, NULL};
    VkInstance instance;
    CHECK(vkCreateInstance(&instance_info, NULL, &instance));
    choose_device(instance, number, needed);

    pipeline_limits.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_PROPERTIES_KHR;
    structure_limits.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR;
    if (is_pipeline) structure_limits.pNext = &pipeline_limits;
    VkPhysicalDeviceDriverProperties driver = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES,
                                               .pNext = &structure_limits};
    VkPhysicalDeviceProperties2 properties = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                              .pNext = &driver};
    vkGetPhysicalDeviceProperties2(physical, &properties);
    const uint32_t api = properties.properties.apiVersion;
    printf("device    %s, %s %s, Vulkan %u.%u.%u, by a %s\n", properties.properties.deviceName, driver.driverName,
           driver.driverInfo, VK_API_VERSION_MAJOR(api), VK_API_VERSION_MINOR(api), VK_API_VERSION_PATCH(api),
           is_pipeline ? "ray tracing pipeline" : "ray query");

    VkPhysicalDeviceRayQueryFeaturesKHR query = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR, NULL,
                                                 VK_TRUE};
    VkPhysicalDeviceRayTracingPipelineFeaturesKHR pipeline = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR, .rayTracingPipeline = VK_TRUE};
    VkPhysicalDeviceAccelerationStructureFeaturesKHR structures = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR,
        .pNext = is_pipeline ? (void*)&pipeline : (void*)&query,
        .accelerationStructure = VK_TRUE};
    VkPhysicalDeviceVulkan12Features features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
                                                 .pNext = &structures,
                                                 .bufferDeviceAddress = VK_TRUE};
    VkQueueFamilyProperties families[64];
    uint32_t family_count = 64, family = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &family_count, families);
    while (family < family_count && !(families[family].queueFlags & VK_QUEUE_COMPUTE_BIT)) ++family;
    check(family < family_count, "the device has no queue for compute");
    const float priority = 1;
    VkDeviceQueueCreateInfo queue_info = {VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, NULL, 0, family, 1, &priority};
    VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                               .pNext = &features,
                               .queueCreateInfoCount = 1,
                               .pQueueCreateInfos = &queue_info,
                               .enabledExtensionCount = 3,
                               .ppEnabledExtensionNames = needed};
    CHECK(vkCreateDevice(physical, &info, NULL, &device));
    vkGetDeviceQueue(device, family, 0, &queue);
    VkCommandPoolCreateInfo pool_info = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, NULL, 0, family};
    CHECK(vkCreateCommandPool(device, &pool_info, NULL, &pool));
    FUNCTIONS(LOAD)
}

// ---- Memory and commands; the end of the process frees all ----
typedef struct {
    VkBuffer handle;
    VkDeviceAddress address;
    void* mapped;
} Buffer;

// Makes a buffer in memory that the host can write; its address is a multiple of `alignment`, a power of two.
static Buffer make_buffer(VkDeviceSize bytes, VkBufferUsageFlags usage, VkDeviceSize alignment) {
    Buffer buffer;
    VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                               .size = bytes + alignment,
                               .usage = usage | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT};
    CHECK(vkCreateBuffer(device, &info, NULL, &buffer.handle));
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device, buffer.handle, &needs);
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);
    const VkMemoryPropertyFlags wanted = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    uint32_t type = 0;
    while (type < memory.memoryTypeCount &&
           (!(needs.memoryTypeBits >> type & 1) || (memory.memoryTypes[type].propertyFlags & wanted) != wanted))
        ++type;
    check(type < memory.memoryTypeCount, "no memory that the host can write suits a buffer");
    VkMemoryAllocateFlagsInfo flags = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO, NULL,
                                       VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT, 0};
    VkMemoryAllocateInfo allocation = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, &flags, needs.size, type};
    VkDeviceMemory block;
    CHECK(vkAllocateMemory(device, &allocation, NULL, &block));
    CHECK(vkBindBufferMemory(device, buffer.handle, block, 0));
    CHECK(vkMapMemory(device, block, 0, VK_WHOLE_SIZE, 0, &buffer.mapped));
    VkBufferDeviceAddressInfo address = {VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO, NULL, buffer.handle};
    buffer.address = vkGetBufferDeviceAddress(device, &address);
    const VkDeviceSize offset = (alignment - buffer.address % alignment) % alignment;
    buffer.address += offset;
    buffer.mapped = (char*)buffer.mapped + offset;
    return buffer;
}

static Buffer upload(const void* data, VkDeviceSize bytes) {
    Buffer buffer = make_buffer(bytes, VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR, 16);
    memcpy(buffer.mapped, data, bytes);
    return buffer;
}

static VkCommandBuffer begin(void) {
    VkCommandBufferAllocateInfo info = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, NULL, pool,
                                        VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
    VkCommandBuffer commands;
    CHECK(vkAllocateCommandBuffers(device, &info, &commands));
    VkCommandBufferBeginInfo begin_info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    CHECK(vkBeginCommandBuffer(commands, &begin_info));
    return commands;
}

static void submit_and_wait(VkCommandBuffer commands) {
    VkMemoryBarrier barrier = {VK_STRUCTURE_TYPE_MEMORY_BARRIER, NULL, VK_ACCESS_MEMORY_WRITE_BIT,
                               VK_ACCESS_HOST_READ_BIT | VK_ACCESS_MEMORY_READ_BIT};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                         VK_PIPELINE_STAGE_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0, NULL, 0,
                         NULL);
    CHECK(vkEndCommandBuffer(commands));
    VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &commands};
    CHECK(vkQueueSubmit(queue, 1, &info, VK_NULL_HANDLE));
    CHECK(vkQueueWaitIdle(queue));
}

// ---- Acceleration structures ----
// Returns the address of the new structure.
static uint64_t build(VkAccelerationStructureTypeKHR type, const VkAccelerationStructureGeometryKHR* geometry,
                      uint32_t count) {
    VkAccelerationStructureBuildGeometryInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR,
        .type = type,
        .flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR,
        .mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR,
        .geometryCount = 1,
        .pGeometries = geometry};
    VkAccelerationStructureBuildSizesInfoKHR sizes = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR};
    p_vkGetAccelerationStructureBuildSizesKHR(device, VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &info, &count,
                                              &sizes);
    Buffer storage =
        make_buffer(sizes.accelerationStructureSize, VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR, 1);
    Buffer scratch = make_buffer(sizes.buildScratchSize, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                 structure_limits.minAccelerationStructureScratchOffsetAlignment);
    VkAccelerationStructureCreateInfoKHR create = {.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR,
                                                   .buffer = storage.handle,
                                                   .size = sizes.accelerationStructureSize,
                                                   .type = type};
    CHECK(p_vkCreateAccelerationStructureKHR(device, &create, NULL, &info.dstAccelerationStructure));
    info.scratchData.deviceAddress = scratch.address;
    const VkAccelerationStructureBuildRangeInfoKHR range = {count, 0, 0, 0}, *ranges = &range;
    VkCommandBuffer commands = begin();
    p_vkCmdBuildAccelerationStructuresKHR(commands, 1, &info, &ranges);
    submit_and_wait(commands);
    VkAccelerationStructureDeviceAddressInfoKHR built = {
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR, NULL, info.dstAccelerationStructure};
    return p_vkGetAccelerationStructureDeviceAddressKHR(device, &built);
}

static uint64_t build_bottom_level(const Instance* instance, Buffer positions, Buffer indices) {
    VkAccelerationStructureGeometryKHR geometry = {.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR,
                                                   .geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR,
                                                   .flags = VK_GEOMETRY_OPAQUE_BIT_KHR};
    VkAccelerationStructureGeometryTrianglesDataKHR* data = &geometry.geometry.triangles;
    data->sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR;
    data->vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
    data->vertexData.deviceAddress = positions.address;
    data->vertexStride = sizeof *vertices;
    data->maxVertex = sizeof vertices / sizeof *vertices - 1;
    data->indexType = VK_INDEX_TYPE_UINT32;
    data->indexData.deviceAddress = indices.address + instance->first_triangle * sizeof *triangles;
    return build(VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, &geometry, instance->triangle_count);
}

static uint64_t build_scene(void) {
    const Buffer positions = upload(vertices, sizeof vertices), indices = upload(triangles, sizeof triangles);
    VkAccelerationStructureInstanceKHR records[instance_count];
    memset(records, 0, sizeof records);
    for (int i = 0; i < instance_count; ++i) {
        records[i].transform = instances[i].transform;
        records[i].mask = 0xff;
        records[i].accelerationStructureReference = build_bottom_level(&instances[i], positions, indices);
    }
    VkAccelerationStructureGeometryKHR geometry = {.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR,
                                                   .geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR,
                                                   .flags = VK_GEOMETRY_OPAQUE_BIT_KHR};
    geometry.geometry.instances.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR;
    geometry.geometry.instances.data.deviceAddress = upload(records, sizeof records).address;
    return build(VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, &geometry, instance_count);
}

// ---- The ray ----
typedef struct {
    float ray[8];
    uint64_t scene, answer;  // addresses
} Push;

static VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits kind, const uint32_t* spirv, size_t bytes) {
    VkShaderModuleCreateInfo info = {VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, NULL, 0, bytes, spirv};
    VkPipelineShaderStageCreateInfo made = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, .stage = kind, .pName = "main"};
    CHECK(vkCreateShaderModule(device, &info, NULL, &made.module));
    return made;
}

static void record_query(VkCommandBuffer commands, VkPipelineLayout layout) {
    VkComputePipelineCreateInfo info = {.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO, .layout = layout};
    info.stage = stage(VK_SHADER_STAGE_COMPUTE_BIT, query_spirv, sizeof query_spirv);
    VkPipeline pipeline;
    CHECK(vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, NULL, &pipeline));
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    vkCmdDispatch(commands, 1, 1, 1);
}

static void record_pipeline(VkCommandBuffer commands, VkPipelineLayout layout) {
    const VkPipelineShaderStageCreateInfo stages[3] = {
        stage(VK_SHADER_STAGE_RAYGEN_BIT_KHR, raygen_spirv, sizeof raygen_spirv),
        stage(VK_SHADER_STAGE_MISS_BIT_KHR, miss_spirv, sizeof miss_spirv),
        stage(VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR, hit_spirv, sizeof hit_spirv)};
    VkRayTracingShaderGroupCreateInfoKHR groups[3];
    for (uint32_t i = 0; i < 3; ++i)
        groups[i] =
            (VkRayTracingShaderGroupCreateInfoKHR){VK_STRUCTURE_TYPE_RAY_TRACING_SHADER_GROUP_CREATE_INFO_KHR,
                                                   NULL,
                                                   i < 2 ? VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR
                                                         : VK_RAY_TRACING_SHADER_GROUP_TYPE_TRIANGLES_HIT_GROUP_KHR,
                                                   i < 2 ? i : VK_SHADER_UNUSED_KHR,
                                                   i < 2 ? VK_SHADER_UNUSED_KHR : i,
                                                   VK_SHADER_UNUSED_KHR,
                                                   VK_SHADER_UNUSED_KHR,
                                                   NULL};
    VkRayTracingPipelineCreateInfoKHR info = {.sType = VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CREATE_INFO_KHR,
                                              .stageCount = 3,
                                              .pStages = stages,
                                              .groupCount = 3,
                                              .pGroups = groups,
                                              .maxPipelineRayRecursionDepth = 1,
                                              .layout = layout};
    VkPipeline pipeline;
    CHECK(p_vkCreateRayTracingPipelinesKHR(device, VK_NULL_HANDLE, VK_NULL_HANDLE, 1, &info, NULL, &pipeline));
    // The shader binding table: one record for each group, where regions may begin.
    const uint32_t size = pipeline_limits.shaderGroupHandleSize, alignment = pipeline_limits.shaderGroupBaseAlignment;
    const VkDeviceSize stride = (size + alignment - 1) / alignment * alignment;
    Buffer table = make_buffer(3 * stride, VK_BUFFER_USAGE_SHADER_BINDING_TABLE_BIT_KHR, alignment);
    VkStridedDeviceAddressRegionKHR regions[3], none = {0, 0, 0};
    for (uint32_t i = 0; i < 3; ++i) {
        CHECK(p_vkGetRayTracingShaderGroupHandlesKHR(device, pipeline, i, 1, size, (char*)table.mapped + i * stride));
        regions[i] = (VkStridedDeviceAddressRegionKHR){table.address + i * stride, stride, stride};
    }
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, pipeline);
    p_vkCmdTraceRaysKHR(commands, &regions[0], &regions[1], &regions[2], &none, 1, 1, 1);
}

static Answer trace(int is_pipeline) {
    const VkShaderStageFlags stages = is_pipeline ? VK_SHADER_STAGE_RAYGEN_BIT_KHR : VK_SHADER_STAGE_COMPUTE_BIT;
    VkPushConstantRange range = {stages, 0, sizeof(Push)};
    VkPipelineLayoutCreateInfo info = {VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, NULL, 0, 0, NULL, 1, &range};
    VkPipelineLayout layout;
    CHECK(vkCreatePipelineLayout(device, &info, NULL, &layout));
    Buffer answer = make_buffer(sizeof(Answer), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, 16);
    Push push = {.scene = build_scene(), .answer = answer.address};
    // origin, t_min, direction, t_max
    memcpy(push.ray, ray, sizeof ray);
    VkCommandBuffer commands = begin();
    vkCmdPushConstants(commands, layout, stages, 0, sizeof push, &push);
    if (is_pipeline)
        record_pipeline(commands, layout);
    else
        record_query(commands, layout);
    submit_and_wait(commands);
    return *(const Answer*)answer.mapped;
}

// ---- The verdict ----
static int lies_in(const double bounds[2], double value) { return bounds[0] <= value && value <= bounds[1]; }

static int is_right(const Answer* answer) {
    if (!answer->is_hit) return is_miss_right;
    for (uint32_t i = 0; i < right_hit_count; ++i) {
        const RightHit* right = &right_hits[i];
        if (right->instance == answer->instance && right->triangle == answer->triangle &&
            lies_in(right->t, answer->t) && lies_in(right->u, answer->u) && lies_in(right->v, answer->v))
            return 1;
    }
    return 0;
}

int main(int argc, char** argv) {
    const int is_pipeline = argc > 2 ? strcmp(argv[2], "pipeline") == 0 : by_pipeline;
    create_device(argc > 1 ? strtol(argv[1], NULL, 10) : -1, is_pipeline);
    const Answer answer = trace(is_pipeline);
    printf("found on  %s\nexpected  %s\nanswered  ", found_on, expected);
    if (answer.is_hit)
        printf("triangle %u of instance %u at t = %.9g (%a), u = %.9g, v = %.9g\n", answer.triangle, answer.instance,
               answer.t, answer.t, answer.u, answer.v);
    else
        printf("a miss\n");
    const int right = is_right(&answer);
    puts(right ? "RIGHT" : "WRONG");
    return right ? 0 : 1;
}
