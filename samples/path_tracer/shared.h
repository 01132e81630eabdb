// SPDX-License-Identifier: MIT
// The structs and the mathematics that the path tracer shares with its kernels, for C++.
#pragma once

#include "engine/accel/spawn.h"
#include "engine/core/sampling.h"
#include "engine/scene/soa.h"

namespace twinray::path_tracer {
using glm::clamp;
using glm::log;

#include "engine/core/bridge_begin.h"
#include "shaders/path_tracer/scene.h"
#include "shaders/path_tracer/move_vertices.h"
#include "shaders/path_tracer/wave.h"
#include "shaders/path_tracer/camera.h"
#include "shaders/path_tracer/film.h"
#include "shaders/path_tracer/weights.h"
#include "shaders/path_tracer/bsdf.h"
#include "engine/core/bridge_end.h"

static_assert(sizeof(SurfaceVertex) == 48 && sizeof(SurfaceTriangle) == 16 && sizeof(SurfaceInstance) == 120);
static_assert(sizeof(SurfaceMaterial) == 216 && sizeof(PunctualLight) == 56 && sizeof(SceneData) == 104);
static_assert(sizeof(WaveData) == 264 && sizeof(KindQueue) == 16 && sizeof(Disagreement) == 104);
static_assert(sizeof(FilmPixel) == 72 && sizeof(FirstSurface) == 40);
}  // namespace twinray::path_tracer
