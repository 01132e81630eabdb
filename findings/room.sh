# shellcheck shell=bash
# SPDX-License-Identifier: MIT
# Scripts on drivers and compilers source it. It makes a room (a minimal Debian in the script's temp $folder), puts
# packages of pinned versions ($mesa_25 and $mesa_26 for lavapipes) into it, and runs C programs and kernels there.
#   ROOMS=FOLDER     keeps rooms in FOLDER for the next script, one script at a time (remove FOLDER when done)
#   MIRROR=ADDRESS   takes packages from there, not from the Debian archive that this machine uses; it may be an old one
# Needs root, debootstrap, an x86-64 machine with AVX2 and 2 GB on the disk.
# shellcheck source=findings/checks.sh
. "$(dirname "${BASH_SOURCE[0]}")/checks.sh"

# shellcheck disable=SC2317,SC2329
leave() {
    if mountpoint -q "$room/proc"; then umount "$room/proc"; fi
    if [[ -z ${ROOMS-} ]]; then rm -rf --one-file-system "$room"; else rm -rf "$folder"; fi
}

proxies=()
for name in http_proxy https_proxy no_proxy; do
    if [[ -n ${!name-} ]]; then proxies+=("$name=${!name}"); fi
done
in_room() {
    env -i "${proxies[@]}" PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
        chroot "$room" env -C /probe "$@"
}

# Makes the room of a suite. Its folder is $room; $probe is the folder in it, /probe inside, where a script works.
make_room() { # trixie or sid
    if ((EUID != 0)); then fail "needs root"; fi
    if [[ -n ${ROOMS-} ]]; then
        mkdir -p "$ROOMS"
        room=$(realpath "$ROOMS")/$1
        exec {lock}>"$room.lock"
        flock "$lock"
    else
        room=$folder
    fi
    trap leave EXIT
    probe=$room/probe
    if [[ ! -e $room/made ]]; then fill_room "$1"; fi
    if ! mountpoint -q "$room/proc"; then mount -t proc proc "$room/proc"; fi
    rm -rf "$probe"
    mkdir "$probe"
}

fill_room() {
    local mirror=${MIRROR-} include=()
    if [[ -z $mirror ]]; then
        # shellcheck disable=SC2016
        mirror=$(apt-get indextargets --format '$(ORIGIN)|$(COMPONENT)|$(LABEL)|$(REPO_URI)' \
            'Created-By: Packages' |
            awk -F'|' '!uri && $1 == "Debian" && $2 == "main" && $3 == "Debian" { uri = $4 } END { print uri }')
    fi
    if [[ -z $mirror ]]; then fail "apt has no Debian mirror; run apt-get update or set MIRROR"; fi
    if [[ -n $(ls -A "$room" 2>/dev/null) ]]; then fail "$room is no room of these scripts; remove it"; fi
    if [[ $mirror == https:* ]]; then include=(--include=ca-certificates); fi
    mkdir -p "$room"
    quietly debootstrap --variant=minbase "${include[@]}" "$1" "$room" "$mirror"
    # The network as this machine sees it.
    cp -L /etc/resolv.conf /etc/hosts "$room/etc/"
    apt-config dump | grep -E '^Acquire::(https?::.*|Check-[A-Za-z-]*|Retries) "' \
        >"$room/etc/apt/apt.conf.d/99transport" || true
    echo 'APT::Install-Recommends "false";' >"$room/etc/apt/apt.conf.d/98lean"
    if [[ -n ${MIRROR-} ]]; then echo 'Acquire::Check-Valid-Until "false";' >>"$room/etc/apt/apt.conf.d/98lean"; fi
    echo "$mirror" >"$room/mirror"
    mkdir "$room/probe"
    if [[ $1 == trixie ]]; then more_of trixie-backports; fi
    quietly in_room apt-get update
    touch "$room/made"
}

quietly() {
    local log
    log=$("$@" 2>&1) || {
        tail -n 15 <<<"$log" >&2
        fail "$1 failed (a pinned version that is gone from the archive: see MIRROR in room.sh)"
    }
}

more_of() { # suite, whose packages can be had as well, by version
    echo "deb $(cat "$room/mirror") $1 main" >"$room/etc/apt/sources.list.d/$1.list"
    printf 'Package: *\nPin: release n=%s\nPin-Priority: 100\n' "$1" >"$room/etc/apt/preferences.d/$1"
}
install() { quietly in_room apt-get install -y --allow-downgrades "$@"; }
unpack() { # suite, package, version: into /opt/PACKAGE/VERSION, beside what is installed
    local folder=/opt/$2/$3
    if [[ -d $room$folder ]]; then return; fi
    if [[ ! -e $room/etc/apt/preferences.d/$1 ]]; then
        more_of "$1"
        quietly in_room apt-get update
    fi
    quietly in_room apt-get download "$2=$3"
    in_room sh -c "mkdir -p $folder && dpkg-deb -x $2_*.deb $folder && rm $2_*.deb"
}

