// SPDX-License-Identifier: MIT
// Records of trees at the ends of their range; saved_test.cpp tests what the checker refuses.
#include <cmath>
#include <random>

#include "engine/accel/geometry.h"
#include "swtlas/check.h"
#include "validation/cpu_reference/reference.h"
#include "tests/support/tall_tree.h"

#include <gtest/gtest.h>

namespace twinray {
namespace {

TEST(Compressed, PlanesLieOutsideAtAnySizeAndPlace) {
    std::mt19937 random(9);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (int i = 0; i < 20'000; ++i) {
        const auto power = [&](int range) {
            return std::ldexp(1.0f, static_cast<int>(random() % (2 * range)) - range);
        };
        const vec3 place = vec3(unit(random), unit(random), unit(random)) * power(100);
        const float size = power(100);
        NodeChildren children{};
        std::vector<LeafBox> boxes;
        children.count = 2 + static_cast<uint>(random() % 3);
        for (uint child = 0; child < children.count; ++child) {
            const vec3 a = place + size * vec3(unit(random), unit(random), unit(random));
            const vec3 b = random() % 4 ? place + size * vec3(unit(random), unit(random), unit(random)) : a;
            children.box[child] = {min(a, b), max(a, b)};
            boxes.push_back(children.box[child]);
        }
        std::vector<CompressedRecord> records = {
            encode_node(children, given_order((1u << children.count) - 1, 0), 1, 4).first};
        for (uint child = 0; child < children.count; ++child) records.push_back(encode_instance(child));
        LeafBox all = empty_box();
        for (const LeafBox& box : boxes) all = {min(all.lo, box.lo), max(all.hi, box.hi)};
        const Bvh bvh{all.lo, all.hi, {}, 0, children.count};
        const TreeCheck check = check_tree(bvh, records, boxes);
        ASSERT_TRUE(check.violations.empty()) << check.violations.front();
    }
    EXPECT_LT(record_count(static_cast<uint>(Geometry::max_primitives), 8), MOST_RECORDS);
}

TEST(Compressed, OriginsKeepAnExponentAndLieCloseBelow) {
    std::mt19937 random(3);
    for (int i = 0; i < 100'000; ++i) {
        const auto bits = static_cast<uint>(random() & 0x80ffffffu) | static_cast<uint>(random() % 0xf8) << 23;
        const float limit = uintBitsToFloat(bits);
        const auto exponent = 1 + static_cast<uint>(random() % 253);
        const float origin = origin_below(limit, exponent);
        EXPECT_EQ(floatBitsToUint(origin) & 0x1ffu, exponent) << limit;
        EXPECT_LE(origin, limit) << exponent;
        EXPECT_LE(double{limit} - double{origin}, std::ldexp(std::abs(double{limit}), -14) + 0x1p-140) << exponent;
    }
}

TEST(RecordCheck, RecordsBelowDifferentChildrenMayNotMix) {
    const LeafBox box{vec3(0), vec3(1)};
    NodeChildren children{};
    children.count = 2;
    children.box[0] = children.box[1] = box;
    const auto node = [&](uint first) { return encode_node(children, given_order(3, 0), first, 4).first; };
    const auto violations = [&](uint of_first, uint of_second, uint of_grandchild) {
        std::vector<CompressedRecord> records = {node(1), node(of_first), node(of_second)};
        for (uint leaf = 0, record = 3; record < 9; ++record)
            records.push_back(record == of_first ? node(of_grandchild) : encode_instance(leaf++));
        const std::vector<LeafBox> boxes(5, box);
        return check_tree({box.lo, box.hi, {}, 0, 5}, records, boxes).violations;
    };
    EXPECT_EQ(violations(3, 7, 5), std::vector<std::string>{});
    EXPECT_EQ(violations(3, 5, 7), std::vector<std::string>{"records below the children of record 0 mix"});
}

// Their sizes are infinite, and the middles of some are NaN.
TEST(Compressed, BoxesWithoutAnEndAreLeavesAsAnyOther) {
    const vec3 most(3e38f), end(INFINITY);
    for (const uint width : {4u, 8u})
        for (const uint n : {2u, 4u, 8u, 16u, 100u}) {
            std::vector<LeafBox> boxes(n, {-most, most});
            boxes[n / 2] = {-end, end};
            boxes[n - 1] = {vec3(0, -INFINITY, 0), vec3(1, INFINITY, 1)};
            const reference::Codes codes = reference::morton(boxes, reference::centroids(boxes));
            const reference::Hierarchy tree = reference::hierarchy(boxes, codes, reference::sort(codes), false);
            const std::vector<CompressedRecord> records = reference::records_of_instances(tree, n, width);
            ASSERT_EQ(records.size(), record_count(n, width));
            const TreeCheck check = check_tree({tree.box.lo, tree.box.hi, {}, 0, n}, records, boxes);
            for (const std::string& violation : check.violations)
                EXPECT_NE(violation.find("lies in planes"), std::string::npos)  // planes end at 2^120
                    << n << " leaves, nodes of " << width << ": " << violation;
        }
}

class CompressedPaths : public testing::TestWithParam<uint> {};
INSTANTIATE_TEST_SUITE_P(OfNodesOf, CompressedPaths, testing::Values(4u, 8u));

TEST_P(CompressedPaths, AreNoDeeperThanAStackIsMadeFor) {
    std::vector<LeafBox> leaf_boxes;
    float size = 0x1p-100f;
    for (uint i = 0; i < test::TallTree::leaves; ++i) {
        leaf_boxes.push_back({vec3(-size), vec3(size)});
        if (i % 4 == 0) size *= 4;
    }
    const test::TallTree tall(leaf_boxes);
    const Bvh binary{tall.tree.box.lo, tall.tree.box.hi, {}, tall.tree.root, tall.leaves};
    const TreeCheck tree = check_tree(binary, reference::linked(tall.tree).nodes, tall.boxes);
    EXPECT_TRUE(tree.violations.empty()) << tree.violations.front();
    EXPECT_EQ(tree.depth, DEEPEST_TREE);
    const TreeCheck check = check_tree(tall.bvh_of_records(),
                                       reference::records_of_instances(tall.tree, tall.leaves, GetParam()), tall.boxes);
    EXPECT_TRUE(check.violations.empty()) << check.violations.front();
    EXPECT_LE(check.depth, DEEPEST_RECORDS);
    if (GetParam() == 4) {
        EXPECT_EQ(check.depth, DEEPEST_RECORDS);
    }
}

}  // namespace
}  // namespace twinray
