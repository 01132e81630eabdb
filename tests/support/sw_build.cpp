#include "tests/support/sw_build.h"
#include "swtlas/plan.h"
#include "swtlas/triangle_pairs.h"

#include <glm/gtc/matrix_transform.hpp>
#include <random>

namespace twinray::test {
namespace {

// Returns boxes by the leaf index that node references use: in sorted order.
std::vector<LeafBox> boxes_of(const std::vector<BvhTriangle>& triangles, const Mesh& mesh, const Mesh* pushed) {
    std::vector<LeafBox> boxes;
    const std::vector<LeafBox> by_primitive = reference::leaves_triangles(built(mesh, pushed), mesh.triangles);
    for (const BvhTriangle& triangle : triangles) boxes.push_back(by_primitive.at(triangle.primitive_index));
    return boxes;
}

}  // namespace

std::vector<vec3> built(const Mesh& mesh, const Mesh* pushed) {
    const SharedArray<vec3> positions =
        Geometry(mesh, software_unit((pushed ? pushed : &mesh)->positions)).built_positions();
    return {positions.begin(), positions.end()};
}

void expect_sound(const BuiltTree& tree, const std::vector<LeafBox>& boxes, const std::string& name) {
    const auto report = [&](const std::vector<std::string>& violations) {
        for (const std::string& violation : violations) ADD_FAILURE() << name << ": " << violation;
    };
    if (!has_records(tree)) return report(check_tree(tree.bvh, tree.nodes, boxes).violations);
    report(check_tree(tree.bvh, tree.records, boxes).violations);
}

std::vector<LeafBox> leaf_boxes(const BuiltTree& tree, const Mesh& mesh, const Mesh* pushed) {
    return has_records(tree) ? reference::leaves_triangles(built(mesh, pushed), mesh.triangles)
                             : boxes_of(tree.triangles, mesh, pushed);
}

void expect_sound(const BuiltTree& tree, const Mesh& mesh, const Mesh* pushed) {
    expect_sound(tree, leaf_boxes(tree, mesh, pushed), mesh.name);
}

double sah_of(const BuiltTree& tree, const std::vector<LeafBox>& boxes) {
    if (!has_records(tree)) return check_tree(tree.bvh, tree.nodes, boxes).sah;
    return check_tree(tree.bvh, tree.records, boxes).sah;
}

void expect_reference(const BuiltTree& tree, const Mesh& mesh, BuildQuality quality) {
    const std::vector<vec3> positions = built(mesh);
    Geometry geometry(MeshView(mesh.name, positions, mesh.triangles), 1);
    if (has_records(tree)) choose_leaves(geometry, false);
    const std::vector<LeafBox> boxes = reference::leaves_triangles(positions, mesh.triangles, geometry.leaves);
    const reference::Codes codes = reference::morton(boxes, reference::centroids(boxes));
    const std::vector<uint> order = reference::sort(codes);
    reference::Hierarchy expected = reference::hierarchy(boxes, codes, order, !has_records(tree), quality);
    if (!has_records(tree)) expected = reference::linked(std::move(expected));
    if (has_records(tree)) {
        std::vector<CompressedRecord> records =
            reference::records_of_triangles(expected, positions, mesh.triangles, width_of(tree), geometry.leaves);
        if (!geometry.welded.is_empty()) name_vertices(records, geometry.welded.triangles);
        EXPECT_TRUE(same_bytes(tree.records, records)) << mesh.name;
        return;
    }
    EXPECT_EQ(tree.bvh.root, expected.root) << mesh.name;
    EXPECT_TRUE(same_bytes(tree.nodes, expected.nodes)) << mesh.name;
    EXPECT_TRUE(same_bytes(tree.triangles, reference::encode_triangles(positions, mesh.triangles, order))) << mesh.name;
}

std::vector<LeafBox> instance_boxes(const Mesh& mesh, const std::vector<Transform>& transforms,
                                    const AccelOptions& options) {
    reference::Scene scene(options.layout, options.build_quality);
    const std::size_t geometry = scene.add_geometry(mesh);
    for (const Transform& transform : transforms) scene.add_instance(geometry, make_instance_record(transform));
    scene.build();
    return {scene.instance_boxes().begin(), scene.instance_boxes().end()};
}

std::vector<Transform> scattered(std::size_t count, uint seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> place(-50, 50);
    std::vector<Transform> transforms;
    for (std::size_t i = 0; i < count; ++i) {
        const vec3 offset(place(random), place(random), place(random));
        const float angle = i % 2 ? place(random) : 0;
        transforms.push_back(Transform::translation(offset) *
                             Transform::of(glm::rotate(glm::mat4(1), angle, glm::vec3(0.6f, 0, 0.8f))) *
                             Transform::scaling({1.5f, -0.25f, 3}));
    }
    return transforms;
}

}  // namespace twinray::test
