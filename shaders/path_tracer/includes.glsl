// SPDX-License-Identifier: MIT
// All headers of kernels that read surfaces, in order, and the specialisation constants of scene.h.
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

FEATURE(PT_HAS_ALPHA, HAS_ALPHA)
FEATURE(PT_HAS_TEXTURES, HAS_TEXTURES)
FEATURE(PT_HAS_GLASS, HAS_GLASS)
FEATURE(PT_HAS_ENVIRONMENT, HAS_ENVIRONMENT)
FEATURE(PT_HAS_LOCAL_LIGHTS, HAS_LOCAL_LIGHTS)
FEATURE(PT_HAS_LIGHT_TREE, HAS_LIGHT_TREE)
FEATURE(PT_HAS_AOVS, HAS_AOVS)
FEATURE(PT_HAS_QUEUES, HAS_QUEUES)
FEATURE(PT_HAS_SPECULAR, HAS_SPECULAR)
FEATURE(PT_HAS_COAT, HAS_COAT)
FEATURE(PT_HAS_SHEEN, HAS_SHEEN)
FEATURE(PT_HAS_ANISOTROPY, HAS_ANISOTROPY)
FEATURE(PT_HAS_VOLUME, HAS_VOLUME)
FEATURE(PT_HAS_MEDIA, HAS_MEDIA)
FEATURE(PT_HAS_COLORS, HAS_COLORS)
FEATURE(PT_HAS_SECOND_UVS, HAS_SECOND_UVS)
FEATURE(PT_HAS_PANES, HAS_PANES)
const uint LAYERS = (HAS_SPECULAR ? LAYER_SPECULAR : 0u) | (HAS_COAT ? LAYER_COAT : 0u) |
                    (HAS_SHEEN ? LAYER_SHEEN : 0u) | (HAS_ANISOTROPY ? LAYER_ANISOTROPY : 0u) |
                    (HAS_VOLUME ? LAYER_VOLUME : 0u);
layout(constant_id = PT_STRATEGY) const uint STRATEGY = STRATEGY_MIS;

#include "shaders/path_tracer/microfacet.h"
#include "shaders/path_tracer/bsdf_record.h"
#include "shaders/path_tracer/bsdf_albedo.h"
#include "shaders/path_tracer/bsdf_opaque.h"
#include "shaders/path_tracer/bsdf_glass.h"
#include "shaders/path_tracer/sheen_table.h"
#include "shaders/path_tracer/bsdf_sheen.h"
#include "shaders/path_tracer/bsdf_coat.h"
#include "shaders/path_tracer/bsdf.h"
#include "shaders/path_tracer/surface.glsl"
#include "shaders/path_tracer/material.glsl"
#include "shaders/path_tracer/layers.glsl"
#include "shaders/path_tracer/bsdf_of.glsl"
#endif
