// SPDX-License-Identifier: MIT
// The size of groups whose invocations wait for each other, or have much to do each: specialised for the device.
#ifndef TWINRAY_SHARED_WORKGROUP_H
#define TWINRAY_SHARED_WORKGROUP_H

const uint GROUP_SIZE_CONSTANT = 1u;
const uint CPU_GROUP = 8u; // on a CPU: a vector's lanes; more would take turns between barriers, and leave threads without a group
#endif
