// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <twinray/scene.h>

#include "renderer/camera.h"

namespace twinray::path_tracer {
namespace {

// Stratified in both dimensions.
template <class F>
std::vector<vec2> points_of(F warp, uint side = 512) {
    std::vector<vec2> points;
    for (uint y = 0; y < side; ++y)
        for (uint x = 0; x < side; ++x) points.push_back(warp((vec2(x, y) + 0.5f) / static_cast<float>(side)));
    return points;
}

// Largest difference between the share of values below x and the distribution that is wanted (Kolmogorov and Smirnov).
double distance_of(std::vector<float> values, const std::function<double(double)>& distribution) {
    std::sort(values.begin(), values.end());
    double largest = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
        largest = std::max(largest, std::abs(distribution(double{values[i]}) -
                                             (static_cast<double>(i) + 0.5) / static_cast<double>(values.size())));
    return largest;
}

TEST(Filter, SamplesAreDistributedAsTheFilterSays) {
    const auto box = [](double x) { return std::clamp(x + 0.5, 0.0, 1.0); };
    const auto triangle = [](double x) { return x < 0 ? (1 + x) * (1 + x) / 2 : 1 - (1 - x) * (1 - x) / 2; };
    const auto gaussian = [](double x) { return 0.5 * std::erfc(-x / 0.5 / std::sqrt(2.0)); };
    const std::pair<uint, std::function<double(double)>> filters[] = {
        {FILTER_BOX, box}, {FILTER_TRIANGLE, triangle}, {FILTER_GAUSSIAN, gaussian}};
    for (const auto& [kind, distribution] : filters) {
        const auto points = points_of([kind = kind](vec2 u) { return filter_offset(kind, u); });
        for (const int axis : {0, 1}) {
            std::vector<float> values;
            for (const vec2& point : points) values.push_back(point[axis]);
            EXPECT_LT(distance_of(values, distribution), 0.002) << "filter " << kind << " axis " << axis;
        }
        double product = 0;
        for (const vec2& point : points) product += double{point.x} * double{point.y};
        EXPECT_NEAR(product / static_cast<double>(points.size()), 0, 1e-4) << "filter " << kind;
    }
}

TEST(Filter, EveryRandomNumberHasAFiniteOffset) {
    const float last = unit_float(0xffffffffu);
    for (const uint kind : {FILTER_BOX, FILTER_TRIANGLE, FILTER_GAUSSIAN})
        for (const vec2 u : {vec2(0), vec2(last), vec2(0, last), vec2(last, 0)})
            EXPECT_LT(length(filter_offset(kind, u)), 3) << "filter " << kind;
}

CameraRays tilted_camera(bool is_orthographic) {
    Camera camera = look_camera({1, 2, 3}, {-4, 0, 1}, {0, 1, 0}, 50);
    if (is_orthographic) camera.orthographic_half_height = 2;
    return camera_rays(camera, 1.5f);
}

TEST(Lens, RaysOfAPointMeetOnTheFocalPlane) {
    for (const bool is_orthographic : {false, true}) {
        CameraRays camera = tilted_camera(is_orthographic);
        const vec2 at(0.3f, -0.8f);
        const Ray pinhole = camera_ray(camera, at, vec2(0.7f));
        const vec3 sharp = pinhole.origin + pinhole.direction * (7 / dot(pinhole.direction, camera.forward));
        camera.lens_radius = 0.25f;
        camera.focal_distance = 7;
        for (const vec2& u : points_of([](vec2 v) { return v; }, 8)) {
            const Ray ray = camera_ray(camera, at, u);
            EXPECT_NEAR(length(ray.direction), 1, 1e-6f);
            EXPECT_NEAR(dot(ray.origin - pinhole.origin, camera.forward), 0, 1e-6f);
            EXPECT_NEAR(length(cross(sharp - ray.origin, ray.direction)), 0, 3e-6f);
        }
    }
}

TEST(Lens, MayFocusAnywhere) {
    CameraRays camera = tilted_camera(false);
    const Ray pinhole = camera_ray(camera, vec2(0), vec2(0));
    camera.lens_radius = 0.25f;
    camera.focal_distance = std::numeric_limits<float>::max();
    EXPECT_EQ(camera_ray(camera, vec2(0), vec2(0.3f)).direction, pinhole.direction);
}

TEST(Lens, RaysStartUniformlyOnADisk) {
    CameraRays camera = tilted_camera(false);
    camera.lens_radius = 0.25f;
    camera.focal_distance = 7;
    std::vector<float> radii, turns;
    for (const vec2& offset : points_of([&](vec2 u) {
             const vec3 way = camera_ray(camera, vec2(0), u).origin - camera.origin;
             return vec2(dot(way, normalize(camera.right)), dot(way, normalize(camera.up)));
         })) {
        radii.push_back(length(offset));
        turns.push_back(std::atan2(offset.y, offset.x));
    }
    EXPECT_LT(distance_of(radii, [](double r) { return r * r * 16; }), 0.002);
    EXPECT_LT(distance_of(turns, [](double angle) { return angle / (2 * M_PI) + 0.5; }), 0.002);
}

TEST(Lens, OfNoSizeIsAPinhole) {
    CameraRays camera = tilted_camera(false);
    const Ray expected = camera_ray(camera, {0.5f, 0.5f}, vec2(0));
    camera.focal_distance = 3;
    const Ray ray = camera_ray(camera, {0.5f, 0.5f}, vec2(0.9f));
    EXPECT_EQ(ray.origin, expected.origin);
    EXPECT_EQ(ray.direction, expected.direction);
}

}  // namespace
}  // namespace twinray::path_tracer
