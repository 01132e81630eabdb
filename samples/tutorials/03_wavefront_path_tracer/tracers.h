// SPDX-License-Identifier: MIT
// The room of tutorial 3, a box of side 1, open towards +z, with a lamp, a mirror and a ball; and three ways to trace
// the same paths: by batches from the host, by a kernel, and by queues on the device; with
// the uncertainty of a mean, and the comparison of pictures.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include <twinray/scene.h>
#include <twinray/tlas.h>

// [include]
#include "twinray/glsl/cpp_sampling.h"
#include "twinray/glsl/cpp_spawn.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "path.h"
#include "twinray/glsl/cpp_end.h"
}  // namespace twinray

// [make]
inline twinray::Room make_room(float aspect) {
    using namespace twinray;
    const ImagePlane plane = image_plane(look_camera({0.5f, 0.5f, 2.4f}, {0.5f, 0.5f, 0}, {0, 1, 0}, 39), aspect);
    return {.looks = {{vec3(0.7f), DIFFUSE},
                      {vec3(0.6f, 0.06f, 0.05f), DIFFUSE},
                      {vec3(0.1f, 0.45f, 0.1f), DIFFUSE},
                      {vec3(0.95f), MIRROR},
                      {vec3(0.8f, 0.55f, 0.15f), DIFFUSE},
                      {vec3(0), LAMP}},
            .lamp = {{0.25f, 0.98f, 0.3f}, {0.5f, 0, 0}, {0, 0, 0.5f}, {7.5f, 7, 6}},
            .eye = {plane.origin, plane.right, plane.up, plane.forward}};
}

// Pushes the room; custom indices name the look of each part.
inline void push_room(twinray::AbstractAccel& accel, const twinray::Room& room) {
    using namespace twinray;
    const auto push = [&](const Mesh& mesh, uint look, const Transform& transform = {}) {
        accel.push(mesh, transform, {.custom_index = look, .mask = SOLID_MASK});
    };
    push(make_quad({0, 0, 0}, {0, 0, 1}, {1, 0, 0}), 0);  // floor
    push(make_quad({0, 1, 0}, {1, 0, 0}, {0, 0, 1}), 0);  // ceiling
    push(make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 0);  // back
    push(make_quad({0, 0, 0}, {0, 1, 0}, {0, 0, 1}), 1);  // left
    push(make_quad({1, 0, 0}, {0, 0, 1}, {0, 1, 0}), 2);  // right
    const Transform turned{{vec4(0.8f, 0, 0.6f, 0.33f), vec4(0, 1, 0, 0), vec4(-0.6f, 0, 0.8f, 0.34f)}};
    push(make_box({-0.14f, 0, -0.14f}, {0.14f, 0.6f, 0.14f}), 3, turned);
    push(make_icosphere(5, 0.16f), 4, Transform::translation({0.68f, 0.16f, 0.66f}));
    accel.push(make_quad(room.lamp.corner, room.lamp.u, room.lamp.v), {}, {.custom_index = 5, .mask = LAMP_MASK});
}
// [/make]

// The radiance of each pixel, row 0 on top: the mean of its paths.
using Picture = std::vector<twinray::vec3>;

// [queue]
// Rays to be traced, and the paths that they belong to.
struct Queue {
    std::vector<twinray::Ray> rays;
    std::vector<twinray::Path> paths;

    void push(const twinray::Ray& ray, const twinray::Path& path) {
        rays.push_back(ray);
        paths.push_back(path);
    }
};
// [/queue]

Queue first_rays(const twinray::Room& room, const twinray::Job& job);
// Traces the rays and adds their light to the picture. Returns those of the paths that go on.
Queue bounce(twinray::AbstractAccel& accel, const twinray::Room& room, const Queue& queue, Picture& picture);
// Traces a job by batches. The accelerator keeps surfaces.
Picture trace_by_batches(twinray::AbstractAccel& accel, const twinray::Room& room, const twinray::Job& job);

// Takes radiances of paths, all of a sample in a row.
Picture mean_of_samples(const std::vector<twinray::vec3>& radiances, std::size_t pixels);
// Uploads the room to device memory, for kernels.
twinray::Buffer upload(twinray::Context& context, const twinray::Room& room);

// Traces a job by a kernel, one path per invocation.
class PathKernel {
  public:
    PathKernel(twinray::AbstractAccel& accel, const twinray::Room& room);
    Picture trace(const twinray::Job& job);

  private:
    twinray::AbstractAccel& accel_;
    twinray::Buffer room_;
    twinray::QueryKernel<twinray::PathArgs> kernel_;
};

// Traces a job by batches whose queues stay on the device.
class PathWaves {
  public:
    PathWaves(twinray::AbstractAccel& accel, const twinray::Room& room);
    Picture trace(const twinray::Job& job);

  private:
    twinray::AbstractAccel& accel_;
    twinray::Room room_;
    twinray::Buffer room_buffer_;
    twinray::Kernel<twinray::WaveArgs> scatter_, unblocked_;
};

using Trace = std::function<Picture(const twinray::Job&)>;

inline double mean_of(const Picture& picture) {
    double sum = 0;
    for (const twinray::vec3& radiance : picture) sum += double(radiance.x) + radiance.y + radiance.z;
    return sum / (3 * double(picture.size()));
}

// [estimate]
struct Estimate {
    double mean, error;  // the standard error of the mean
};

// The mean over 32 pictures of one path per pixel: the less their means differ, the surer is the mean of all.
inline Estimate mean_radiance(const Trace& trace, twinray::uint first_sample) {
    const twinray::uint rounds = 32;
    std::vector<double> means;
    double mean = 0, squares = 0;
    for (twinray::uint i = 0; i < rounds; ++i) means.push_back(mean_of(trace({64, 64, first_sample + i, 1})));
    for (const double m : means) mean += m / rounds;
    for (const double m : means) squares += (m - mean) * (m - mean);
    return {mean, std::sqrt(squares / (rounds - 1) / rounds)};
}

// Two correct results differ by more than 4 of them once in 16,000 times.
inline double standard_errors_between(const Estimate& a, const Estimate& b) {
    return std::abs(a.mean - b.mean) / std::hypot(a.error, b.error);
}
// [/estimate]

// Returns in how many pixels two pictures differ by more than rounding may do.
inline std::size_t differing_pixels(const Picture& a, const Picture& b) {
    std::size_t differing = 0;
    for (std::size_t i = 0; i < a.size(); ++i) differing += !(length(a[i] - b[i]) <= length(a[i]) / 1000);
    return differing;
}
