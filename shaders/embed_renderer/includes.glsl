// SPDX-License-Identifier: MIT
// Everything that the passes need, in order.
#ifndef TWINRAY_EMBED_RENDERER_INCLUDES_GLSL
#define TWINRAY_EMBED_RENDERER_INCLUDES_GLSL
#include "twinray/glsl/common.glsl"
#include "twinray/glsl/rays.h"
#include "twinray/glsl/soa.h"
#include "twinray/glsl/spawn.h"
#include "twinray/glsl/textures.glsl"
#include "shaders/path_tracer/scene.h"
#include "shaders/path_tracer/extras.glsl"
#include "shaders/path_tracer/wave.h"
#include "twinray/glsl/random.h"
#include "shaders/path_tracer/weights.h"
#include "twinray/glsl/sampling.h"
#include "shaders/path_tracer/camera.h"
#include "shaders/embed_renderer/frame.h"

Rows to_world_of(SurfaceInstance instance)
{
    Rows rows;
    rows.r0 = instance.object_to_world[0];
    rows.r1 = instance.object_to_world[1];
    rows.r2 = instance.object_to_world[2];
    return rows;
}

Rows to_object_of(SurfaceInstance instance)
{
    Rows rows;
    rows.r0 = instance.world_to_object[0];
    rows.r1 = instance.world_to_object[1];
    rows.r2 = instance.world_to_object[2];
    return rows;
}
#endif
