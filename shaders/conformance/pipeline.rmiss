// SPDX-License-Identifier: MIT
#version 460
#extension GL_EXT_ray_tracing : require

layout(location = 0) rayPayloadInEXT uint is_hit;

void main() { is_hit = 0u; }
