// The report about a device that is lost or stops answering: the driver's words (VK_EXT_device_fault), and the work in
// flight.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include <vulkan/vulkan_core.h>

namespace twinray {

struct VulkanTable;

struct DeviceFault {
    std::string description = {};
    std::vector<VkDeviceFaultAddressInfoEXT> addresses = {};
    std::vector<VkDeviceFaultVendorInfoEXT> vendor = {};
};

// Queries a lost device; returns an empty fault if the driver does not tell.
DeviceFault query_device_fault(const VulkanTable& vk, VkDevice device);

// Formats it: "; the driver says: 'ring hang', invalid read at 0x1200 to 0x12ff, 'engine' (code 0x7, data 0x1)"; empty
// if there is nothing.
std::string sentence(const DeviceFault& fault);

// A pass of submitted commands, and how many groups its dispatches of known size have.
struct PassWork {
    std::string name;
    std::uint64_t groups = 0;
};

// Submissions that are not known to be done.
class SubmissionLog {
  public:
    // `value`: the timeline's value when they are done.
    void submitted(std::uint64_t value, std::string commands, std::vector<PassWork> passes);
    void reached(std::uint64_t value);
    // Says "; in flight: 'trace' (1 pass: 'swtlas_trace closest' of 625 groups)", the passes with the most groups
    // first; empty if nothing is.
    std::string sentence() const;

  private:
    struct Submission {
        std::uint64_t value;
        std::string commands;
        std::vector<PassWork> passes;
    };
    std::deque<Submission> submissions_;
};

}  // namespace twinray
