// A scene in device memory, as kernels read it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <twinray/commands.h>
#include "renderer/environment.h"
#include "renderer/lights.h"
#include "renderer/material_kinds.h"
#include "renderer/surface_records.h"

namespace twinray::path_tracer {

template <class T>
Buffer array_of(Context& context, const char* name, std::uint64_t count) {
    return Buffer(context, {.name = name, .bytes = count * sizeof(T)});
}

// Submits what `record` records into one pass.
template <class Record>
void submit_pass(Context& context, const char* name, const Record& record) {
    Commands commands(context, name);
    {
        const auto pass = commands.pass(name);
        record(commands);
    }
    commands.submit();
}

// The kernels' features that a scene needs; the rest is compiled out.
struct SceneFeatures {
    MaterialKinds kinds;
    bool environment = false;
    bool local_lights = false;
    bool light_tree = false;
    bool panes = false;
    bool deep_textures = false;  // of 16 bits a channel

    // Returns whether some material needs it; need: PT_HAS_ALPHA and the like.
    bool some(uint need) const { return kinds.all_needs() >> need & 1; }
    // Returns whether shadow rays pass any surface.
    bool passes_shadows() const { return panes || some(PT_HAS_ALPHA); }
    bool has_layers() const {
        return some(PT_HAS_SPECULAR) || some(PT_HAS_COAT) || some(PT_HAS_SHEEN) || some(PT_HAS_ANISOTROPY) ||
               some(PT_HAS_VOLUME);
    }
};
SceneFeatures features_of(const Scene& scene, const LocalLights& lights, const EnvironmentMap* environment);
// Has one kind of material with everything, under an environment: to measure what leaving out saves.
SceneFeatures all_features(const Scene& scene);

// A scene in device memory as the kernels read it. Instances keep their index.
class DeviceScene {
  public:
    // environment: null for black. features: at least what the scene needs. Returns before the upload is done; later
    // submissions see it.
    DeviceScene(Context& context, const Scene& scene, const LocalLights& lights, const EnvironmentMap* environment,
                SceneFeatures features);
    // Uses the features that the scene needs.
    DeviceScene(Context& context, const Scene& scene, const LocalLights& lights, const EnvironmentMap* environment)
        : DeviceScene(context, scene, lights, environment, features_of(scene, lights, environment)) {}

    // Takes over the current positions of the scene's instances and lights. Waits for the device. Throws Error if there
    // are lights now and were none when this was made: the kernels cannot find them.
    void move(const Scene& scene, const LocalLights& lights);
    // Reads a mesh's vertices there from the next move() on, which frees its own. The memory must outlive this.
    void use_vertices(std::size_t mesh, const Deformer::Output& moved);
    // Returns the mesh's indices, 3 per triangle.
    Uints indices(std::size_t mesh) const { return meshes_[mesh].arrays.packed.indices; }

    Ref<SceneData> data() const { return data_.ref<SceneData>(); }
    const SceneFeatures& features() const { return features_; }
    LightChoice light_choice() const { return light_choice_; }
    std::uint64_t device_bytes() const;

  private:
    // The buffer goes into `kept`; null: into buffers_.
    template <class T>
    Ref<T> upload(Commands& commands, const std::string& name, const std::vector<T>& values,
                  std::vector<Buffer>* kept = nullptr);
    void upload_meshes(Commands& commands, const Scene& scene);
    Ref<SurfaceInstance> upload_instances(Commands& commands, const Scene& scene, const LocalLights& lights);
    void upload_lights(Commands& commands, const LocalLights& lights);
    void upload_textures(const Scene& scene, const TextureList& list);
    Environment upload_environment(Commands& commands, const EnvironmentMap& map);
    void upload_all(Commands& commands, const Scene& scene, const LocalLights& lights, const EnvironmentMap* map);

    struct UploadedMesh {
        SurfaceMesh arrays;
        std::vector<Buffer> movable;  // positions, normals and tangents
    };
    Context& context_;
    SceneFeatures features_;
    LightChoice light_choice_ = LightChoice::table;  // of the lights that it has
    std::vector<Buffer> buffers_, moving_;           // the first stay, move() replaces the others
    std::vector<UploadedMesh> meshes_;
    std::optional<LightSet> lights_;        // none: no need for any
    std::optional<TextureStore> textures_;  // none: no material has any
    SceneData record_{};
    Buffer data_;  // of record_
};

}  // namespace twinray::path_tracer
