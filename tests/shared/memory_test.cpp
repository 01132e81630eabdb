// Memory as kernels read and write it, in words: positions and indices, boxes, and numbers of 16 bits. Shares of work
// for groups, and of groups for the threads of a CPU.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <vector>

#include <twinray/context.h>
#include "engine/accel/mesh_gather.h"
#include "engine/accel/trace_program.h"
#include "swtlas/structures.h"

namespace twinray {
namespace {

TEST(LoadThree, OfPositionsAndIndices) {
    const std::vector<float> positions = {0.0f, -1.5f, 2.0f, 3.25f, -0.0f, 1e-45f, 6.0f, 7.0f, 8.0f};
    for (uint vertex = 0; vertex < 3; ++vertex) {
        const vec3 loaded = load_position(Floats::to(positions.data()), vertex);
        EXPECT_EQ(std::memcmp(&loaded, &positions[std::size_t{3} * vertex], sizeof loaded), 0) << vertex;
    }
    const std::vector<uint> indices = {1, 2, 3, 40, 50, 60, 7, 8, 9};
    EXPECT_EQ(load_indices(Uints::to(indices.data()), 1), uvec3(40, 50, 60));
    EXPECT_EQ(load_indices(Uints::to(indices.data()), 2), uvec3(7, 8, 9));
}

TEST(BoxWords, AreTheFloatsOfTheBox) {
    const LeafBox boxes[] = {{vec3(1, -2, 3), vec3(4, 5, -6)},
                             empty_box(),
                             {vec3(-0.0f, 1e-45f, 3.4e38f), vec3(0.0f, -1e-45f, std::nanf("7"))}};
    std::vector<LeafBox> stored(5, {vec3(7), vec3(8)});
    const std::vector<LeafBox> before = stored;
    for (uint i = 0; i < 3; ++i) store_box(Ref<LeafBox>::to(stored.data()), i + 1, boxes[i]);
    EXPECT_EQ(std::memcmp(&stored[1], boxes, sizeof boxes), 0);
    EXPECT_EQ(std::memcmp(&stored[0], &before[0], sizeof(LeafBox)), 0) << "the one before is as it was";
    EXPECT_EQ(std::memcmp(&stored[4], &before[4], sizeof(LeafBox)), 0) << "and the one behind";
    for (uint i = 0; i < 3; ++i) {
        const LeafBox loaded = load_box(Ref<LeafBox>::to(stored.data()), i + 1);
        EXPECT_EQ(std::memcmp(&loaded, &boxes[i], sizeof loaded), 0) << i;
    }
}

// Returns the value of a number of 16 bits in float64.
double half_value(uint bits) {
    const double sign = bits & 0x8000u ? -1 : 1;
    const int exponent = static_cast<int>(bits >> 10 & 31u);
    const double fraction = bits & 1023u;
    if (exponent == 31) return fraction != 0 ? NAN : sign * INFINITY;
    return sign * (exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25));
}

TEST(GatherMesh, EveryHalfIsItsValue) {
    for (uint bits = 0; bits < 65536; ++bits) {
        const double value = half_value(bits);
        const float decoded = float_of_half(bits);
        if (std::isnan(value)) {
            EXPECT_TRUE(std::isnan(decoded)) << bits;
            continue;
        }
        EXPECT_EQ(double(decoded), value) << bits;
        EXPECT_EQ(std::signbit(decoded), std::signbit(value)) << bits;
    }
}

TEST(GatherMesh, EveryNormalizedNumberIsItsQuotientRoundedOnce) {
    for (int value = -32768; value < 32768; ++value)
        EXPECT_EQ(float_of_snorm16(static_cast<uint>(value) & 0xffffu),
                  value == -32768 ? -1.0f : static_cast<float>(value / 32767.0))
            << value;
}

std::vector<uint> dealt(uint count, uint threads) {
    std::vector<uint> groups(count);
    for (uint i = 0; i < count; ++i) groups[i] = interleaved_group(i, count, threads);
    return groups;
}

std::vector<uint> in_order(uint count) {
    std::vector<uint> groups(count);
    std::iota(groups.begin(), groups.end(), 0u);
    return groups;
}

TEST(DealtGroups, AreAllOfThemOnce) {
    for (const uint threads : {0u, 1u, 2u, 3u, 16u, 64u})
        for (const uint count : {1u, 2u, 3u, 15u, 16u, 17u, 64u, 1000u, 16'384u}) {
            std::vector<uint> groups = dealt(count, threads);
            std::sort(groups.begin(), groups.end());
            EXPECT_EQ(groups, in_order(count)) << count << " to " << threads;
        }
}

TEST(DealtGroups, GoToEachStretchInTurn) {
    EXPECT_EQ(dealt(11, 3), (std::vector<uint>{0, 3, 6, 1, 4, 7, 2, 5, 8, 9, 10}));
    EXPECT_EQ(dealt(8, 2), (std::vector<uint>{0, 2, 4, 6, 1, 3, 5, 7}));
}

TEST(DealtGroups, StayWithoutTwoHandsAndWhereGroupsAreFewer) {
    EXPECT_EQ(dealt(1000, 0), in_order(1000));
    EXPECT_EQ(dealt(1000, 1), in_order(1000));
    EXPECT_EQ(dealt(5, 16), in_order(5));
}

TEST(RunsOfBlocks, HoldAllItemsAndLeaveNoGroupWithoutNeed) {
    for (const uint items : {0u, 1u, 15u, 16u, 17u, 1000u, 262'144u, 4'294'967'295u})
        for (const uint size : {8u, 16u, 64u})
            for (const uint groups : {1u, 2u, 7u, 32u, 4096u}) {
                const std::uint64_t run = run_of_blocks(items, size, groups),
                                    least = std::uint64_t{items} / size / groups;
                EXPECT_GE(run * groups * size, items) << items << " by " << size << " in " << groups;
                EXPECT_LE(run, least + 1) << items << " by " << size << " in " << groups;
            }
    EXPECT_EQ(run_of_blocks(64, 64, 1), 1u);
    EXPECT_EQ(run_of_blocks(65, 64, 1), 2u);
}

// Returns how many groups Kernel::dispatch_groups launches, with which trace.comp finds its rays.
std::uint64_t launched(std::uint64_t groups) {
    return groups <= GROUPS_PER_ROW ? groups : (groups + GROUPS_PER_ROW - 1) / GROUPS_PER_ROW * GROUPS_PER_ROW;
}

KernelTuning on_cpu(uint lanes, uint threads) {
    DeviceProperties properties;
    properties.subgroup_size = lanes;
    properties.cpu_threads = threads;
    return tuning_for(properties, TuningRow::cpu_driver);
}

TEST(GroupsForRays, TraceEachRayOnce) {
    const KernelTuning cpu = on_cpu(8, 3);
    for (const uint rays : {1u, 7u, 8u, 9u, 500u, 1024u, 4097u, 100'000u}) {
        const RayGroups launch = groups_for_rays(rays, cpu, true);
        const auto groups = static_cast<uint>(launched(launch.count));
        for (const uint count : {rays, rays / 3, 0u}) {  // the device may know of fewer
            std::vector<uint> traced(count, 0);
            const uint run = run_of_blocks(count, launch.size, groups);
            for (uint i = 0; i < groups * launch.size; ++i) {
                const uint group = interleaved_group(i / launch.size, groups, cpu.threads);
                const uint first = group * run * launch.size + i % launch.size;
                for (uint k = 0; k < run && first + k * launch.size < count; ++k) ++traced[first + k * launch.size];
            }
            EXPECT_EQ(traced, std::vector<uint>(count, 1)) << count << " of " << rays;
        }
    }
}

TEST(GroupsForRays, CountInThirtyTwoBits) {
    for (const uint lanes : {4u, 8u, 16u})
        for (const uint threads : {1u, 2u, 64u}) {
            const RayGroups launch = groups_for_rays(UINT32_MAX, on_cpu(lanes, threads), true);
            const std::uint64_t groups = launched(launch.count);
            const std::uint64_t run = run_of_blocks(UINT32_MAX, launch.size, static_cast<uint>(groups));
            EXPECT_LE(groups * run * launch.size, std::uint64_t{1} << 32)
                << lanes << " lanes, " << threads << " threads";
        }
}

TEST(GroupsForRays, AreOneForSixtyFourButOnCpusBySoftware) {
    const KernelTuning gpu, cpu = on_cpu(16, 2);
    for (const bool is_software : {false, true}) {
        EXPECT_EQ(groups_for_rays(1000, gpu, is_software).size, 64u);
        EXPECT_EQ(groups_for_rays(1000, gpu, is_software).count, 16u);
    }
    EXPECT_EQ(groups_for_rays(1000, cpu, false).count, 16u);
    EXPECT_EQ(groups_for_rays(1000, cpu, true).size, 16u);
    EXPECT_EQ(groups_for_rays(1'000'000, cpu, true).count, 977u) << "1024 rays each";
    EXPECT_EQ(groups_for_rays(10'000, cpu, true).count, 32u) << "16 for each thread";
    EXPECT_EQ(groups_for_rays(40, cpu, true).count, 3u) << "no more than there are vectors of rays";
    EXPECT_EQ(groups_for_rays(1, cpu, true).count, 1u);
    EXPECT_EQ(groups_for_rays(1, on_cpu(6, 2), true).size, 4u) << "a power of two";
    EXPECT_EQ(groups_for_rays(1, on_cpu(0, 2), true).size, 1u);
}

}  // namespace
}  // namespace twinray
