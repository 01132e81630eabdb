#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: a newer release of a driver builds acceleration structures about as fast as the one before.
# Seen: lavapipe of Mesa 26.1.6 needs a hundred times as long as that of 25.0.7, and more, for the bottom level of
# 100,352 triangles, and not in the first build alone: each figure is the best of four after a first one. The script
# asks for a ratio of eight in one run on one machine.
# Seen with 25.0.7-2+deb13u1 and 26.1.6-1~bpo13+1 of mesa-vulkan-drivers on 2026-11-27; by hand also with 26.2.6-1
# (sid), which does as 26.1.6 does.
folder=$(mktemp -d)
mesa_25=25.0.7-2+deb13u1
mesa_26=26.1.6-1~bpo13+1
# shellcheck source=findings/room.sh
. "$(dirname "${BASH_SOURCE[0]}")/room.sh"
make_lavapipe_room

cat >"$probe/build.c" <<'END'
#include "vk.h"
enum { SIDE = 224, VERTICES = (SIDE + 1) * (SIDE + 1), TRIANGLES = 2 * SIDE * SIDE };
int main(void) {
    open_device();
    const Buffer positions = new_buffer(12 * VERTICES), indices = new_buffer(12 * TRIANGLES);
    float* position = positions.data;
    for (uint32_t i = 0; i < VERTICES; ++i, position += 3) { // rough ground
        position[0] = (float)(i % (SIDE + 1));
        position[1] = (float)(i / (SIDE + 1));
        position[2] = random_unit();
    }
    uint32_t* index = indices.data;
    for (uint32_t i = 0; i < SIDE * SIDE; ++i, index += 6) {
        const uint32_t a = i / SIDE * (SIDE + 1) + i % SIDE, b = a + 1, c = a + SIDE + 1, d = c + 1;
        const uint32_t both[6] = {a, b, d, a, d, c};
        memcpy(index, both, sizeof both);
    }
    const VkAccelerationStructureGeometryKHR geometry = triangles(positions, VERTICES, indices);
    const uint32_t count = TRIANGLES;
    double best = INFINITY;
    for (int i = 0; i < 5; ++i) {
        const double ms = build_bottom(0, 1, &geometry, &count).build_ms;
        if (i > 0) best = fmin(best, ms);
    }
    printf("%.0f\n", best * 1000);
    fprintf(stderr, "%u triangles, best of four builds: %.1f ms\n", count, best);
    return 0;
}
END
program build
before=$(on_driver "$mesa_25" ./build)
after=$(on_driver "$mesa_26" ./build)
holds "Mesa $mesa_25 needs $before microseconds, Mesa $mesa_26 $after: more than eight times" $((after > 8 * before))
conclude
