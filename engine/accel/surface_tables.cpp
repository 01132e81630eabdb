// SPDX-License-Identifier: MIT
#include "engine/accel/surface_tables.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "engine/core/error.h"

namespace twinray {
namespace {

constexpr std::size_t most_names = 256;
constexpr std::uint64_t alignment = 16;

std::uint64_t aligned(std::uint64_t offset) { return (offset + alignment - 1) / alignment * alignment; }

std::uint64_t append(std::vector<std::byte>& packed, std::span<const std::byte> bytes) {
    const std::uint64_t offset = aligned(packed.size());
    packed.resize(offset + bytes.size());
    std::copy(bytes.begin(), bytes.end(), packed.begin() + static_cast<std::ptrdiff_t>(offset));
    return offset;
}

// Throws Error unless it is empty or has one entry for each of `count`.
void check_length(const MeshView& mesh, std::string_view name, std::size_t length, std::size_t count,
                  const char* of_what) {
    if (length != 0 && length != count)
        fail("mesh '", mesh.name, "': ", length, " entries of '", name, "' for ", count, " ", of_what);
}

template <class V>
void add(SurfaceSlice& slice, const MeshView& mesh, std::string_view name, uint number, std::span<const V> values) {
    check_length(mesh, name, values.size(), mesh.positions.size(), "vertices");
    if (values.empty()) return;
    slice.arrays.push_back({number, sizeof(V) / sizeof(float), false, append(slice.packed, std::as_bytes(values))});
}

void add(SurfaceSlice& slice, const MeshView& mesh, const AttributeView& attribute, uint number) {
    if (attribute.components < 1 || attribute.components > 4)
        fail("mesh '", mesh.name, "': attribute '", attribute.name, "' has ", attribute.components,
             " components; 1 to 4 fit");
    const std::size_t count = attribute.is_per_face ? mesh.triangles.size() : mesh.positions.size();
    check_length(mesh, attribute.name, attribute.values.size(), count * attribute.components,
                 attribute.is_per_face ? "triangles, times its components" : "vertices, times its components");
    if (attribute.values.empty()) return;
    slice.arrays.push_back(
        {number, attribute.components, attribute.is_per_face, append(slice.packed, std::as_bytes(attribute.values))});
}

}  // namespace

SurfaceTables::SurfaceTables(Context& context)
    : context_(context),
      names_{"normals", "tangents", "uv0", "uv1", "colors"},
      table_(context, {.name = "surface table", .bytes = sizeof(SurfaceTable)}) {}

std::optional<uint> SurfaceTables::number_of(std::string_view name) const {
    const auto found = std::ranges::find(names_, name);
    if (found == names_.end()) return std::nullopt;
    return static_cast<uint>(found - names_.begin());
}

SurfaceSlice SurfaceTables::slice_of(const MeshView& mesh) {
    SurfaceSlice slice;
    add(slice, mesh, "normals", ATTRIBUTE_NORMALS, mesh.normals);
    add(slice, mesh, "tangents", ATTRIBUTE_TANGENTS, mesh.tangents);
    add(slice, mesh, "uv0", ATTRIBUTE_UV0, mesh.uv0);
    add(slice, mesh, "uv1", ATTRIBUTE_UV1, mesh.uv1);
    add(slice, mesh, "colors", ATTRIBUTE_COLORS, mesh.colors);
    std::vector<std::string> names = names_;
    for (const AttributeView& attribute : mesh.attributes) {
        const auto known = std::ranges::find(names, attribute.name);
        const auto number = static_cast<uint>(known - names.begin());
        const bool is_taken =
            number < ATTRIBUTES_NAMED || std::ranges::count(mesh.attributes, attribute.name, &AttributeView::name) > 1;
        if (attribute.name.empty() || is_taken)
            fail("mesh '", mesh.name, "': an attribute's name, '", attribute.name, "', is ",
                 attribute.name.empty() ? "empty" : "taken");
        if (known == names.end()) names.emplace_back(attribute.name);
        if (names.size() > most_names)
            fail("mesh '", mesh.name, "': attribute '", attribute.name, "' is one too many: an accelerator has ",
                 most_names - ATTRIBUTES_NAMED);
        add(slice, mesh, attribute, number);
    }
    check_length(mesh, "face_metadata", mesh.face_metadata.size(), mesh.triangles.size(), "triangles");
    if (!mesh.face_metadata.empty()) slice.face_metadata = append(slice.packed, std::as_bytes(mesh.face_metadata));
    if (!mesh.metadata.empty()) slice.metadata = append(slice.packed, mesh.metadata);
    names_ = std::move(names);
    return slice;
}

SurfaceTables::Staged SurfaceTables::stage(Commands& commands, std::span<const Item> items,
                                           Ref<InstanceRecord> instances) const {
    Staged staged;
    const auto pass = commands.pass("surfaces");
    uint attribute_count = 0;
    for (const Item& item : items)
        for (const SurfaceSlice::Array& array : item.slice->arrays)
            attribute_count = std::max(attribute_count, array.number + 1);

    std::vector<SurfaceGeometry> geometries;
    std::vector<SurfaceAttribute> attributes(items.size() * attribute_count);
    std::vector<uint> geometry_of_instance;
    for (std::size_t i = 0; i < items.size(); ++i) {
        SurfaceSlice& slice = *items[i].slice;
        std::uint64_t address = slice.data.bytes() ? slice.data.address() : 0;
        if (!slice.packed.empty()) {
            Buffer data(context_, {.name = "surface data", .bytes = slice.packed.size()});
            commands.upload(data, std::span<const std::byte>(slice.packed));
            address = data.address();
            staged.data.emplace_back(&slice, std::move(data));
        }
        const auto at = [&](std::optional<std::uint64_t> offset) { return offset ? address + *offset : 0; };
        geometries.push_back({items[i].handle,
                              {at(slice.face_metadata)},
                              at(slice.metadata),
                              static_cast<uint>(geometry_of_instance.size()),
                              static_cast<uint>(items[i].faces)});
        for (const SurfaceSlice::Array& array : slice.arrays)
            attributes[i * attribute_count + array.number] = {
                {address + array.offset}, array.components, array.is_per_face ? 1u : 0u};
        geometry_of_instance.insert(geometry_of_instance.end(), items[i].instances, static_cast<uint>(i));
    }

    std::vector<std::byte> rows;
    const std::uint64_t of_geometries = append(rows, std::as_bytes(std::span(geometries)));
    const std::uint64_t of_attributes = append(rows, std::as_bytes(std::span(attributes)));
    const std::uint64_t of_instances = append(rows, std::as_bytes(std::span(geometry_of_instance)));
    staged.rows.emplace(context_, BufferDesc{.name = "surface rows", .bytes = rows.size()});
    const std::uint64_t address = rows.empty() ? 0 : staged.rows->address();
    if (!rows.empty()) commands.upload(*staged.rows, std::span<const std::byte>(rows));
    commands.write(table_, SurfaceTable{instances,
                                        {address + of_instances},
                                        {address + of_geometries},
                                        {address + of_attributes},
                                        attribute_count,
                                        0});
    return staged;
}

void SurfaceTables::commit(Staged&& staged) {
    for (auto& [slice, data] : staged.data) {
        slice->data = std::move(data);
        slice->packed = std::vector<std::byte>();  // without its memory
    }
    if (staged.rows) rows_ = std::move(*staged.rows);
}

}  // namespace twinray
