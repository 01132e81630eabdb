// SPDX-License-Identifier: MIT
// The sums of each pixel. Neither the order nor the grouping of the summands changes a bit of them: each number is cut
// into digits of 40 bits at fixed positions, and the digits of two positions are added as integers, those of the
// position that the largest number reaches and of the next below. Smaller parts, less than 2^-40 of the largest number,
// are left out, whenever they come. (Demmel and Nguyen, "Parallel Reproducible Summation", 2015; integers, because
// devices need not round float64 correctly or have it at all.) Needs wave.h.
#ifndef TWINRAY_PATH_TRACER_FILM_H
#define TWINRAY_PATH_TRACER_FILM_H
#include "twinray/glsl/word64.h"

const uint FILM_DIGIT_BITS = 40u;  // 2^23 numbers fit into a sum of 64 bits with a sign
const uint FILM_SQUARES = 3u;      // the number of their sum, behind red, green and blue

// One digit of four sums of a block: red, green, blue, and the luminance squared.
struct FilmDigits {
    uvec2 red;
    uvec2 green;
    uvec2 blue;
    uvec2 square;
};

// 72 bytes. A sum is (high * 2^40 + low) * 2^(40 position), in two's complement, in units of 2^-149 for colors and of
// 2^-298 for squares.
struct FilmPixel {
    uint count;      // of the blocks that were added
    uint positions;  // low half: of the color sums; high half: of the sum of squares
    FilmDigits high;
    FilmDigits low;
};
BUFFER_OF(FilmPixel, 8);

// Return the mantissa and the shift of |x|, which is mantissa << shift, in units of 2^-149, for finite x.
FUNC uint film_mantissa(float x) {
    uint bits = floatBitsToUint(x);
    return (bits & 0x7fffffu) | ((bits & 0x7f800000u) != 0u ? 0x800000u : 0u);
}
FUNC uint film_shift(float x) { return max((floatBitsToUint(x) >> 23u) & 0xffu, 1u) - 1u; }

// Returns the lower of the two positions for a number of so many bits, which need not all be used.
FUNC uint film_position(uint shift, uint bits) { return max((shift + bits - 1u) / FILM_DIGIT_BITS, 1u) - 1u; }

// Returns bits [40 position, 40 position + 40) of mantissa << shift, for mantissas of at most 48 bits.
FUNC uvec2 film_digit(uvec2 mantissa, uint shift, uint position) {
    int up = int(shift) - int(FILM_DIGIT_BITS * position);
    if (up >= int(FILM_DIGIT_BITS) || up <= -48) return uvec2(0u);
    uvec2 bits = up >= 0 ? shift_up64(mantissa, uint(up)) : shift_down64(mantissa, uint(-up));
    return uvec2(bits.x, bits.y & ((1u << (FILM_DIGIT_BITS - 32u)) - 1u));
}

// Bits below the positions are left out; a sum whose position is not lower already stays.
FUNC void film_raise(INOUT(uvec2) high, INOUT(uvec2) low, uint from, uint to) {
    if (to <= from) return;
    low = to == from + 1u ? high : uvec2(0u);
    high = uvec2(0u);
}

FUNC void film_raise_all(INOUT(FilmPixel) pixel, uint color_position, uint square_position) {
    uint old_color = pixel.positions & 0xffffu, old_square = pixel.positions >> 16u;
    film_raise(pixel.high.red, pixel.low.red, old_color, color_position);
    film_raise(pixel.high.green, pixel.low.green, old_color, color_position);
    film_raise(pixel.high.blue, pixel.low.blue, old_color, color_position);
    film_raise(pixel.high.square, pixel.low.square, old_square, square_position);
    pixel.positions = max(old_color, color_position) | (max(old_square, square_position) << 16u);
}

// Adds to the digits of a sum, whose position is high enough.
FUNC void film_add_color(INOUT(uvec2) high, INOUT(uvec2) low, float value, uint position) {
    uint shift = film_shift(value);
    uvec2 mantissa = uvec2(film_mantissa(value), 0u);
    uvec2 low_digit = film_digit(mantissa, shift, position), high_digit = film_digit(mantissa, shift, position + 1u);
    bool is_negative = value < 0.0f;
    low = add64(low, is_negative ? negate64(low_digit) : low_digit);
    high = add64(high, is_negative ? negate64(high_digit) : high_digit);
}

// Adds a block's sum of finite radiance.
FUNC void film_add(INOUT(FilmPixel) pixel, vec3 radiance, float luminance_of_it) {
    uint shift = max(film_shift(radiance.x), max(film_shift(radiance.y), film_shift(radiance.z)));
    uint square_shift = 2u * film_shift(luminance_of_it);
    film_raise_all(pixel, film_position(shift, 24u), film_position(square_shift, 48u));
    uint position = pixel.positions & 0xffffu, square_position = pixel.positions >> 16u;
    film_add_color(pixel.high.red, pixel.low.red, radiance.x, position);
    film_add_color(pixel.high.green, pixel.low.green, radiance.y, position);
    film_add_color(pixel.high.blue, pixel.low.blue, radiance.z, position);
    uvec2 square = multiply64(film_mantissa(luminance_of_it), film_mantissa(luminance_of_it));
    pixel.low.square = add64(pixel.low.square, film_digit(square, square_shift, square_position));
    pixel.high.square = add64(pixel.high.square, film_digit(square, square_shift, square_position + 1u));
    pixel.count += 1u;
}

struct AccumulateArgs {
    REF(FilmPixel) film;
    REF(Radiance) sums;
    REF(Counters) counters;
    Uints pixels;
    uint count;
};
#endif
