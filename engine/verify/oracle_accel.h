// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>

#include "engine/accel/abstract_accel.h"
#include "engine/verify/oracle.h"

namespace twinray {
#include "engine/core/bridge_begin.h"
#include "shaders/verify/copy_items.h"
#include "engine/core/bridge_end.h"

// The float64 referee behind the interface of the accelerators: it shows what each call of AbstractAccel means, and is
// the third to be compared. The host answers, while a trace is recorded, from what the last sync left on the device. So
// that sync, the rays and the indirect count must be submitted before trace() is called (they need not be done), which
// waits for them; Error if the sync is not. The hits are written when the commands run, as ever. It runs no GPU code,
// and so meets neither boxes nor filters.
class OracleAccel final : public AbstractAccel {
  public:
    explicit OracleAccel(Context& context);

    Capability capability(Feature feature) const override;
    bool is_software() const override { return true; }

  private:
    struct OracleGeometry;
    struct OracleScene;
    class OracleProgram;
    std::vector<std::unique_ptr<BuiltGeometry>> build_geometries(Commands& commands,
                                                                 std::span<const GeometryInput> inputs) override;
    std::vector<std::unique_ptr<BuiltGeometry>> refit_geometries(Commands& commands,
                                                                 std::span<const GeometryInput> inputs) override;
    BuildBytes geometry_bytes(std::span<const GeometrySize>) const override { return {}; }
    BuildBytes scene_bytes(std::size_t count, std::size_t capacity) const override;
    bool works_on_device() const override { return false; }
    std::unique_ptr<BuiltScene> build_scene(Commands& commands, const SceneInput& input,
                                            const BuiltScene* current) override;
    void refit_scene(Commands& commands, const SceneInput& input, const BuiltScene& current) override;
    std::unique_ptr<TraceProgram> create_program(const TraceProgramCode* code, uint features) const override;
    std::vector<Hit> trace_host(std::span<const Ray> rays, TraceDesc desc) override;

    template <class T>
    void record_copy(Commands& commands, Ref<T> from, Ref<T> to, std::size_t count) const;
    template <class T>
    Buffer read(Ref<T> from, std::size_t count) const;
    Oracle oracle() const;
    void record_trace(Commands& commands, const TraceArgs& args) const;

    Kernel<CopyItemsArgs> copy_items_;
    // By the address of the block that instances point at; ends with the geometry it names.
    std::map<std::uint64_t, std::weak_ptr<const Geometry64>> geometries_;
};

// The float nearest to t inside the ray's open interval; nothing where float32 has none.
std::optional<float> reported_t(double t, const Ray& ray);

}  // namespace twinray
