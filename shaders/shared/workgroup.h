// SPDX-License-Identifier: MIT
// Sizes of groups and of dispatches of them.
#ifndef TWINRAY_SHARED_WORKGROUP_H
#define TWINRAY_SHARED_WORKGROUP_H

// Of dispatches that shaders record: devices guarantee 65535 along an axis; global_index() undoes it.
const uint GROUPS_PER_ROW = 32768u;

// Of groups whose invocations wait for each other, or have much to do each: specialised for the device.
const uint GROUP_SIZE_CONSTANT = 1u;
const uint CPU_GROUP = 8u; // on a CPU: a vector's lanes; more would take turns between barriers, and leave threads without a group
#endif
