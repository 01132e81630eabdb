// SPDX-License-Identifier: MIT
// Functions that get the surface of a hit, and the mesh data that accelerators with AccelOptions::keeps_surfaces hold,
// for kernels and C++. Each is separate, so that unused ones are left out.
#ifndef TWINRAY_SURFACE_AT_H
#define TWINRAY_SURFACE_AT_H
#include "twinray/glsl/crossing.h"
#include "twinray/glsl/surface.h"

// An array of a mesh: float32 numbers, `components` (1 to 4) per vertex or per face.
struct SurfaceAttribute {
    Floats values;  // absent if the mesh has none
    uint components;
    uint is_per_face;
};
BUFFER_OF(SurfaceAttribute, 8);

// Numbers of attributes: those with a name of their own, then those of MeshView::attributes
// (AbstractAccel::attribute_number).
const uint ATTRIBUTE_NORMALS = 0u;
const uint ATTRIBUTE_TANGENTS = 1u;
const uint ATTRIBUTE_UV0 = 2u;
const uint ATTRIBUTE_UV1 = 3u;
const uint ATTRIBUTE_COLORS = 4u;
const uint ATTRIBUTES_NAMED = 5u;

// The data of one push.
struct SurfaceGeometry {
    Uint64 handle;        // AccelHandle::id
    Uints face_metadata;  // one per face, or absent
    Address metadata;     // MeshView::metadata, or absent
    uint first_instance;  // Hit::instance_index of its first instance
    uint face_count;      // 0 for boxes, and if no mesh is kept
};
BUFFER_OF(SurfaceGeometry, 8);

// The surface data of an accelerator, on the device.
struct SurfaceTable {
    REF(InstanceRecord) instances;     // by Hit::instance_index
    Uints geometry_of_instance;        // likewise: the number of its geometry
    REF(SurfaceGeometry) geometries;   // by number
    REF(SurfaceAttribute) attributes;  // attribute_count for each geometry
    uint attribute_count;
    uint reserved;
};
BUFFER_OF(SurfaceTable, 8);

// The triangle that a hit names, and the ray's hit on it. `vertices`, `placement` and the object-space part of
// point_at() are in units of `unit`, a power of two that the accelerator chooses.
struct SurfacePlace {
    Placement placement;
    TriangleVertices vertices;
    uvec3 indices;
    float unit;
    Crossing crossing;
    uint primitive_index;
    uint instance_flags;
    uint custom_index;
    SurfaceGeometry geometry;
    REF(SurfaceAttribute) attributes;
    uint attribute_count;
};

// Returns the data of the push that made an instance's geometry.
FUNC SurfaceGeometry surface_geometry(SurfaceTable table, uint instance_index) {
    return AT(table.geometries, AT(table.geometry_of_instance, instance_index));
}

// Needs a hit on a triangle, not a miss or a box.
FUNC SurfacePlace surface_place(SurfaceTable table, Ray ray, Hit hit) {
    uint number = AT(table.geometry_of_instance, hit.instance_index);
    InstanceRecord record = AT(table.instances, hit.instance_index);
    GeometrySource source = AT(REF(GeometrySource)(address_after(record.geometry, GEOMETRY_SOURCE_OFFSET)), 0);
    SurfacePlace place;
    place.placement = placement_of(in_built_units(record));
    place.unit = source.scale;
    place.indices = load_indices(source.mesh.indices, hit.primitive_index);
    place.vertices.a = load_position(source.mesh.positions, place.indices.x);
    place.vertices.b = load_position(source.mesh.positions, place.indices.y);
    place.vertices.c = load_position(source.mesh.positions, place.indices.z);
    place.crossing = crossing_of(ray, place.placement, place.vertices);
    place.primitive_index = hit.primitive_index;
    place.instance_flags = flags_of(record);
    place.custom_index = custom_index_of(record);
    place.geometry = AT(table.geometries, number);
    place.attributes = REF(SurfaceAttribute)(address_at(table.attributes.address, number * table.attribute_count, 16u));
    place.attribute_count = table.attribute_count;
    return place;
}

// Returns the point from which a ray may start, with spawn_position(), or passing_t() and the placement.
FUNC SurfacePoint point_at(SurfacePlace place) {
    return surface_point(place.placement, place.vertices, place.crossing.uv);
}

// Returns whether the front is seen: the side from which the vertices are counter-clockwise in object space, or the
// other one for instances with flip_facing.
FUNC bool is_front_at(SurfacePlace place) {
    return place.crossing.is_front == ((place.instance_flags & INSTANCE_FLIP_FACING) == 0u);
}

