// SPDX-License-Identifier: MIT
// The common part of the pipeline's stages: the same shots and answers as in query.comp; the arguments are in a buffer.
#include "twinray/glsl/common.glsl"
#include "shaders/shared/trace.h"
#include "shaders/conformance/query.h"
layout(push_constant, scalar) uniform Push { TraceArgs launch; };

QueryArgs arguments() { return AT(REF(QueryArgs)(launch.user_data), 0); }
uint shot_index() { return launch.first + gl_LaunchIDEXT.y * gl_LaunchSizeEXT.x + gl_LaunchIDEXT.x; }
