// SPDX-License-Identifier: MIT
// From floats to integers.
#ifndef TWINRAY_SHARED_WHOLE_H
#define TWINRAY_SHARED_WHOLE_H

// A whole number from 0 to 2^23 - 1 as an integer, read from the last bits of its sum with 2^23. Drivers on CPUs may
// convert floats to integers lane by lane, which takes some seven times as long.
FUNC uint whole_number(float x)
{
    PRECISE float sum = x + 8388608.0f;
    return floatBitsToUint(sum) & 0x7fffffu;
}
#endif
