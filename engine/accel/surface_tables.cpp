#include "engine/accel/surface_tables.h"

#include <algorithm>
#include <array>
#include <utility>

#include "engine/core/device_list.h"
#include "engine/core/error.h"
#include "engine_copy_words.spv.h"

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

// `Attribute` is AttributeView or DeviceAttribute.
template <class Attribute>
void check_named(std::string_view mesh, std::span<const Attribute> all, const Attribute& attribute) {
    if (attribute.name.empty()) fail("mesh '", mesh, "': an attribute's name, '', is empty");
    if (std::ranges::count(all, attribute.name, &Attribute::name) > 1)
        fail("mesh '", mesh, "': an attribute's name, '", attribute.name, "', is taken");
    if (attribute.components < 1 || attribute.components > 4)
        fail("mesh '", mesh, "': attribute '", attribute.name, "' has ", attribute.components,
             " components; 1 to 4 fit");
}

void check_attribute(const MeshView& mesh, const AttributeView& attribute) {
    if (AttributeNames().number_of(attribute.name))
        fail("mesh '", mesh.name, "': an attribute's name, '", attribute.name, "', is taken");
    check_named(mesh.name, mesh.attributes, attribute);
    const std::size_t count = attribute.is_per_face ? mesh.triangles.size() : mesh.positions.size();
    check_length(mesh, attribute.name, attribute.values.size(), count * attribute.components,
                 attribute.is_per_face ? "triangles, times its components" : "vertices, times its components");
}

void check_attribute(const DeviceMesh& mesh, const DeviceAttribute& attribute) {
    check_named(mesh.name, mesh.attributes, attribute);
    const uint number = AttributeNames().number_of(attribute.name).value_or(ATTRIBUTES_NAMED);
    if (number < ATTRIBUTES_NAMED && (attribute.components != named_components[number] || attribute.is_per_face))
        fail("mesh '", mesh.name, "': '", attribute.name, "' has ", named_components[number],
             " components per vertex, not ", attribute.components, attribute.is_per_face ? " per triangle" : "");
}

// Checks that there is an array of so many numbers at the address.
void check_array(const DeviceMesh& mesh, std::string_view name, std::uint64_t address, std::uint64_t words) {
    if (address == 0 || address % 4 != 0)
        fail("mesh '", mesh.name, "': device address ", address, " of its '", name,
             "' must be a multiple of 4 and not 0");
    if (words > ~0u) fail("mesh '", mesh.name, "': '", name, "' has ", words, " numbers; at most ", ~0u, " fit");
}

std::uint64_t words_of(const DeviceMesh& mesh, const DeviceAttribute& attribute) {
    return (attribute.is_per_face ? mesh.triangle_count : mesh.vertex_count) * std::uint64_t{attribute.components};
}

template <class V>
void add(SurfaceSlice& slice, uint number, std::span<const V> values) {
    if (values.empty()) return;
    slice.arrays.push_back(
        {number, sizeof(V) / sizeof(float), false, {append_aligned(slice.packed, std::as_bytes(values))}});
}

void add(SurfaceSlice& slice, const AttributeView& attribute, uint number) {
    if (attribute.values.empty()) return;
    slice.arrays.push_back({number,
                            attribute.components,
                            attribute.is_per_face,
                            {append_aligned(slice.packed, std::as_bytes(attribute.values))}});
}

// Returns where so many of the caller's words are from the next sync on.
SurfaceSlice::Place place(SurfaceSlice& slice, const DeviceMesh& mesh, std::uint64_t address, std::uint64_t words) {
    if (mesh.in_place) return {.in_place = address};
    slice.copies.push_back({{address}, aligned(slice.pending_bytes()), words});
    return {.offset = slice.copies.back().offset};
}

}  // namespace

std::optional<uint> AttributeNames::number_of(std::string_view name) const {
    const auto found = std::ranges::find(names_, name);
    if (found == names_.end()) return std::nullopt;
    return static_cast<uint>(found - names_.begin());
}

