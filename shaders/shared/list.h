// SPDX-License-Identifier: MIT
// A list to which invocations append. It continues to count when it is full, so that the host can make room for all. It
// has two words, since 64-bit atomics are not everywhere.
#ifndef TWINRAY_SHARED_LIST_H
#define TWINRAY_SHARED_LIST_H

struct ListTotal {
    uint low;
    uint high;
};
BUFFER_OF(ListTotal, 8);
#endif