# lavapipe of a version of mesa-vulkan-drivers, beside others in one room.
driver() {
    if [[ -e $room/opt/mesa/$1/icd.json ]]; then return; fi
    install "mesa-vulkan-drivers=$1"
    keep_driver "$1" "$room"
}
keep_driver() { # version, folder where the package lies
    mkdir -p "$room/opt/mesa/$1"
    cp "$2/usr/lib/x86_64-linux-gnu/libvulkan_lvp.so" "$room/opt/mesa/$1/"
    echo '{"file_format_version":"1.0.0","ICD":{"library_path":"./libvulkan_lvp.so","api_version":"1.3.0"}}' \
        >"$room/opt/mesa/$1/icd.json"
}
on_driver() { # version, command...
    in_room env VK_DRIVER_FILES="/opt/mesa/$1/icd.json" LD_LIBRARY_PATH="/opt/mesa/$1" \
        VK_LOADER_LAYERS_DISABLE='~implicit~' MESA_SHADER_CACHE_DISABLE=true "${@:2}"
}

# A trixie room with both lavapipes, a C compiler, Vulkan's headers and glslang.
make_lavapipe_room() {
    make_room trixie
    install gcc libc6-dev libvulkan-dev glslang-tools
    driver "${mesa_25:?}"
    driver "${mesa_26:?}"
    write_vk_h
}
kernel() { in_room glslangValidator --quiet --target-env vulkan1.3 -o "$1.spv" "$1.comp"; } # reads NAME.comp
program() { in_room gcc -O2 -Wall -Werror -o "$1" "$1.c" -lvulkan -lm; }                   # reads NAME.c

# Vulkan for these programs: one device, buffers that the CPU sees, kernels that get addresses as push constants, and
# acceleration structures.
write_vk_h() {
    cat >"$probe/vk.h" <<'END'
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <vulkan/vulkan.h>

#define CHECK(call) check(call, #call)
static inline void check(VkResult result, const char* call) {
    if (result == VK_SUCCESS) return;
    fprintf(stderr, "%s: %d\n", call, result);
    exit(1);
}

static VkInstance instance;
static VkPhysicalDevice physical;
static VkDevice device;
static VkQueue queue;
static VkCommandPool pool;
static VkCommandBuffer commands;
static VkPipelineLayout layout;
static uint32_t memory_type;

#define DEVICE_FUNCTION(name) ((PFN_##name)vkGetDeviceProcAddr(device, #name))

// The first device, with every feature that it has and, of the extensions below, those that it has.
static inline void open_device(void) {
    const VkApplicationInfo application = {VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_3};
    const VkInstanceCreateInfo for_instance = {
        VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &application};
    CHECK(vkCreateInstance(&for_instance, NULL, &instance));
    uint32_t count = 1;
    const VkResult listed = vkEnumeratePhysicalDevices(instance, &count, &physical);
    if (listed != VK_INCOMPLETE) CHECK(listed);
    VkPhysicalDeviceDriverProperties driver = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver};
    vkGetPhysicalDeviceProperties2(physical, &properties);
    fprintf(stderr, "%s, %s\n", driver.driverName, driver.driverInfo);

    static const char* const wanted[] = {
        VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME, VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
        VK_KHR_RAY_QUERY_EXTENSION_NAME, VK_KHR_RAY_TRACING_POSITION_FETCH_EXTENSION_NAME};
    static VkExtensionProperties there[1024];
    uint32_t there_count = 1024;
    CHECK(vkEnumerateDeviceExtensionProperties(physical, NULL, &there_count, there));
    const char* names[4];
    uint32_t names_count = 0;
    for (int i = 0; i < 4; ++i)
        for (uint32_t j = 0; j < there_count; ++j)
            if (strcmp(wanted[i], there[j].extensionName) == 0) names[names_count++] = wanted[i];
    if (names_count < 4) fprintf(stderr, "the device lacks extensions for rays\n"), exit(1);

    VkPhysicalDeviceRayTracingPositionFetchFeaturesKHR fetch = {
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_POSITION_FETCH_FEATURES_KHR};
    VkPhysicalDeviceRayQueryFeaturesKHR query = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR, &fetch};
    VkPhysicalDeviceAccelerationStructureFeaturesKHR structures = {
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR, &query};
    VkPhysicalDeviceVulkan12Features vulkan12 = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &structures};
    VkPhysicalDeviceFeatures2 features = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &vulkan12};
    vkGetPhysicalDeviceFeatures2(physical, &features);
    const float priority = 1;
    const VkDeviceQueueCreateInfo for_queue = {
        VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, .queueCount = 1, .pQueuePriorities = &priority};
    const VkDeviceCreateInfo for_device = {
        VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features, .queueCreateInfoCount = 1, .pQueueCreateInfos = &for_queue,
        .enabledExtensionCount = names_count, .ppEnabledExtensionNames = names};
    CHECK(vkCreateDevice(physical, &for_device, NULL, &device));
    vkGetDeviceQueue(device, 0, 0, &queue);

    const VkMemoryPropertyFlags visible = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);
    while ((memory.memoryTypes[memory_type].propertyFlags & visible) != visible) ++memory_type;

    const VkCommandPoolCreateInfo for_pool = {
        VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT};
    CHECK(vkCreateCommandPool(device, &for_pool, NULL, &pool));
    const VkCommandBufferAllocateInfo for_commands = {
        VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, .commandPool = pool, .commandBufferCount = 1};
    CHECK(vkAllocateCommandBuffers(device, &for_commands, &commands));
    const VkPushConstantRange range = {VK_SHADER_STAGE_COMPUTE_BIT, 0, 128};
    const VkPipelineLayoutCreateInfo for_layout = {
        VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, .pushConstantRangeCount = 1, .pPushConstantRanges = &range};
    CHECK(vkCreatePipelineLayout(device, &for_layout, NULL, &layout));
}

