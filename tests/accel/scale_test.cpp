// SPDX-License-Identifier: MIT
// Multiplying everything by a power of two is exact, so it must change nothing but t.
#include <cmath>

#include "validation/reference/aimed_rays.h"
#include "tests/accel/accel_fixture.h"

namespace twinray {
namespace {

using Scale = test::AccelTest;
TWINRAY_OVER_EVERY_ACCEL(Scale);

Mesh scaled(Mesh mesh, float factor) {
    for (vec3& position : mesh.positions) position *= factor;
    return mesh;
}

Transform scaled(Transform transform, float factor) {
    for (vec4& row : transform.rows) row.w *= factor;
    return transform;
}

std::vector<Ray> scaled(std::vector<Ray> rays, float factor) {
    for (Ray& ray : rays) ray.origin *= factor;
    return rays;
}

// Random rays, and rays at vertices, where ties are decided.
std::vector<Ray> rays_at(const Mesh& mesh) {
    std::vector<Ray> rays = random_rays({vec3(-2), vec3(2)}, 2000, 3);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const vec3 from(1.5f, 0.25f * static_cast<float>(i % 7), -1.25f);
        rays.push_back({from, 0, mesh.positions[i] - from, INFINITY});
    }
    return rays;
}

TEST_P(Scale, ByAPowerOfTwoLeavesIdsAndWeightsAndScalesDistances) {
    const Mesh mesh = make_icosphere(3);
    const Transform turned{{vec4(0.3f, 0.8f, 0.1f, 1), vec4(-0.7f, 0.2f, 0.4f, -1), vec4(0.1f, -0.3f, 0.7f, 0.5f)}};
    const AccelHandle first = accel().push(mesh);
    const AccelHandle second = accel().push(mesh, turned);
    const std::vector<Ray> rays = rays_at(mesh);
    const std::vector<Hit> expected = accel().closest_hits(rays);
    const int most = -std::ilogb(smallest_scale());
    for (int k = -most; k <= most; k += is_ours() ? 1 : 12) {
        const float factor = std::ldexp(1.0f, k);
        for (const AccelHandle handle : {first, second}) accel().update(handle, scaled(mesh, factor));
        accel().update_transform(second, scaled(turned, factor));
        const std::vector<Hit> hits = accel().closest_hits(scaled(rays, factor));
        for (std::size_t i = 0; i < rays.size(); ++i) {
            Hit hit = hits[i];
            if (hit.hit) hit.t /= factor;
            ASSERT_EQ(std::memcmp(&hit, &expected[i], sizeof(Hit)), 0) << "ray " << i << " at 2^" << k;
        }
    }
}

// The transform alone scales: the mesh keeps its size.
TEST_P(Scale, OfTheTransformByAPowerOfTwoLeavesIdsAndWeights) {
    const Mesh mesh = make_icosphere(3);
    const AccelHandle handle = accel().push(mesh);
    const std::vector<Ray> rays = rays_at(mesh);
    const std::vector<Hit> expected = accel().closest_hits(rays);
    const int most = -std::ilogb(smallest_scale());
    for (int k = -most; k <= most; k += is_ours() ? 3 : 12) {
        const float factor = std::ldexp(1.0f, k);
        accel().update_transform(handle, Transform::scaling(vec3(factor)));
        const std::vector<Hit> hits = accel().closest_hits(scaled(rays, factor));
        for (std::size_t i = 0; i < rays.size(); ++i) {
            Hit hit = hits[i];
            if (hit.hit) hit.t /= factor;
            ASSERT_EQ(std::memcmp(&hit, &expected[i], sizeof(Hit)), 0) << "ray " << i << " at 2^" << k;
        }
    }
}

}  // namespace
}  // namespace twinray
