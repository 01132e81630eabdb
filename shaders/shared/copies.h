// SPDX-License-Identifier: MIT
// The arguments of kernels that copy an array.
#ifndef TWINRAY_SHARED_COPIES_H
#define TWINRAY_SHARED_COPIES_H

struct CopyWordsArgs
{
    Uints from;
    Uints to;
    uint count;
    uint reserved;
};

struct CopyFloatsArgs
{
    Floats from;
    Floats to;
    uint count;
    float factor;
};
#endif
