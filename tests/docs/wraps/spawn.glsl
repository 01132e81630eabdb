#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/query.glsl"
INCLUDES
layout(local_size_x = 64) in;
// Names that lines about rays that leave a surface use.
layout(push_constant, scalar) uniform Push
{
    Address accel;
    REF(Ray) rays;
    REF(InstanceRecord) instances;
    Floats positions;
    Uints indices;
    Uints blocked;
} push;

void main()
{
    uint index_in_handle = 0u;
    vec3 to_light = vec3(0.0, 1.0, 0.0);
    Hit hit;
    if (!closest_hit(push.accel, AT(push.rays, global_index()), hit)) return;
    BLOCK
    AT(push.blocked, global_index()) = any_hit(push.accel, shadow) ? 1u : 0u;
}
