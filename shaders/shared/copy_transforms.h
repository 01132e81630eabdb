// SPDX-License-Identifier: MIT
// What shaders/engine/copy_transforms.comp takes.
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
