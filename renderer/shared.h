// The structs and the mathematics that the path tracer shares with its kernels, for C++.
#pragma once

#include <twinray/scene.h>
#include <twinray/sets.h>

#include "twinray/glsl/cpp_spawn.h"
#include "twinray/glsl/cpp_sampling.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "twinray/glsl/word64.h"
#include "twinray/glsl/cpp_end.h"
}  // namespace twinray

namespace twinray::path_tracer {

constexpr uint LAYERS = ~0u;  // in kernels specialisation constants

#include "twinray/glsl/cpp_begin.h"
#include "shaders/path_tracer/scene.h"
#include "shaders/path_tracer/wave.h"
#include "shaders/path_tracer/camera.h"
#include "shaders/path_tracer/film.h"
#include "shaders/path_tracer/weights.h"
#include "shaders/path_tracer/microfacet.h"
#include "shaders/path_tracer/bsdf_record.h"
#include "shaders/path_tracer/bsdf_albedo.h"
#include "shaders/path_tracer/bsdf_opaque.h"
#include "shaders/path_tracer/bsdf_glass.h"
#include "shaders/path_tracer/sheen_table.h"
#include "shaders/path_tracer/bsdf_sheen.h"
#include "shaders/path_tracer/bsdf_coat.h"
#include "shaders/path_tracer/bsdf.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(SurfaceMesh) == 64 && sizeof(SurfaceInstance) == 120);
static_assert(sizeof(SurfaceMaterial) == 216 && sizeof(PunctualLight) == 56 && sizeof(LightNode) == 52 &&
              sizeof(SceneData) == 192);
static_assert(sizeof(LayeredMaterial) == 332 && sizeof(WaveData) == 296);
static_assert(sizeof(KindQueue) == 16 && sizeof(Disagreement) == 104);
static_assert(sizeof(FilmPixel) == 72 && sizeof(FirstSurface) == 40);
}  // namespace twinray::path_tracer
