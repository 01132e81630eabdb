// SPDX-License-Identifier: MIT
// The record of invalid accesses in kernels compiled with TWINRAY_DEBUG: their number and the first of them.
#ifndef TWINRAY_SHARED_FAULTS_H
#define TWINRAY_SHARED_FAULTS_H

// The number of invalid accesses in kernels, and the first of them.
struct Faults {
    uint count;
    uint type;  // SetKey::type; 0 for an index into a structure of arrays
    uint index;
    uint reserved;
};
BUFFER_OF(Faults, 16);
#endif
