// SPDX-License-Identifier: MIT
// Which device to use, and why not the others: plain data in, plain data out, no Vulkan calls.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/core/requirement.h"

namespace twinray {

enum class DeviceKind : std::uint8_t { discrete, integrated, virtual_gpu, cpu, other };

// What twinray wants to know of a device; filled by query_device_facts.
struct DeviceFacts {
    std::string name;
    std::string driver;
    DeviceKind kind = DeviceKind::other;
    std::uint32_t api_version = 0;  // as VK_MAKE_API_VERSION
    // Of a compute group; until the device is asked, what Vulkan guarantees.
    std::uint32_t shared_bytes = 16384, group_invocations = 128, push_constant_bytes = 128;
    std::uint32_t driver_id = 0;    // VkDriverId
    std::uint32_t cpu_threads = 0;  // of a CPU, which run the groups of a dispatch; else 0
    std::uint32_t subgroup_size = 0;
    bool has_compute_queue = false;
    bool timeline_semaphore = false;
    bool buffer_device_address = false;
    bool scalar_block_layout = false;
    bool shader_int64 = false;  // for kernels of hosts; none of ours needs it
    bool shader_float64 = false;
    bool acceleration_structure = false;
    bool ray_query = false;
    bool ray_tracing_pipeline = false;
    bool device_fault = false;  // it tells why it was lost
    bool runtime_descriptor_array = false;
    bool variable_descriptor_count = false;
    bool nonuniform_sampled_images = false;
    bool update_after_bind_images = false;

    // Whether kernels can reach any number of images through one array of descriptors.
    bool has_image_arrays() const {
        return runtime_descriptor_array && variable_descriptor_count && nonuniform_sampled_images &&
               update_after_bind_images;
    }
};

// What the software accelerator and everything else of twinray needs and this device lacks: Requirement::what.
std::vector<std::string> missing_for_software(const DeviceFacts& device);
// The same for the hardware accelerator (includes what software needs).
std::vector<std::string> missing_for_hardware(const DeviceFacts& device);

struct DeviceChoice {
    int index = -1;                       // into the given span; -1 = none fits
    std::vector<std::string> rejections;  // one sentence for each device that was not chosen
};

// request: "" = best (hardware ray tracing first, then discrete > integrated > virtual > cpu, then order),
// a decimal index, or a part of the device's name (case-insensitive).
DeviceChoice choose_device(std::span<const DeviceFacts> devices, const std::string& request);

const char* name_of(DeviceKind kind);

}  // namespace twinray
