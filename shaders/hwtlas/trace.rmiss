// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#include "twinray/glsl/common.glsl"
#include "twinray/glsl/rays.h"

layout(location = 0) rayPayloadInEXT Hit payload;

void main() { payload = miss(); }
