// Traversal on devices that flush denormals, which the CPU imitates.
#include "validation/cpu_reference/flush_denormals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "engine/accel/geometry.h"
#include "swtlas/plan.h"
#include "validation/cpu_reference/reference.h"
#include "tests/support/device.h"
#include "report/suite/scenes.h"

namespace twinray::suite {
namespace {

std::size_t hit_count(const std::vector<Hit>& hits) {
    std::size_t count = 0;
    for (const Hit& hit : hits) count += hit.hit;
    return count;
}

// t is 1e-36, and its products with the steps of compressed boxes are denormal, so they are scaled by a power of two.
TEST(FlushedDenormals, LongDirectionsLoseNothing) {
    if (!FlushDenormals::is_able()) TWINRAY_LACKS("flushed_denormals", "this processor cannot");
    const std::unique_ptr<reference::Scene> on_cpu = cpu_reference_of(instances_of(make_icosphere(3)));
    std::vector<Ray> rays = random_rays({vec3(-1), vec3(1)}, 4096, 1);
    for (Ray& ray : rays) ray.direction = normalize(ray.direction);
    const std::size_t expected = hit_count(trace_cpu_reference(*on_cpu, rays, Level::watertight));
    EXPECT_GT(expected, 500u);
    for (const float length : {1e-30f, 1e30f, 1e36f}) {
        std::vector<Ray> stretched = rays;
        for (Ray& ray : stretched) ray.direction *= length;
        const std::size_t found =
            hit_count(trace_cpu_reference(*on_cpu, stretched, Level::watertight, Denormals::flushed));
        EXPECT_GE(found + expected / 100, expected) << length;  // hits nearer than 0.01 have a denormal t themselves
    }
}

// At 1e30 times its size, a mesh is built in a unit of its own, in which a direction 1e-8 long is short.
TEST(FlushedDenormals, ShortDirectionsInLargeScenesLoseNothing) {
    if (!FlushDenormals::is_able()) TWINRAY_LACKS("flushed_denormals", "this processor cannot");
    for (const auto& [size, length] : {std::pair{3e30f, 1e-8f}, {1e38f, 1.0f}, {1e20f, 1e-15f}, {3e38f, 4.0f}}) {
        const std::unique_ptr<reference::Scene> on_cpu =
            cpu_reference_of(instances_of(scaled(make_icosphere(3), size)));
        std::vector<Ray> rays = scaled(random_rays({vec3(-1), vec3(1)}, 4096, 1), size);
        for (Ray& ray : rays) ray.direction = length * normalize(ray.direction);
        const std::size_t expected = hit_count(trace_cpu_reference(*on_cpu, rays, Level::watertight));
        EXPECT_GT(expected, 500u);
        EXPECT_EQ(hit_count(trace_cpu_reference(*on_cpu, rays, Level::watertight, Denormals::flushed)), expected)
            << size;
        EXPECT_GT(10 * hit_count(trace_cpu_reference(*on_cpu, rays, Level::fast, Denormals::flushed)), 9 * expected)
            << size;
    }
}

// A mesh that is so large leaves the smallest of its triangles denormal in its unit.
TEST(FlushedDenormals, TreesAreTheSame) {
    if (!FlushDenormals::is_able()) TWINRAY_LACKS("flushed_denormals", "this processor cannot");
    Mesh mesh = make_soup(500, 1);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        mesh.positions[i] *= std::ldexp(1.0f, 20 - static_cast<int>(i / 3 % 60) * 4);
    append(mesh, scaled(make_icosphere(0), 0x1p126f));
    const auto first = static_cast<uint>(mesh.positions.size());
    for (const vec3& corner : {vec3(0), vec3(0x1p-36f, 0x1p96f, 0), vec3(0, 0x1p126f, 0)})
        mesh.positions.push_back(corner);
    mesh.triangles.push_back({first, first + 1, first + 2});  // flat where the denormal is 0
    const Geometry geometry(mesh, software_unit(mesh.positions));
    const SharedArray<vec3> positions = geometry.built_positions();
    const auto tree_of = [&] {
        const std::vector<LeafBox> boxes = reference::leaves_triangles(positions, geometry.triangles);
        const reference::Codes codes = reference::morton(boxes, reference::centroids(boxes));
        return reference::hierarchy(boxes, codes, reference::sort(codes), true, BuildQuality::ploc).nodes;
    };
    const auto flushed_tree = [&] {
        const FlushDenormals flush;
        return tree_of();
    };
    const std::vector<BvhNode> tree = tree_of(), flushed = flushed_tree();
    ASSERT_EQ(tree.size(), flushed.size());
    EXPECT_EQ(std::memcmp(tree.data(), flushed.data(), tree.size() * sizeof(BvhNode)), 0);
}

}  // namespace
}  // namespace twinray::suite
