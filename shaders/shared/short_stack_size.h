// SPDX-License-Identifier: MIT
// The numbers of entries that a traversal's stack keeps: powers of two.
#ifndef TWINRAY_SHARED_SHORT_STACK_SIZE_H
#define TWINRAY_SHARED_SHORT_STACK_SIZE_H
const uint STACK_SIZE = 16u;
const uint REGISTER_STACK_SIZE = 8u; // where each is compared with the slot
#endif
