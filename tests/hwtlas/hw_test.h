// SPDX-License-Identifier: MIT
// What the tests of HwTlas share: every way of tracing as a parameter, and a float64 brute force as the check.
#pragma once

#include <algorithm>
#include <optional>
#include <random>

#include <twinray/tlas.h>
#include "engine/core/ray.h"
#include "tests/support/device.h"

namespace twinray::test {

struct Way {
    const char* name;
    bool use_ray_query;
    BuildOrder order;

    friend void PrintTo(const Way& way, std::ostream* out) { *out << way.name; }
};

// A fresh accelerator per test and way; skips the ways that the device does not have.
class HwTlasTest : public VulkanTest, public ::testing::WithParamInterface<Way> {
  protected:
    void SetUp() override {
        VulkanTest::SetUp();
        if (IsSkipped()) return;
        if (HasFailure()) FAIL() << "no device";
        const DeviceProperties& properties = context().properties();
        const bool has_way = GetParam().use_ray_query ? properties.ray_query : properties.ray_tracing_pipeline;
        if (!has_way || !missing_for_hardware(properties).empty())
            TWINRAY_LACKS("ray_tracing", properties.name + " has no such ray tracing");
        accel_ = std::make_unique<HwTlas>(context(), GetParam().order);
    }
    void TearDown() override {
        accel_.reset();
        VulkanTest::TearDown();
    }
    ContextDesc context_desc() const override {
        ContextDesc desc;
        desc.use_ray_query = GetParam().use_ray_query;
        return desc;
    }
    HwTlas& accel() { return *accel_; }
    Hit closest(const Ray& ray) { return accel_->closest_hits(std::span(&ray, 1)).front(); }
    Hit any(const Ray& ray) { return accel_->any_hits(std::span(&ray, 1)).front(); }

  private:
    std::unique_ptr<HwTlas> accel_;
};

inline const auto all_ways = ::testing::Values(
    Way{"RayQueryInputOrder", true, BuildOrder::input}, Way{"RayQueryMortonOrder", true, BuildOrder::morton},
    Way{"PipelineInputOrder", false, BuildOrder::input}, Way{"PipelineMortonOrder", false, BuildOrder::morton});
inline const auto name_of_way = [](const auto& info) { return info.param.name; };

inline bool same_bytes(const Hit& a, const Hit& b) { return std::memcmp(&a, &b, sizeof(Hit)) == 0; }

struct ExpectedHit {
    double t = INFINITY, u = 0, v = 0;
    uint instance = 0, primitive = 0;
};

// The scene once more, in float64 and in the user's numbering.
class BruteForce {
  public:
    void add(const Mesh& mesh, const Transform& transform = {}) {
        for (uint i = 0; i < mesh.triangles.size(); ++i) {
            Triangle triangle{{}, instance_count_, i};
            for (int k = 0; k < 3; ++k)
                triangle.corners[k] = world(transform, dvec3(mesh.positions[mesh.triangles[i][k]]));
            triangles_.push_back(triangle);
        }
        ++instance_count_;
    }

    // Nothing when float32 may rightly disagree: an edge or a second triangle too near. t = infinity is a miss.
    std::optional<ExpectedHit> closest(const Ray& ray) const {
        ExpectedHit best, second;
        for (const Triangle& triangle : triangles_) {
            ExpectedHit hit;
            const double inside = intersect(triangle, ray, hit);
            if (!(inside > -margin_) || hit.t <= ray.t_min || hit.t >= ray.t_max) continue;
            if (inside < margin_) hit.primitive = unsure_;
            if (hit.t < best.t)
                second = best, best = hit;
            else if (hit.t < second.t)
                second = hit;
        }
        if (best.t == INFINITY) return best;
        if (best.primitive == unsure_ || second.t - best.t < margin_ * best.t) return {};
        return best;
    }

  private:
    struct Triangle {
        dvec3 corners[3];
        uint instance, primitive;
    };
    static dvec3 world(const Transform& transform, const dvec3& p) {
        dvec3 result;
        for (int row = 0; row < 3; ++row) {
            const dvec4 m(transform.rows[static_cast<std::size_t>(row)]);
            result[row] = m.x * p.x + m.y * p.y + m.z * p.z + m.w;
        }
        return result;
    }
    // The smallest of the three barycentric coordinates; NaN for degenerate and non-finite triangles.
    static double intersect(const Triangle& triangle, const Ray& ray, ExpectedHit& hit) {
        const dvec3 d(ray.direction), a = triangle.corners[0];
        const dvec3 e1 = triangle.corners[1] - a, e2 = triangle.corners[2] - a, s = dvec3(ray.origin) - a;
        const dvec3 p = cross(d, e2), q = cross(s, e1);
        const double determinant = dot(e1, p);
        if (determinant == 0) return NAN;
        hit = {dot(e2, q) / determinant, dot(s, p) / determinant, dot(d, q) / determinant, triangle.instance,
               triangle.primitive};
        return std::min({hit.u, hit.v, 1 - hit.u - hit.v});
    }

    static constexpr double margin_ = 1e-3;
    static constexpr uint unsure_ = ~0u;
    std::vector<Triangle> triangles_;
    uint instance_count_ = 0;
};

// Rays between random points of a box of this half extent around the origin.
inline std::vector<Ray> random_rays(std::size_t count, unsigned seed, float extent) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> within(-extent, extent);
    const auto point = [&] { return vec3(within(random), within(random), within(random)); };
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i) {
        const vec3 origin = point();
        rays.push_back({origin, 0, point() - origin, INFINITY});
    }
    return rays;
}

// Every ray whose answer is certain is answered right; at least `least_hits` of them hit something.
inline void expect_agreement(HwTlas& accel, const BruteForce& reference, const std::vector<Ray>& rays,
                             std::size_t least_hits) {
    const std::vector<Hit> hits = accel.closest_hits(rays), any_hits = accel.any_hits(rays);
    std::size_t hit_count = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const std::optional<ExpectedHit> expected = reference.closest(rays[i]);
        if (!expected) continue;
        if (expected->t == INFINITY) {
            ASSERT_TRUE(same_bytes(hits[i], miss()) && same_bytes(any_hits[i], miss())) << "ray " << i;
            continue;
        }
        ++hit_count;
        ASSERT_EQ(hits[i].hit, 1u) << "ray " << i;
        ASSERT_EQ(any_hits[i].hit, 1u) << "ray " << i;
        EXPECT_EQ(hits[i].instance_index, expected->instance) << "ray " << i;
        EXPECT_EQ(hits[i].primitive_index, expected->primitive) << "ray " << i;
        EXPECT_NEAR(hits[i].t, expected->t, 1e-5 * std::max(1.0, expected->t)) << "ray " << i;
        EXPECT_NEAR(hits[i].u, expected->u, 1e-3) << "ray " << i;
        EXPECT_NEAR(hits[i].v, expected->v, 1e-3) << "ray " << i;
    }
    EXPECT_GE(hit_count, least_hits);
}

}  // namespace twinray::test
