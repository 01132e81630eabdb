// Submissions: their order, how many items each gets, and what the error of a lost device says.
#include "engine/core/device_fault.h"
#include "engine/core/commands.h"
#include "engine/core/context.h"
#include "engine/core/vulkan.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

namespace twinray {
namespace {

TEST(PromisedPoints, PassInTheOrderInWhichTheyWerePromised) {
    PromisedPoints points;
    EXPECT_EQ(points.promise(), 1u);
    EXPECT_EQ(points.promise(), 2u);
    EXPECT_TRUE(points.is_due(1));
    EXPECT_FALSE(points.is_due(2));
    points.pass(1);
    EXPECT_TRUE(points.is_passed(1) && points.is_due(2));
}

TEST(PromisedPoints, ThoseGivenUpPassWithTheOneBefore) {
    PromisedPoints points;
    for (int i = 0; i < 4; ++i) points.promise();
    points.give_up(3);
    points.give_up(2);
    EXPECT_EQ(points.value_of(1), 3u);
    points.pass(1);
    EXPECT_EQ(points.last_passed(), 3u);
    EXPECT_EQ(points.value_of(4), 4u);
    EXPECT_TRUE(points.is_due(4));
}

constexpr double limit = 0.5;  // seconds

TEST(Pace, BeginsWithWhatTheSlowestDeviceCanDo) {
    EXPECT_EQ(first_items(0.5), 16384u);
    EXPECT_EQ(first_items(1), 32768u);
    EXPECT_EQ(first_items(1e-9), 64u) << "a group at least";
}

TEST(Pace, GrowsFourfoldWhileWorkIsShort) {
    EXPECT_EQ(next_items(16384, {16384, 1e-4}, limit), 65536u);
    EXPECT_EQ(next_items(16384, {16384, 0}, limit), 65536u) << "a clock that is too coarse";
    EXPECT_EQ(next_items(65536, {65536, 0.03125}, limit), 262144u) << "which is an eighth of a second";
}

TEST(Pace, AimsAtAQuarterOfTheLimit) {
    EXPECT_EQ(next_items(1 << 20, {1 << 20, 0.0625}, limit), 2u << 20);
    EXPECT_EQ(next_items(1 << 20, {1 << 20, 0.125}, limit), 1u << 20);
    EXPECT_EQ(next_items(1 << 20, {1 << 20, 1}, limit), 1u << 17) << "and shrinks at once";
    EXPECT_EQ(next_items(64, {64, 100}, limit), 64u);
    EXPECT_EQ(next_items(6400, {6400, 0.25}, limit), 3200u);
    EXPECT_EQ(next_items(6400, {6400, 0.26}, limit), 3072u) << "whole groups";
}

TEST(Pace, ARestIsNoMeasureUnlessItIsSlow) {
    EXPECT_EQ(next_items(1 << 20, {10, 1e-5}, limit), 1u << 20);
    EXPECT_EQ(next_items(1 << 20, {1 << 19, 0.25}, limit), 1u << 18);
}

TEST(Pace, KeepsBelowTheLimitWhereNeighboursTakeUpToFourTimesAsLong) {
    for (unsigned seed = 0; seed < 200; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> exponent(5.5, 11), deviation(-1, 1);
        const double usual = std::pow(10, exponent(random));  // items a second
        std::uint64_t allowed = first_items(limit);
        double seconds = 0;
        for (int submission = 0; submission < 50; ++submission) {
            seconds = static_cast<double>(allowed) / (usual * std::exp2(deviation(random)));
            ASSERT_LE(seconds, limit * (1 + 1e-9)) << "seed " << seed << ", submission " << submission;
            allowed = next_items(allowed, {allowed, seconds}, limit);
        }
        EXPECT_GE(seconds, limit / 16 * (1 - 1e-9)) << "no shorter than it must be, seed " << seed;
    }
}

TEST(Pace, PassesThatNobodyMeasuresShareASubmissionWhereTheyAreSmall) {
    EXPECT_EQ(most_groups(0.5), 16384u);
    EXPECT_EQ(most_groups(1e-9), 0u);
    EXPECT_EQ(most_groups(0), UINT64_MAX) << "no limit";
}

TEST(SubmissionLog, WhatIsDoneIsNotTold) {
    SubmissionLog work;
    EXPECT_EQ(work.sentence(), "");
    work.submitted(1, "sync", {{"swtlas_morton", 7}, {"sort_scan", 1}});
    work.submitted(2, "trace", {{"swtlas_trace closest", 625}});
    EXPECT_EQ(work.sentence(),
              "; in flight: 'sync' (2 passes: 'swtlas_morton' of 7 groups, 'sort_scan' of 1 groups), 'trace' (1 pass: "
              "'swtlas_trace closest' of 625 groups)");
    work.reached(1);
    EXPECT_EQ(work.sentence(), "; in flight: 'trace' (1 pass: 'swtlas_trace closest' of 625 groups)");
    work.reached(2);
    EXPECT_EQ(work.sentence(), "");
}

TEST(SubmissionLog, LargePassesComeFirstAndTheRestIsCounted) {
    SubmissionLog work;
    work.submitted(1, "a", {{"copy", 0}, {"small", 1}, {"large", 9}, {"middle", 5}});
    for (std::uint64_t value = 2; value < 6; ++value) work.submitted(value, "b", {{"copy", 0}});
    EXPECT_EQ(
        work.sentence(),
        "; in flight: 'a' (4 passes: 'large' of 9 groups, 'middle' of 5 groups, 'small' of 1 groups, ...), 'b' (1 "
        "pass: 'copy'), 'b' (1 pass: 'copy'), and 2 more");
}

// No driver here has VK_EXT_device_fault: these structs stand in for its data.
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

// Acts as a driver that tells one address of two that it promised.
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
