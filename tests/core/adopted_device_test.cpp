// A device that the host made: both accelerators trace on it, and submissions wait on a timeline of the host. Buffers
// in the host's memory: tests/install/host uses an allocator of its own; this one fails and breaks promises.
#include <atomic>

#include <chrono>
#include <thread>

#include <twinray/queries.h>
#include <twinray/tlas.h>
#include "tests/core/host_device.h"
#include "tests/scene/temp_dir.h"
#include "tests/support/caller.h"

namespace twinray {
namespace {

class AdoptedDeviceTest : public test::HostTest {
  protected:
    // Expects an Error that says this when the device is adopted.
    void expect_refusal(const std::string& part) {
        test::expect_error(part, [&] { const Context context(host_.device); });
    }
};

void expect_both_trace(const AdoptedDevice& device) {
    Context context(device);
    std::vector<std::unique_ptr<AbstractAccel>> accels;
    accels.push_back(std::make_unique<SwTlas>(context));
    if (missing_for_hardware(context.properties()).empty()) accels.push_back(std::make_unique<HwTlas>(context));
    for (const std::unique_ptr<AbstractAccel>& accel : accels) {
        accel->push(make_box(vec3(-1), vec3(1)));
        const Ray ray{vec3(0.25f, 0.5f, 5), 0, vec3(0, 0, -1), INFINITY};
        EXPECT_EQ(accel->closest_hits(std::span(&ray, 1)).front().t, 4.0f) << accel->name();
    }
}

TEST_F(AdoptedDeviceTest, BothAcceleratorsTraceOnIt) {
    ASSERT_TRUE(host_.create());
    expect_both_trace(host_.device);
    EXPECT_EQ(host_.locked, 0) << "each lock of the queue is undone";
    EXPECT_GT(host_.submissions, 0);
    EXPECT_TRUE(host_.device.enabled.shader_int64) << "as the host enabled it";
}

TEST_F(AdoptedDeviceTest, TheHostSaysHowLongASubmissionMayTake) {
    ASSERT_TRUE(host_.create());
    host_.device.most_submission_seconds = 0.125;
    EXPECT_EQ(Context(host_.device).state().tuning().most_submission_seconds, 0.125);
}

// The layer complains of a queue that two threads use at once.
TEST_F(AdoptedDeviceTest, TheHostSubmitsFromAnotherThreadUnderTheSameLock) {
    ASSERT_TRUE(host_.create());
    std::mutex mutex;
    host_.device.lock_queue = [&] { mutex.lock(); };
    host_.device.unlock_queue = [&] { mutex.unlock(); };
    std::atomic<bool> is_over = false;
    std::thread other([&] {
        while (!is_over) {
            {
                const std::lock_guard lock(mutex);
                vkQueueSubmit(host_.device.queue, 0, nullptr, VK_NULL_HANDLE);
            }
            // Otherwise the validation layer falls behind, and reports that it has waited for 10 s.
            std::this_thread::sleep_for(std::chrono::microseconds(50));
        }
    });
    {
        Context context(host_.device);
        for (int i = 0; i < 500; ++i) Commands(context, "nothing").submit();
    }
    is_over = true;
    other.join();
}

// The host has features and extensions of its own, some of them the same: the layer would complain of duplicates.
TEST_F(AdoptedDeviceTest, BothAcceleratorsTraceOnADeviceThatEnablesMore) {
    VkPhysicalDeviceVulkan12Features own{};
    own.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    own.hostQueryReset = VK_TRUE;
    VkPhysicalDeviceFeatures old_style{};
    const char* extensions[] = {VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME};
    host_.extend = [&](VkDeviceCreateInfo& info) {
        old_style.shaderFloat64 = host_.supported.shader_float64;
        info.pNext = &own;
        info.pEnabledFeatures = &old_style;
        info.enabledExtensionCount = host_.supported.acceleration_structure ? 1 : 0;
        info.ppEnabledExtensionNames = extensions;
    };
    ASSERT_TRUE(host_.create());
    EXPECT_TRUE(own.hostQueryReset && own.timelineSemaphore);
    EXPECT_EQ(host_.device.enabled.shader_float64, host_.supported.shader_float64);
    expect_both_trace(host_.device);
}

TEST_F(AdoptedDeviceTest, SoftwareAloneTracesWithoutTheExtensions) {
    host_.wants_hardware = false;
    ASSERT_TRUE(host_.create());
    EXPECT_FALSE(missing_for_hardware(host_.device.enabled).empty());
    expect_both_trace(host_.device);
}

// The error comes before a kernel is made: SwiftShader ends the process if one computes in float64.
TEST_F(AdoptedDeviceTest, DistancesAndContactsNeedFloat64) {
    host_.wants_float64 = false;
    ASSERT_TRUE(host_.create());
    Context context(host_.device);
    const std::string need = "need float64 (shaderFloat64), which device";
    test::expect_error(need, [&] { PointQuery query(context); });
    test::expect_error(need, [&] { NarrowPhase phase(context); });
}

// A host that tells what the driver supports instead of what it enabled.
TEST_F(AdoptedDeviceTest, AnExtensionThatWasNotEnabledIsNotBelieved) {
    host_.wants_hardware = false;
    ASSERT_TRUE(host_.create());
    if (!host_.supported.acceleration_structure) TWINRAY_LACKS("ray_tracing", "no ray tracing extensions");
    host_.device.enabled = host_.supported;
    expect_refusal("VK_KHR_acceleration_structure is listed as enabled, but the VkDevice was created without");
}

TEST_F(AdoptedDeviceTest, WhatItLacksIsRefusedInWords) {
    ASSERT_TRUE(host_.create());
    const AdoptedDevice whole = host_.device;
    host_.device.enabled.timeline_semaphore = false;
    expect_refusal("twinray needs timelineSemaphore because it never waits for the GPU");
    host_.device = whole;
    host_.device.api_version = VK_API_VERSION_1_1;
    expect_refusal("twinray needs Vulkan 1.2");
    host_.device = whole;
    host_.device.queue_family = 99;
    expect_refusal("queue family 99 does not exist");
}

// The layer would complain of a cache that is destroyed twice.
TEST_F(AdoptedDeviceTest, PipelinesGoIntoTheHostsCache) {
    ASSERT_TRUE(host_.create());
    VkPipelineCacheCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO;
    VkPipelineCache& cache = host_.device.pipeline_cache;
    ASSERT_EQ(vkCreatePipelineCache(host_.device.device, &info, nullptr, &cache), VK_SUCCESS);
    EXPECT_EQ(Context(host_.device).state().pipeline_cache(), cache);
    expect_both_trace(host_.device);
    vkDestroyPipelineCache(host_.device.device, cache, nullptr);
}

class WaitTest : public test::VulkanTest {
  protected:
    void prepare() override { caller_.emplace(context()); }
    void TearDown() override {
        caller_.reset();
        VulkanTest::TearDown();
    }
    std::optional<test::Caller> caller_;
};

TEST_F(WaitTest, ASubmissionSeesWhatTheHostWroteBeforeItsSignal) {
    const Buffer from(context(), {.name = "from", .bytes = 4, .memory = Memory::upload});
    const Buffer to(context(), {.name = "to", .bytes = 4, .memory = Memory::readback});
    const auto write = [&](uint value) { std::memcpy(from.mapped(), &value, 4); };
    write(1);
    Commands commands(context(), "copy");
    {
        const auto pass = commands.pass("copy");
        commands.copy(from, 0, to, 0, 4);
    }
    context().wait_before_next_submission(caller_->begin().done, VK_PIPELINE_STAGE_TRANSFER_BIT);
    const SyncPoint copied = commands.submit();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_FALSE(context().is_reached(copied));
    write(2);
    caller_->signal();
    context().wait(copied);
    uint value = 0;
    std::memcpy(&value, to.mapped(), 4);
    EXPECT_EQ(value, 2u);
    // The next one does not wait again: the layer would complain of a semaphore that is gone.
    caller_.reset();
    context().wait(Commands(context(), "does not wait").submit());
}

TEST_F(WaitTest, AWaitForNothingIsRefused) {
    EXPECT_THROW(context().wait_before_next_submission({}), Error);
    const SyncPoint done = caller_->begin().done;
    EXPECT_THROW(context().wait_before_next_submission({done.semaphore, 0}), Error);
    EXPECT_THROW(context().wait_before_next_submission(done, 0), Error);
    context().wait(Commands(context(), "does not wait").submit());
}

// Gives each buffer a VkDeviceMemory.
class HostMemory {
  public:
    explicit HostMemory(const AdoptedDevice& device) : device_(device) {}
    AllocatorHooks hooks() {
        return {[](void* user, const BufferRequest& request, AllocatedBuffer& result) {
                    return static_cast<HostMemory*>(user)->allocate(request, result);
                },
                [](void* user, const AllocatedBuffer& buffer) { static_cast<HostMemory*>(user)->free(buffer); }, this};
    }
    std::size_t live() const { return live_.size(); }
    std::size_t made = 0;
    std::size_t fails_at = SIZE_MAX;  // of `made`
    bool forgets_buffer = false, forgets_mapping = false, misplaces = false;

