// SPDX-License-Identifier: MIT
// What each pixel has gathered. Sums are such that neither the order nor the grouping of what is added changes a bit
// of them: each number is cut into digits of 40 bits at fixed positions, and the digits of two positions are added as
// integers, those of the position that the largest number reaches and of the next below. What is smaller than both,
// less than 2^-40 of the largest number, is left out, whenever it comes. (Demmel and Nguyen, "Parallel
// Reproducible Summation", 2015; integers, because devices need not round float64 correctly or have it at all.) Needs
// wave.h.
#ifndef TWINRAY_PATH_TRACER_FILM_H
#define TWINRAY_PATH_TRACER_FILM_H
#include "twinray/glsl/word64.h"

const uint FILM_DIGIT_BITS = 40u; // 2^23 numbers fit into a sum of 64 bits with a sign
const uint FILM_SQUARES = 3u;     // index of their sum

// 72 bytes. A sum is (high * 2^40 + low) * 2^(40 position), in two's complement, in units of 2^-149 for colors and of
// 2^-298 for squares.
struct FilmPixel
{
    uint count;       // of the blocks that were added
    uint positions;      // low half: of the color sums; high half: of the sum of squares
    uvec2 high[4]; // of a block's red, green and blue, and of its luminance squared
    uvec2 low[4];
};
BUFFER_OF(FilmPixel, 8);

// |x| is mantissa << shift, in units of 2^-149, for finite x.
FUNC uint film_mantissa(float x)
{
    uint bits = floatBitsToUint(x);
    return (bits & 0x7fffffu) | ((bits & 0x7f800000u) != 0u ? 0x800000u : 0u);
}
FUNC uint film_shift(float x) { return max((floatBitsToUint(x) >> 23u) & 0xffu, 1u) - 1u; }

// The lower of the two positions for a number of so many bits, which need not all be used.
FUNC uint film_position(uint shift, uint bits) { return max((shift + bits - 1u) / FILM_DIGIT_BITS, 1u) - 1u; }

// Bits [40 position, 40 position + 40) of mantissa << shift, for mantissas of at most 48 bits.
FUNC uvec2 film_digit(uvec2 mantissa, uint shift, uint position)
{
    int up = int(shift) - int(FILM_DIGIT_BITS * position);
    if (up >= int(FILM_DIGIT_BITS) || up <= -48) return uvec2(0u);
    uvec2 bits = up >= 0 ? shift_up64(mantissa, uint(up)) : shift_down64(mantissa, uint(-up));
    return uvec2(bits.x, bits.y & ((1u << (FILM_DIGIT_BITS - 32u)) - 1u));
}

// What lies below the positions is left out; a sum whose position is not lower already stays.
FUNC void film_raise(INOUT(FilmPixel) pixel, uint sum, uint from, uint to)
{
    if (to <= from) return;
    pixel.low[sum] = to == from + 1u ? pixel.high[sum] : uvec2(0u);
    pixel.high[sum] = uvec2(0u);
}

FUNC void film_raise_all(INOUT(FilmPixel) pixel, uint color_position, uint square_position)
{
    uint old_color = pixel.positions & 0xffffu, old_square = pixel.positions >> 16u;
    for (uint i = 0u; i < FILM_SQUARES; ++i) film_raise(pixel, i, old_color, color_position);
    film_raise(pixel, FILM_SQUARES, old_square, square_position);
    pixel.positions = max(old_color, color_position) | (max(old_square, square_position) << 16u);
}

// A block's sum of finite radiance.
FUNC void film_add(INOUT(FilmPixel) pixel, vec3 radiance, float luminance_of_it)
{
    float values[3];
    values[0] = radiance.x;
    values[1] = radiance.y;
    values[2] = radiance.z;
    uint shift = max(film_shift(radiance.x), max(film_shift(radiance.y), film_shift(radiance.z)));
    uint square_shift = 2u * film_shift(luminance_of_it);
    film_raise_all(pixel, film_position(shift, 24u), film_position(square_shift, 48u));
    uint position = pixel.positions & 0xffffu, square_position = pixel.positions >> 16u;
    for (uint i = 0u; i < FILM_SQUARES; ++i)
    {
        uint digit_shift = film_shift(values[i]);
        uvec2 mantissa = uvec2(film_mantissa(values[i]), 0u), low = film_digit(mantissa, digit_shift, position);
        uvec2 high = film_digit(mantissa, digit_shift, position + 1u);
        bool is_negative = values[i] < 0.0f;
        pixel.low[i] = add64(pixel.low[i], is_negative ? negate64(low) : low);
        pixel.high[i] = add64(pixel.high[i], is_negative ? negate64(high) : high);
    }
    uvec2 square = multiply64(film_mantissa(luminance_of_it), film_mantissa(luminance_of_it));
    pixel.low[FILM_SQUARES] = add64(pixel.low[FILM_SQUARES], film_digit(square, square_shift, square_position));
    pixel.high[FILM_SQUARES] = add64(pixel.high[FILM_SQUARES], film_digit(square, square_shift, square_position + 1u));
    pixel.count += 1u;
}

struct AccumulateArgs
{
    REF(FilmPixel) film;
    REF(Radiance) sums;
    REF(Counters) counters;
    Uints pixels;
    uint count;
};
#endif
