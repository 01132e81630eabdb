// SPDX-License-Identifier: MIT
// The arguments of shaders/engine/copy_transforms.comp.
#ifndef TWINRAY_SHARED_COPY_TRANSFORMS_H
#define TWINRAY_SHARED_COPY_TRANSFORMS_H
#include "twinray/glsl/instance.h"

struct CopyTransformsArgs
{
    REF(InstanceRecord) records;
    Vec4s rows; // three a transform, 48 bytes
    uint count;
    uint reserved;
};
#endif
