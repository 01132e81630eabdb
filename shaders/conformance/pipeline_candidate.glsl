// SPDX-License-Identifier: MIT
// Candidates of the pipeline. Intersections have no payload, so counters lie in the answer, which begins as zeros.
#include "shaders/conformance/pipeline.glsl"

void note_candidate(QueryArgs args, uint shot, bool is_box)
{
    uint boxes = atomicAdd(AT(args.answers, shot).boxes, is_box ? 1u : 0u);
    uint triangles = atomicAdd(AT(args.answers, shot).triangles, is_box ? 0u : 1u);
    uint position = boxes + triangles;
    if (position >= args.slots) return;
    AT(args.candidates, shot * args.slots + position) =
        candidate_name(is_box, gl_InstanceID, gl_GeometryIndexEXT, gl_PrimitiveID);
}
