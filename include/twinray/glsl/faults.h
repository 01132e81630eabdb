// SPDX-License-Identifier: MIT
// What kernels compiled with TWINRAY_DEBUG were refused: how often, and the first of it.
#ifndef TWINRAY_SHARED_FAULTS_H
#define TWINRAY_SHARED_FAULTS_H

// How often kernels were refused something, and the first of it.
struct Faults {
    uint count;
    uint type;  // of a SetKey; 0 for an index into a structure of arrays
    uint index;
    uint reserved;
};
BUFFER_OF(Faults, 16);
#endif
