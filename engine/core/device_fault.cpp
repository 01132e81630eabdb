// Explains why a device cannot be used: it is lost, or belongs to another process.
#include "engine/core/device_fault.h"

#include <algorithm>
#include <iomanip>

#include "engine/core/context.h"
#include "engine/core/error.h"
#include "engine/core/platform.h"
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

constexpr std::size_t most_told = 3;  // submissions, and passes of each

std::string told(const PassWork& pass) {
    return text('\'', pass.name, '\'', pass.groups ? text(" of ", pass.groups, " groups") : "");
}

std::string told(const std::string& commands, std::vector<PassWork> passes) {
    std::ranges::stable_sort(passes, std::ranges::greater{}, &PassWork::groups);
    std::vector<std::string> largest;
    for (std::size_t i = 0; i < std::min(passes.size(), most_told); ++i) largest.push_back(told(passes[i]));
    if (passes.size() > most_told) largest.emplace_back("...");
    const char* const unit = passes.size() == 1 ? " pass: " : " passes: ";
    return text('\'', commands, "' (", passes.size(), unit, joined(largest), ')');
}

}  // namespace

DeviceFault query_device_fault(const VulkanTable& vk, VkDevice device) {
    if (!vk.vkGetDeviceFaultInfoEXT) return {};
    VkDeviceFaultCountsEXT counts = OfType{VK_STRUCTURE_TYPE_DEVICE_FAULT_COUNTS_EXT};
    if (vk.vkGetDeviceFaultInfoEXT(device, &counts, nullptr) != VK_SUCCESS) return {};
    counts.vendorBinarySize = 0;  // a dump for tools of the vendor
    DeviceFault fault{.addresses = std::vector<VkDeviceFaultAddressInfoEXT>(counts.addressInfoCount),
                      .vendor = std::vector<VkDeviceFaultVendorInfoEXT>(counts.vendorInfoCount)};
    VkDeviceFaultInfoEXT info = OfType{VK_STRUCTURE_TYPE_DEVICE_FAULT_INFO_EXT};
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

std::string Context::State::words_of_loss() const {
    if (!fault_) fault_ = properties_.device_fault ? sentence(query_device_fault(vk_, device_)) : "";
    return name_of(VK_ERROR_DEVICE_LOST) + submission_log_.sentence() + *fault_;
}

void Context::State::check(VkResult result, const char* action) const {
    is_lost_ |= result == VK_ERROR_DEVICE_LOST;
    if (result == VK_ERROR_DEVICE_LOST) throw DeviceLost(text(action, ": ", words_of_loss()));
    vk_check(result, action);
}

bool Context::State::is_of_this_process() const noexcept { return process_ == platform::process_id(); }

void Context::State::check_process() const {
    if (!is_of_this_process())
        fail("device '", properties_.name, "': process ", process_, " opened it, and a fork made process ",
             platform::process_id(),
             " of that; a device does not outlive a fork. Open one in the new process, or start that by spawn");
}

void Context::State::check_alive() const {
    check_process();
    if (is_lost_) throw DeviceLost(text("device '", properties_.name, "': ", words_of_loss()));
}

void SubmissionLog::submitted(std::uint64_t value, std::string commands, std::vector<PassWork> passes) {
    submissions_.push_back({value, std::move(commands), std::move(passes)});
}

void SubmissionLog::reached(std::uint64_t value) {
    while (!submissions_.empty() && submissions_.front().value <= value) submissions_.pop_front();
}

std::string SubmissionLog::sentence() const {
    if (submissions_.empty()) return "";
    std::vector<std::string> first;
    for (std::size_t i = 0; i < std::min(submissions_.size(), most_told); ++i)
        first.push_back(told(submissions_[i].commands, submissions_[i].passes));
    if (submissions_.size() > most_told) first.push_back(text("and ", submissions_.size() - most_told, " more"));
    return "; in flight: " + joined(first);
}

}  // namespace twinray