// Reads the existing components; (0, 0, 0, 1) for the others.
FUNC vec4 load_attribute(SurfaceAttribute array, uint components, uint item) {
    uint at = item * components;
    vec4 value = vec4(0.0f, 0.0f, 0.0f, 1.0f);
    value.x = AT(array.values, at);
    if (components > 1u) value.y = AT(array.values, at + 1u);
    if (components > 2u) value.z = AT(array.values, at + 2u);
    if (components > 3u) value.w = AT(array.values, at + 3u);
    return value;
}

// Returns (1-u-v) a + u b + v c, by component; off by at most 4 roundings of the sum of the three magnitudes.
FUNC vec4 interpolated(vec4 a, vec4 b, vec4 c, vec2 uv) {
    PRECISE float weight = 1.0f - uv.x;
    weight = weight - uv.y;
    PRECISE vec4 of_a = a * weight;
    PRECISE vec4 of_b = b * uv.x;
    PRECISE vec4 of_c = c * uv.y;
    PRECISE vec4 sum = of_a + of_b;
    sum = sum + of_c;
    return sum;
}

// Returns the array of an attribute by its number; its values are absent if the mesh has none.
FUNC SurfaceAttribute attribute_of(SurfacePlace place, uint number) {
    SurfaceAttribute none;
    none.values = Floats(absent_near(place.attributes.address));
    none.components = 1u;
    none.is_per_face = 0u;
    if (number >= place.attribute_count) return none;
    return AT(place.attributes, number);
}

// Needs a mesh with the attribute. `components` is its known number of components.
FUNC vec4 interpolated_attribute(SurfaceAttribute array, uint components, SurfacePlace place) {
    if (array.is_per_face != 0u) return load_attribute(array, components, place.primitive_index);
    vec4 value = interpolated(load_attribute(array, components, place.indices.x),
                              load_attribute(array, components, place.indices.y),
                              load_attribute(array, components, place.indices.z), place.crossing.uv);
    if (components < 4u) value.w = 1.0f;
    return value;
}

// Returns an attribute by its number: interpolated, or the face's; `missing` if the mesh does not have it. Fewer than
// four components are completed by 0, 0, 1.
FUNC vec4 attribute_at(SurfacePlace place, uint number, vec4 missing) {
    SurfaceAttribute array = attribute_of(place, number);
    if (is_absent(array.values)) return missing;
    return interpolated_attribute(array, array.components, place);
}

// Returns texture coordinates by their attribute number, interpolated; (0, 0) if the mesh has none.
FUNC vec2 uv_at(SurfacePlace place, uint number) {
    SurfaceAttribute array = attribute_of(place, number);
    if (is_absent(array.values)) return vec2(0.0f, 0.0f);
    vec4 uv = interpolated_attribute(array, 2u, place);
    return vec2(uv.x, uv.y);
}
// Returns the first set of texture coordinates.
FUNC vec2 uv0_at(SurfacePlace place) { return uv_at(place, ATTRIBUTE_UV0); }
// Returns the second set of texture coordinates.
FUNC vec2 uv1_at(SurfacePlace place) { return uv_at(place, ATTRIBUTE_UV1); }

// Returns the colour of the vertices, interpolated, as it was pushed; (1, 1, 1, 1) if the mesh has none.
FUNC vec4 color_at(SurfacePlace place) {
    SurfaceAttribute array = attribute_of(place, ATTRIBUTE_COLORS);
    if (is_absent(array.values)) return vec4(1.0f, 1.0f, 1.0f, 1.0f);
    return interpolated_attribute(array, 4u, place);
}

// Returns the unit vector along v; `otherwise` if v has no direction: its length is 0, infinite or NaN.
FUNC vec3 unit_or(vec3 v, vec3 otherwise) {
    float scale = power_of_two_below(largest_entry(v));
    if (!(scale > 0.0f) || !is_finite(v)) return otherwise;
    vec3 scaled = v / scale;
    return scaled / length(scaled);
}

