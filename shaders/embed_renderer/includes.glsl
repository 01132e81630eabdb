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
#endif
