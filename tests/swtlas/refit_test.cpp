// Refitted trees; costs of trees by quality of the build, and end_point_overlap() against its definition.
#include <glm/gtc/matrix_transform.hpp>
#include "validation/cpu_reference/reference.h"
#include "tests/support/sw_build.h"

namespace twinray {
namespace {

using namespace test;

class SwRefit : public SwBuildTest {};
INSTANTIATE_TEST_SUITE_P(Every, SwRefit, builds_of_the_default_layout(), name_of_build);
INSTANTIATE_TEST_SUITE_P(Full, SwRefit, builds_of_other_layouts(), name_of_build);

void expect_same_topology(const BuiltTree& after, const BuiltTree& before) {
    ASSERT_EQ(after.nodes.size(), before.nodes.size());
    for (std::size_t i = 0; i < before.nodes.size(); ++i) {
        EXPECT_EQ(after.nodes[i].child0, before.nodes[i].child0);
        EXPECT_EQ(after.nodes[i].child1, before.nodes[i].child1);
    }
    ASSERT_EQ(after.records.size(), before.records.size());
    for (std::size_t i = 0; i < before.records.size(); ++i) {
        const CompressedRecord &now = after.records[i], &then = before.records[i];
        EXPECT_EQ(is_leaf(now), is_leaf(then));
        EXPECT_EQ(now.a.w, then.a.w);
    }
}

void expect_leaves_of(std::span<const CompressedRecord> records, std::span<const vec3> positions,
                      std::span<const uvec3> triangles) {
    BuildTree source{};
    source.positions = Floats::to(&positions.data()->x);
    source.indices = Uints::to(&triangles.data()->x);
    for (const CompressedRecord& record : records) {
        if (!is_leaf(record)) continue;
        const Leaf leaf = leaf_of(record);
        const CompressedRecord right = encode_boxed_leaf(source, leaf, boxed_leaf(source, leaf));
        EXPECT_EQ(std::memcmp(&record, &right, sizeof right), 0) << "primitive " << leaf.first;
    }
}

TEST_P(SwRefit, ARefittedSceneTreeIsSoundAndKeepsItsTopology) {
    const Mesh mesh = make_soup(10, 1);
    for (const std::size_t count : {1u, 2u, 3u, 255u, 256u, 257u, 1000u}) {
        SwTlas accel(context(), options());
        const AccelHandle handle = accel.push(mesh, scattered(count, 1));
        accel.sync();
        accel.update_transforms(handle, scattered(count, 2));  // the first move rebuilds
        accel.sync();
        const BuiltTree before = download_scene(accel);
        const std::vector<Transform> moved = scattered(count, 3);
        accel.update_transforms(handle, moved);
        accel.sync();
        const BuiltTree after = download_scene(accel);
        expect_sound(after, instance_boxes(mesh, moved, options()), text(count, " instances"));
        expect_same_topology(after, before);
    }
}

// Expects the box of all points under the map, in float64.
void expect_around(const BuiltTree& scene, const std::vector<vec3>& points, const Transform& map, double slack) {
    for (int axis = 0; axis < 3; ++axis) {
        double lo = INFINITY, hi = -INFINITY;
        for (const vec3& point : points) {
            const double x = dot(dvec4(map.rows[static_cast<std::size_t>(axis)]), dvec4(point, 1));
            lo = std::min(lo, x);
            hi = std::max(hi, x);
        }
        EXPECT_LE(double{scene.bvh.lo[axis]}, lo) << "axis " << axis;
        EXPECT_GE(double{scene.bvh.hi[axis]}, hi) << "axis " << axis;
        EXPECT_LT(scene.bvh.hi[axis] - scene.bvh.lo[axis], hi - lo + slack) << "axis " << axis;
    }
}

TEST_P(SwRefit, ARotatedInstanceHasABoxAroundWhatItsGeometryHasBecome) {
    const Transform map =
        Transform::translation({3, 0, -2}) * Transform::of(glm::rotate(glm::mat4(1), 0.8f, glm::vec3(0.6f, 0, 0.8f)));
    Mesh ball = make_icosphere(4);
    SwTlas accel(context(), options());
    const AccelHandle handle = accel.push(ball, std::vector<Transform>(2, map));  // a lone one has a loose box
    accel.sync();
    expect_around(download_scene(accel), ball.positions, map, 0.5);
    for (vec3& point : ball.positions) point = point * vec3(1, 2, 1) + vec3(0, 0.5f * point.x, 0);
    accel.update_vertices(handle, ball.positions);
    accel.sync();
    expect_around(download_scene(accel), ball.positions, map, 0.9);
}

// Each triangle is there three times, so that its number decides equal t, in whichever order the trees are.
TEST_P(SwRefit, ARefittedGeometryHasTheHitsOfAFreshOneToTheLastBit) {
    Mesh mesh = make_soup(400, 1, 0.3f);
    const std::vector<uvec3> once = mesh.triangles;
    for (int copy = 0; copy < 2; ++copy) mesh.triangles.insert(mesh.triangles.end(), once.begin(), once.end());
    std::mt19937 random(7);
    std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
    SwTlas refitted(context(), options());
    const AccelHandle handle = refitted.push(mesh);
    refitted.sync();
    const Mesh other = make_soup(400, 2, 0.3f);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        mesh.positions[i] = 0.9f * mesh.positions[i] + 0.1f * other.positions[i];
    refitted.update_vertices(handle, mesh.positions);
    SwTlas fresh(context(), options());
    fresh.push(mesh);
    std::vector<Ray> rays;
    std::uniform_real_distribution<float> draw(-1, 1);
    const auto point = [&] { return vec3(draw(random), draw(random), draw(random)); };
    for (int i = 0; i < 10'000; ++i) rays.push_back({2.0f * point(), 0, point(), INFINITY});
    const std::vector<Hit> hits = refitted.closest_hits(rays);
    EXPECT_TRUE(same_bytes(hits, fresh.closest_hits(rays)));
    EXPECT_GT(std::ranges::count(hits, 1u, &Hit::hit), 100);
}

TEST_P(SwRefit, RotatedBoxesLieInTheirBox) {
    const Transform map = Transform::of(glm::rotate(glm::mat4(1), 0.8f, glm::vec3(0.6f, 0, 0.8f)));
    std::vector<Bounds> boxes;
    std::vector<vec3> corners;
    for (const vec3& center : make_icosphere(2).positions) {
        boxes.push_back({center - 0.05f, center + 0.05f});
        for (uint i = 0; i < 8; ++i)
            corners.push_back(center + 0.05f * vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
    }
    SwTlas accel(context(), options());
    accel.push(BoxesView{"boxes", boxes}, std::vector<Transform>(2, map));
    accel.sync();
    for (vec3& corner : corners) corner *= 1 - 1e-6f;  // centres and halves were added in float32
    expect_around(download_scene(accel), corners, map, 0.6);
}

TEST_P(SwRefit, ARefittedGeometryIsSoundAndKeepsItsTopology) {
    SwTlas accel(context(), options());
    std::vector<Mesh> meshes;
    std::vector<AccelHandle> handles;
    std::vector<BuiltTree> before;
    for (const uint n : {1u, 2u, 3u, 255u, 256u, 257u, 1000u}) meshes.push_back(make_soup(n, n));
    const std::size_t soups = meshes.size();
    for (const uint level : {0u, 2u, 5u}) meshes.push_back(make_icosphere(level));  // leaves of two triangles
    meshes.push_back(test::with_seam(make_icosphere(3)));
    for (const Mesh& mesh : meshes) handles.push_back(accel.push(mesh));
    const std::vector<Mesh> pushed = meshes;
    accel.sync();
    for (const AccelHandle handle : handles) before.push_back(download_geometry(accel, handle));
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        if (i < soups) meshes[i].positions = make_soup(static_cast<uint>(meshes[i].triangles.size()), 77).positions;
        for (vec3& position : meshes[i].positions) position = position * 0.9f + vec3(0.1f * position.y, 0, 0.05f);
        meshes[i].positions[1] = meshes[i].positions[0];  // a triangle that has both has no area
        if (meshes[i].positions.size() > 100) meshes[i].positions[100].y = NAN;
        accel.update_vertices(handles[i], meshes[i].positions);
    }
    accel.sync();
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const BuiltTree after = download_geometry(accel, handles[i]);
        expect_sound(after, meshes[i], &pushed[i]);
        expect_same_topology(after, before[i]);
        EXPECT_EQ(VkDeviceAddress{after.bvh.nodes.address}, VkDeviceAddress{before[i].bvh.nodes.address});
        const std::vector<vec3> positions = built(meshes[i], &pushed[i]);
        if (has_records(after)) {
            expect_leaves_of(after.records, positions, meshes[i].triangles);
            continue;
        }
        std::vector<uint> order;
        for (const BvhTriangle& triangle : before[i].triangles) order.push_back(triangle.primitive_index);
        EXPECT_TRUE(same_bytes(after.triangles, reference::encode_triangles(positions, meshes[i].triangles, order)));
    }
}

TEST_P(SwRefit, TheCostOnTheDeviceIsThatOfTheChecker) {
    for (const uint n : {1u, 2u, 3u, 256u, 257u, 258u, 1000u, 70'000u}) {
        SwTlas accel(context(), options());
        Mesh mesh = make_soup(n, 5, 0.1f);
        const std::vector<Transform> transforms = scattered(std::min(n, 1000u), n);
        const AccelHandle handle = accel.push(mesh, transforms);
        accel.sync();
        EXPECT_EQ(accel.sah(handle), std::nullopt) << "not measured before its vertices move";
        const BuiltTree top = download_scene(accel);
        const double expected = sah_of(top, instance_boxes(mesh, transforms, options()));
        EXPECT_NEAR(*accel.sah(), expected, 1e-5 * expected) << n;
        for (const uint seed : {6u, 7u}) {
            mesh.positions = make_soup(n, seed, 0.1f).positions;
            if (n > 3) mesh.positions[5].x = INFINITY;
            accel.update_vertices(handle, mesh.positions);
            accel.sync();
            const BuiltTree tree = download_geometry(accel, handle);
            const double cost = sah_of(tree, leaf_boxes(tree, mesh));
            EXPECT_NEAR(*accel.sah(handle), cost, 1e-5 * cost) << n;
            EXPECT_EQ(accel.sah_if_ready(handle), accel.sah(handle));
        }
    }
}

// Makes triangles of many sizes and shapes, as architecture has: long walls, panels, small parts.
Mesh mixed_triangles(std::size_t count) {
    std::mt19937 random(8);
    std::uniform_real_distribution<float> unit(-1, 1);
    Mesh mesh;
    for (uint i = 0; i < count; ++i) {
        const float size = std::ldexp(1.0f, -static_cast<int>(random() % 10));
        const vec3 place(unit(random), unit(random), unit(random));
        for (uint corner = 0; corner < 3; ++corner) {
            vec3 offset(unit(random), unit(random), unit(random));
            offset[static_cast<int>(i % 3)] = 0;
            mesh.positions.push_back(place + size * offset);
        }
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

class SwQuality : public test::VulkanTest, public testing::WithParamInterface<Layout> {};
INSTANTIATE_TEST_SUITE_P(Every, SwQuality, testing::ValuesIn(all_layouts),
                         [](const auto& layout) { return std::string(name_of(layout.param)); });

TEST_P(SwQuality, HighAndPlocCostRaysLess) {
    for (const Mesh& mesh : {mixed_triangles(20'000), make_icosphere(6)}) {
        double sah[all_build_qualities.size()];
        for (const BuildQuality quality : all_build_qualities) {
            SwTlas accel(context(), {.layout = GetParam(), .build_quality = quality});
            const AccelHandle handle = accel.push(mesh);
            accel.sync();
            const BuiltTree tree = download_geometry(accel, handle);
            sah[static_cast<std::size_t>(quality)] = test::sah_of(tree, test::leaf_boxes(tree, mesh));
        }
        std::printf("surface-area cost of %zu triangles: fast %.2f, high %.2f, ploc %.2f\n", mesh.triangles.size(),
                    sah[0], sah[1], sah[2]);
        // On a sphere, whose triangles are alike, nodes of eight leave little to gain.
        const bool is_wide = GetParam() == Layout::compressed8;
        EXPECT_LT(sah[1], (is_wide ? 0.99 : 0.97) * sah[0]);
        EXPECT_LT(sah[2], (is_wide ? 0.995 : 0.99) * sah[0]);
    }
}

using Corners = std::vector<dvec3>;

Corners cut(const Corners& whole, int axis, double plane, double side) {
    Corners part;
    for (std::size_t i = 0; i < whole.size(); ++i) {
        const dvec3 &from = whole[i], &to = whole[(i + 1) % whole.size()];
        const double a = (from[axis] - plane) * side, b = (to[axis] - plane) * side;
        if (a >= 0) part.push_back(from);
        if ((a < 0) != (b < 0)) part.push_back(from + (to - from) * (a / (a - b)));
    }
    return part;
}

double area_of(const Corners& corners) {
    dvec3 twice(0);
    for (std::size_t i = 2; i < corners.size(); ++i)
        twice += cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
    return length(twice) / 2;
}

double area_in(Corners corners, const LeafBox& box) {
    for (int axis = 0; axis < 3; ++axis) {
        corners = cut(corners, axis, double{box.lo[axis]}, 1);
        corners = cut(corners, axis, double{box.hi[axis]}, -1);
    }
    return area_of(corners);
}

// A box below the root's, with the primitives below it.
struct Box {
    LeafBox box;
    std::set<uint> below;
};

std::set<uint> collect(const BuiltTree& tree, uint reference, std::vector<Box>& boxes) {
    std::vector<std::pair<LeafBox, uint>> children;
    if (tree.records.empty()) {
        if (reference & LEAF_BIT) return {tree.triangles[reference & ~LEAF_BIT].primitive_index};
        const BvhNode& node = tree.nodes[reference];
        children = {{{node.lo0, node.hi0}, node.child0}, {{node.lo1, node.hi1}, node.child1}};
    } else {
        const CompressedRecord& record = tree.records[reference];
        if (is_leaf(record) && is_pair(record)) return {index_in(record), second_index_in(record)};
        if (is_leaf(record)) return {index_in(record)};
        const CompressedRecord& second_half = tree.records[is_wide_node(record) ? reference + 1 : reference];
        const ChildSlots slots = child_slots(record, second_half);
        for (uint slot = 0; slot < 8; ++slot) {
            if (!has_child(slots, slot)) continue;
            const uint child = child_index(slots, slot);
            children.emplace_back(box_in_planes(record, second_half, slot), child);
        }
    }
    std::set<uint> all;
    for (const auto& [box, child] : children) {
        std::set<uint> below = collect(tree, child, boxes);
        all.insert(below.begin(), below.end());
        boxes.push_back({box, std::move(below)});
    }
    return all;
}

double overlap_of(const BuiltTree& tree, const Mesh& mesh) {
    std::vector<Box> boxes;
    collect(tree, tree.bvh.root, boxes);
    double overlap = 0, area = 0;
    for (uint i = 0; i < mesh.triangles.size(); ++i) {
        const uvec3 t = mesh.triangles[i];
        const Corners corners = {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
        area += area_of(corners);
        for (const Box& box : boxes)
            if (!box.below.contains(i)) overlap += area_in(corners, box.box);
    }
    return overlap / area;
}

class SwOverlap : public test::VulkanTest, public testing::WithParamInterface<Layout> {};
INSTANTIATE_TEST_SUITE_P(Every, SwOverlap, testing::ValuesIn(all_layouts),
                         [](const auto& layout) { return std::string(name_of(layout.param)); });

TEST_P(SwOverlap, IsThatOfItsDefinition) {
    SwTlas accel(context(), {.layout = GetParam()});
    Mesh far = make_soup(200, 2, 0.3f);
    for (vec3& position : far.positions) position = (position + 3.0f) * 0x1p55f;
    for (const Mesh& mesh : {make_soup(300, 1, 0.5f), make_icosphere(2), far}) {
        const AccelHandle handle = accel.push(mesh);
        accel.sync();
        const BuiltTree tree = download_geometry(accel, handle);
        const double expected = overlap_of(tree, mesh);
        // Boxes of compressed nodes may stick out of their parents' by a rounding: whoever goes down the tree, as rays
        // do, misses what lies there. Without that the two agree to 1e-9.
        EXPECT_NEAR(reference::end_point_overlap(tree), expected, 1e-6 * expected);
        EXPECT_GT(expected, 0.01) << "the test would see nothing";
    }
}

TEST_P(SwOverlap, IsNothingWhereBoxesHoldTheirOwnAlone) {
    SwTlas accel(context(), {.layout = GetParam()});
    Mesh apart;
    for (uint i = 0; i < 9; ++i) {
        const vec3 at(static_cast<float>(10 * i), 0, 0);
        for (const vec3& corner : {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0.5f)}) apart.positions.push_back(at + corner);
        apart.triangles.push_back(uvec3(3 * i) + uvec3(0, 1, 2));
    }
    Mesh one = apart;
    one.triangles.resize(1);
    for (const Mesh& mesh : {apart, one, Mesh{}}) {
        const AccelHandle handle = accel.push(mesh);
        accel.sync();
        EXPECT_NEAR(reference::end_point_overlap(download_geometry(accel, handle)), 0, 1e-9);
    }
}

}  // namespace
}  // namespace twinray
