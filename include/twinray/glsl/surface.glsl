// SPDX-License-Identifier: MIT
// From a hit to the surface, in kernels, on either accelerator alike: for accelerators with
// AccelOptions::keeps_surfaces.
//
//     if (!closest_hit(accel, ray, hit)) ...
//     Surface surface = surface_at(accel, ray, hit);           // all of it; or what is needed:
//     SurfacePlace place = surface_place(accel, ray, hit);
//     SurfacePoint point = point_at(place);                    // for spawn_position()
//     vec3 normal = normal_at(place, point);
//     vec2 uv = uv0_at(place);
//     float heat = attribute_at(place, push.heat, vec4(0.0)).x;   // AbstractAccel::attribute_number("heat")
//     uint material = face_metadata_at(place);
//
// `accel` is AccelView::scene. The hit may be of either accelerator, or read from a batch.
#ifndef TWINRAY_SURFACE_GLSL
#define TWINRAY_SURFACE_GLSL
#include "twinray/glsl/common.glsl"
#include "twinray/glsl/accel_header.h"
#include "twinray/glsl/surface_at.h"

// The table of an accelerator with AccelOptions::keeps_surfaces or keeps_metadata; others have nothing to read.
SurfaceTable surfaces_of(Address accel)
{
    return AT(REF(SurfaceTable)(AT(REF(AccelHeader)(accel), 0).surfaces), 0);
}

// The triangle of a hit for which has_surface() is true, and where the ray meets it; normal_at() and others read it.
SurfacePlace surface_place(Address accel, Ray ray, Hit hit) { return surface_place(surfaces_of(accel), ray, hit); }

// Whether the hit is of a triangle of a mesh that is kept: functions down to surface_color() want that. Misses, boxes
// and hits of accelerators with AccelOptions::keeps_metadata alone have no surface.
bool has_surface(Address accel, Hit hit)
{
    return hit.hit != 0u && surface_geometry(surfaces_of(accel), hit.instance_index).face_count != 0u;
}

// All is 0 where there is none.
Surface surface_at(Address accel, Ray ray, Hit hit)
{
    if (!has_surface(accel, hit)) return no_surface();
    return surface_at(surface_place(accel, ray, hit), hit.instance_index);
}

// Where the ray meets the triangle, in world space.
vec3 surface_position(Address accel, Ray ray, Hit hit) { return point_at(surface_place(accel, ray, hit)).position; }
// Shading normal, as normal_at(): unit, world space, on the side of the geometric one.
vec3 surface_normal(Address accel, Ray ray, Hit hit)
{
    SurfacePlace place = surface_place(accel, ray, hit);
    return normal_at(place, point_at(place));
}
// The first texture coordinates; (0, 0) where the mesh has none.
vec2 surface_uv(Address accel, Ray ray, Hit hit) { return uv0_at(surface_place(accel, ray, hit)); }
// The colour of the vertices; (1, 1, 1, 1) where the mesh has none.
vec4 surface_color(Address accel, Ray ray, Hit hit) { return color_at(surface_place(accel, ray, hit)); }

// As AbstractAccel::handle_of(): AccelHandle::id.
Uint64 handle_of(Address accel, Hit hit) { return surface_geometry(surfaces_of(accel), hit.instance_index).handle; }
// As AbstractAccel::index_in_handle(): which of the instances of its handle, from 0.
uint index_in_handle(Address accel, Hit hit)
{
    return hit.instance_index - surface_geometry(surfaces_of(accel), hit.instance_index).first_instance;
}

// The instance's custom index where that is not 0, else what the face was given (MeshView::face_metadata), else 0.
uint face_metadata(Address accel, Hit hit)
{
    SurfaceTable table = surfaces_of(accel);
    uint custom_index = custom_index_of(AT(table.instances, hit.instance_index));
    Uints of_faces = surface_geometry(table, hit.instance_index).face_metadata;
    return custom_index != 0u || is_absent(of_faces) ? custom_index : AT(of_faces, hit.primitive_index);
}
// The address of MeshView::metadata: AT(REF(T)(geometry_metadata(accel, hit)), 0); absent where there is none.
Address geometry_metadata(Address accel, Hit hit)
{
    return surface_geometry(surfaces_of(accel), hit.instance_index).metadata;
}
#endif
