// SPDX-License-Identifier: MIT
// Functions that get the surface of a hit, in kernels, on either accelerator: for accelerators with
// AccelOptions::keeps_surfaces.
//
//     if (!closest_hit(accel, ray, hit)) ...
//     Surface surface = surface_at(accel, ray, hit);           // all of it; or only the needed parts:
//     SurfacePlace place = surface_place(accel, ray, hit);
//     SurfacePoint point = point_at(place);                    // for spawn_position()
//     vec3 normal = normal_at(place, point);
//     vec2 uv = uv0_at(place);
//     float heat = attribute_at(place, push.heat, vec4(0.0)).x;   // AbstractAccel::attribute_number("heat")
//     uint material = face_metadata_at(place);
//
// `accel` is AccelView::scene. The hit may come from either accelerator, or be read from a batch.
#ifndef TWINRAY_SURFACE_GLSL
#define TWINRAY_SURFACE_GLSL
#include "twinray/glsl/common.glsl"
#include "twinray/glsl/accel_header.h"
#include "twinray/glsl/surface_at.h"

// Returns the table of an accelerator with AccelOptions::keeps_surfaces or keeps_metadata; others have none.
SurfaceTable surfaces_of(Address accel) { return AT(REF(SurfaceTable)(AT(REF(AccelHeader)(accel), 0).surfaces), 0); }

// Returns the triangle of a hit for which has_surface() is true, and the point where the ray hits it, for normal_at()
// and others.
SurfacePlace surface_place(Address accel, Ray ray, Hit hit) { return surface_place(surfaces_of(accel), ray, hit); }

// Returns whether the hit is on a triangle of a mesh that is kept: functions down to surface_color() need that. Misses,
// boxes and hits of accelerators with only AccelOptions::keeps_metadata have no surface.
bool has_surface(Address accel, Hit hit) {
    return hit.hit != 0u && surface_geometry(surfaces_of(accel), hit.instance_index).face_count != 0u;
}

// Returns the whole surface; all fields are 0 if there is none.
Surface surface_at(Address accel, Ray ray, Hit hit) {
    if (!has_surface(accel, hit)) return no_surface();
    return surface_at(surface_place(accel, ray, hit), hit.instance_index);
}

// Returns the hit point in world space.
vec3 surface_position(Address accel, Ray ray, Hit hit) { return point_at(surface_place(accel, ray, hit)).position; }
// Returns the shading normal, like normal_at(): unit, world space, on the side of the geometric one.
vec3 surface_normal(Address accel, Ray ray, Hit hit) {
    SurfacePlace place = surface_place(accel, ray, hit);
    return normal_at(place, point_at(place));
}
// Returns the first texture coordinates; (0, 0) if the mesh has none.
vec2 surface_uv(Address accel, Ray ray, Hit hit) { return uv0_at(surface_place(accel, ray, hit)); }
// Returns the colour of the vertices; (1, 1, 1, 1) if the mesh has none.
vec4 surface_color(Address accel, Ray ray, Hit hit) { return color_at(surface_place(accel, ray, hit)); }

// Returns AccelHandle::id of the hit instance, as AbstractAccel::handle_of() does.
Uint64 handle_of(Address accel, Hit hit) { return surface_geometry(surfaces_of(accel), hit.instance_index).handle; }
// Returns the index of the hit instance in its handle, from 0, as AbstractAccel::index_in_handle() returns it.
uint index_in_handle(Address accel, Hit hit) {
    return hit.instance_index - surface_geometry(surfaces_of(accel), hit.instance_index).first_instance;
}

// Returns the instance's custom index if it is not 0, else the face's MeshView::face_metadata, else 0.
uint face_metadata(Address accel, Hit hit) {
    SurfaceTable table = surfaces_of(accel);
    uint custom_index = custom_index_of(AT(table.instances, hit.instance_index));
    Uints of_faces = surface_geometry(table, hit.instance_index).face_metadata;
    return custom_index != 0u || is_absent(of_faces) ? custom_index : AT(of_faces, hit.primitive_index);
}
// Returns the address of MeshView::metadata: AT(REF(T)(geometry_metadata(accel, hit)), 0); absent if there is none.
Address geometry_metadata(Address accel, Hit hit) {
    return surface_geometry(surfaces_of(accel), hit.instance_index).metadata;
}
#endif
