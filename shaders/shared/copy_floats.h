// SPDX-License-Identifier: MIT
// What shaders/engine/copy_floats.comp takes.
#ifndef TWINRAY_SHARED_COPY_FLOATS_H
#define TWINRAY_SHARED_COPY_FLOATS_H

struct CopyFloatsArgs
{
    Floats from;
    Floats to;
    uint count;
    float factor;
};
#endif
