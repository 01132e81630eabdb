// A Vulkan layer that makes a driver answer rays wrongly, so that tests have a broken one. It patches the SPIR-V of
// every module with ray queries or trace calls before the driver compiles it; all others pass as they are.
//
//     VK_ADD_LAYER_PATH=FOLDER_OF_THE_MANIFEST VK_INSTANCE_LAYERS=VK_LAYER_TWINRAY_broken_driver
//     TWINRAY_BROKEN_DRIVER=FAULT
//
// FAULT is a name of the table below; without one nothing is patched. Only modules given to vkCreateShaderModule are
// seen, not those chained to a pipeline's stage, nor shader objects.
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <pthread.h>
#include <vulkan/vulkan.h>
#include <vulkan/vk_layer.h>

// Numbers of SPIR-V.
enum { op_type_int = 21, op_constant = 43, op_function = 54, op_load = 61, op_decorate = 71, op_f_mul = 133 };
enum { op_bitwise_or = 197, op_bitwise_and = 199, op_trace_ray = 4445, op_initialize_query = 4473 };
enum { op_query_t = 6018, op_query_primitive = 6023, built_in = 11, primitive_id = 7, ray_t_max = 5326 };

// A change of each ray's flags (`query` is op_initialize_query), or of the driver's answers: `operation` with the
// constant whose bits are `bits`.
struct fault {
    const char* name;
    uint32_t query, variable;  // the instruction of ray queries, the variable of hit shaders
    uint32_t operation, bits;
};
static const struct fault faults[] = {
    {"cull", op_initialize_query, 0, op_bitwise_or, 0x10},                // back faces are not hit
    {"first", op_initialize_query, 0, op_bitwise_or, 0x4},                // any hit in place of the closest
    {"distance", op_query_t, ray_t_max, op_f_mul, 0x3f802000},            // t is 1 + 2^-10 times as large
    {"infinite", op_query_t, ray_t_max, op_f_mul, 0x7f800000},            // t is infinite
    {"triangle", op_query_primitive, primitive_id, op_bitwise_and, ~1u},  // odd triangles are named as the one before
};

static const struct fault* chosen_fault(void) {
    const char* name = getenv("TWINRAY_BROKEN_DRIVER");
    for (size_t i = 0; name && i < sizeof faults / sizeof *faults; ++i)
        if (strcmp(name, faults[i].name) == 0) return &faults[i];
    if (name && *name) fprintf(stderr, "broken_driver: there is no fault '%s'\n", name);
    return NULL;
}

// The places to patch and their types, as a first pass over the module finds them.
struct target {
    uint32_t type;      // of the constant, and of its other operand
    uint32_t variable;  // a hit shader's, 0 for none
    size_t count;       // of instructions to patch
};

static uint32_t opcode(const uint32_t* at) { return *at & 0xffff; }

static int is_target(const struct fault* fault, const struct target* target, const uint32_t* at) {
    if (opcode(at) == fault->query) return 1;
    if (fault->query == op_initialize_query) return opcode(at) == op_trace_ray;
    return opcode(at) == op_load && target->variable && at[3] == target->variable;
}

static struct target find_target(const struct fault* fault, const uint32_t* code, size_t words) {
    struct target target = {0, 0, 0};
    uint32_t uint_type = 0;
    for (const uint32_t* at = code + 5; at < code + words; at += *at >> 16) {
        if (opcode(at) == op_type_int && at[2] == 32 && at[3] == 0) uint_type = at[1];
        if (opcode(at) == op_decorate && at[2] == built_in && at[3] == fault->variable) target.variable = at[1];
        if (!is_target(fault, &target, at)) continue;
        target.type = fault->query == op_initialize_query ? uint_type : at[1];
        ++target.count;
    }
    return target;
}

// Returns a copy of the module with the fault, of *words words, or NULL if nothing needs a patch.
static uint32_t* patched(const struct fault* fault, const uint32_t* code, size_t* words) {
    const struct target target = find_target(fault, code, *words);
    if (target.count == 0) return NULL;
    uint32_t *const copy = malloc((*words + 4 + 5 * target.count) * sizeof *copy), *out = copy;
    if (!copy) return NULL;
    uint32_t bound = code[3];
    const uint32_t constant = bound++;
    int has_constant = 0;
    for (size_t i = 0; i < 5; ++i) *out++ = code[i];
    for (const uint32_t* at = code + 5; at < code + *words; at += *at >> 16) {
        const size_t length = *at >> 16;
        if (opcode(at) == op_function && !has_constant) {
            const uint32_t definition[] = {4u << 16 | op_constant, target.type, constant, fault->bits};
            for (size_t i = 0; i < 4; ++i) *out++ = definition[i];
            has_constant = 1;
        }
        if (!is_target(fault, &target, at)) {
            for (size_t i = 0; i < length; ++i) *out++ = at[i];
            continue;
        }
        // Changes flags before the instruction, or a result right after it, under the name that the result had.
        const int of_flags = fault->query == op_initialize_query;
        const size_t changed = !of_flags ? 2 : opcode(at) == op_trace_ray ? 2 : 3;
        const uint32_t added = bound++, type = of_flags ? target.type : at[1];
        const uint32_t combine[] = {5u << 16 | fault->operation, type, of_flags ? added : at[2],
                                    of_flags ? at[changed] : added, constant};
        uint32_t* const instruction = of_flags ? out + 5 : out;
        memcpy(instruction, at, length * sizeof *out);
        instruction[changed] = added;
        memcpy(of_flags ? out : out + length, combine, sizeof combine);
        out += length + 5;
    }
    copy[3] = bound;
    *words = (size_t)(out - copy);
    return copy;
}