typedef struct {
    VkBuffer handle;
    VkDeviceMemory memory;
    void* data;
    VkDeviceAddress address; // a multiple of 256
} Buffer;

static inline Buffer new_buffer(VkDeviceSize size) {
    Buffer buffer;
    const VkBufferCreateInfo for_buffer = {
        VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = size,
        .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
                 VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR |
                 VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR};
    CHECK(vkCreateBuffer(device, &for_buffer, NULL, &buffer.handle));
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device, buffer.handle, &needs);
    const VkMemoryAllocateFlagsInfo with_address = {
        VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO, .flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT};
    const VkMemoryAllocateInfo for_memory = {
        VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, &with_address, needs.size, memory_type};
    CHECK(vkAllocateMemory(device, &for_memory, NULL, &buffer.memory));
    CHECK(vkBindBufferMemory(device, buffer.handle, buffer.memory, 0));
    CHECK(vkMapMemory(device, buffer.memory, 0, VK_WHOLE_SIZE, 0, &buffer.data));
    const VkBufferDeviceAddressInfo of = {VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO, .buffer = buffer.handle};
    buffer.address = vkGetBufferDeviceAddress(device, &of);
    if (buffer.address % 256 != 0) fprintf(stderr, "a buffer's address is no multiple of 256\n"), exit(1);
    memset(buffer.data, 0, size);
    return buffer;
}

static inline void free_buffer(Buffer buffer) {
    vkDestroyBuffer(device, buffer.handle, NULL);
    vkFreeMemory(device, buffer.memory, NULL);
}
static inline void close_device(void) { // after free_buffer() of each buffer
    vkDestroyPipelineLayout(device, layout, NULL);
    vkDestroyCommandPool(device, pool, NULL);
    vkDestroyDevice(device, NULL);
    vkDestroyInstance(instance, NULL);
}

static inline void record(void) {
    const VkCommandBufferBeginInfo begin = {
        VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    CHECK(vkBeginCommandBuffer(commands, &begin));
}
static inline double submit(void) { // and wait; milliseconds
    CHECK(vkEndCommandBuffer(commands));
    const VkSubmitInfo info = {
        VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &commands};
    struct timespec from, to;
    clock_gettime(CLOCK_MONOTONIC, &from);
    CHECK(vkQueueSubmit(queue, 1, &info, VK_NULL_HANDLE));
    CHECK(vkQueueWaitIdle(queue));
    clock_gettime(CLOCK_MONOTONIC, &to);
    return (to.tv_sec - from.tv_sec) * 1e3 + (to.tv_nsec - from.tv_nsec) * 1e-6;
}

static inline VkPipeline load_kernel(const char* path) {
    static uint32_t words[1 << 16];
    FILE* file = fopen(path, "rb");
    if (!file) perror(path), exit(1);
    const size_t count = fread(words, 4, 1 << 16, file);
    fclose(file);
    const VkShaderModuleCreateInfo for_module = {
        VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = 4 * count, .pCode = words};
    VkShaderModule module;
    CHECK(vkCreateShaderModule(device, &for_module, NULL, &module));
    const VkComputePipelineCreateInfo for_pipeline = {
        VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = module, .pName = "main"},
        .layout = layout};
    VkPipeline pipeline;
    CHECK(vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &for_pipeline, NULL, &pipeline));
    vkDestroyShaderModule(device, module, NULL);
    return pipeline;
}
static inline void run_kernel(const char* path, const void* push, uint32_t size, uint32_t groups) {
    const VkPipeline pipeline = load_kernel(path);
    record();
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    vkCmdPushConstants(commands, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, size, push);
    vkCmdDispatch(commands, groups, 1, 1);
    submit();
    vkDestroyPipeline(device, pipeline, NULL);
}