uint AttributeNames::number_for(std::string_view mesh, std::string_view name) {
    if (const std::optional<uint> known = number_of(name)) return *known;
    if (names_.size() == most_names)
        fail("mesh '", mesh, "': attribute '", name, "' exceeds the limit: an accelerator has at most ",
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

void check_arrays(const MeshView& mesh) {
    const std::size_t vertices = mesh.positions.size();
    check_length(mesh, "normals", mesh.normals.size(), vertices, "vertices");
    check_length(mesh, "tangents", mesh.tangents.size(), vertices, "vertices");
    check_length(mesh, "uv0", mesh.uv0.size(), vertices, "vertices");
    check_length(mesh, "uv1", mesh.uv1.size(), vertices, "vertices");
    check_length(mesh, "colors", mesh.colors.size(), vertices, "vertices");
    for (const AttributeView& attribute : mesh.attributes) check_attribute(mesh, attribute);
    check_length(mesh, "face_metadata", mesh.face_metadata.size(), mesh.triangles.size(), "triangles");
}

void check_arrays(const DeviceMesh& mesh) {
    for (const DeviceAttribute& attribute : mesh.attributes) {
        check_attribute(mesh, attribute);
        check_array(mesh, attribute.name, attribute.values.address, words_of(mesh, attribute));
    }
    if (mesh.face_metadata.address) check_array(mesh, "face_metadata", mesh.face_metadata.address, mesh.triangle_count);
}

MeshView metadata_of(const MeshView& mesh) {
    MeshView metadata(mesh.name, mesh.positions, mesh.triangles);
    metadata.face_metadata = mesh.face_metadata;
    metadata.metadata = mesh.metadata;
    return metadata;
}

DeviceMesh metadata_of(const DeviceMesh& mesh) {
    DeviceMesh metadata = mesh;
    metadata.attributes = {};
    return metadata;
}

SurfaceSlice surface_slice(const MeshView& mesh, AttributeNames& names) {
    AttributeNames known = names;
    SurfaceSlice slice;
    add(slice, ATTRIBUTE_NORMALS, mesh.normals);
    add(slice, ATTRIBUTE_TANGENTS, mesh.tangents);
    add(slice, ATTRIBUTE_UV0, mesh.uv0);
    add(slice, ATTRIBUTE_UV1, mesh.uv1);
    add(slice, ATTRIBUTE_COLORS, mesh.colors);
    for (const AttributeView& attribute : mesh.attributes)
        add(slice, attribute, known.number_for(mesh.name, attribute.name));
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
    for (const DeviceAttribute& attribute : mesh.attributes)
        slice.arrays.push_back({known.number_for(mesh.name, attribute.name), attribute.components,
                                attribute.is_per_face,
                                place(slice, mesh, attribute.values.address, words_of(mesh, attribute))});
    if (mesh.face_metadata.address)
        slice.face_metadata = place(slice, mesh, mesh.face_metadata.address, mesh.triangle_count);
    names = std::move(known);
    return slice;
}

SurfaceTables::SurfaceTables(Context& context)
    : context_(context),
      copy_words_(context, lazy_kernel("engine_copy_words", engine_copy_words_spirv)),
      table_(context, {.name = "surface table", .bytes = sizeof(SurfaceTable)}) {}

// Returns where its arrays are.
std::uint64_t SurfaceTables::stage_data(Commands& commands, SurfaceSlice& slice, Staged& staged) const {
    if (const auto shared = staged.data.find(&slice); shared != staged.data.end()) return shared->second.address();
    const std::uint64_t bytes = slice.pending_bytes();
    if (bytes == 0) return slice.data.bytes() ? slice.data.address() : 0;
    Buffer data(context_, {.name = "surface data", .bytes = bytes});
    if (!slice.packed.empty()) commands.upload(data, std::span<const std::byte>(slice.packed));
    for (const SurfaceSlice::Copy& copy : slice.copies)
        copy_words_.dispatch(commands, {copy.from, data.ref<uint>(copy.offset), static_cast<uint>(copy.words), 0},
                             copy.words);
    const std::uint64_t address = data.address();
    staged.data.emplace(&slice, std::move(data));
    return address;
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
    std::vector<SurfaceAttribute> attributes(items.size() * attribute_count, {{context_.absent()}, 0, 0});
    std::vector<uint> geometry_of_instance;
    for (std::size_t i = 0; i < items.size(); ++i) {
        SurfaceSlice& slice = *items[i].slice;
        const std::uint64_t base = stage_data(commands, slice, staged);
        const auto at = [&](const std::optional<SurfaceSlice::Place>& place) {
            return place ? place->address(base) : context_.absent();
        };
        geometries.push_back({items[i].handle,
                              {at(slice.face_metadata)},
                              at(slice.metadata),
                              static_cast<uint>(geometry_of_instance.size()),
                              static_cast<uint>(items[i].faces)});
        for (const SurfaceSlice::Array& array : slice.arrays)
            attributes[i * attribute_count + array.number] = {
                {array.place.address(base)}, array.components, array.is_per_face ? 1u : 0u};
        geometry_of_instance.insert(geometry_of_instance.end(), items[i].instances, static_cast<uint>(i));
    }

    std::vector<std::byte> rows;
    const std::uint64_t of_geometries = append_aligned(rows, std::as_bytes(std::span(geometries)));
    const std::uint64_t of_attributes = append_aligned(rows, std::as_bytes(std::span(attributes)));
    const std::uint64_t of_instances = append_aligned(rows, std::as_bytes(std::span(geometry_of_instance)));
    staged.rows.emplace(context_, BufferDesc{.name = "surface rows", .bytes = rows.size()});
    const std::uint64_t address = rows.empty() ? context_.absent() : staged.rows->address();
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
        slice->packed = std::vector<std::byte>();  // empty, and its memory is freed
        slice->copies = {};
    }
    if (staged.rows) rows_ = std::move(*staged.rows);
}

std::vector<uint> SurfaceTables::read(const SurfaceSlice& slice, const SurfaceSlice::Place& place,
                                      std::size_t count) const {
    if (!place.in_place) return download<uint>(context_, slice.data, count, place.offset);
    const Buffer copy(context_, {.name = "surface data", .bytes = count * sizeof(uint)});
    Commands commands(context_, "read surface data");
    copy_words_.dispatch(commands, {{place.in_place}, copy.ref<uint>(), static_cast<uint>(count), 0}, count);
    commands.submit();
    return download<uint>(context_, copy, count);
}

}  // namespace twinray
