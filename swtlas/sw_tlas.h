// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "engine/accel/abstract_accel.h"
#include "swtlas/build.h"

namespace twinray {

// The software accelerator: a two-level BVH built and traversed by compute shaders. Needs no ray tracing extension.
class SwTlas final : public AbstractAccel {
  public:
    explicit SwTlas(Context& context);

    // For checks and tools: copies of the built trees, downloaded. Throws Error on a dead or unsynced handle.
    struct Tree {
        Bvh bvh;
        std::vector<BvhNode> nodes;
        std::vector<BvhTriangle> triangles;  // of a geometry; empty for the scene
    };
    Tree download_geometry(AccelHandle handle) const;
    Tree download_scene() const;

  private:
    struct SwBuiltGeometry;
    struct SwBuiltScene;
    struct Batch;
    using Built = std::vector<std::unique_ptr<BuiltGeometry>>;
    Built build_geometries(Commands& commands, std::span<const GeometryInput> inputs) override;
    Built refit_geometries(Commands& commands, std::span<const GeometryInput> inputs) override;
    static std::uint64_t source_bytes(const GeometryInput& input);
    static std::vector<Builder::Measured> measured(std::span<const GeometryInput> inputs);
    void record_batches(Commands& commands, std::span<const GeometryInput> inputs,
                        const std::function<void(const Batch&, const Buffer& scratch)>& record);
    void record_build(Commands& commands, const Batch& batch, const Buffer& scratch, Built& built);
    static std::vector<DeviceMesh> record_meshes(Commands& commands, const Batch& batch, const Buffer& scratch);
    std::unique_ptr<SwBuiltGeometry> make_geometry(const Geometry& geometry);
    std::unique_ptr<BuiltScene> build_scene(Commands& commands, const SceneInput& input,
                                            const BuiltScene* current) override;
    void refit_scene(Commands& commands, const SceneInput& input, const BuiltScene& current) override;
    void record_trace(Commands& commands, const TraceDesc& desc, std::uint64_t scene) const override;

    Builder builder_;
    Kernel<SwTraceArgs> trace_closest_;
    Kernel<SwTraceArgs> trace_any_;
};

}  // namespace twinray
