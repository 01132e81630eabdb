#include "hwtlas/blas.h"

#include <algorithm>
#include <utility>

#include "engine/accel/batches.h"
#include "engine/accel/morton_order.h"

namespace twinray {
namespace {

BlasInput boxes_input(std::span<const Bounds> boxes, bool reorder) {
    BlasInput input;
    std::vector<vec3> centers;
    for (const Bounds& box : boxes) {
        centers.push_back(box.center());
        input.bounds.include(box);
    }
    if (reorder) input.original = morton_order(centers);
    for (std::size_t i = 0; i < boxes.size(); ++i) input.boxes.push_back(boxes[reorder ? input.original[i] : i]);
    return input;
}

StructureBuild build_of_boxes(const std::string& name, std::uint64_t boxes, std::size_t count) {
    static_assert(sizeof(Bounds) == sizeof(VkAabbPositionsKHR));
    StructureBuild build = structure_build("blas " + name, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR,
                                           VK_GEOMETRY_TYPE_AABBS_KHR, count);
    VkAccelerationStructureGeometryAabbsDataKHR& data = build.geometry.geometry.aabbs;
    data.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_AABBS_DATA_KHR;
    data.data.deviceAddress = boxes;
    data.stride = sizeof(Bounds);
    return build;
}

// Uploads the input and describes how to build from it.
StructureBuild record_input(Commands& commands, const std::string& name, const BlasInput& input) {
    const std::span<const std::byte> boxes = std::as_bytes(std::span(input.boxes));
    Buffer buffer(commands.context(), {.name = "blas input " + name,
                                       .bytes = boxes.size() + std::span(input.positions).size_bytes() +
                                                std::span(input.triangles).size_bytes()});
    MeshUpload upload(buffer);
    StructureBuild build;
    if (boxes.empty()) {
        const PackedMesh mesh = upload.add(input.positions, input.triangles);
        build = triangle_build(name, mesh.positions.address, input.positions.size(), input.triangles.size());
        build.geometry.geometry.triangles.indexData.deviceAddress = mesh.indices.address;
    } else {
        build = build_of_boxes(name, upload.add(boxes), input.boxes.size());
    }
    upload.record(commands);
    build.flags |= VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_COMPACTION_BIT_KHR;
    commands.retain(std::move(buffer));
    return build;
}

}  // namespace

BlasInput blas_input(const Geometry& geometry, bool reorder) {
    if (geometry.kind == GEOMETRY_BOXES) return boxes_input(geometry.boxes, reorder);
    const SharedArray<vec3> positions = geometry.built_positions();
    const auto is_active = [&](uvec3 vertices) {
        return is_active_triangle(positions[vertices.x], positions[vertices.y], positions[vertices.z]);
    };
    const auto first_active = std::find_if(geometry.triangles.begin(), geometry.triangles.end(), is_active);
    if (first_active == geometry.triangles.end()) return {};
    const uint anchor = first_active->x;

    BlasInput input;
    input.positions.assign(positions.begin(), positions.end());
    for (vec3& position : input.positions)
        if (!is_finite(position)) position = positions[anchor];
    if (reorder) input.original = morton_order(triangle_centers(positions, geometry.triangles));
    input.triangles.reserve(geometry.triangles.size());
    for (std::size_t i = 0; i < geometry.triangles.size(); ++i) {
        const uvec3 vertices = geometry.triangles[reorder ? input.original[i] : i];
        const bool active = is_active(vertices);
        input.triangles.push_back(active ? vertices : uvec3(anchor));
        if (!active) continue;
        for (int vertex = 0; vertex < 3; ++vertex) input.bounds.include(positions[vertices[vertex]]);
    }
    return input;
}

StructureBuild triangle_build(const std::string& name, std::uint64_t positions, std::size_t vertex_count,
                              std::size_t triangle_count) {
    StructureBuild build = structure_build("blas " + name, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR,
                                           VK_GEOMETRY_TYPE_TRIANGLES_KHR, triangle_count);
    VkAccelerationStructureGeometryTrianglesDataKHR& data = build.geometry.geometry.triangles;
    data.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR;
    data.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
    data.vertexData.deviceAddress = positions;
    data.vertexStride = sizeof(vec3);
    data.maxVertex = static_cast<std::uint32_t>(vertex_count) - 1;
    data.indexType = VK_INDEX_TYPE_UINT32;
    return build;
}

std::vector<Blas> build_blases(Commands& commands, std::span<const Geometry* const> geometries,
                               const BlasOptions& options) {
    std::vector<Blas> blases(geometries.size());
    std::vector<StructureBuild> builds;
    std::vector<std::size_t> built;  // builds[i] belongs to blases[built[i]]
    if (geometries.empty()) return blases;
    {
        const auto pass = commands.pass("hwtlas_upload_meshes");
        for (std::size_t i = 0; i < geometries.size(); ++i) {
            const Geometry& geometry = *geometries[i];
            const BlasInput input = blas_input(geometry, options.reorder);
            blases[i].kind = geometry.kind;
            if (input.is_empty()) continue;
            blases[i].bounds = input.bounds;
            if (options.reorder) {
                const std::span<const uint> order = input.original;
                const auto buffer = std::make_shared<Buffer>(
                    commands.context(), BufferDesc{.name = "blas order " + geometry.name, .bytes = order.size_bytes()});
                commands.upload(*buffer, order);
                blases[i].original = buffer;
            }
            builds.push_back(record_input(commands, geometry.name, input));
            built.push_back(i);
        }
    }
    std::vector<AccelerationStructure> structures =
        build_structures(commands, "hwtlas_build_blases", builds, options.scratch_budget);
    if (built.empty()) return blases;
    std::vector<const AccelerationStructure*> asked;
    for (std::size_t i = 0; i < built.size(); ++i) {
        blases[built[i]].structure = std::move(structures[i]);
        asked.push_back(&blases[built[i]].structure);
    }
    const auto compacted = std::make_shared<CompactedSizes>(commands, asked);
    for (std::size_t i = 0; i < built.size(); ++i) {
        blases[built[i]].compacted = compacted;
        blases[built[i]].compacted_index = i;
    }
    return blases;
}

BuildBytes blas_bytes(const Context& context, std::span<const GeometrySize> meshes, const BlasOptions& options) {
    BuildBytes bytes;
    std::vector<std::uint64_t> scratch;
    for (const GeometrySize& mesh : meshes) {
        if (mesh.triangles == 0 || mesh.in_device_memory) continue;
        StructureBuild build = triangle_build("", 0, mesh.vertices, mesh.triangles);
        build.flags |= VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_COMPACTION_BIT_KHR;
        bytes.structures +=
            sizes_of(context, build).accelerationStructureSize + (options.reorder ? mesh.triangles * sizeof(uint) : 0);
        bytes.scratch += mesh.vertices * sizeof(vec3) + mesh.triangles * sizeof(uvec3);
        scratch.push_back(scratch_bytes_of(context, {build, BuildMode::build, nullptr}));
    }
    bytes.scratch += cut_into_batches(scratch, options.scratch_budget).scratch_bytes;
    return bytes;
}

}  // namespace twinray
