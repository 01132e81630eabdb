// SPDX-License-Identifier: MIT
// Buffers in the host's memory: tests/install/host uses an allocator of its own; this one fails and breaks promises.
#include <cmath>
#include <set>

#include "engine/core/error.h"
#include <twinray/geometry.h>
#include <twinray/tlas.h>
#include "tests/core/host_device.h"

namespace twinray {
namespace {

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
