// SPDX-License-Identifier: MIT
// The hardware accelerator, on VK_KHR_acceleration_structure.
#pragma once

#include "engine/accel/abstract_accel.h"
#include "hwtlas/tlas.h"

namespace twinray {

class MovingBlasBuilder;
struct MovingMesh;

// The order in which triangles and instances go to the driver. Results do not depend on it.
enum class BuildOrder : std::uint8_t {
    automatic,  // morton where KernelTuning::builds_in_input_order, else input
    input,      // as pushed; no table to map ids back exists then
    morton,
};

// The accelerator on VK_KHR_acceleration_structure. Traces with ray queries where they are enabled, else with a ray
// tracing pipeline. Where the driver finds two triangles at the same distance, the driver chooses.
class HwTlas : public AbstractAccel {
  public:
    // Throws Error naming the device and what it lacks.
    explicit HwTlas(Context& context, BuildOrder order = BuildOrder::automatic, const AccelOptions& options = {});
    ~HwTlas() override;

    // What the hardware accelerator can do on a device that it runs on.
    static Capability capability_on(const DeviceFacts& device, Feature feature);
    Capability capability(Feature feature) const override { return capability_on(context().facts(), feature); }
    bool is_software() const override { return false; }

    // "ray query" or "ray tracing pipeline".
    const char* trace_path() const;
    bool reorders() const override { return reorder_; }

  protected:
    using Built = std::vector<std::unique_ptr<BuiltGeometry>>;
    Built build_geometries(Commands& commands, std::span<const GeometryInput> inputs) override;
    Built refit_geometries(Commands& commands, std::span<const GeometryInput> inputs) override;
    BuildBytes geometry_bytes(std::span<const GeometrySize> geometries) const override;
    BuildBytes scene_bytes(std::size_t count, std::size_t capacity) const override;
    bool can_compact(const BuiltGeometry& built, SyncPoint done) const override;
    Built compact_geometries(Commands& commands, std::span<const GeometryInput> inputs) override;
    std::unique_ptr<BuiltScene> build_scene(Commands& commands, const SceneInput& input,
                                            const BuiltScene* current) override;
    void refit_scene(Commands& commands, const SceneInput& input, const BuiltScene& current) override;
    std::unique_ptr<TraceProgram> create_program(const TraceProgramCode* code, uint features) const override;

  private:
    struct HwBuiltGeometry;
    struct HwTopLevel;
    void build_still(Commands& commands, std::span<const GeometryInput> inputs, Built& built);
    MovingMesh prepare_moving(const GeometryInput& input, std::unique_ptr<BuiltGeometry>& built) const;

    bool reorder_;
    std::unique_ptr<MovingBlasBuilder> moving_;
    TlasBuilder tlas_builder_;
};

}  // namespace twinray
