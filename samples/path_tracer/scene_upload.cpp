// SPDX-License-Identifier: MIT
#include "samples/path_tracer/scene_upload.h"

#include <cstring>

#include "samples/path_tracer/layered_records.h"

namespace twinray::path_tracer {
namespace {

std::vector<uint> texels_of(const Image& image) {
    std::vector<uint> texels(std::size_t{image.width} * image.height);
    std::memcpy(texels.data(), image.rgba.data(), texels.size() * sizeof(uint));
    return texels;
}

}  // namespace

SceneFeatures features_of(const Scene& scene, const LocalLights& lights, const EnvironmentMap* environment) {
    SceneFeatures features;
    features.kinds = kinds_of(scene);
    features.environment = environment && !environment->is_black();
    features.local_lights = !lights.empty();
    return features;
}

DeviceScene::DeviceScene(Context& context, const Scene& scene, const LocalLights& lights,
                         const EnvironmentMap* environment)
    : context_(context),
      features_(features_of(scene, lights, environment)),
      data_(context, {.name = "path tracer scene", .bytes = sizeof(SceneData)}) {
    Commands commands(context, "path tracer upload");
    {
        const auto pass = commands.pass("path tracer upload");
        const SceneData data = upload_all(commands, scene, lights, environment);
        commands.upload(data_, std::span(&data, 1));
    }
    commands.submit();
}

SceneData DeviceScene::upload_all(Commands& commands, const Scene& scene, const LocalLights& lights,
                                  const EnvironmentMap* map) {
    SceneData data{};
    data.instances = upload_instances(commands, scene, lights);
    data.materials = upload(commands, "materials", material_records(scene));
    data.layered = upload(commands, "layers of materials", layered_records(scene));
    if (features_.kinds.needs.size() > 1)
        data.material_kinds = upload(commands, "kinds of materials", features_.kinds.of);
    data.images = upload_images(commands, scene);
    data.emitters = upload(commands, "emitters", lights.emitters);
    data.punctual = upload(commands, "punctual lights", lights.punctual);
    data.local_table = upload(commands, "light table", lights.table);
    data.emitter_count = static_cast<uint>(lights.emitters.size());
    data.local_count = static_cast<uint>(lights.table.size());
    if (features_.environment) data.environment = upload_environment(commands, *map);
    return data;
}

template <class T>
Ref<T> DeviceScene::upload(Commands& commands, const std::string& name, const std::vector<T>& values) {
    Buffer buffer(context_, {.name = name, .bytes = values.size() * sizeof(T)});
    commands.upload(buffer, std::span(values));
    buffers_.push_back(std::move(buffer));
    return buffers_.back().ref<T>();
}

Ref<SurfaceInstance> DeviceScene::upload_instances(Commands& commands, const Scene& scene, const LocalLights& lights) {
    struct MeshRefs {
        Ref<SurfaceVertex> vertices;
        Ref<SurfaceTriangle> triangles;
    };
    std::vector<MeshRefs> meshes;
    for (const Mesh& mesh : scene.meshes)
        meshes.push_back({upload(commands, "vertices of '" + mesh.name + "'", vertex_records(mesh)),
                          upload(commands, "triangles of '" + mesh.name + "'", triangle_records(mesh))});
    std::vector<SurfaceInstance> records;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        SurfaceInstance record = instance_record(scene.instances[i].transform);
        record.vertices = meshes[scene.instances[i].mesh].vertices;
        record.triangles = meshes[scene.instances[i].mesh].triangles;
        record.emitter_density = upload(commands, "emitter densities", lights.densities[i]);
        records.push_back(record);
    }
    return upload(commands, "surface instances", records);
}

Ref<TexelGrid> DeviceScene::upload_images(Commands& commands, const Scene& scene) {
    std::vector<TexelGrid> grids;
    for (const Image& image : scene.images)
        grids.push_back({upload(commands, "image '" + image.name + "'", texels_of(image)), image.width, image.height});
    return upload(commands, "images", grids);
}

Environment DeviceScene::upload_environment(Commands& commands, const EnvironmentMap& map) {
    std::vector<Radiance> pixels;
    pixels.reserve(map.image.rgb.size());
    for (const vec3& rgb : map.image.rgb) pixels.push_back({rgb});
    return {upload(commands, "environment", pixels),
            upload(commands, "environment row sums", map.row_sums),
            upload(commands, "environment column sums", map.column_sums),
            map.image.width,
            map.image.height,
            map.density_per_luminance,
            features_.local_lights ? 0.5f : 1.0f};
}

}  // namespace twinray::path_tracer
