// Plans of builds: where their memory lies, and how shares of a batch make room for it. The world boxes of instances,
// by the CPU reference, with which tests of builds compare those of the device.
#include <algorithm>

#include <random>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <twinray/geometry.h>
#include <twinray/scene.h>
#include "engine/core/commands.h"
#include "engine/core/radix_sort.h"
#include "swtlas/plan.h"
#include "validation/cpu_reference/reference_scene.h"

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

constexpr std::array layouts = all_layouts;

LeafBox placed(Layout layout, const Mesh& mesh, const Transform& transform) {
    reference::Scene scene(layout);
    const auto geometry = scene.add_geometry(mesh);
    for (int i = 0; i < 2; ++i)
        scene.add_instance(geometry, make_instance_record(transform));  // a lone one has a loose box
    scene.build();
    return scene.instance_boxes().front();
}

// The box around all vertices, in float64.
struct Exact {
    dvec3 lo = dvec3(INFINITY), hi = dvec3(-INFINITY);
};
Exact around(const std::vector<vec3>& points, const Transform& transform) {
    Exact box;
    for (const vec3& point : points) {
        dvec3 there;
        for (int axis = 0; axis < 3; ++axis)
            there[axis] = dot(dvec4(transform.rows[static_cast<std::size_t>(axis)]), dvec4(point, 1));
        box = {min(box.lo, there), max(box.hi, there)};
    }
    return box;
}
template <class Box>
double area(const Box& box) {
    const dvec3 size = dvec3(box.hi) - dvec3(box.lo);
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

std::vector<vec3> corners_of(const Mesh& mesh) {
    const Bounds bounds = bounds_of(mesh);
    std::vector<vec3> corners;
    for (uint i = 0; i < 8; ++i)
        corners.push_back(
            {i & 1 ? bounds.hi.x : bounds.lo.x, i & 2 ? bounds.hi.y : bounds.lo.y, i & 4 ? bounds.hi.z : bounds.lo.z});
    return corners;
}

Transform turned(float angle, vec3 axis) {
    return Transform::of(glm::rotate(glm::mat4(1), angle, to_glm(normalize(axis))));
}

Transform any_map(std::mt19937& random) {
    std::uniform_real_distribution<float> unit(-1, 1);
    const auto draw = [&] { return vec3(unit(random), unit(random), unit(random)); };
    const vec3 axis = draw() + vec3(0, 0, 2), size = exp2(8.0f * draw()), place = 1e4f * draw();
    return Transform::translation(place) * turned(3 * unit(random), axis) * Transform::scaling(size) *
           turned(3 * unit(random), draw() + vec3(2, 0, 0));
}

void expect_around(const LeafBox& box, const Exact& all, const std::string& what) {
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(double{box.lo[axis]}, all.lo[axis]) << what << ", axis " << axis;
        EXPECT_GE(double{box.hi[axis]}, all.hi[axis]) << what << ", axis " << axis;
    }
}

TEST(PlaceInstance, TheBoxHoldsTheGeometryUnderEveryMap) {
    std::mt19937 random(4);
    const Mesh meshes[] = {make_icosphere(2), make_soup(300, 3), make_soup(5, 1), make_soup(1, 1)};
    for (const Mesh& mesh : meshes)
        for (int i = 0; i < 20; ++i) {
            const Transform map = any_map(random);
            for (const Layout layout : layouts)
                expect_around(placed(layout, mesh, map), around(mesh.positions, map),
                              mesh.name + " in " + std::string(name_of(layout)));
        }
}

TEST(PlaceInstance, ARotatedBallHasABoxNearlyAsSmallAsItsOwn) {
    const Mesh ball = make_icosphere(4);
    for (const vec3 axis : {vec3(1, 1, 0), vec3(1, 2, 3), vec3(0, 0, 1)}) {
        const Transform map = Transform::translation({5, 0, 0}) * turned(0.8f, axis);
        const double least = area(around(ball.positions, map)), most = area(around(corners_of(ball), map));
        for (const Layout layout : layouts) {
            const double made = area(placed(layout, ball, map));
            EXPECT_GE(made, least) << name_of(layout);
            EXPECT_LT(made, least + 0.3 * (most - least)) << name_of(layout);
        }
    }
}

// If no box below the root's can be smaller, none is looked at.
TEST(PlaceInstance, MapsKnowWhetherTheyKeepAxes) {
    const auto keeps = [](const Transform& t) { return keeps_axes({t.rows[0], t.rows[1], t.rows[2]}); };
    EXPECT_TRUE(keeps(Transform{}));
    EXPECT_TRUE(keeps(Transform::translation({1, 2, 3}) * Transform::scaling({1, -2, 3})));
    EXPECT_TRUE(keeps({{vec4(0, 2, 0, 5), vec4(0, 0, -1, 0), vec4(1, 0, 0, 0)}}));
    EXPECT_FALSE(keeps({{vec4(1, 1e-30f, 0, 0), vec4(0, 1, 0, 0), vec4(0, 0, 1, 0)}}));
    EXPECT_FALSE(keeps({{vec4(1, 0, 0, 0), vec4(0, 1, -1e-30f, 0), vec4(0, 0, 1, 0)}}));
    EXPECT_FALSE(keeps({{vec4(1, 0, 0, 0), vec4(0, 1, 0, 0), vec4(-1, 0, 1, 0)}}));
}

// The boxes at both ends add products that are infinite with one sign and the other; the whole box does not.
TEST(PlaceInstance, MapsAtTheEndOfTheRangeLoseNothing) {
    Mesh mesh = make_soup(300, 3, 1e-6f);
    for (vec3& point : mesh.positions) {
        const float q = 2 * point.x - 1, x = q + std::copysign(2.4f, q);
        point = vec3(x, x + 0.1f * x * std::abs(x), point.z);
    }
    const Transform map{{vec4(1.5e38f, -1.5e38f, 1e37f, 0), vec4(1e37f, 1e37f, 0, 0), vec4(0, 0, 1e38f, 0)}};
    for (const Layout layout : layouts)
        expect_around(placed(layout, mesh, map), around(mesh.positions, map), std::string(name_of(layout)));
}

}  // namespace
}  // namespace twinray
