// SPDX-License-Identifier: MIT
// Three ways to trace the same paths: by batches from the host, by a kernel, and by queues on the device.
#pragma once

#include <vector>

#include "room.h"

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
