#include "report/frame/devices.h"

#include <algorithm>
#include <iostream>

#include "engine/core/error.h"
#include <twinray/tlas.h>

namespace twinray::frame {

std::string_view name_of(Backend backend) {
    constexpr std::array<std::string_view, 3> names = {"sw", "hw", "hw-pipeline"};
    return names[static_cast<std::size_t>(backend)];
}

Devices::Devices(ContextDesc desc, const AccelOptions& trees) : desc_(std::move(desc)), trees_(trees) {
    desc_.log = [this, log = desc_.log, also = desc_.validation](std::string_view message) {
        warnings_.emplace_back(message);
        if (also) log ? log(message) : static_cast<void>(std::cerr << "twinray: " << message << '\n');
    };
    context_ = std::make_unique<Context>(desc_);
}

Context& Devices::context(Backend backend) {
    if (backend != Backend::pipeline) return *context_;
    if (!pipeline_context_) pipeline_context_ = std::make_unique<Context>(desc(backend));
    return *pipeline_context_;
}

ContextDesc Devices::desc(Backend backend) const {
    ContextDesc desc = desc_;
    if (backend == Backend::pipeline) desc.use_ray_query = false;
    return desc;
}

std::string Devices::why_not(const Configuration& configuration) {
    const DeviceProperties& properties = context_->properties();
    if (configuration.backend == Backend::ray_query && !properties.ray_query) return "the device has no ray queries";
    if (configuration.backend == Backend::pipeline && !properties.ray_tracing_pipeline)
        return "the device has no ray tracing pipelines";
    const Feature level = feature_of(configuration.level);
    const DeviceProperties& seen = context(configuration.backend).properties();
    const Capability able =
        is_ours(configuration.backend) ? SwTlas::capability_on(seen, level) : HwTlas::capability_on(seen, level);
    return able.support == Support::unsupported ? text(name_of(level), " is unsupported: ", able.note) : "";
}

Level Devices::level_to_make(const Configuration& configuration) {
    return std::max(configuration.level, Level::watertight);
}

AccelOptions Devices::options(const Configuration& configuration, std::optional<Layout> layout) const {
    return {level_to_make(configuration), layout.value_or(trees_.layout), trees_.build_quality};
}

std::unique_ptr<AbstractAccel> Devices::make_accel(const Configuration& configuration, std::optional<Layout> layout) {
    return make_accel(context(configuration.backend), configuration.backend, options(configuration, layout));
}

std::unique_ptr<AbstractAccel> Devices::make_accel(Context& context, Backend backend, const AccelOptions& options) {
    return twinray::make_accel(context, {is_ours(backend), ""}, options);
}

AbstractAccel& Devices::empty_accel(const Configuration& configuration, std::optional<Layout> layout) {
    std::unique_ptr<AbstractAccel>& accel =
        accels_[{configuration.backend, level_to_make(configuration), layout.value_or(trees_.layout)}];
    if (!accel) accel = make_accel(configuration, layout);
    for (const AccelHandle handle : accel->handles()) accel->erase(handle);
    return *accel;
}

const CrossingCounter& Devices::crossing_counter(const Configuration& configuration) {
    std::unique_ptr<CrossingCounter>& counter = counters_[{configuration.backend, configuration.level}];
    if (!counter)
        counter = std::make_unique<CrossingCounter>(context(configuration.backend), is_ours(configuration.backend),
                                                    configuration.level);
    return *counter;
}

}  // namespace twinray::frame
