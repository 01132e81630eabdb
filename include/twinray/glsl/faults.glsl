// SPDX-License-Identifier: MIT
// Reports to the host a key or an index that names nothing, in kernels compiled with TWINRAY_DEBUG.
#ifndef TWINRAY_FAULTS_GLSL
#define TWINRAY_FAULTS_GLSL
#include "twinray/glsl/common.glsl"
#include "twinray/glsl/faults.h"

#ifdef TWINRAY_DEBUG
void note_fault(REF(Faults) faults, uint type, uint index) {
    if (atomicAdd(AT(faults, 0).count, 1u) != 0u) return;
    AT(faults, 0).type = type;
    AT(faults, 0).index = index;
}
#define TWINRAY_FAULT(faults, type, index) note_fault(faults, type, index);
#else
// A statement with its semicolon: records that a kernel used the invalid `index` of `type`; empty without
// TWINRAY_DEBUG.
#define TWINRAY_FAULT(faults, type, index)
#endif
#endif
