#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: what vkGetPipelineCacheData gives begins with a header of 32 bytes, as Vulkan says
# (VkPipelineCacheHeaderVersionOne), even for an empty cache, so that a program may read its UUID.
# Seen: lavapipe of Mesa 26.2.6 gives 20 bytes, of which the first four say that the header has 32: the UUID is cut
# off after four bytes. A program that checks such data before it gives them back finds them broken, at each start.
# Mesa 26.1.6 gives 32.
# Seen with 26.2.6-1 (sid) and 26.1.6-1~bpo13+1 of mesa-vulkan-drivers on 2026-11-27.
folder=$(mktemp -d)
mesa_26=26.1.6-1~bpo13+1
# shellcheck source=findings/room.sh
. "$(dirname "${BASH_SOURCE[0]}")/room.sh"
mesa_sid=26.2.6-1

cache_c() {
    cat <<'END'
#include "vk.h"
int main(void) { // prints how many bytes an empty pipeline cache has, and how many its header says that it has
    open_device();
    const VkPipelineCacheCreateInfo empty = {VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    VkPipelineCache cache;
    CHECK(vkCreatePipelineCache(device, &empty, NULL, &cache));
    size_t size = 0;
    CHECK(vkGetPipelineCacheData(device, cache, &size, NULL));
    uint32_t* const data = calloc(1, size + 4);
    CHECK(vkGetPipelineCacheData(device, cache, &size, data));
    printf("%zu bytes, header of %u\n", size, data[0]);
    return 0;
}
END
}

seen() { # suite, version
    make_room "$1"
    install gcc libc6-dev libvulkan-dev
    driver "$2"
    write_vk_h
    cache_c >"$probe/cache.c"
    program cache
    on_driver "$2" ./cache
    leave
}
same "an empty cache of $mesa_26" "$(seen trixie "$mesa_26")" '32 bytes, header of 32'
same "an empty cache of $mesa_sid" "$(seen sid "$mesa_sid")" '20 bytes, header of 32'
conclude
