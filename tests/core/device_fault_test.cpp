// SPDX-License-Identifier: MIT
// What the error of a lost device says of VK_EXT_device_fault: no driver here has it, so that structs stand in.
#include "engine/core/device_fault.h"
#include "engine/core/vulkan.h"

#include <gtest/gtest.h>

#include <cstring>

namespace twinray {
namespace {

VkDeviceFaultAddressInfoEXT address(VkDeviceFaultAddressTypeEXT type, VkDeviceAddress at, VkDeviceSize precision) {
    return {type, at, precision};
}

VkDeviceFaultVendorInfoEXT vendor(const char* description, std::uint64_t code, std::uint64_t data) {
    VkDeviceFaultVendorInfoEXT info{};
    std::strncpy(info.description, description, sizeof info.description - 1);
    info.vendorFaultCode = code;
    info.vendorFaultData = data;
    return info;
}

TEST(DeviceFault, SaysWhatTheDriverDoes) {
    EXPECT_EQ(sentence({}), "");
    EXPECT_EQ(sentence({.description = "ring hang"}), "; the driver says: 'ring hang'");
    const DeviceFault fault{.description = "page fault",
                            .addresses = {address(VK_DEVICE_FAULT_ADDRESS_TYPE_READ_INVALID_EXT, 0x1234, 0x100),
                                          address(VK_DEVICE_FAULT_ADDRESS_TYPE_INSTRUCTION_POINTER_FAULT_EXT, 0x40, 1)},
                            .vendor = {vendor("engine", 7, 0xab)}};
    EXPECT_EQ(sentence(fault),
              "; the driver says: 'page fault', invalid read at 0x1200 to 0x12ff, faulting instruction at 0x40, "
              "'engine' (code 0x7, data 0xab)");
}

TEST(DeviceFault, ListsAreCutShort) {
    const std::vector addresses(11, address(VK_DEVICE_FAULT_ADDRESS_TYPE_WRITE_INVALID_EXT, 0x10, 0x10));
    const std::string said = sentence({.addresses = addresses});
    EXPECT_TRUE(said.ends_with("invalid write at 0x10 to 0x1f, 3 more")) << said;
}

// A driver that tells one address of two that it promised.
VkResult VKAPI_PTR fault_info(VkDevice, VkDeviceFaultCountsEXT* counts, VkDeviceFaultInfoEXT* info) {
    if (!info) {
        counts->addressInfoCount = 2;
        counts->vendorInfoCount = 1;
        counts->vendorBinarySize = 1000;
        return VK_SUCCESS;
    }
    EXPECT_EQ(counts->vendorBinarySize, 0u) << "there is no room for it";
    std::strcpy(info->description, "hang");
    info->pAddressInfos[0] = address(VK_DEVICE_FAULT_ADDRESS_TYPE_EXECUTE_INVALID_EXT, 0x20, 1);
    info->pVendorInfos[0] = vendor("unit", 1, 2);
    counts->addressInfoCount = 1;
    return VK_INCOMPLETE;
}

TEST(DeviceFault, IsAskedForWhereTheDeviceHasIt) {
    VulkanTable vk;
    EXPECT_EQ(sentence(query_device_fault(vk, VK_NULL_HANDLE)), "");
    vk.vkGetDeviceFaultInfoEXT = fault_info;
    EXPECT_EQ(sentence(query_device_fault(vk, VK_NULL_HANDLE)),
              "; the driver says: 'hang', invalid execution at 0x20, 'unit' (code 0x1, data 0x2)");
    vk.vkGetDeviceFaultInfoEXT = [](VkDevice, VkDeviceFaultCountsEXT*, VkDeviceFaultInfoEXT*) {
        return VK_ERROR_OUT_OF_HOST_MEMORY;
    };
    EXPECT_EQ(sentence(query_device_fault(vk, VK_NULL_HANDLE)), "");
}

}  // namespace
}  // namespace twinray
