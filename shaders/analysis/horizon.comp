// SPDX-License-Identifier: MIT
// Each invocation follows all ways of a cell to the end. Blocks of squares that cannot rise above the horizon so far
// are skipped, by their maxima. They are judged with a margin for roundings, so that an answer depends on no block, and
// not on where a raster was cut into tiles.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/analysis/horizon.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { HorizonArgs args; };

const float AT_END = 1.0f / 65536.0f;  // of an edge, near: more than a place on it is rounded, and a vertex itself
const float AT_END_BY_STEPS = 1.0f / 4194304.0f;  // of the steps done: likewise far away
const float ROUNDINGS = 1.0f + 1.0f / 65536.0f;   // more than those of a slope

float height_at(ivec2 at) {
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(args.columns, args.rows)))) return NO_HEIGHT;
    return AT(args.heights, uint(at.y) * args.columns + uint(at.x));
}

bool is_there(ivec2 at) { return height_at(at) > NO_HEIGHT; }

// A way from a cell. It is counted in steps of a column or a row away from the cell, whatever its direction.
struct Way {
    ivec2 start;  // column and row
    ivec2 side;   // 1 or -1: where columns and rows go
    vec2 speed;   // steps per length
    vec2 pause;   // length per step
    float eye;
};

// Returns how many steps are done at a length, by the same rounding as step * pause.
int steps_done(float along, float speed, float pause) {
    int steps = int(along * speed);
    if (float(steps + 1) * pause <= along) return steps + 1;
    return float(steps) * pause > along ? steps - 1 : steps;
}

// Returns whether the cell is a corner of a triangle: two neighbours of the six that its triangles have are there.
bool is_corner(ivec2 cell) {
    const ivec2 around[6] = ivec2[6](ivec2(1, 0), ivec2(1, 1), ivec2(0, 1), ivec2(-1, 0), ivec2(-1, -1), ivec2(0, -1));
    if (!is_there(cell)) return false;
    bool was_there = is_there(cell + around[5]), is_any = false;
    for (uint k = 0u; k < 6u; ++k) {
        bool is_next = is_there(cell + around[k]);
        is_any = is_any || (was_there && is_next);
        was_there = is_next;
    }
    return is_any;
}

// Returns the slope to the point of an edge of the surface, `part` of it behind p, if it is steeper than `least` and
// part of a triangle: that with `third` or `other_third`, or at an end of the edge any. It is no higher than the edge's
// ends, by the same rounding as that of maxima.
float slope_to(Way way, ivec2 p, ivec2 q, ivec2 third, ivec2 other_third, float part, float along, float least) {
    float end = max(AT_END, along * max(way.speed.x, way.speed.y) * AT_END_BY_STEPS);
    bool is_p = part<end, is_q = part> 1.0f - end;
    float a = height_at(p), b = height_at(q);
    if (is_p && b <= NO_HEIGHT) b = a;
    if (is_q && a <= NO_HEIGHT) a = b;
    PRECISE float higher = max(a, b) - way.eye;
    PRECISE float between = (a - way.eye) + (b - a) * part;
    PRECISE float slope = min(between, higher) / along - 0.5f * args.bend * along;
    if (!(slope > least && along <= args.reach)) return least;
    bool is_surface = is_p   ? is_corner(p)
                      : is_q ? is_corner(q)
                             : is_there(p) && is_there(q) && (is_there(third) || is_there(other_third));
    return is_surface ? slope : least;
}

