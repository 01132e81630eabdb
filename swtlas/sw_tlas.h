// SPDX-License-Identifier: MIT
// The software accelerator: trees that compute shaders build and traverse.
#pragma once

#include <filesystem>
#include <functional>

#include "engine/accel/abstract_accel.h"
#include "swtlas/build.h"
#include "swtlas/plan.h"

namespace twinray {

struct SavedGeometry;

// The software accelerator: a two-level BVH built and traversed by compute shaders. Needs no ray tracing extension.
class SwTlas final : public AbstractAccel {
  public:
    explicit SwTlas(Context& context, const AccelOptions& options = {});

    // What the software accelerator can do on a device that it runs on.
    static Capability capability_on(const DeviceFacts& device, Feature feature);
    Capability capability(Feature feature) const override { return capability_on(context().facts(), feature); }
    bool is_software() const override { return true; }

    // Writes the built geometries and their instances. Throws Error when edits are pending and when the file cannot be
    // written, which is then as it was before.
    void save(const std::filesystem::path& file) const;
    struct Loaded {
        std::unique_ptr<SwTlas> accel;
        std::vector<AccelHandle> handles;  // in the order in which they were pushed
    };
    // A new accelerator with what save() has written. Its first sync() builds the top level alone; closest hits
    // are equal to the last bit, any hits too unless the saved top level had been refitted. Throws Error naming the
    // file, what was found and what was expected when it is missing, damaged, of another format version, or not a saved
    // SwTlas.
    static Loaded load(Context& context, const std::filesystem::path& file);

    // For checks and tools: copies of the built trees, downloaded. Throws Error on a dead or unsynced handle.
    struct Tree {
        Bvh bvh;
        std::vector<BvhNode> nodes;             // of layout bvh2
        std::vector<BvhTriangle> triangles;     // of a geometry in layout bvh2
        std::vector<CompressedRecord> records;  // of all other layouts
    };
    Tree download_geometry(AccelHandle handle) const;
    Tree download_scene() const;

  private:
    struct SwBuiltGeometry;
    struct SwBuiltScene;
    AccelHandle push_saved(Commands& commands, SavedGeometry&& saved);
    struct Batch;
    using Built = std::vector<std::unique_ptr<BuiltGeometry>>;
    Built build_geometries(Commands& commands, std::span<const GeometryInput> inputs) override;
    Built refit_geometries(Commands& commands, std::span<const GeometryInput> inputs) override;
    BuildBytes geometry_bytes(std::span<const GeometrySize> geometries) const override;
    BuildBytes scene_bytes(std::size_t count, std::size_t capacity) const override;
    static std::uint64_t source_bytes(const GeometryInput& input);
    static std::vector<Builder::Measured> measured(const Batch& batch, std::span<const BuildTree> trees);
    void record_batches(Commands& commands, std::span<const GeometryInput> inputs,
                        const std::function<void(const Batch&, const Buffer& scratch)>& record);
    void record_build(Commands& commands, const Batch& batch, const Buffer& scratch, Built& built);
    static std::vector<DeviceMesh> record_meshes(Commands& commands, const Batch& batch, const Buffer& scratch);
    std::unique_ptr<BuiltScene> build_scene(Commands& commands, const SceneInput& input,
                                            const BuiltScene* current) override;
    void refit_scene(Commands& commands, const SceneInput& input, const BuiltScene& current) override;
    float unit_of(std::span<const vec3> positions) const override { return software_unit(positions); }
    std::unique_ptr<TraceProgram> create_program(const TraceProgramCode* code, uint features) const override;

    Builder builder_;
};

}  // namespace twinray
