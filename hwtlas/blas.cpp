// SPDX-License-Identifier: MIT
#include "hwtlas/blas.h"

#include <utility>

#include "hwtlas/blas_input.h"

namespace twinray {
namespace {

template <class T>
Buffer upload(Commands& commands, const std::string& name, const std::vector<T>& values) {
    Buffer buffer(commands.context(), {.name = name, .bytes = values.size() * sizeof(T)});
    commands.upload(buffer, std::span<const T>(values));
    return buffer;
}

}  // namespace

StructureBuild triangle_build(const std::string& name, std::uint64_t positions, uint vertex_count,
                              uint triangle_count) {
    StructureBuild build{};
    build.name = "blas " + name;
    build.type = VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR;
    build.primitive_count = triangle_count;
    build.geometry.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR;
    build.geometry.geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR;
    build.geometry.flags = VK_GEOMETRY_OPAQUE_BIT_KHR;
    VkAccelerationStructureGeometryTrianglesDataKHR& data = build.geometry.geometry.triangles;
    data.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR;
    data.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
    data.vertexData.deviceAddress = positions;
    data.vertexStride = sizeof(vec3);
    data.maxVertex = vertex_count - 1;
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
            if (input.is_empty()) continue;
            blases[i].bounds = input.bounds;
            Buffer positions = upload(commands, "blas positions " + geometry.name, input.positions);
            Buffer triangles = upload(commands, "blas triangles " + geometry.name, input.triangles);
            if (options.reorder)
                blases[i].original_triangles =
                    std::make_shared<const Buffer>(upload(commands, "blas order " + geometry.name, input.original));
            builds.push_back(triangle_build(geometry.name, positions.address(),
                                            static_cast<uint>(input.positions.size()),
                                            static_cast<uint>(input.triangles.size())));
            builds.back().flags |= VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_COMPACTION_BIT_KHR;
            builds.back().geometry.geometry.triangles.indexData.deviceAddress = triangles.address();
            built.push_back(i);
            commands.keep(std::move(positions));
            commands.keep(std::move(triangles));
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
        blases[built[i]].place = i;
    }
    return blases;
}

}  // namespace twinray
