// SPDX-License-Identifier: MIT
// The structs that the renderer shares with its shaders, for C++.
#pragma once

#include "renderer/shared.h"

namespace twinray::embed_renderer {
using path_tracer::CameraRays;
using path_tracer::SurfaceInstance;
using path_tracer::SurfaceMaterial;
using path_tracer::VertexExtras;

#include "twinray/glsl/cpp_begin.h"
#include "shaders/embed_renderer/frame.h"
#include "twinray/glsl/cpp_end.h"
}  // namespace twinray::embed_renderer