// Returns the steepest of `best` and the points where a way crosses the diagonal and the far sides of a square: `done`
// steps away, reached at `along` and left at `leave`.
float slope_in_square(Way way, ivec2 done, float along, vec2 leave, float best) {
    ivec2 near = way.start + way.side * done, far = near + way.side;
    ivec2 low = min(near, far), high = max(near, far);
    if (leave.x <= leave.y) {
        PRECISE float part = leave.x * way.speed.y - float(done.y);
        ivec2 top = ivec2(far.x, low.y);
        best = slope_to(way, ivec2(far.x, near.y), far, top + ivec2(1, 1), top + ivec2(-1, 0), part, leave.x, best);
    }
    if (leave.y <= leave.x) {
        PRECISE float part = leave.y * way.speed.x - float(done.x);
        ivec2 left = ivec2(low.x, far.y);
        best = slope_to(way, ivec2(near.x, far.y), far, left + ivec2(1, 1), left + ivec2(0, -1), part, leave.y, best);
    }
    bool is_along = way.side.x == way.side.y;  // the diagonal rises with both steps
    int line = is_along ? done.x - done.y : done.x + done.y + 1;
    float across = is_along ? way.speed.x - way.speed.y : way.speed.x + way.speed.y;
    if (across == 0.0f) return best;
    PRECISE float at_line = float(line) / across;
    if (!(at_line > along && at_line < min(leave.x, leave.y))) return best;
    PRECISE float part = at_line * way.speed.x - float(done.x);
    ivec2 from = ivec2(near.x, is_along ? near.y : far.y), to = ivec2(far.x, is_along ? far.y : near.y);
    return slope_to(way, from, to, ivec2(high.x, low.y), ivec2(low.x, high.y), part, at_line, best);
}

float slope_of_horizon(ivec2 start, vec2 across) {
    Way way;
    way.start = start;
    way.speed = abs(across);
    // A way along a column or a row has squares on both sides, but at the raster's border.
    bvec2 is_ahead = mix(greaterThan(across, vec2(0.0f)), lessThan(start + 1, ivec2(args.columns, args.rows)),
                         lessThanEqual(way.speed, vec2(PARALLEL)));
    way.side = ivec2(is_ahead.x ? 1 : -1, is_ahead.y ? 1 : -1);
    way.pause = 1.0f / way.speed;
    PRECISE float eye = height_at(start) + args.lift;
    way.eye = eye;
    uint level = 0u;
    ivec2 done = ivec2(0);
    float along = 0.0f, best = 0.0f;
    float top = AT(args.maxima, AT(args.levels, args.level_count - 1u).first) - eye;
    while (true) {
        ivec2 square = start + way.side * done - ivec2(lessThan(way.side, ivec2(0)));
        if (any(lessThan(square, ivec2(0))) || any(greaterThanEqual(square + 1, ivec2(args.columns, args.rows)))) break;
        HorizonLevel maxima = AT(args.levels, level);
        ivec2 block = square >> int(level);
        float rise = AT(args.maxima, maxima.first + uint(block.y) * maxima.columns + uint(block.x)) - eye;
        PRECISE float wanted = (best + 0.5f * args.bend * along) * along;
        bool is_low = rise <= 0.0f || rise * ROUNDINGS <= wanted;
        if (!is_low && level > 0u) {
            --level;
            continue;
        }
        ivec2 end = ivec2(way.side.x > 0 ? ((block.x + 1) << int(level)) - start.x : start.x - (block.x << int(level)),
                          way.side.y > 0 ? ((block.y + 1) << int(level)) - start.y : start.y - (block.y << int(level)));
        PRECISE vec2 leave = vec2(end) * way.pause;
        if (!is_low) best = slope_in_square(way, done, along, leave, best);
        along = min(leave.x, leave.y);
        if (along > args.reach || top * ROUNDINGS <= best * along) break;
        if (leave.x <= leave.y)
            done = ivec2(end.x, steps_done(leave.x, way.speed.y, way.pause.y));
        else
            done = ivec2(steps_done(leave.y, way.speed.x, way.pause.x), end.y);
        level = min(level + 1u, args.level_count - 1u);
    }
    return best;
}

void main() {
    uint i = global_index();
    if (i >= args.count) return;
    i += args.first;
    ivec2 cell = ivec2(args.corner + uvec2(i % args.asked_columns, i / args.asked_columns));
    bool is_hole = !is_there(cell);
    PRECISE float sum = 0.0f;
    for (uint k = 0u; k < args.way_count; ++k) {
        float slope = is_hole ? uintBitsToFloat(0x7fc00000u) : slope_of_horizon(cell, AT(args.ways, k));
        if (args.measure == HORIZON_SLOPE) {
            AT(args.answers, i * args.way_count + k) = slope;
            continue;
        }
        PRECISE float square = 1.0f + slope * slope;
        PRECISE float light = 1.0f / square;
        PRECISE float part = args.measure == HORIZON_LIGHT ? light : 1.0f - slope / sqrt(square);
        sum += part;
    }
    PRECISE float mean = sum / float(args.way_count);
    if (args.measure != HORIZON_SLOPE) AT(args.answers, i) = mean;
}
