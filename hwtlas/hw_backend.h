// SPDX-License-Identifier: MIT
// What is behind HwTlas: structures that the driver builds.
#pragma once

#include <twinray/tlas.h>

#include "engine/accel/accel_backend.h"
#include "hwtlas/tlas.h"

namespace twinray {

class MovingBlasBuilder;
struct MovingMesh;

class HwBackend final : public AccelBackend {
  public:
    HwBackend(Context& context, BuildOrder order, const AccelOptions& options);
    ~HwBackend() override;

    Capability capability(Feature feature) const override {
        return HwTlas::capability_on(context().properties(), feature);
    }
    bool is_software() const override { return false; }
    bool reorders() const override { return reorder_; }

  private:
    using Built = std::vector<std::unique_ptr<BuiltGeometry>>;
    Built build_geometries(Commands& commands, std::span<const GeometryInput> inputs) override;
    Built refit_geometries(Commands& commands, std::span<const GeometryInput> inputs) override;
    BuildBytes geometry_bytes(std::span<const GeometrySize> geometries) const override;
    BuildBytes scene_bytes(std::size_t count, std::size_t capacity) const override;
    bool has_compaction(const BuiltGeometry& built) const override;
    Compaction compaction_of(const BuiltGeometry& built, SyncPoint done) const override;
    Built compact_geometries(Commands& commands, std::span<const GeometryInput> inputs) override;
    std::unique_ptr<BuiltTlas> build_tlas(Commands& commands, const TlasInput& input,
                                          const BuiltTlas* current) override;
    void refit_tlas(Commands& commands, const TlasInput& input, const BuiltTlas& current) override;
    void measure_tlas(Commands& commands, const TlasInput& input, const BuiltTlas& current) const override;
    std::unique_ptr<TraceProgram> create_program(const TraceProgramCode* code, uint features) const override;

    struct HwBuiltGeometry;
    struct HwTopLevel;
    void build_still(Commands& commands, std::span<const GeometryInput> inputs, Built& built);
    twinray::TlasInput builder_input(const TlasInput& input) const;
    MovingMesh prepare_moving(const GeometryInput& input, std::unique_ptr<BuiltGeometry>& built) const;

    bool reorder_;
    std::unique_ptr<MovingBlasBuilder> moving_;
    TlasBuilder tlas_builder_;
};

}  // namespace twinray