  private:
    VkResult allocate(const BufferRequest& request, AllocatedBuffer& result);
    std::uint32_t memory_type(std::uint32_t allowed, VkMemoryPropertyFlags wanted) const;
    VkDeviceAddress address_of(VkBuffer buffer) const {
        VkBufferDeviceAddressInfo info{};
        info.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO;
        info.buffer = buffer;
        return vkGetBufferDeviceAddress(device_.device, &info);
    }
    void free(const AllocatedBuffer& buffer) {
        EXPECT_EQ(live_.erase(buffer.buffer), 1u);
        vkDestroyBuffer(device_.device, buffer.buffer, nullptr);
        vkFreeMemory(device_.device, static_cast<VkDeviceMemory>(buffer.allocation), nullptr);
    }

    const AdoptedDevice& device_;
    std::set<VkBuffer> live_;
};

std::uint32_t HostMemory::memory_type(std::uint32_t allowed, VkMemoryPropertyFlags wanted) const {
    VkPhysicalDeviceMemoryProperties properties;
    vkGetPhysicalDeviceMemoryProperties(device_.physical_device, &properties);
    for (std::uint32_t i = 0; i < properties.memoryTypeCount; ++i)
        if ((allowed >> i & 1) && (properties.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
    return 0;
}

VkResult HostMemory::allocate(const BufferRequest& request, AllocatedBuffer& result) {
    if (made++ == fails_at) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    if (forgets_buffer) return VK_SUCCESS;
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = request.bytes;
    info.usage = request.usage;
    vkCreateBuffer(device_.device, &info, nullptr, &result.buffer);
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device_.device, result.buffer, &needs);
    EXPECT_TRUE(misplaces || 256 % request.alignment == 0) << "memory of its own is aligned to no more on every device";
    VkMemoryAllocateFlagsInfo address{};
    address.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO;
    address.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    VkMemoryAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    allocate.pNext = &address;
    allocate.allocationSize = needs.size + needs.alignment;  // room to misplace it
    allocate.memoryTypeIndex =
        memory_type(needs.memoryTypeBits, request.memory == Memory::device ? VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT
                                                                           : VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                                                                 VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    VkDeviceMemory memory = VK_NULL_HANDLE;
    EXPECT_EQ(vkAllocateMemory(device_.device, &allocate, nullptr, &memory), VK_SUCCESS);
    vkBindBufferMemory(device_.device, result.buffer, memory, 0);
    if (misplaces && address_of(result.buffer) % request.alignment == 0) {
        vkDestroyBuffer(device_.device, result.buffer, nullptr);
        vkCreateBuffer(device_.device, &info, nullptr, &result.buffer);
        vkGetBufferMemoryRequirements(device_.device, result.buffer, &needs);
        vkBindBufferMemory(device_.device, result.buffer, memory, needs.alignment);
    }
    if (request.memory != Memory::device && !forgets_mapping)
        vkMapMemory(device_.device, memory, 0, VK_WHOLE_SIZE, 0, &result.mapped);
    result.allocation = memory;
    live_.insert(result.buffer);
    return VK_SUCCESS;
}

class HostAllocator : public test::HostTest {
  protected:
    void SetUp() override {
        test::HostTest::SetUp();
        if (IsSkipped()) return;
        ASSERT_TRUE(host_.create());
        host_.device.allocator = memory_.hooks();
    }
    void TearDown() override { EXPECT_EQ(memory_.live(), 0u) << "buffers that twinray did not give back"; }
    // Returns the failure when the memory breaks its promise `breaks` from then on.
    std::string failure_of(const BufferDesc& desc, bool HostMemory::*breaks) {
        Context context(host_.device);
        memory_.*breaks = true;
        try {
            const Buffer buffer(context, desc);
        } catch (const Error& error) {
            EXPECT_EQ(context.allocated_bytes(), 0u);
            memory_.*breaks = false;
            return error.what();
        }
        memory_.*breaks = false;
        return "no failure";
    }
    HostMemory memory_{host_.device};
};

std::vector<Hit> hits_of(AbstractAccel& accel) {
    accel.push(make_box(vec3(-1), vec3(1)));
    const Ray ray{vec3(0.25f, 0.5f, 5), 0, vec3(0, 0, -1), INFINITY};
    return accel.closest_hits(std::span(&ray, 1));
}

std::unique_ptr<AbstractAccel> make(Context& context, bool hardware) {
    if (hardware) return std::make_unique<HwTlas>(context);
    return std::make_unique<SwTlas>(context);
}

TEST_F(HostAllocator, ServesBothAccelerators) {
    Context context(host_.device);
    const std::size_t own = memory_.live();  // the memory of the context itself
    for (const bool hardware : {false, true}) {
        if (hardware && !missing_for_hardware(context.properties()).empty()) continue;
        const std::size_t before = memory_.made;
        EXPECT_EQ(hits_of(*make(context, hardware)).front().t, 4.0f);
        EXPECT_GT(memory_.made, before);
    }
    EXPECT_GT(memory_.live(), own);
    context.wait_for_gpu();
    EXPECT_EQ(memory_.live(), own) << "freed when the GPU is done";
    EXPECT_EQ(context.allocated_bytes(), 0u);
}

// The n-th allocation fails, for every possible n.
TEST_F(HostAllocator, AFailureAnywhereIsAnErrorAndLeaksNothing) {
    Context context(host_.device);
    const std::size_t own = memory_.live();
    for (const bool hardware : {false, true}) {
        if (hardware && !missing_for_hardware(context.properties()).empty()) continue;
        bool has_failed = true;
        for (std::size_t n = 0; has_failed; ++n) {
            has_failed = false;
            memory_.made = 0;
            memory_.fails_at = n;
            try {
                hits_of(*make(context, hardware));
            } catch (const Error& error) {
                has_failed = true;
                EXPECT_NE(std::string(error.what()).find("out of device memory"), std::string::npos) << error.what();
            }
            EXPECT_EQ(has_failed, memory_.made > n);
            context.wait_for_gpu();
            EXPECT_EQ(memory_.live(), own) << "after failure " << n;
        }
    }
}

TEST_F(HostAllocator, SuccessWithoutABufferIsNotBelieved) {
    EXPECT_EQ(failure_of({.name = "b", .bytes = 8}, &HostMemory::forgets_buffer),
              "buffer 'b' of 8 bytes: the host's allocator reports success but gave no buffer");
}

TEST_F(HostAllocator, MemoryForTheHostMustBeMapped) {
    EXPECT_EQ(failure_of({.name = "b", .bytes = 8}, &HostMemory::forgets_mapping), "no failure");
    EXPECT_EQ(failure_of({.name = "b", .bytes = 8, .memory = Memory::upload}, &HostMemory::forgets_mapping),
              "buffer 'b' of 8 bytes: the host's allocator reports success but gave memory that is not mapped");
}

TEST_F(HostAllocator, TheAddressMustBeAligned) {
    const std::string failure = failure_of({.name = "b", .bytes = 8, .alignment = 1 << 16}, &HostMemory::misplaces);
    EXPECT_NE(failure.find("it must be a multiple of 65536 and not 0"), std::string::npos) << failure;
}

TEST_F(HostAllocator, OneHookAloneIsRefused) {
    host_.device.allocator.free = nullptr;
    EXPECT_THROW(Context context(host_.device), Error);
}

}  // namespace
}  // namespace twinray