typedef struct {
    VkAccelerationStructureKHR handle;
    VkDeviceAddress address;
    double build_ms;
} Structure;

// Opaque triangles: positions are three floats a vertex, indices three uint32_t a triangle.
static inline VkAccelerationStructureGeometryKHR triangles(Buffer positions, uint32_t vertices, Buffer indices) {
    return (VkAccelerationStructureGeometryKHR){
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR, .geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR,
        .geometry.triangles = {VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR,
                               .vertexFormat = VK_FORMAT_R32G32B32_SFLOAT,
                               .vertexData.deviceAddress = positions.address, .vertexStride = 12,
                               .maxVertex = vertices - 1, .indexType = VK_INDEX_TYPE_UINT32,
                               .indexData.deviceAddress = indices.address},
        .flags = VK_GEOMETRY_OPAQUE_BIT_KHR};
}

static inline Structure build(VkAccelerationStructureTypeKHR type, VkBuildAccelerationStructureFlagsKHR flags,
                              uint32_t count, const VkAccelerationStructureGeometryKHR* geometries,
                              const uint32_t* primitives) {
    VkAccelerationStructureBuildGeometryInfoKHR info = {
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR, .type = type,
        .flags = flags | VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR,
        .mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR, .geometryCount = count, .pGeometries = geometries};
    VkAccelerationStructureBuildSizesInfoKHR sizes = {
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR};
    DEVICE_FUNCTION(vkGetAccelerationStructureBuildSizesKHR)
    (device, VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &info, primitives, &sizes);
    const Buffer memory = new_buffer(sizes.accelerationStructureSize), scratch = new_buffer(sizes.buildScratchSize);
    const VkAccelerationStructureCreateInfoKHR for_structure = {
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR, .buffer = memory.handle,
        .size = sizes.accelerationStructureSize, .type = type};
    Structure structure;
    CHECK(DEVICE_FUNCTION(vkCreateAccelerationStructureKHR)(device, &for_structure, NULL, &structure.handle));
    info.dstAccelerationStructure = structure.handle;
    info.scratchData.deviceAddress = scratch.address;
    VkAccelerationStructureBuildRangeInfoKHR ranges[8] = {{0}};
    for (uint32_t i = 0; i < count; ++i) ranges[i].primitiveCount = primitives[i];
    const VkAccelerationStructureBuildRangeInfoKHR* const first = ranges;
    record();
    DEVICE_FUNCTION(vkCmdBuildAccelerationStructuresKHR)(commands, 1, &info, &first);
    structure.build_ms = submit();
    const VkAccelerationStructureDeviceAddressInfoKHR of = {
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR, .accelerationStructure = structure.handle};
    structure.address = DEVICE_FUNCTION(vkGetAccelerationStructureDeviceAddressKHR)(device, &of);
    return structure;
}

static inline Structure build_bottom(VkBuildAccelerationStructureFlagsKHR flags, uint32_t count,
                                     const VkAccelerationStructureGeometryKHR* geometries,
                                     const uint32_t* primitives) {
    return build(VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, flags, count, geometries, primitives);
}

static inline Structure build_top(Structure bottom) { // one instance, where its mesh is
    const VkAccelerationStructureInstanceKHR instance = {
        {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}, .mask = 0xff,
        .flags = VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR,
        .accelerationStructureReference = bottom.address};
    const Buffer instances = new_buffer(sizeof instance);
    memcpy(instances.data, &instance, sizeof instance);
    const VkAccelerationStructureGeometryKHR geometry = {
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR, .geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR,
        .geometry.instances = {VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR,
                               .data.deviceAddress = instances.address}};
    const uint32_t one = 1;
    return build(VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, 0, 1, &geometry, &one);
}

static inline float random_unit(void) { // in [0, 1), the same on every machine
    static uint32_t state = 1;
    state = state * 1664525u + 1013904223u;
    return (state >> 8) * 0x1p-24f;
}
END
}
