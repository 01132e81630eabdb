// SPDX-License-Identifier: MIT
// Rays through trees as deep as there may be. No builder is known to make one of a mesh, so they come from files.
#include <cmath>
#include <string>

#include <twinray/geometry.h>
#include "swtlas/saved.h"
#include <twinray/tlas.h>
#include "tests/scene/temp_dir.h"
#include "tests/support/device.h"
#include "tests/support/tall_tree.h"

namespace twinray {
namespace {

class DeepTrees : public test::VulkanTest, public testing::WithParamInterface<Layout> {
  protected:
    // All boxes are around the origin. A ray from there along (1, 1, 1) enters them all, and meets one triangle of the
    // fork `open`, that farther in being visited first.
    std::unique_ptr<SwTlas> load(uint open) {
        Mesh mesh;
        float size = 0x1p-60f;
        const auto add = [&](float side) {
            const auto first = static_cast<uint>(mesh.positions.size());
            const float s = size * side;
            mesh.positions.insert(mesh.positions.end(), {{s, -s, s}, {-s, s, s}, {s, s, -s}});
            mesh.triangles.push_back({first, first + 1, first + 2});
        };
        add(-1);
        for (uint fork = 0; fork < test::TallTree::forks; ++fork) {
            size *= 1.6f;
            for (uint leaf = 0; leaf < 4; ++leaf) add(fork == open && leaf == 2 ? 1.0f : -1.0f);
        }
        const Geometry geometry(mesh);
        const test::TallTree tall(reference::leaves_triangles(geometry.positions, mesh.triangles));
        const std::vector<CompressedRecord> records =
            reference::records_of_triangles(tall.tree, geometry.positions, mesh.triangles, width_of(GetParam()));
        const std::vector<SavedGeometry> saved = {
            {geometry, tall.bvh_of_records(), {}, {}, records, {make_instance_record(Transform{}, {})}}};
        const EncodedSave encoded = encode_save(GetParam(), saved);
        std::string file(reinterpret_cast<const char*>(encoded.head.data()), encoded.head.size());
        for (const std::span<const std::byte> piece : encoded.body)
            file.append(reinterpret_cast<const char*>(piece.data()), piece.size());
        return SwTlas::load(context(), folder_.write("deep.swtlas", file)).accel;
    }

    void expect_hit(SwTlas& accel, uint open) {
        const Ray ray{vec3(0), 0, vec3(1), INFINITY};
        const uint triangle = 4 * open + 3;
        const Hit closest = accel.closest_hits({&ray, 1}).front();
        EXPECT_EQ(std::pair(closest.hit, closest.primitive_index), std::pair(1u, triangle)) << "fork " << open;
        const Hit any = accel.any_hits({&ray, 1}).front();
        EXPECT_EQ(std::pair(any.hit, any.primitive_index), std::pair(1u, triangle)) << "fork " << open;
    }

    test::TempDir folder_;
};

INSTANTIATE_TEST_SUITE_P(In, DeepTrees, testing::Values(Layout::compressed4, Layout::compressed8),
                         [](const auto& layout) { return std::string(name_of(layout.param)); });

TEST_P(DeepTrees, NothingThatWaitsIsLost) {
    for (uint open = 0; open < test::TallTree::forks; ++open) expect_hit(*load(open), open);
}

TEST_P(DeepTrees, NothingThatWaitsIsLostBelowATopLevel) {
    for (uint open = 0; open < test::TallTree::forks; open += 3) {
        const std::unique_ptr<SwTlas> accel = load(open);
        accel->push(make_soup(10, 1), Transform::translation({0, 10, 0}));
        expect_hit(*accel, open);
    }
}

}  // namespace
}  // namespace twinray
