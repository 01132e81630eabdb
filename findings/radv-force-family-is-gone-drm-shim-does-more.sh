#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: RADV_FORCE_FAMILY makes RADV compile for a GPU that is not there; and no such thing exists for the
# drivers of other vendors, least of all for one of telephones or of Apple's on an x86-64 machine. Seen: it does so on
# Mesa 25.0.7. On 26.1.6 RADV says that the variable has been removed, and makes no instance. Its replacement is in
# Debian's package mesa-drm-shim: libraries to preload that answer like a kernel's driver. With them RADV, NVK (NVIDIA),
# Turnip (Qualcomm) and Honeykrisp (Apple) list a GPU on a machine without any. Seen with 25.0.7-2+deb13u1 and
# 26.1.6-1~bpo13+1 of mesa-vulkan-drivers and mesa-drm-shim on 2026-11-27.
folder=$(mktemp -d)
mesa_25=25.0.7-2+deb13u1
mesa_26=26.1.6-1~bpo13+1
# shellcheck source=findings/room.sh
. "$(dirname "${BASH_SOURCE[0]}")/room.sh"
make_room trixie
install gcc libc6-dev libvulkan-dev

cat >"$probe/devices.c" <<'END'
#include <stdio.h>
#include <vulkan/vulkan.h>
int main(void) { // the names of all devices
    const VkApplicationInfo application = {VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_0};
    const VkInstanceCreateInfo info = {VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &application};
    VkInstance instance;
    VkPhysicalDevice devices[8];
    uint32_t count = 8;
    if (vkCreateInstance(&info, NULL, &instance)) return puts("no instance"), 0;
    if (vkEnumeratePhysicalDevices(instance, &count, devices) || count == 0) puts("none");
    for (uint32_t i = 0; i < count; ++i) {
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(devices[i], &properties);
        puts(properties.deviceName);
    }
    return 0;
}
END
program devices

devices() { # driver, environment...
    local file
    file=$(cd "$room" && ls usr/share/vulkan/icd.d/"$1"_icd*.json)
    in_room env VK_DRIVER_FILES="/$file" VK_LOADER_LAYERS_DISABLE='~implicit~' "${@:2}" ./devices
}
shim() { # kernel driver: what makes it answer
    local file
    file=$(cd "$room" && find usr/lib -name "lib$1_noop_drm_shim.so")
    if [[ -z $file ]]; then fail "mesa-drm-shim has no $1"; fi
    echo "LD_PRELOAD=/$file"
}

install "mesa-vulkan-drivers=$mesa_25" "mesa-drm-shim=$mesa_25"
same "Mesa $mesa_25, RADV_FORCE_FAMILY=navi31" "$(devices radeon RADV_FORCE_FAMILY=navi31)" \
    "Null hardware (RADV NAVI31)"
install "mesa-vulkan-drivers=$mesa_26" "mesa-drm-shim=$mesa_26"
same "Mesa $mesa_26, RADV_FORCE_FAMILY=navi31" "$(devices radeon RADV_FORCE_FAMILY=navi31)" "no instance"
same "Mesa $mesa_26, shim of amdgpu" "$(devices radeon "$(shim amdgpu)" AMDGPU_GPU_ID=navi31)" \
    "AMD Radeon RX 7900 XTX (RADV NAVI31)"
same "Mesa $mesa_26, shim of nouveau" "$(devices nouveau "$(shim nouveau)" NOUVEAU_CHIPSET=172)" "NVK "
same "Mesa $mesa_26, shim of freedreno" "$(devices freedreno "$(shim freedreno)" FD_GPU_ID=740)" \
    "Turnip Adreno (TM) 740"
same "Mesa $mesa_26, shim of asahi" "$(devices asahi "$(shim asahi)")" "Apple M1 (G13G A0)"
conclude
