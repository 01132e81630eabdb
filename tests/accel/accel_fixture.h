// A fixture that runs a test over every accelerator: the software one, the hardware one through each way of tracing,
// and the reference.
#pragma once

#include <tuple>

#include "engine/core/vulkan.h"
#include "validation/reference/classify.h"
#include "validation/reference/reference_accel.h"
#include <twinray/tlas.h>
#include "tests/support/device.h"

namespace twinray::test {

enum class Kind { software, ray_query, pipeline, reference };

inline std::string name_of_kind(const ::testing::TestParamInfo<Kind>& info) {
    switch (info.param) {
        case Kind::software: return "Software";
        case Kind::ray_query: return "RayQuery";
        case Kind::pipeline: return "Pipeline";
        case Kind::reference: return "ReferenceScene";
    }
    return "";
}

inline const auto every_way = ::testing::Values(Kind::software, Kind::ray_query, Kind::pipeline);
inline const auto every_kind = ::testing::Values(Kind::software, Kind::ray_query, Kind::pipeline, Kind::reference);

// Adds the ways of tracing to what a context is made of.
inline ContextDesc desc_of(Kind kind, ContextDesc desc = {}) {
    desc.use_ray_query = kind == Kind::ray_query;
    desc.use_ray_tracing_pipeline = kind == Kind::pipeline;
    return desc;
}
inline std::unique_ptr<AbstractAccel> make_accel(Context& context, Kind kind, const AccelOptions& options) {
    if (kind == Kind::reference) return std::make_unique<ReferenceAccel>(context);
    if (kind == Kind::software) return std::make_unique<SwTlas>(context, options);
    return std::make_unique<HwTlas>(context, BuildOrder::automatic, options);
}
// Returns whether SwTlas, or HwTlas, has the level on this device.
inline bool has_level(const Context& context, Level level, bool is_software = true) {
    const auto capability_on = is_software ? SwTlas::capability_on : HwTlas::capability_on;
    return capability_on(context.properties(), feature_of(level)).support != Support::unsupported;
}

// Traces the rays in commands of their own. Hits that no trace writes are `before`.
inline std::vector<Hit> traced(AbstractAccel& accel, const AccelView& view, std::span<const Ray> rays,
                               TraceDesc desc = {}, const Hit& before = {}) {
    Context& context = accel.context();
    const Buffer source = device_copy(context, rays),
                 hits = device_copy(context, std::vector<Hit>(rays.size(), before));
    desc.rays = source.ref<Ray>();
    desc.hits = hits.ref<Hit>();
    desc.count = rays.size();
    Commands commands(context, "trace");
    accel.trace(commands, view, desc);
    commands.submit();
    return download<Hit>(context, hits, rays.size());
}

class AccelTest : public VulkanTest, public ::testing::WithParamInterface<Kind> {
  protected:
    ContextDesc context_desc() const override { return desc_of(GetParam()); }
    void prepare() override {
        if (!is_ours() && !missing_for_hardware(context().properties()).empty())
            TWINRAY_LACKS("ray_tracing", context().properties().name + " has no such ray tracing");
        if (!has_level(accel_options().level))
            TWINRAY_LACKS("float64", context().properties().name + " lacks what this level needs");
        accel_ = make_accel();
    }
    void TearDown() override {
        accel_.reset();
        VulkanTest::TearDown();
    }

    // Returns whether the accelerator is ours, not the driver's: ours keeps every rule to the letter.
    bool is_ours() const { return GetParam() == Kind::software || GetParam() == Kind::reference; }
    // Returns whether costs are those of trees, not those of the input's order, which a driver builds from as it likes.
    bool measures_its_trees() const { return is_ours() || context().state().tuning().builds_in_input_order; }
    // Returns the smallest scale of a whole scene. A GPU's driver may invert instances' maps by a determinant in
    // float32 (docs/requirements.md).
    float smallest_scale() const {
        return is_ours() || context().state().tuning().row == TuningRow::cpu_driver ? 1e-18f : 1e-12f;
    }
    // Returns whether the accelerator has the level on this device; the reference has all levels on any device.
    bool has_level(Level level) const {
        return GetParam() == Kind::reference || test::has_level(context(), level, is_ours());
    }
    // Programs that no test waits for are not compiled.
    virtual AccelOptions accel_options() const { return {.compiles_in_background = false}; }
    std::unique_ptr<AbstractAccel> make_accel() { return make_accel(accel_options()); }
    std::unique_ptr<AbstractAccel> make_accel(const AccelOptions& options) {
        return test::make_accel(context(), GetParam(), options);
    }
    AbstractAccel& accel() { return *accel_; }
    void drop_accel() { accel_.reset(); }
    Hit closest(const Ray& ray) { return accel().closest_hits(std::span(&ray, 1)).front(); }
    Hit any(const Ray& ray) { return accel().any_hits(std::span(&ray, 1)).front(); }

    // Writes as a kernel would, `offset` bytes behind the start of a handle's instances.
    template <class T>
    void write_instances(const InstanceRange& range, std::uint64_t offset, const T& value) {
        submit_pass(context(), "write", [&](Commands& commands) {
            context().state().vk().vkCmdUpdateBuffer(commands.handle(), range.buffer, range.offset + offset,
                                                     sizeof value, &value);
        });
    }

    // Returns the classes of the hits that this accelerator found.
    HitClassCounts classes_of(const ReferenceScene& reference, std::span<const Ray> rays, std::span<const Hit> hits) {
        const std::span<const Hit> none;
        HitClassCounts classes;
        for (const RayResult& result :
             is_ours() ? classify_all(reference, rays, hits, none) : classify_all(reference, rays, none, hits))
            classes.add(is_ours() ? *result.software : *result.hardware);
        return classes;
    }

    // Traces the ray through this view.
    Hit trace(const AccelView& view, const Ray& ray) { return traced(accel(), view, {&ray, 1}).front(); }

  private:
    std::unique_ptr<AbstractAccel> accel_;
};

// SwTlas in each layout, at each level.
using LayoutAndLevel = std::tuple<Layout, Level>;
inline std::string name_of_layout_and_level(const ::testing::TestParamInfo<LayoutAndLevel>& info) {
    return text(name_of(std::get<Layout>(info.param)), '_', name_of(std::get<Level>(info.param)));
}
inline const auto every_level = ::testing::ValuesIn(all_levels);

// The unit square at height z, facing up; rays go down onto it.
inline Mesh square(float z) { return make_quad(vec3(0, 0, z), vec3(1, 0, 0), vec3(0, 1, 0)); }
inline Ray down(float x, float y) { return {vec3(x, y, 10), 0, vec3(0, 0, -1), INFINITY}; }

}  // namespace twinray::test

#define TWINRAY_OVER_EVERY_ACCEL(Fixture) \
    INSTANTIATE_TEST_SUITE_P(Every, Fixture, ::twinray::test::every_way, ::twinray::test::name_of_kind)

// Instantiates tests of the contract, which the reference keeps as well.
#define TWINRAY_OVER_EVERY_ACCEL_AND_THE_REFERENCE(Fixture) \
    INSTANTIATE_TEST_SUITE_P(Every, Fixture, ::twinray::test::every_kind, ::twinray::test::name_of_kind)
