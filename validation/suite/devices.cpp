// SPDX-License-Identifier: MIT
#include "validation/suite/devices.h"

#include <algorithm>
#include <iostream>

#include "engine/core/error.h"
#include <twinray/tlas.h>

namespace twinray::suite {

Devices::Devices(ContextDesc desc, const AccelOptions& trees) : desc_(std::move(desc)), trees_(trees) {
    desc_.log = [this, log = desc_.log, also = desc_.validation](std::string_view message) {
        warnings_.emplace_back(message);
        if (also) log ? log(message) : static_cast<void>(std::cerr << "twinray: " << message << '\n');
    };
    context_ = std::make_unique<Context>(desc_);
}

Devices::~Devices() = default;

Context& Devices::context(Backend backend) {
    if (backend != Backend::pipeline) return *context_;
    if (!pipeline_context_) {
        ContextDesc desc = desc_;
        desc.use_ray_query = false;
        pipeline_context_ = std::make_unique<Context>(desc);
    }
    return *pipeline_context_;
}

std::string Devices::why_not(const Subject& subject) {
    const DeviceFacts& facts = context_->facts();
    if (subject.backend == Backend::ray_query && !facts.ray_query) return "the device has no ray queries";
    if (subject.backend == Backend::pipeline && !facts.ray_tracing_pipeline)
        return "the device has no ray tracing pipelines";
    const Feature level = feature_of(subject.level);
    const DeviceFacts& seen = context(subject.backend).facts();
    const Capability able =
        is_ours(subject.backend) ? SwTlas::capability_on(seen, level) : HwTlas::capability_on(seen, level);
    return able.support == Support::unsupported ? text(name_of(level), " is unsupported: ", able.note) : "";
}

Level Devices::level_to_make(const Subject& subject) { return std::max(subject.level, Level::watertight); }

std::unique_ptr<AbstractAccel> Devices::make_accel(const Subject& subject, Layout layout) {
    const AccelOptions options{level_to_make(subject), layout, trees_.build_quality};
    Context& where = context(subject.backend);
    if (is_ours(subject.backend)) return std::make_unique<SwTlas>(where, options);
    return std::make_unique<HwTlas>(where, BuildOrder::automatic, options);
}

AbstractAccel& Devices::empty_accel(const Subject& subject, Layout layout) {
    std::unique_ptr<AbstractAccel>& accel = accels_[{subject.backend, level_to_make(subject), layout}];
    if (!accel) accel = make_accel(subject, layout);
    for (const AccelHandle handle : accel->handles()) accel->erase(handle);
    return *accel;
}

const CrossingCounter& Devices::crossing_counter(const Subject& subject) {
    std::unique_ptr<CrossingCounter>& counter = counters_[{subject.backend, subject.level}];
    if (!counter) counter = std::make_unique<CrossingCounter>(context(subject.backend), subject);
    return *counter;
}

void Devices::drop_accels() { accels_.clear(); }

}  // namespace twinray::suite
