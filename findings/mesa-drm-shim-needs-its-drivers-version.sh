#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: on Debian 13 with Mesa's drivers from backports, `apt-get install mesa-drm-shim` gives a shim that works
# with them: both come from one source package.
# Seen: apt installs the shim of the release, 25.0.7, beside drivers of 26.1.6, for the package depends on no version of
# theirs. RADV 26.1.6 then refuses the GPU: the shim speaks DRM 3.49, and 3.54 is the least. With the shim of
# 26.1.6 the same GPU is there.
# Seen with 26.1.6-1~bpo13+1 of mesa-vulkan-drivers, and 25.0.7-2+deb13u1 and 26.1.6-1~bpo13+1 of mesa-drm-shim, on
# 2026-11-29.
folder=$(mktemp -d)
mesa_25=25.0.7-2+deb13u1
mesa_26=26.1.6-1~bpo13+1
# shellcheck source=findings/room.sh
. "$(dirname "${BASH_SOURCE[0]}")/room.sh"
make_room trixie
install vulkan-tools "mesa-vulkan-drivers=$mesa_26" "mesa-drm-shim=$mesa_25"

devices() { # what vulkaninfo and the driver say of GPUs
    local file
    file=$(cd "$room" && ls usr/share/vulkan/icd.d/radeon_icd*.json)
    in_room env VK_DRIVER_FILES="/$file" VK_LOADER_LAYERS_DISABLE='~implicit~' AMDGPU_GPU_ID=navi31 \
        LD_PRELOAD="/$(cd "$room" && find usr/lib -name libamdgpu_noop_drm_shim.so)" vulkaninfo --summary 2>&1 |
        grep -oE 'DRM version is [0-9.]+, but this driver is only compatible with [0-9.]+|deviceName .*' | sort -u
}

same "the shim depends on a version of the driver" \
    "$(in_room apt-cache show "mesa-drm-shim=$mesa_26" | grep -cE '^Depends:.*mesa-vulkan-drivers')" 0
same "drivers of $mesa_26, shim of $mesa_25" "$(devices)" \
    "DRM version is 3.49.0, but this driver is only compatible with 3.54.0"
install "mesa-drm-shim=$mesa_26"
same "drivers of $mesa_26, shim of $mesa_26" "$(devices | tr -s ' ')" \
    "deviceName = AMD Radeon RX 7900 XTX (RADV NAVI31)"
conclude
