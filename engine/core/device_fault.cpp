// SPDX-License-Identifier: MIT
#include "engine/core/device_fault.h"

#include <algorithm>
#include <iomanip>

#include "engine/core/error.h"
#include "engine/core/vulkan.h"

namespace twinray {
namespace {

constexpr std::size_t most_infos = 8;  // of either list

const char* kind_of(VkDeviceFaultAddressTypeEXT type) {
    switch (type) {
        case VK_DEVICE_FAULT_ADDRESS_TYPE_READ_INVALID_EXT: return "invalid read";
        case VK_DEVICE_FAULT_ADDRESS_TYPE_WRITE_INVALID_EXT: return "invalid write";
        case VK_DEVICE_FAULT_ADDRESS_TYPE_EXECUTE_INVALID_EXT: return "invalid execution";
        case VK_DEVICE_FAULT_ADDRESS_TYPE_INSTRUCTION_POINTER_UNKNOWN_EXT: return "instruction";
        case VK_DEVICE_FAULT_ADDRESS_TYPE_INSTRUCTION_POINTER_INVALID_EXT: return "invalid instruction";
        case VK_DEVICE_FAULT_ADDRESS_TYPE_INSTRUCTION_POINTER_FAULT_EXT: return "faulting instruction";
        default: return "address";
    }
}

std::string hexadecimal(std::uint64_t value) { return text("0x", std::hex, value); }

// The precision is a power of two.
std::string told(const VkDeviceFaultAddressInfoEXT& address) {
    const std::uint64_t within = address.addressPrecision ? address.addressPrecision - 1 : 0;
    const std::uint64_t first = address.reportedAddress & ~within, last = address.reportedAddress | within;
    return text(kind_of(address.addressType), " at ", hexadecimal(first),
                last > first ? " to " + hexadecimal(last) : "");
}

std::string told(const VkDeviceFaultVendorInfoEXT& vendor) {
    return text('\'', vendor.description, "' (code ", hexadecimal(vendor.vendorFaultCode), ", data ",
                hexadecimal(vendor.vendorFaultData), ')');
}

template <class Info>
void tell(const std::vector<Info>& infos, std::vector<std::string>& parts) {
    for (std::size_t i = 0; i < std::min(infos.size(), most_infos); ++i) parts.push_back(told(infos[i]));
    if (infos.size() > most_infos) parts.push_back(text(infos.size() - most_infos, " more"));
}

}  // namespace

DeviceFault query_device_fault(const VulkanTable& vk, VkDevice device) {
    if (!vk.vkGetDeviceFaultInfoEXT) return {};
    VkDeviceFaultCountsEXT counts{};
    counts.sType = VK_STRUCTURE_TYPE_DEVICE_FAULT_COUNTS_EXT;
    if (vk.vkGetDeviceFaultInfoEXT(device, &counts, nullptr) != VK_SUCCESS) return {};
    counts.vendorBinarySize = 0;  // a dump for tools of the vendor
    DeviceFault fault{.addresses = std::vector<VkDeviceFaultAddressInfoEXT>(counts.addressInfoCount),
                      .vendor = std::vector<VkDeviceFaultVendorInfoEXT>(counts.vendorInfoCount)};
    VkDeviceFaultInfoEXT info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_FAULT_INFO_EXT;
    info.pAddressInfos = fault.addresses.data();
    info.pVendorInfos = fault.vendor.data();
    // The result is incomplete if there are more by now.
    const VkResult result = vk.vkGetDeviceFaultInfoEXT(device, &counts, &info);
    if (result != VK_SUCCESS && result != VK_INCOMPLETE) return {};
    fault.description = info.description;
    fault.addresses.resize(counts.addressInfoCount);
    fault.vendor.resize(counts.vendorInfoCount);
    return fault;
}

std::string sentence(const DeviceFault& fault) {
    std::vector<std::string> parts;
    if (!fault.description.empty()) parts.push_back('\'' + fault.description + '\'');
    tell(fault.addresses, parts);
    tell(fault.vendor, parts);
    return parts.empty() ? "" : "; the driver says: " + joined(parts);
}

}  // namespace twinray
