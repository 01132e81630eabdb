// Parts that tests of SwTlas' builds and refits share: each layout with a build quality, and the rules of built
// trees; a tree of the largest height, and meshes whose vertices are there twice.
#pragma once

#include <cstring>
#include <tuple>

#include "engine/core/error.h"
#include <twinray/geometry.h>
#include "validation/cpu_reference/reference_scene.h"
#include "swtlas/tree.h"
#include "tests/support/device.h"

namespace twinray::test {

enum class KernelShape { of_device, of_gpu };
using How = std::tuple<Layout, BuildQuality, KernelShape>;

class SwBuildTest : public VulkanTest, public testing::WithParamInterface<How> {
  protected:
    BuildQuality quality() const { return std::get<BuildQuality>(GetParam()); }
    AccelOptions options() const { return {.layout = std::get<Layout>(GetParam()), .build_quality = quality()}; }
    ContextDesc context_desc() const override {
        ContextDesc desc;
        if (std::get<KernelShape>(GetParam()) == KernelShape::of_gpu) desc.tuning = TuningRow::gpu;
        return desc;
    }
};

inline auto builds_of_the_default_layout() {
    using enum KernelShape;
    return testing::Values(How{Layout::compressed4, BuildQuality::fast, of_device},
                           How{Layout::compressed4, BuildQuality::high, of_device},
                           How{Layout::compressed4, BuildQuality::high, of_gpu},
                           How{Layout::compressed4, BuildQuality::ploc, of_device});
}
inline auto builds_of_other_layouts() {
    using enum KernelShape;
    return testing::Values(
        How{Layout::bvh2, BuildQuality::high, of_device}, How{Layout::bvh2, BuildQuality::fast, of_gpu},
        How{Layout::bvh2, BuildQuality::ploc, of_gpu}, How{Layout::compressed8, BuildQuality::fast, of_device},
        How{Layout::compressed8, BuildQuality::high, of_gpu}, How{Layout::compressed8, BuildQuality::ploc, of_device});
}
inline std::string name_of_build(const testing::TestParamInfo<How>& how) {
    return text(name_of(std::get<Layout>(how.param)), '_', name_of(std::get<BuildQuality>(how.param)),
                std::get<KernelShape>(how.param) == KernelShape::of_gpu ? "_as_on_a_gpu" : "");
}

// Returns positions as they are built: in units of a power of two, that of the pushed mesh.
std::vector<vec3> built(const Mesh& mesh, const Mesh* pushed = nullptr);

// Returns boxes by the leaf index that references of the tree use.
std::vector<LeafBox> leaf_boxes(const BuiltTree& tree, const Mesh& mesh, const Mesh* pushed = nullptr);
// Returns the boxes of the scene tree's leaves over these placements of one mesh, by the CPU reference.
std::vector<LeafBox> instance_boxes(const Mesh& mesh, const std::vector<Transform>& transforms,
                                    const AccelOptions& options);
// Returns transforms, every other one with a rotation.
std::vector<Transform> scattered(std::size_t count, uint seed);

inline bool has_records(const BuiltTree& tree) { return !tree.records.empty(); }
// Returns, for a tree with records, the largest number of children of a node. One leaf has room for a node in
// compressed8 alone.
inline uint width_of(const BuiltTree& tree) {
    return tree.records.size() == 2 || is_wide_node(tree.records.front()) ? 8 : 4;
}

// Expects a sound tree, with references that are the leaves' own indices, or with records.
void expect_sound(const BuiltTree& tree, const std::vector<LeafBox>& boxes, const std::string& name);
void expect_sound(const BuiltTree& tree, const Mesh& mesh, const Mesh* pushed = nullptr);
void expect_reference(const BuiltTree& tree, const Mesh& mesh, BuildQuality quality);
double sah_of(const BuiltTree& tree, const std::vector<LeafBox>& boxes);

// Returns the same triangles without normals, but with each vertex there twice: the first half of the triangles takes
// the copies. Files have such vertices at a seam of textures.
inline Mesh with_seam(Mesh mesh) {
    const auto copies = static_cast<uint>(mesh.positions.size());
    mesh.positions.reserve(2 * mesh.positions.size());
    for (uint i = 0; i < copies; ++i) mesh.positions.push_back(mesh.positions[i]);
    mesh.normals.clear();
    for (std::size_t i = 0; i < mesh.triangles.size() / 2; ++i) mesh.triangles[i] += uvec3(copies);
    return mesh;
}

// A binary tree of the largest height: its spine forks into a fat tree of four leaves and all that is farther in. If
// boxes shrink inwards, the taller part is always the smaller one. Leaf 0 is the innermost, followed by four per fork.
struct TallTree {
    static constexpr uint forks = DEEPEST_TREE - 2;
    static constexpr uint leaves = 4 * forks + 1;

    std::vector<LeafBox> boxes;
    reference::Hierarchy tree = {};

    explicit TallTree(std::vector<LeafBox> leaf_boxes) : boxes(std::move(leaf_boxes)) {
        Part all = leaf(0);
        for (uint i = 0; i < forks; ++i)
            all = join(all, join(join(leaf(4 * i + 1), leaf(4 * i + 2)), join(leaf(4 * i + 3), leaf(4 * i + 4))));
        tree.root = all.reference;
        tree.box = all.box;
    }

    // Returns the tree of a file or a check, in layouts of records.
    Bvh bvh_of_records() const { return {tree.box.lo, tree.box.hi, {}, 0, leaves}; }

  private:
    struct Part {
        uint reference;
        LeafBox box;
        uint subtree;
    };

    Part leaf(uint i) const { return {LEAF_BIT | i, boxes[i], subtree_info(1, 0)}; }
    Part join(const Part& a, const Part& b) {
        tree.nodes.push_back({a.box.lo, a.reference, a.box.hi, a.subtree, b.box.lo, b.reference, b.box.hi, b.subtree});
        return {static_cast<uint>(tree.nodes.size() - 1),
                {min(a.box.lo, b.box.lo), max(a.box.hi, b.box.hi)},
                subtree_info(leaves_in(a.subtree) + leaves_in(b.subtree),
                             1 + std::max(height_in(a.subtree), height_in(b.subtree)))};
    }
};

}  // namespace twinray::test
