// SPDX-License-Identifier: MIT
// The arguments of kernels that copy an array.
#ifndef TWINRAY_SHARED_COPIES_H
#define TWINRAY_SHARED_COPIES_H
#include "twinray/glsl/instance.h"

struct CopyWordsArgs {
    Uints from;
    Uints to;
    uint count;
    uint reserved;
};

struct CopyFloatsArgs {
    Floats from;
    Floats to;
    uint count;
    float factor;
};

// Transforms go into instance records; ids, masks and flags stay.
struct CopyTransformsArgs {
    REF(InstanceRecord) records;
    Vec4s rows;  // three a transform, 48 bytes
    uint count;
    uint reserved;
};

// Items have `words_per_item` words each.
struct CopyItemsArgs {
    Uints from;
    Uints to;
    uint count;
    uint words_per_item;
};
#endif
