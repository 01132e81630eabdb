// SPDX-License-Identifier: MIT
// Everything that kernels which look at surfaces need, in order.
#ifndef TWINRAY_PATH_TRACER_INCLUDES_GLSL
#define TWINRAY_PATH_TRACER_INCLUDES_GLSL
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/intersect.h"
#include "shaders/shared/spawn.h"
#include "shaders/shared/soa.h"
#include "shaders/path_tracer/scene.h"
#include "shaders/path_tracer/wave.h"
#include "shaders/path_tracer/weights.h"
#include "shaders/shared/sampling.h"
#include "shaders/path_tracer/bsdf.h"
#include "shaders/path_tracer/features.glsl"
#include "shaders/path_tracer/texture.glsl"
#include "shaders/path_tracer/surface.glsl"
#include "shaders/path_tracer/material.glsl"
#endif
