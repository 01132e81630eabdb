// SPDX-License-Identifier: MIT
// Parts that tests of SwTlas' builds and refits share: each layout with a build quality, and the rules of built trees.
#pragma once

#include <cstring>
#include <tuple>

#include "engine/core/error.h"
#include <twinray/geometry.h>
#include "swtlas/check.h"
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

template <class Array>
bool same_bytes(const Array& a, const Array& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
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

}  // namespace twinray::test
