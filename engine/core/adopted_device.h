// SPDX-License-Identifier: MIT
// What is checked of a device that somebody else created before it is used.
#pragma once

#include <twinray/context.h>

namespace twinray {

struct VulkanTable;

// What twinray may use of it: the features of `adopted.enabled`, all other properties from the driver. Throws Error,
// naming what the host has to change, unless twinray can run on the device: something needed is not enabled, the queue
// family has no compute, or `enabled` claims what the device does not support or the VkDevice was not created with. The
// handles must be set and the functions of all levels loaded.
DeviceProperties check_adoption(const AdoptedDevice& adopted, const VulkanTable& vk);

}  // namespace twinray
