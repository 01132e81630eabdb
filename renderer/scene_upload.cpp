#include "renderer/scene_upload.h"

#include "samples/support/text.h"

namespace twinray::path_tracer {
using samples::fail;

namespace {

void fill_absent(const Context& context, SceneData& data) {
    context.fill_absent(data.instances, data.materials, data.layered, data.material_kinds, data.textures.records,
                        data.textures.faults, data.lights.emitters, data.lights.punctual, data.lights.faults,
                        data.light_keys, data.light_table, data.light_tree, data.environment.pixels,
                        data.environment.row_sums, data.environment.column_sums);
}

LightNode dark_leaf() {
    LightNode leaf{};
    leaf.child = LIGHT_LEAF;
    return leaf;
}

}  // namespace

SceneFeatures features_of(const Scene& scene, const LocalLights& lights, const EnvironmentMap* environment) {
    SceneFeatures features;
    features.kinds = kinds_of(scene);
    features.environment = environment && !environment->is_black();
    features.deep_textures =
        std::ranges::any_of(scene.images, [](const Image& image) { return !image.rgba16.empty(); });
    features.local_lights = !lights.empty();
    features.light_tree = lights.by == LightChoice::tree;
    const std::vector<bool> used = used_materials(scene);
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        features.panes |= used[i] && may_be_pane(scene.materials[i]);
    return features;
}

SceneFeatures all_features(const Scene& scene) {
    SceneFeatures features;
    features.kinds.needs = {0};
    for (const uint need : material_needs) features.kinds.needs[0] |= 1u << need;
    features.kinds.of.resize(scene.materials.size());
    features.environment = features.local_lights = features.light_tree = features.panes = features.deep_textures = true;
    return features;
}

DeviceScene::DeviceScene(Context& context, const Scene& scene, const LocalLights& lights,
                         const EnvironmentMap* environment, SceneFeatures features)
    : context_(context), features_(std::move(features)), data_(array_of<SceneData>(context, "path tracer scene", 1)) {
    submit_pass(context, "path tracer upload", [&](Commands& commands) {
        upload_all(commands, scene, lights, environment);
        fill_absent(context, record_);
        commands.write(data_, record_);
    });
}

void DeviceScene::move(const Scene& scene, const LocalLights& lights) {
    if (!lights.empty() && !features_.local_lights)
        fail("a surface or light starts to emit in a scene that has no emission at rest; this is not supported");
    context_.wait_for_gpu();
    moving_.clear();
    submit_pass(context_, "path tracer move", [&](Commands& commands) {
        record_.instances = upload_instances(commands, scene, lights);
        upload_lights(commands, lights);
        fill_absent(context_, record_);
        commands.write(data_, record_);
    });
}

void DeviceScene::upload_all(Commands& commands, const Scene& scene, const LocalLights& lights,
                             const EnvironmentMap* map) {
    TextureList textures;
    upload_meshes(commands, scene);
    record_.instances = upload_instances(commands, scene, lights);
    record_.materials = upload(commands, "materials", material_records(scene, textures));
    if (features_.has_layers())
        record_.layered = upload(commands, "layers of materials", layered_records(scene, textures));
    if (features_.kinds.needs.size() > 1)
        record_.material_kinds = upload(commands, "kinds of materials", features_.kinds.of);
    upload_textures(scene, textures);
    if (features_.environment)
        record_.environment = upload_environment(commands, map ? *map : EnvironmentMap(constant_sky(vec3(0))));
    upload_lights(commands, lights);
}

// If all lights have gone out, kernels that look for them find a key that names nothing.
void DeviceScene::upload_lights(Commands& commands, const LocalLights& lights) {
    const auto some_of = []<class T>(const std::vector<T>& values) {
        return values.empty() ? std::vector<T>(1) : values;
    };
    if (lights.by == LightChoice::tree && !features_.light_tree)
        fail("lights are in a tree, but the kernels of this scene choose lights from a table");
    light_choice_ = lights.by;
    if (features_.local_lights) {
        if (!lights_) lights_.emplace(context_);
        const std::vector<SetKey> keys = lights_->put(lights);
        record_.lights = lights_->view();
        record_.light_keys = upload(commands, "keys of lights", some_of(keys), &moving_);
        record_.light_table = upload(commands, "light table", some_of(lights.table), &moving_);
        record_.table_first = lights.table_first;
        record_.table_count = std::max(lights.table_count, 1u);
        record_.table_chance = lights.table_chance;
    }
    if (features_.light_tree)
        record_.light_tree = upload(commands, "light tree",
                                    lights.tree.nodes.empty() ? std::vector{dark_leaf()} : lights.tree.nodes, &moving_);
    const bool has_sky = record_.environment.density_per_luminance > 0;
    record_.environment.chance = has_sky ? 1.0f / static_cast<float>(1 + lights.kind_count()) : 0;
}

std::uint64_t DeviceScene::device_bytes() const {
    std::uint64_t bytes = data_.bytes();
    if (textures_) bytes += textures_->buffer_bytes();
    if (lights_) bytes += lights_->buffer_bytes();
    const auto add = [&](const std::vector<Buffer>& buffers) {
        for (const Buffer& buffer : buffers) bytes += buffer.bytes();
    };
    add(buffers_);
    add(moving_);
    for (const UploadedMesh& mesh : meshes_) add(mesh.movable);
    return bytes;
}

template <class T>
Ref<T> DeviceScene::upload(Commands& commands, const std::string& name, const std::vector<T>& values,
                           std::vector<Buffer>* kept) {
    Buffer buffer(context_, {.name = name, .bytes = values.size() * sizeof(T)});
    commands.upload(buffer, std::span(values));
    std::vector<Buffer>& buffers = kept ? *kept : buffers_;
    buffers.push_back(std::move(buffer));
    return buffers.back().ref<T>();
}

void DeviceScene::upload_meshes(Commands& commands, const Scene& scene) {
    for (const Mesh& mesh : scene.meshes) {
        UploadedMesh& uploaded = meshes_.emplace_back();
        SurfaceMesh& arrays = uploaded.arrays;
        const auto put = [&]<class T>(auto& array, const char* what, const std::vector<T>& values,
                                      std::vector<Buffer>* kept = nullptr) {
            if (!values.empty())
                array.address = upload(commands, text(what, " of '", mesh.name, "'"), values, kept).address;
        };
        put(arrays.packed.positions, "positions", mesh.positions, &uploaded.movable);
        put(arrays.packed.indices, "triangles", mesh.triangles);
        put(arrays.normals, "normals", unit_normals(mesh), &uploaded.movable);
        put(arrays.tangents, "tangents", unit_tangents(mesh), &uploaded.movable);
        put(arrays.uvs, "uvs", mesh.uvs);
        if (features_.some(PT_HAS_SECOND_UVS)) put(arrays.second_uvs, "second uvs", mesh.second_uvs);
        if (features_.some(PT_HAS_COLORS)) put(arrays.colors, "colors", mesh.colors);
        put(arrays.materials, "materials", mesh.materials);
    }
}

void DeviceScene::use_vertices(std::size_t mesh, const Deformer::Output& moved) {
    auto& [arrays, movable] = meshes_[mesh];
    std::ranges::move(movable, std::back_inserter(moving_));
    movable.clear();
    arrays.packed.positions = moved.positions.ref<float>();
    arrays.normals = moved.normals.ref<float>();
    arrays.tangents = {moved.tangents.address()};
}

Ref<SurfaceInstance> DeviceScene::upload_instances(Commands& commands, const Scene& scene, const LocalLights& lights) {
    std::vector<SurfaceMesh> meshes;
    for (const UploadedMesh& mesh : meshes_) {
        SurfaceMesh& arrays = meshes.emplace_back(mesh.arrays);
        context_.fill_absent(arrays.packed.positions, arrays.packed.indices, arrays.normals, arrays.uvs,
                             arrays.tangents, arrays.second_uvs, arrays.colors, arrays.materials);
    }
    const Ref<SurfaceMesh> uploaded = upload(commands, "surface meshes", meshes, &moving_);
    std::vector<SurfaceInstance> records;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        SurfaceInstance record = instance_record(scene.instances[i].transform);
        record.mesh = {uploaded.address + scene.instances[i].mesh * sizeof(SurfaceMesh)};
        record.emitter_density = upload(commands, "emitter densities", lights.densities[i], &moving_);
        if (features_.light_tree) record.emitter_ways = upload(commands, "ways to emitters", lights.ways[i], &moving_);
        context_.fill_absent(record.emitter_density, record.emitter_ways);
        records.push_back(record);
    }
    return upload(commands, "surface instances", records, &moving_);
}

// Uses buffers, which are filtered in float32 everywhere: a picture does not depend on the device's samplers.
void DeviceScene::upload_textures(const Scene& scene, const TextureList& list) {
    if (list.textures.empty() || !features_.some(PT_HAS_TEXTURES)) return;
    textures_.emplace(context_, "textures", TextureStorage::buffers);
    for (const SampledTexture& texture : list.textures) textures_->push(scene.images[texture.image], texture.options);
    textures_->sync();
    record_.textures = textures_->view();
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
            1.0f};
}

}  // namespace twinray::path_tracer
