#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: VK_DRIVER_FILES=A:B makes device 0 one of A and device 1 one of B, where each has one.
# Seen: with two lavapipes, which differ in version alone, device 0 is that of B and device 1 that of A, in either
# order. A program that takes the first device therefore runs on the last driver that it was given.
# Seen with libvulkan1 1.4.309.0-1 and 25.0.7-2+deb13u1 and 26.1.6-1~bpo13+1 of mesa-vulkan-drivers on 2026-11-27.
folder=$(mktemp -d)
mesa_25=25.0.7-2+deb13u1
mesa_26=26.1.6-1~bpo13+1
# shellcheck source=findings/room.sh
. "$(dirname "${BASH_SOURCE[0]}")/room.sh"
make_lavapipe_room
install libvulkan1=1.4.309.0-1

cat >"$probe/order.c" <<'END'
#include <stdio.h>
#include <string.h>
#include <vulkan/vulkan.h>
int main(void) {
    const VkApplicationInfo application = {VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_3};
    const VkInstanceCreateInfo info = {VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &application};
    VkInstance instance;
    VkPhysicalDevice devices[8];
    uint32_t count = 8;
    if (vkCreateInstance(&info, NULL, &instance) || vkEnumeratePhysicalDevices(instance, &count, devices)) return 1;
    for (uint32_t i = 0; i < count; ++i) {
        VkPhysicalDeviceDriverProperties driver = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
        VkPhysicalDeviceProperties2 properties = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver};
        vkGetPhysicalDeviceProperties2(devices[i], &properties);
        driver.driverInfo[strcspn(driver.driverInfo, "(") - 1] = '\0'; // "Mesa VERSION (LLVM ...)"
        printf("%s%u: %s", i > 0 ? ", " : "", i, driver.driverInfo);
    }
    printf("\n");
    return 0;
}
END
program order
order() {
    in_room env VK_DRIVER_FILES="/opt/mesa/$1/icd.json:/opt/mesa/$2/icd.json" \
        VK_LOADER_LAYERS_DISABLE='~implicit~' ./order
}
same "given $mesa_25, then $mesa_26" "$(order "$mesa_25" "$mesa_26")" "0: Mesa $mesa_26, 1: Mesa $mesa_25"
same "given $mesa_26, then $mesa_25" "$(order "$mesa_26" "$mesa_25")" "0: Mesa $mesa_25, 1: Mesa $mesa_26"
conclude
