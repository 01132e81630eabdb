// SPDX-License-Identifier: MIT
// Plans of builds: where their memory lies, and how shares of a batch make room for it.
#include <algorithm>
#include <random>
#include <vector>

#include "engine/core/commands.h"
#include "engine/core/radix_sort.h"
#include "swtlas/plan.h"

#include <gtest/gtest.h>

namespace twinray {
namespace {

struct Region {
    const char* name;
    std::uint64_t begin, bytes;
};

// Returns all that a build has at one time. Places of leaves' records lie where the codes were.
std::vector<Region> regions_of(const BuildPlan& plan, const KernelTuning& tuning) {
    const BuildScratch& at = plan.scratch;
    const std::uint64_t n = plan.leaf_count, trees = plan.first.size();
    std::vector<Region> regions = {{"trees", at.trees, trees * sizeof(BuildTree)},
                                   {"chunks", at.chunks, plan.chunks.size() * sizeof(LeafChunk)},
                                   {"boxes", at.boxes, n * sizeof(LeafBox)},
                                   {"centroids", at.centroids, trees * sizeof(CentroidBounds)},
                                   {"codes", at.codes, n * sizeof(uint)},
                                   {"low codes", at.low_codes, n * sizeof(uint)},
                                   {"duplicates", at.duplicates, trees * sizeof(uint)},
                                   {"duplicate codes", at.duplicate_codes, sizeof(DuplicateCodes)},
                                   {"tree of", at.tree_of, plan.tree_bits ? n * sizeof(uint) : 0},
                                   {"other_bounds", at.other_bounds, n * sizeof(uint)},
                                   {"counters", at.counters, RadixSort::counter_bytes(n, tuning)},
                                   {"levels", at.levels, (plan.collapse_levels + 2) * sizeof(CollapseLevel)}};
    for (int i = 0; i < 2; ++i) {
        regions.push_back({"keys", at.keys[i], n * sizeof(uint)});
        regions.push_back({"order", at.order[i], n * sizeof(uint)});
    }
    if (has_records(plan.layout)) regions.push_back({"nodes", at.nodes, n * sizeof(BvhNode)});
    return regions;
}

void expect_apart(std::vector<Region> regions, std::uint64_t bytes) {
    std::sort(regions.begin(), regions.end(), [](const Region& a, const Region& b) {
        return a.begin != b.begin ? a.begin < b.begin : a.bytes < b.bytes;
    });
    for (std::size_t i = 0; i < regions.size(); ++i) {
        const Region& region = regions[i];
        EXPECT_EQ(region.begin % cache_line_bytes, 0u) << region.name;
        const std::uint64_t limit = i + 1 < regions.size() ? regions[i + 1].begin : bytes;
        EXPECT_LE(region.begin + region.bytes, limit) << region.name;
    }
}

KernelTuning tuning_of(TuningRow row) {
    DeviceProperties properties;
    properties.cpu_threads = 2;
    properties.shared_bytes = 64 << 10;
    properties.subgroup_size = 16;
    return tuning_for(properties, row);
}

class BuildPlans : public testing::TestWithParam<std::tuple<TuningRow, Layout>> {};
INSTANTIATE_TEST_SUITE_P(On, BuildPlans,
                         testing::Combine(testing::Values(TuningRow::cpu_driver, TuningRow::gpu),
                                          testing::ValuesIn(all_layouts)));

TEST_P(BuildPlans, RegionsBeginAtLinesOfCachesLieApartAndFitTheSumOfShares) {
    const auto& [row, layout] = GetParam();
    const KernelTuning tuning = tuning_of(row);
    std::mt19937 random(1);
    for (int round = 0; round < 300; ++round) {
        std::vector<uint> counts(1 + random() % 20);
        for (uint& count : counts) count = static_cast<uint>(random()) % (1u << random() % 18);
        const BuildPlan plan = plan_build(counts, layout, tuning);
        expect_apart(regions_of(plan, tuning), plan.scratch.bytes);
        std::uint64_t shares = 0;
        for (const uint count : counts) shares += scratch_share(count, layout, tuning);
        EXPECT_LE(plan.scratch.bytes, shares) << counts.size() << " trees";
    }
}

TEST_P(BuildPlans, ListsOfItemsFitWhereTheBoxesWere) {
    const auto& [row, layout] = GetParam();
    for (uint n = 1; n < 300; ++n) {
        const CollapseLists lists = collapse_lists(n);
        EXPECT_LE(lists.end * sizeof(CollapseItem), n * sizeof(LeafBox)) << n;
        EXPECT_LE(n / 2, lists.queues - lists.subtrees) << "subtrees of two leaves or more";
        EXPECT_LE(n / fewest_large_leaves, lists.level[1] - lists.level[0]) << n;
        EXPECT_LE(n / fewest_large_leaves, lists.subtrees - lists.level[1]) << n;
    }
    EXPECT_LE(fewest_large_leaves, plan_build({}, layout, tuning_of(row)).subtree_leaves + 1) << "what levels are for";
}

TEST(CollapseQueues, OfSubtreesAndTreesLieApart) {
    for (const uint width : {4u, 8u})
        for (uint leaves = 2; leaves < 5000; ++leaves)
            for (uint tree_first = 0; tree_first < 7; ++tree_first) {
                const uint most_nodes = width == 8 ? std::max((leaves - 1) / 3, 1u) : (2 * leaves - 1) / 3;
                for (uint before = 1; before < 4; ++before)
                    EXPECT_GE(queue_begin(tree_first, before + records_below(leaves, width)),
                              queue_begin(tree_first, before) + most_nodes)
                        << leaves << " leaves, records from " << before << " on";
                EXPECT_LE(queue_begin(tree_first, 1 + records_below(leaves, width)),
                          queue_begin(tree_first + leaves, 0))
                    << leaves;
            }
    EXPECT_EQ(queue_begin(4'000'000'000, 0), 3'333'333'333) << "beyond what 32 bits hold on the way";
}

TEST_P(BuildPlans, ChunksCoverEachTreeOnce) {
    const auto& [row, layout] = GetParam();
    const std::vector<uint> counts = {0, 1, BUILD_GROUP, 0, BUILD_GROUP + 1, 3 * BUILD_GROUP - 1, 5};
    const BuildPlan plan = plan_build(counts, layout, tuning_of(row));
    uint next = 0;
    std::vector<uint> covered(counts.size());
    for (const LeafChunk& chunk : plan.chunks) {
        EXPECT_EQ(chunk.first, next);
        EXPECT_GE(chunk.count, 1u) << "kernels count on it";
        EXPECT_LE(chunk.count, BUILD_GROUP);
        covered[chunk.tree] += chunk.count;
        next += chunk.count;
    }
    EXPECT_EQ(next, plan.leaf_count);
    EXPECT_EQ(covered, counts);
}

TEST_P(BuildPlans, PartsOfGeometriesAndScenesBeginAtLinesOfCaches) {
    const Layout layout = std::get<Layout>(GetParam());
    for (const uint count : {0u, 1u, 2u, 7u, 1000u}) {
        const GeometryLayout geometry = layout_geometry(count, count, layout);
        for (const std::uint64_t offset : {geometry.nodes, geometry.triangles, geometry.records, geometry.vertices})
            EXPECT_EQ(offset % cache_line_bytes, 0u) << count;
        const SceneLayout scene = layout_scene(count, layout);
        for (const std::uint64_t offset : {scene.nodes, scene.instances, scene.records})
            EXPECT_EQ(offset % cache_line_bytes, 0u) << count;
    }
}

}  // namespace
}  // namespace twinray
