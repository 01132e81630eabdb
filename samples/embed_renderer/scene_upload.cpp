// SPDX-License-Identifier: MIT
#include "samples/embed_renderer/scene_upload.h"

#include <algorithm>

#include "renderer/surface_records.h"

namespace twinray::embed_renderer {

SceneBuffers::SceneBuffers(const Device& device, Context& context, const Scene& scene)
    : device_(device), textures_(context, "textures", TextureStorage::buffers) {
    path_tracer::TextureList list;
    instances_ = add_instances(scene);
    extras_ = add_extras(context, scene);
    materials_ = add(path_tracer::material_records(scene, list));
    path_tracer::push_textures(textures_, scene, list);
    textures_.sync();
    context.wait_for_gpu();
    device.run_once([&](VkCommandBuffer commands) {
        for (const Upload& upload : uploads_) {
            const VkBufferCopy all{0, 0, upload.staging.bytes()};
            vkCmdCopyBuffer(commands, upload.staging.handle(), buffers_[upload.target].handle(), 1, &all);
        }
    });
    uploads_.clear();
}

template <class T>
Ref<T> SceneBuffers::add(const std::vector<T>& values) {
    const std::uint64_t bytes = values.size() * sizeof(T);
    buffers_.emplace_back(device_, bytes);
    if (bytes == 0) return {};
    HostBuffer staging(device_, bytes, HostBuffer::Access::uploaded);
    std::memcpy(staging.mapped(), values.data(), bytes);
    uploads_.push_back({std::move(staging), buffers_.size() - 1});
    return buffers_.back().ref<T>();
}

Ref<SurfaceInstance> SceneBuffers::add_instances(const Scene& scene) {
    std::vector<SurfaceInstance> meshes(scene.meshes.size());
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        meshes[i].vertices = add(path_tracer::vertex_records(scene.meshes[i]));
        meshes[i].triangles = add(path_tracer::triangle_records(scene.meshes[i]));
    }
    std::vector<SurfaceInstance> records;
    for (const Instance& instance : scene.instances) {
        SurfaceInstance record = path_tracer::instance_record(instance.transform);
        record.vertices = meshes[instance.mesh].vertices;
        record.triangles = meshes[instance.mesh].triangles;
        records.push_back(record);
        triangle_counts_.push_back(static_cast<uint>(scene.meshes[instance.mesh].triangles.size()));
    }
    return add(records);
}

// Absent where no mesh has any.
Ref<VertexExtras> SceneBuffers::add_extras(const Context& context, const Scene& scene) {
    const auto has_any = [](const Mesh& mesh) { return !mesh.colors.empty() || !mesh.second_uvs.empty(); };
    if (std::ranges::none_of(scene.meshes, has_any)) return {};
    std::vector<VertexExtras> of_meshes, records;
    for (const Mesh& mesh : scene.meshes) {
        VertexExtras& extras = of_meshes.emplace_back();
        extras = {{add(mesh.second_uvs).address}, {add(mesh.colors).address}};
        context.fill_absent(extras.second_uvs, extras.colors);
    }
    for (const Instance& instance : scene.instances) records.push_back(of_meshes[instance.mesh]);
    return add(records);
}

}  // namespace twinray::embed_renderer
