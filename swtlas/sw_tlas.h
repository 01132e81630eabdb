// SPDX-License-Identifier: MIT
#pragma once

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
    std::vector<std::unique_ptr<BuiltGeometry>> build_geometries(Commands& commands,
                                                                 std::span<const GeometryInput> inputs) override;
    std::vector<std::unique_ptr<BuiltGeometry>> refit_geometries(Commands& commands,
                                                                 std::span<const GeometryInput> inputs) override;
    static std::vector<uint> triangle_counts(std::span<const GeometryInput> inputs);
    static std::vector<Builder::Measured> measured(std::span<const GeometryInput> inputs);
    std::vector<DeviceMesh> record_meshes(Commands& commands, std::span<const GeometryInput> inputs);
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
