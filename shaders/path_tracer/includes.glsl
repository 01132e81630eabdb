// SPDX-License-Identifier: MIT
// All headers of kernels that read surfaces, in order.
#ifndef TWINRAY_PATH_TRACER_INCLUDES_GLSL
#define TWINRAY_PATH_TRACER_INCLUDES_GLSL
#include "twinray/glsl/spawn.glsl"
#include "twinray/glsl/soa.h"
#include "twinray/glsl/multi_type_set.glsl"
#include "twinray/glsl/textures.glsl"
#include "shaders/path_tracer/scene.h"
#include "shaders/path_tracer/wave.h"
#include "shaders/path_tracer/weights.h"
#include "twinray/glsl/sampling.h"
#include "shaders/path_tracer/features.glsl"
#include "shaders/path_tracer/microfacet.h"
#include "shaders/path_tracer/bsdf_record.h"
#include "shaders/path_tracer/bsdf_albedo.h"
#include "shaders/path_tracer/bsdf_opaque.h"
#include "shaders/path_tracer/bsdf_glass.h"
#include "shaders/path_tracer/sheen_table.h"
#include "shaders/path_tracer/bsdf_sheen.h"
#include "shaders/path_tracer/bsdf_coat.h"
#include "shaders/path_tracer/bsdf.h"
#include "shaders/path_tracer/extras.glsl"
#include "shaders/path_tracer/surface.glsl"
#include "shaders/path_tracer/material.glsl"
#include "shaders/path_tracer/layers.glsl"
#include "shaders/path_tracer/bsdf_of.glsl"
#endif
