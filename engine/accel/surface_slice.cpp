// SPDX-License-Identifier: MIT
#include "engine/accel/surface_slice.h"

#include <algorithm>
#include <array>

#include "engine/accel/surface_tables.h"
#include "engine/core/error.h"

namespace twinray {
namespace {

constexpr std::size_t most_names = 256;
constexpr std::array<uint, ATTRIBUTES_NAMED> named_components = {3, 4, 2, 2, 4};  // by ATTRIBUTE_*

std::uint64_t aligned(std::uint64_t offset) { return (offset + 15) / 16 * 16; }

// Throws Error unless it is empty or has one entry for each of `count`.
void check_length(const MeshView& mesh, std::string_view name, std::size_t length, std::size_t count,
                  const char* of_what) {
    if (length != 0 && length != count)
        fail("mesh '", mesh.name, "': ", length, " entries of '", name, "' for ", count, " ", of_what);
}

void check_components(std::string_view mesh, std::string_view name, uint components) {
    if (components < 1 || components > 4)
        fail("mesh '", mesh, "': attribute '", name, "' has ", components, " components; 1 to 4 fit");
}

// `attributes`: AttributeView or DeviceAttribute.
template <class Attributes>
void check_not_twice(std::string_view mesh, std::string_view name, const Attributes& attributes) {
    if (std::ranges::count_if(attributes, [&](const auto& other) { return other.name == name; }) > 1)
        fail("mesh '", mesh, "': an attribute's name, '", name, "', is taken");
}

template <class V>
void add(SurfaceSlice& slice, const MeshView& mesh, std::string_view name, uint number, std::span<const V> values) {
    check_length(mesh, name, values.size(), mesh.positions.size(), "vertices");
    if (values.empty()) return;
    slice.arrays.push_back(
        {number, sizeof(V) / sizeof(float), false, {append_aligned(slice.packed, std::as_bytes(values))}});
}

void add(SurfaceSlice& slice, const MeshView& mesh, const AttributeView& attribute, uint number) {
    if (number < ATTRIBUTES_NAMED)
        fail("mesh '", mesh.name, "': an attribute's name, '", attribute.name, "', is taken");
    check_components(mesh.name, attribute.name, attribute.components);
    const std::size_t count = attribute.is_per_face ? mesh.triangles.size() : mesh.positions.size();
    check_length(mesh, attribute.name, attribute.values.size(), count * attribute.components,
                 attribute.is_per_face ? "triangles, times its components" : "vertices, times its components");
    if (attribute.values.empty()) return;
    slice.arrays.push_back({number,
                            attribute.components,
                            attribute.is_per_face,
                            {append_aligned(slice.packed, std::as_bytes(attribute.values))}});
}

// Where so many words of the caller's are from the next sync on.
SurfaceSlice::Place place(SurfaceSlice& slice, const DeviceMesh& mesh, std::string_view name, std::uint64_t address,
                          std::uint64_t words) {
    if (address == 0 || address % 4 != 0)
        fail("mesh '", mesh.name, "': device address ", address, " of its '", name,
             "' must be a multiple of 4 and not 0");
    if (words > ~0u) fail("mesh '", mesh.name, "': '", name, "' has ", words, " numbers; at most ", ~0u, " fit");
    if (mesh.in_place) return {.in_place = address};
    slice.copies.push_back({{address}, aligned(slice.pending_bytes()), words});
    return {.offset = slice.copies.back().offset};
}

void add(SurfaceSlice& slice, const DeviceMesh& mesh, const DeviceAttribute& attribute, uint number) {
    check_components(mesh.name, attribute.name, attribute.components);
    if (number < ATTRIBUTES_NAMED && (attribute.components != named_components[number] || attribute.is_per_face))
        fail("mesh '", mesh.name, "': '", attribute.name, "' has ", named_components[number],
             " components a vertex, not ", attribute.components, attribute.is_per_face ? " a triangle" : "");
    const std::uint64_t count = attribute.is_per_face ? mesh.triangle_count : mesh.vertex_count;
    slice.arrays.push_back(
        {number, attribute.components, attribute.is_per_face,
         place(slice, mesh, attribute.name, attribute.values.address, count * attribute.components)});
}

}  // namespace

std::optional<uint> AttributeNames::number_of(std::string_view name) const {
    const auto found = std::ranges::find(names_, name);
    if (found == names_.end()) return std::nullopt;
    return static_cast<uint>(found - names_.begin());
}

uint AttributeNames::number_for(std::string_view mesh, std::string_view name) {
    if (name.empty()) fail("mesh '", mesh, "': an attribute's name, '', is empty");
    if (const std::optional<uint> known = number_of(name)) return *known;
    if (names_.size() == most_names)
        fail("mesh '", mesh, "': attribute '", name, "' is one too many: an accelerator has ",
             most_names - ATTRIBUTES_NAMED);
    names_.emplace_back(name);
    return static_cast<uint>(names_.size() - 1);
}

std::uint64_t append_aligned(std::vector<std::byte>& packed, std::span<const std::byte> bytes) {
    const std::uint64_t offset = aligned(packed.size());
    packed.resize(offset + bytes.size());
    std::copy(bytes.begin(), bytes.end(), packed.begin() + static_cast<std::ptrdiff_t>(offset));
    return offset;
}

SurfaceSlice surface_slice(const MeshView& mesh, AttributeNames& names) {
    AttributeNames known = names;
    SurfaceSlice slice;
    add(slice, mesh, "normals", ATTRIBUTE_NORMALS, mesh.normals);
    add(slice, mesh, "tangents", ATTRIBUTE_TANGENTS, mesh.tangents);
    add(slice, mesh, "uv0", ATTRIBUTE_UV0, mesh.uv0);
    add(slice, mesh, "uv1", ATTRIBUTE_UV1, mesh.uv1);
    add(slice, mesh, "colors", ATTRIBUTE_COLORS, mesh.colors);
    for (const AttributeView& attribute : mesh.attributes) {
        check_not_twice(mesh.name, attribute.name, mesh.attributes);
        add(slice, mesh, attribute, known.number_for(mesh.name, attribute.name));
    }
    check_length(mesh, "face_metadata", mesh.face_metadata.size(), mesh.triangles.size(), "triangles");
    if (!mesh.face_metadata.empty())
        slice.face_metadata = {append_aligned(slice.packed, std::as_bytes(mesh.face_metadata))};
    if (!mesh.metadata.empty()) slice.metadata = {append_aligned(slice.packed, mesh.metadata)};
    names = std::move(known);
    return slice;
}

SurfaceSlice surface_slice(const DeviceMesh& mesh, AttributeNames& names) {
    AttributeNames known = names;
    SurfaceSlice slice;
    if (!mesh.metadata.empty()) slice.metadata = {append_aligned(slice.packed, mesh.metadata)};
    for (const DeviceAttribute& attribute : mesh.attributes) {
        check_not_twice(mesh.name, attribute.name, mesh.attributes);
        add(slice, mesh, attribute, known.number_for(mesh.name, attribute.name));
    }
    if (mesh.face_metadata.address)
        slice.face_metadata = place(slice, mesh, "face_metadata", mesh.face_metadata.address, mesh.triangle_count);
    names = std::move(known);
    return slice;
}

}  // namespace twinray
