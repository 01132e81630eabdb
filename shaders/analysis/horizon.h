// SPDX-License-Identifier: MIT
// The horizon of a raster of heights along ways across it. Its surface is the triangles between four neighbours each:
// those with the corners (c, r), (c + 1, r), (c + 1, r + 1), and (c, r), (c + 1, r + 1), (c, r + 1).
#ifndef TWINRAY_ANALYSIS_HORIZON_H
#define TWINRAY_ANALYSIS_HORIZON_H

const uint HORIZON_SLOPE = 0u;        // the horizon's height over its distance, one answer a way
const uint HORIZON_LIGHT = 1u;        // the part of a uniform sky's light on a horizontal plane, of all ways together
const uint HORIZON_SOLID_ANGLE = 2u;  // the part of the hemisphere, likewise

const float NO_HEIGHT = -3.0e38f;  // of a hole
const float PARALLEL = 1.0e-20f;   // a way that stays in its column, or row, all over a raster

// Level 0 has the largest of the four heights of each square; each level halves the sides of the one before it.
struct HorizonLevel {
    uint first;  // of its maxima
    uint columns;
};
BUFFER_OF(HorizonLevel, 4);

struct HorizonArgs {
    Floats heights;  // row by row
    Floats maxima;   // of all levels
    REF(HorizonLevel) levels;
    Vec2s ways;  // columns and rows per length; a component of PARALLEL is as good as 0
    Floats answers;
    uint columns;
    uint rows;
    uvec2 corner;        // column and row of the first cell that is asked for
    uint asked_columns;  // they are asked for row by row
    uint first;          // of the cells asked for, of this run
    uint count;
    uint way_count;
    uint level_count;
    uint measure;  // HORIZON_*
    float lift;    // of the eye above its cell
    float bend;    // the curvature of the planet
    float reach;   // how far the raster hides anything
};
#endif
