// SPDX-License-Identifier: MIT
// The structs and the mathematics that the particles share with their kernels, for C++.
#pragma once

#include <cmath>

#include <twinray/sets.h>

#include "twinray/glsl/cpp_spawn.h"

namespace twinray::particles {
using std::sin;

#include "twinray/glsl/cpp_begin.h"
#include "shaders/particles/particles.h"
#include "shaders/particles/picture.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(MoveArgs) == 112 && sizeof(PictureScene) == 80 && sizeof(ShadeArgs) <= 128);
using Materials = TWINRAY_MULTI_TYPE_SET(ParticleMaterials, PARTICLE_MATERIALS);
using ParticleArrays = TWINRAY_SOA(Particles, PARTICLE_FIELDS);
}  // namespace twinray::particles
