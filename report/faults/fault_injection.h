// Vulkan that fails on demand, above the layers and the driver and without a hook in the library: contexts take a
// vkGetInstanceProcAddr, and this one hands out wrappers that count calls, fail the chosen ones and know what is alive.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include <vulkan/vulkan_core.h>

namespace twinray::faults {

// The calls that fail, counted from inject() on. Before it, none fails.
struct Fault {
    std::string_view function = {};      // "" = every one that can return `result`
    std::uint64_t first = 1;             // the first call to fail; 1 = the next
    std::uint64_t count = 1;             // how many fail from there on
    VkResult result = VK_ERROR_UNKNOWN;  // unknown: the natural error of each function
};

constexpr std::uint64_t every_call = UINT64_MAX;

using Counts = std::map<std::string, std::size_t>;

// Only one exists at a time, around the contexts that use it. A call that fails is not passed on, but a device that is
// reported lost is waited for first, because the work of a lost device counts as finished.
class FaultInjector {
  public:
    FaultInjector();
    ~FaultInjector();
    FaultInjector(const FaultInjector&) = delete;
    FaultInjector& operator=(const FaultInjector&) = delete;

    PFN_vkGetInstanceProcAddr entry() const;

    void inject(const Fault& fault);
    void heal() { armed_ = false; }
    std::uint64_t calls() const { return calls_; }         // that `fault` could have failed, since inject()
    std::uint64_t injected() const { return injected_; }   // that failed, since inject()
    const std::string& failed() const { return failed_; }  // the function that failed last, since inject()

    // Acts as a driver that asks for this many bytes more for each acceleration structure than it uses, as drivers do
    // if structures can be compacted. Call it once, before the first structure, with an odd number, so that a size with
    // slack equals no size without.
    void set_structure_slack(std::uint64_t bytes) { structure_slack_ = bytes; }

    // Returns how many objects are alive, by type ("VkBuffer"), without types that have none. Command buffers go with
    // their pool and are not counted.
    Counts live() const;
    // Leaves out memory, because VMA keeps a block for the next allocation. allocated_bytes() returns how much of it is
    // used.
    Counts live_objects() const;
    // Returns how many destroyed objects were not alive, or outlived their device.
    std::size_t wrong_destructions() const { return wrong_destructions_; }
    VkInstance instance() const { return instance_; }  // the last one made

    // The wrappers use these.
    struct Function {
        const char* name;
        VkResult error;
        bool may_lose_device;
    };
    VkResult enter(const Function& function);
    std::uint64_t with_slack(std::uint64_t bytes);
    std::uint64_t without_slack(std::uint64_t bytes) const;
    void created(const char* type, void* handle);
    void destroyed(const char* type, void* handle);

  private:
    bool is_picked(const Function& function) const;
    void wait_for_devices() const;

    bool armed_ = false;
    Fault fault_;
    std::string function_;
    std::uint64_t structure_slack_ = 0;
    std::set<std::uint64_t> generous_;  // sizes reported with slack
    std::uint64_t calls_ = 0, injected_ = 0;
    std::string failed_;
    std::set<std::pair<std::string, void*>> live_;
    std::size_t wrong_destructions_ = 0;
    VkInstance instance_ = VK_NULL_HANDLE;
};

// Returns whether VMA has another way to the same memory, or only the freeing of memory waits for the answer.
bool may_be_harmless(const std::string& function);

enum class Outcome { done, error, lost };

// Return the outcome of an action, and the text of its Error.
Outcome outcome_of(const std::function<void()>& action, std::string* what = nullptr);
std::string what_is_thrown_by(const std::function<void()>& action);

}  // namespace twinray::faults