// Returns the interpolated normal in object space, of length 1; the triangle's if there is none. A vertex whose normal
// is 0 takes the triangle's, on the side of the others.
FUNC vec3 object_normal(SurfacePlace place, vec3 of_triangle) {
    vec3 zero = vec3(0.0f, 0.0f, 0.0f);
    SurfaceAttribute normals = attribute_of(place, ATTRIBUTE_NORMALS);
    if (is_absent(normals.values)) return of_triangle;
    vec3 a = xyz(load_attribute(normals, 3u, place.indices.x));
    vec3 b = xyz(load_attribute(normals, 3u, place.indices.y));
    vec3 c = xyz(load_attribute(normals, 3u, place.indices.z));
    vec3 own = dot(a + b + c, of_triangle) < 0.0f ? -of_triangle : of_triangle;
    a = a == zero ? own : a;
    b = b == zero ? own : b;
    c = c == zero ? own : c;
    return unit_or(xyz(interpolated(vec4(a, 0.0f), vec4(b, 0.0f), vec4(c, 0.0f), place.crossing.uv)), of_triangle);
}

// Returns a unit vector in world space: interpolated vertex normals by the inverse transpose, on the side of
// point.normal.
FUNC vec3 normal_at(SurfacePlace place, SurfacePoint point) {
    if (is_absent(attribute_of(place, ATTRIBUTE_NORMALS).values)) return point.normal;
    vec3 normal = object_normal(place, point.normal_object);
    vec3 world = unit_or(transposed_times(place.placement.to_object, normal), point.normal);
    return dot(world, point.normal) < 0.0f ? -world : world;
}

// Returns xyz: unit, world space; w: 1 or -1, so that the bitangent is cross(normal, xyz) * w for this normal, also for
// mirrored instances. 0 if none were pushed or it has no direction.
FUNC vec4 tangent_at(SurfacePlace place, SurfacePoint point, vec3 normal) {
    vec4 none = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    SurfaceAttribute tangents = attribute_of(place, ATTRIBUTE_TANGENTS);
    if (is_absent(tangents.values)) return none;
    vec4 tangent = interpolated_attribute(tangents, 4u, place);
    vec3 world = unit_or(transform_vector(place.placement.to_world, xyz(tangent)), xyz(none));
    if (world == xyz(none)) return none;
    // The map, or the choice of the normal's side, may have flipped the frame.
    vec3 given = object_normal(place, point.normal_object);
    vec3 bitangent = transform_vector(place.placement.to_world, cross(given, xyz(tangent)));
    bool is_same = dot(cross(normal, world), bitangent) >= 0.0f;
    return vec4(world, is_same == (tangent.w >= 0.0f) ? 1.0f : -1.0f);
}

// Returns the instance's custom index if it is not 0, else the face's own, else 0.
FUNC uint face_metadata_at(SurfacePlace place) {
    if (place.custom_index != 0u) return place.custom_index;
    if (is_absent(place.geometry.face_metadata)) return 0u;
    return AT(place.geometry.face_metadata, place.primitive_index);
}

// Returns the surface of a miss.
FUNC Surface no_surface() {
    vec3 zero = vec3(0.0f, 0.0f, 0.0f);
    Surface surface;
    surface.point.position = zero;
    surface.point.normal = zero;
    surface.point.offset = 0.0f;
    surface.point.feature = 0.0f;
    surface.point.normal_object = zero;
    surface.point.error_object = zero;
    surface.t = 0.0f;
    surface.uv = vec2(0.0f, 0.0f);
    surface.vertices = uvec3(0u, 0u, 0u);
    surface.is_front = 0u;
    surface.normal = zero;
    surface.tangent = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    surface.uv0 = vec2(0.0f, 0.0f);
    surface.uv1 = vec2(0.0f, 0.0f);
    surface.color = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    surface.custom_index = 0u;
    surface.face_metadata = 0u;
    surface.instance_index = 0u;
    surface.primitive_index = 0u;
    surface.is_hit = 0u;
    return surface;
}

// Returns the whole surface.
FUNC Surface surface_at(SurfacePlace place, uint instance_index) {
    Surface surface;
    surface.point = point_at(place);
    surface.point.error_object = surface.point.error_object * place.unit;
    surface.t = place.crossing.t;
    surface.uv = place.crossing.uv;
    surface.vertices = place.indices;
    surface.is_front = is_front_at(place) ? 1u : 0u;
    surface.normal = normal_at(place, surface.point);
    surface.tangent = tangent_at(place, surface.point, surface.normal);
    surface.uv0 = uv0_at(place);
    surface.uv1 = uv1_at(place);
    surface.color = color_at(place);
    surface.custom_index = place.custom_index;
    surface.face_metadata = face_metadata_at(place);
    surface.instance_index = instance_index;
    surface.primitive_index = place.primitive_index;
    surface.is_hit = 1u;
    return surface;
}
#endif
