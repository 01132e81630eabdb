// SPDX-License-Identifier: MIT
#ifndef TWINRAY_SHARED_SHORT_STACK_SIZE_H
#define TWINRAY_SHARED_SHORT_STACK_SIZE_H
const uint STACK_SIZE = 16u; // slots of a traversal's stack, a power of two
#endif
