// SPDX-License-Identifier: MIT
// The queues of a wave in device memory, for C++ and kernels.
#ifndef TUTORIALS_WAVE_H
#define TUTORIALS_WAVE_H
#include "path.h"

BUFFER_OF(Path, 4);

struct DeviceQueue {
    REF(Ray) rays;
    REF(Path) paths;
    Uints count;
};

struct WaveArgs {
    Address accel;
    REF(Room) room;
    REF(Hit) hits;      // of the queue, then of the shadow rays
    Vec3s radiances;    // of each path, all of a sample in a row
    DeviceQueue queue;  // what is traced
    DeviceQueue next;
    DeviceQueue shadows;  // the weight of their paths is the light that they ask for
    uint pixels;
    uint first_sample;
};

FUNC uint place_of(WaveArgs args, Path path) {
    return (path.sample_index - args.first_sample) * args.pixels + path.pixel;
}
#endif
