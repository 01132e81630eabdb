// SPDX-License-Identifier: MIT
// 30-bit Morton codes: 10 bits an axis, x in the highest bit of each triple; and of 60-bit codes the lower half, that
// of the next 10 bits an axis.
#ifndef TWINRAY_SHARED_MORTON_H
#define TWINRAY_SHARED_MORTON_H

// ........ ........ ......98 76543210  ->  ....9..8 ..7..6.. 5..4..3. .2..1..0
FUNC uint spread_bits(uint x) {
    x = (x | (x << 16u)) & 0x030000ffu;
    x = (x | (x << 8u)) & 0x0300f00fu;
    x = (x | (x << 4u)) & 0x030c30c3u;
    x = (x | (x << 2u)) & 0x09249249u;
    return x;
}

// Returns the cell of a coordinate in [lo, hi] cut into 2^20; 0 if the interval has no length.
FUNC uint cell_of(float x, float lo, float hi) {
    PRECISE float extent = hi - lo;
    if (!(extent > 0.0f)) return 0u;
    PRECISE float offset = x - lo;
    PRECISE float scaled = offset / extent * 1048576.0f;
    scaled = scaled > 0.0f ? scaled : 0.0f;
    scaled = scaled < 1048575.0f ? scaled : 1048575.0f;
    return uint(scaled);
}

FUNC uvec3 cells_of(vec3 point, vec3 lo, vec3 hi) {
    return uvec3(cell_of(point.x, lo.x, hi.x), cell_of(point.y, lo.y, hi.y), cell_of(point.z, lo.z, hi.z));
}

// Returns the code of cells of 10 bits an axis.
FUNC uint interleaved(uint x, uint y, uint z) {
    return (spread_bits(x) << 2u) | (spread_bits(y) << 1u) | spread_bits(z);
}

FUNC uint morton_code(vec3 point, vec3 lo, vec3 hi) {
    uvec3 cells = cells_of(point, lo, hi);
    return interleaved(cells.x >> 10u, cells.y >> 10u, cells.z >> 10u);
}

FUNC uint morton_code_low(vec3 point, vec3 lo, vec3 hi) {
    uvec3 cells = cells_of(point, lo, hi);
    return interleaved(cells.x & 1023u, cells.y & 1023u, cells.z & 1023u);
}

// Maps floats (NaN excepted) to uints and keeps their order, for atomic min and max.
FUNC uint ordered_bits(float x) {
    uint bits = floatBitsToUint(x);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}
FUNC float from_ordered_bits(uint bits) {
    return uintBitsToFloat((bits & 0x80000000u) != 0u ? bits & 0x7fffffffu : ~bits);
}
#endif
