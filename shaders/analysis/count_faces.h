// SPDX-License-Identifier: MIT
// Counts hits by the groups of their faces.
#ifndef TWINRAY_ANALYSIS_COUNT_FACES_H
#define TWINRAY_ANALYSIS_COUNT_FACES_H
#include "shaders/analysis/faces.h"

const uint NO_GROUP = 0xffffffffu;  // of a face whose hits do not count, and of a miss

struct GroupCount {
    uint hits;
    uint odd;  // pairs of rays (2 i, 2 i + 1) in which one is a hit of the group
};
BUFFER_OF(GroupCount, 4);

struct CountFacesArgs {
    FaceTable table;
    REF(Hit) hits;
    Uints groups;  // of each face; absent: a face is its own group
    // There is one more than groups: the last one counts as odd the pairs in which one ray hits any group.
    REF(GroupCount) counts;
    uint ray_count;
    uint group_count;
};

FUNC uint group_of(CountFacesArgs args, uint ray) {
    Hit hit = AT(args.hits, ray);
    if (hit.hit == 0u) return NO_GROUP;
    uint face = face_of(args.table, hit);
    return is_absent(args.groups) ? face : AT(args.groups, face);
}
#endif