// The functions after this layer, for each instance and device; all objects of one share its first pointer.
struct next {
    void* key;
    PFN_vkGetInstanceProcAddr instance_function;
    PFN_vkGetDeviceProcAddr device_function;
    struct next* rest;
};
static struct next* all_next;
static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;

static struct next* next_of(void* handle) {
    pthread_mutex_lock(&mutex);
    struct next* found = all_next;
    while (found && found->key != *(void**)handle) found = found->rest;
    if (!found && (found = calloc(1, sizeof *found))) {
        found->key = *(void**)handle;
        found->rest = all_next;
        all_next = found;
    }
    pthread_mutex_unlock(&mutex);
    return found ? found : (abort(), NULL);
}

static VKAPI_ATTR VkResult VKAPI_CALL create_shader_module(VkDevice device, const VkShaderModuleCreateInfo* info,
                                                           const VkAllocationCallbacks* allocator,
                                                           VkShaderModule* module) {
    const PFN_vkCreateShaderModule create =
        (PFN_vkCreateShaderModule)next_of(device)->device_function(device, "vkCreateShaderModule");
    const struct fault* const fault = chosen_fault();
    VkShaderModuleCreateInfo broken = *info;
    size_t words = info->codeSize / 4;
    uint32_t* const code = fault ? patched(fault, info->pCode, &words) : NULL;
    if (code) {
        broken.pCode = code;
        broken.codeSize = words * 4;
    }
    const VkResult result = create(device, &broken, allocator, module);
    free(code);
    return result;
}

static VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo* info,
                                                      const VkAllocationCallbacks* allocator, VkInstance* instance) {
    VkLayerInstanceCreateInfo* link = (VkLayerInstanceCreateInfo*)info->pNext;
    while (link->sType != VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO || link->function != VK_LAYER_LINK_INFO)
        link = (VkLayerInstanceCreateInfo*)link->pNext;
    const PFN_vkGetInstanceProcAddr next = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const VkResult result = ((PFN_vkCreateInstance)next(NULL, "vkCreateInstance"))(info, allocator, instance);
    if (result == VK_SUCCESS) next_of(*instance)->instance_function = next;
    return result;
}

static VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                                    const VkAllocationCallbacks* allocator, VkDevice* device) {
    VkLayerDeviceCreateInfo* link = (VkLayerDeviceCreateInfo*)info->pNext;
    while (link->sType != VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO || link->function != VK_LAYER_LINK_INFO)
        link = (VkLayerDeviceCreateInfo*)link->pNext;
    const PFN_vkGetInstanceProcAddr next = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    const PFN_vkGetDeviceProcAddr device_next = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const VkResult result = ((PFN_vkCreateDevice)next(NULL, "vkCreateDevice"))(physical, info, allocator, device);
    if (result == VK_SUCCESS) next_of(*device)->device_function = device_next;
    return result;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_function(VkDevice device, const char* name) {
    if (strcmp(name, "vkGetDeviceProcAddr") == 0) return (PFN_vkVoidFunction)device_function;
    if (strcmp(name, "vkCreateShaderModule") == 0) return (PFN_vkVoidFunction)create_shader_module;
    return next_of(device)->device_function(device, name);
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instance_function(VkInstance instance, const char* name) {
    if (strcmp(name, "vkGetInstanceProcAddr") == 0) return (PFN_vkVoidFunction)instance_function;
    if (strcmp(name, "vkCreateInstance") == 0) return (PFN_vkVoidFunction)create_instance;
    if (strcmp(name, "vkCreateDevice") == 0) return (PFN_vkVoidFunction)create_device;
    if (strcmp(name, "vkGetDeviceProcAddr") == 0) return (PFN_vkVoidFunction)device_function;
    return instance ? next_of(instance)->instance_function(instance, name) : NULL;
}

__attribute__((visibility("default"))) VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* interface) {
    interface->loaderLayerInterfaceVersion = 2;
    interface->pfnGetInstanceProcAddr = instance_function;
    interface->pfnGetDeviceProcAddr = device_function;
    interface->pfnGetPhysicalDeviceProcAddr = NULL;
    return VK_SUCCESS;
}
