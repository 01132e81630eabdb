// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/world_bound.h"
#include "shaders/shared/surface_area.h"
#include "shaders/shared/hw_scene.h"
#include "shaders/hwtlas/trace.glsl"

layout(location = 0) rayPayloadInEXT Hit payload;
hitAttributeEXT vec2 barycentrics;

void main()
{
    payload = hit_of(uvec2(gl_InstanceID, gl_PrimitiveID), gl_InstanceCustomIndexEXT, gl_HitTEXT, barycentrics);
}
