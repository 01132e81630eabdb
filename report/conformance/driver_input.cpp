#include "report/conformance/driver.h"

#include <algorithm>
#include <cstring>

#include <glm/gtc/packing.hpp>

#include "engine/core/error.h"

namespace twinray::conformance {
namespace {

constexpr std::uint64_t input_alignment = 16;

// The place of items that a build must skip. It is far from everything else, so that a build that does not skip them is
// noticed.
constexpr float passed_over = 64;

template <class T>
void append(std::vector<std::byte>& bytes, const T& value) {
    const auto* first = reinterpret_cast<const std::byte*>(&value);
    bytes.insert(bytes.end(), first, first + sizeof(T));
}

std::int16_t snorm16(float value) { return static_cast<std::int16_t>(std::lround(static_cast<double>(value) * 32767)); }

void append_vertex(std::vector<std::byte>& bytes, VkFormat format, vec3 p) {
    switch (format) {
        case VK_FORMAT_R32G32_SFLOAT:
            append(bytes, p.x);
            append(bytes, p.y);
            return;
        case VK_FORMAT_R32G32B32_SFLOAT: append(bytes, p); return;
        case VK_FORMAT_R16G16_SFLOAT:
            for (const float value : {p.x, p.y}) append(bytes, glm::packHalf1x16(value));
            return;
        case VK_FORMAT_R16G16B16A16_SFLOAT:
            for (const float value : {p.x, p.y, p.z, passed_over}) append(bytes, glm::packHalf1x16(value));
            return;
        case VK_FORMAT_R16G16_SNORM:
            for (const float value : {p.x, p.y}) append(bytes, snorm16(value));
            return;
        case VK_FORMAT_R16G16B16A16_SNORM:
            for (const float value : {p.x, p.y, p.z, 1.0f}) append(bytes, snorm16(value));
            return;
        default: fail("vertex format ", static_cast<int>(format), " is not one that Vulkan requires");
    }
}

void pad(std::vector<std::byte>& bytes, std::uint32_t count) { bytes.resize(bytes.size() + count, std::byte{0x55}); }

std::uint64_t to_device(Commands& commands, const char* name, const std::vector<std::byte>& bytes) {
    // An empty build also needs an address.
    Buffer buffer(commands.context(),
                  {.name = name, .bytes = std::max<std::uint64_t>(bytes.size(), 1), .alignment = input_alignment});
    commands.upload(buffer, std::span(bytes));
    const std::uint64_t address = buffer.address();
    commands.retain(std::move(buffer));
    return address;
}

VkAccelerationStructureGeometryKHR new_geometry(VkGeometryTypeKHR type, VkGeometryFlagsKHR flags) {
    VkAccelerationStructureGeometryKHR geometry{};
    geometry.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR;
    geometry.geometryType = type;
    geometry.flags = flags;
    return geometry;
}

VkIndexType index_type(Indices indices) {
    switch (indices) {
        case Indices::none: return VK_INDEX_TYPE_NONE_KHR;
        case Indices::bits16: return VK_INDEX_TYPE_UINT16;
        case Indices::bits32: return VK_INDEX_TYPE_UINT32;
    }
    return VK_INDEX_TYPE_UINT32;
}

std::uint32_t bytes_of_item(const GeometryInput& input) {
    if (input.is_boxes()) return sizeof(Bounds) + input.padding;
    if (input.indices == Indices::none) return 3 * vertex_stride(input);
    return 3 * (input.indices == Indices::bits16 ? 2 : 4);
}

void add_boxes(Commands& commands, const GeometryInput& input, BuildInput& build) {
    VkAccelerationStructureGeometryKHR geometry = new_geometry(VK_GEOMETRY_TYPE_AABBS_KHR, input.flags);
    VkAccelerationStructureGeometryAabbsDataKHR& data = geometry.geometry.aabbs;
    data.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_AABBS_DATA_KHR;
    data.data.deviceAddress = to_device(commands, "conformance boxes", encoded_boxes(input));
    data.stride = sizeof(Bounds) + input.padding;
    build.geometries.push_back(geometry);
}

void add_triangles(Commands& commands, const GeometryInput& input, BuildInput& build) {
    VkAccelerationStructureGeometryKHR geometry = new_geometry(VK_GEOMETRY_TYPE_TRIANGLES_KHR, input.flags);
    VkAccelerationStructureGeometryTrianglesDataKHR& data = geometry.geometry.triangles;
    data.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR;
    data.vertexFormat = input.format;
    data.vertexData.deviceAddress = to_device(commands, "conformance vertices", encoded_vertices(input));
    data.vertexStride = vertex_stride(input);
    data.maxVertex =
        input.first_vertex + static_cast<std::uint32_t>(std::max<std::size_t>(input.positions.size(), 1)) - 1;
    data.indexType = index_type(input.indices);
    if (input.indices != Indices::none)
        data.indexData.deviceAddress = to_device(commands, "conformance indices", encoded_indices(input));
    if (input.transform) {
        std::vector<std::byte> places;
        for (std::uint32_t i = 0; i < input.earlier_places; ++i)
            append(places, Transform::translation(vec3(passed_over)));
        append(places, *input.transform);
        data.transformData.deviceAddress = to_device(commands, "conformance transforms", places);
    }
    build.geometries.push_back(geometry);
}

VkAccelerationStructureInstanceKHR instance_of(const InstanceInput& input, const std::vector<BottomRef>& bottoms) {
    VkAccelerationStructureInstanceKHR instance{};
    static_assert(sizeof instance.transform == sizeof(Transform));
    std::memcpy(&instance.transform, &input.to_world, sizeof(Transform));
    instance.instanceCustomIndex = input.custom_index & 0xffffff;
    instance.mask = input.mask & 0xff;
    instance.instanceShaderBindingTableRecordOffset = input.sbt_offset & 0xffffff;
    instance.flags = static_cast<std::uint8_t>(input.flags);
    instance.accelerationStructureReference = input.bottom == no_bottom ? 0 : bottoms[input.bottom].address;
    return instance;
}

}  // namespace

std::uint32_t vertex_stride(const GeometryInput& geometry) {
    std::vector<std::byte> one;
    append_vertex(one, geometry.format, vec3(0));
    return static_cast<std::uint32_t>(one.size()) + geometry.padding;
}

std::vector<std::byte> encoded_vertices(const GeometryInput& geometry) {
    std::vector<std::byte> bytes;
    const auto add = [&](vec3 position) {
        append_vertex(bytes, geometry.format, position);
        pad(bytes, geometry.padding);
    };
    const std::uint32_t earlier =
        geometry.first_vertex + (geometry.indices == Indices::none ? 3 * geometry.earlier_items : 0);
    const auto add_others = [&](std::uint32_t count) {
        for (std::uint32_t i = 0; i < count; ++i) add(vec3(passed_over + static_cast<float>(i % 3), passed_over, 0));
    };
    add_others(earlier);
    for (const vec3& position : geometry.positions) add(position);
    add_others(geometry.first_vertex);  // for drivers that pass over too many
    return bytes;
}

std::vector<std::byte> encoded_indices(const GeometryInput& geometry) {
    std::vector<std::byte> bytes;
    if (geometry.indices == Indices::none) return bytes;
    const auto add = [&](uvec3 corners) {
        for (std::size_t i = 0; i < 3; ++i) {
            if (geometry.indices == Indices::bits16)
                append(bytes, static_cast<std::uint16_t>(corners[i]));
            else
                append(bytes, corners[i]);
        }
    };
    for (std::uint32_t i = 0; i < geometry.earlier_items; ++i) add(uvec3(0));
    for (const uvec3& corners : geometry.triangles) add(corners);
    return bytes;
}

std::vector<std::byte> encoded_boxes(const GeometryInput& geometry) {
    std::vector<std::byte> bytes;
    const auto add = [&](const Bounds& box) {
        append(bytes, box);
        pad(bytes, geometry.padding);
    };
    for (std::uint32_t i = 0; i < geometry.earlier_items; ++i) add({vec3(passed_over), vec3(passed_over + 1)});
    for (const Bounds& box : geometry.boxes) add(box);
    return bytes;
}

BuildInput upload(Commands& commands, const BottomInput& input) {
    BuildInput build;
    build.flags = input.flags;
    const auto pass = commands.pass("conformance upload of a bottom level");
    for (const GeometryInput& geometry : input.geometries) {
        if (geometry.is_boxes())
            add_boxes(commands, geometry, build);
        else
            add_triangles(commands, geometry, build);
        build.counts.push_back(geometry.primitive_count());
        build.ranges.push_back({geometry.primitive_count(), geometry.earlier_items * bytes_of_item(geometry),
                                geometry.first_vertex,
                                static_cast<std::uint32_t>(geometry.earlier_places * sizeof(Transform))});
    }
    return build;
}

BuildInput upload(Commands& commands, const TopInput& input, const std::vector<BottomRef>& bottoms) {
    BuildInput build;
    build.flags = input.flags;
    build.type = VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR;
    const auto pass = commands.pass("conformance upload of a top level");
    std::vector<std::byte> instances, pointers;
    for (const InstanceInput& instance : input.instances) append(instances, instance_of(instance, bottoms));
    const std::uint64_t address = to_device(commands, "conformance instances", instances);
    for (std::uint64_t i = 0; i < input.instances.size(); ++i)
        append(pointers, address + i * sizeof(VkAccelerationStructureInstanceKHR));
    VkAccelerationStructureGeometryKHR geometry = new_geometry(VK_GEOMETRY_TYPE_INSTANCES_KHR, 0);
    VkAccelerationStructureGeometryInstancesDataKHR& data = geometry.geometry.instances;
    data.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR;
    data.arrayOfPointers = input.has_pointers;
    data.data.deviceAddress =
        input.has_pointers ? to_device(commands, "conformance pointers to instances", pointers) : address;
    build.geometries.push_back(geometry);
    build.counts.push_back(static_cast<std::uint32_t>(input.instances.size()));
    build.ranges.push_back({build.counts.back(), 0, 0, 0});
    return build;
}

}  // namespace twinray::conformance
