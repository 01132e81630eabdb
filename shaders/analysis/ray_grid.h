// SPDX-License-Identifier: MIT
// Parallel rays through the cells of a plane: the view of a scene from far away.
#ifndef TWINRAY_ANALYSIS_RAY_GRID_H
#define TWINRAY_ANALYSIS_RAY_GRID_H
#include "twinray/glsl/random.h"
#include "twinray/glsl/rays.h"

const uint GRID_AT_CENTERS = 0u;
const uint GRID_AT_RANDOM = 1u;  // one point of each cell, uniform and independent
const uint GRID_STRIP = 8u;      // rows that are walked together, column by column: neighbouring rays stay together
const uint GRID_STREAM = 0x67726964u;

struct RayGrid {
    vec3 origin;  // the outer end of the first cell
    vec3 across;  // sides of a cell
    vec3 up;
    vec3 direction;  // of all rays; unit
    uint side;       // cells in a row and rows, 1 to 65535
    uint points;     // GRID_AT_*
    uint seed_low;
    uint seed_high;
};

struct GridRaysArgs {
    RayGrid grid;
    REF(Ray) rays;
    uint first;  // ray of the grid
    uint count;
};

// Returns column and row of a cell. Any two cells 2 i and 2 i + 1 are neighbours, except at the ends of strips.
FUNC uvec2 grid_cell(RayGrid grid, uint index) {
    uint strip = index / (GRID_STRIP * grid.side);
    uint first_row = strip * GRID_STRIP;
    uint height = min(GRID_STRIP, grid.side - first_row);
    uint within = index - first_row * grid.side;
    return uvec2(within / height, first_row + within % height);
}

FUNC Ray grid_ray(RayGrid grid, uint index) {
    vec2 within_cell = vec2(0.5f, 0.5f);
    if (grid.points == GRID_AT_RANDOM) {
        uvec4 words = random_words(uvec4(index, grid.seed_low, grid.seed_high, GRID_STREAM));
        within_cell = unit_floats(uvec2(words.x, words.y));
    }
    uvec2 cell = grid_cell(grid, index);
    PRECISE float a = float(cell.x) + within_cell.x;
    PRECISE float b = float(cell.y) + within_cell.y;
    PRECISE vec3 along_a = grid.across * a;
    PRECISE vec3 along_b = grid.up * b;
    PRECISE vec3 inside = along_a + along_b;
    PRECISE vec3 origin = grid.origin + inside;
    Ray ray;
    ray.origin = origin;
    ray.t_min = 0.0f;
    ray.direction = grid.direction;
    ray.t_max = uintBitsToFloat(0x7f800000u);
    return ray;
}
#endif
