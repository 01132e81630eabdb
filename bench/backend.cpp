#include "bench/backend.h"

#include <algorithm>

#include <twinray/tlas.h>

#include "engine/core/error.h"
#include "engine/core/commands.h"

namespace twinray::bench {
namespace {

bool is_named(const std::string& name, const std::vector<std::string>& only) {
    return only.empty() ||
           std::ranges::any_of(only, [&](const std::string& part) { return name.find(part) != std::string::npos; });
}

// One of twinray's accelerators. Its times are those of the GPU's passes.
class AccelBackend : public Backend {
  public:
    using Make = std::function<std::unique_ptr<AbstractAccel>()>;
    AccelBackend(Labels labels, Level level, RayOrder order, Make make)
        : Backend(std::move(labels)), level_(level), order_(order), make_(std::move(make)) {}

    BuildFigures build(const Scene& scene) override {
        accel_.reset();
        accel_ = make_();
        accel_->wait_for_gpu();
        const Stopwatch watch;
        push_scene(*accel_, scene);
        const std::uint64_t scratch_bytes = accel_->memory_requirements().scratch;
        accel_->sync();
        accel_->wait_for_gpu();
        const double wall_ms = watch.ms();
        return {total_ms(accel_->build_timings(), watch), wall_ms, accel_->memory_usage().structures(), scratch_bytes};
    }
    double trace(const RayBatch& batch) override {
        return trace_ms(*accel_, "bench", batch,
                        {.level = level_, .occlusion_only = batch.query() == Query::any, .order = order_});
    }
    std::vector<Hit> hits(const RayBatch& batch) const override { return download_hits(*accel_, batch); }

  private:
    Level level_;
    RayOrder order_;
    Make make_;
    std::unique_ptr<AbstractAccel> accel_;
};

class LineUpFactory {
  public:
    explicit LineUpFactory(const LineUpOptions& options) : options_(options) {}

    void add_software(Context& context, const AccelOptions& accel) {
        const std::string layout(twinray::name_of(accel.layout)), quality(twinray::name_of(accel.build_quality));
        const std::string built = accel.build_quality == BuildQuality::fast ? layout : text(layout, ' ', quality);
        add({.name = text("sw ", built, ' ', name_of(accel.level)),
             .backend = "sw",
             .path = "compute",
             .layout = layout,
             .builder = quality,
             .level = std::string(name_of(accel.level))},
            accel.level, [&context, accel] { return std::make_unique<SwTlas>(context, accel); });
    }

    // Adds everything that the device can do, from the first level on.
    void add_hardware(Context& context) {
        if (!missing_for_hardware(context.properties()).empty()) return;
        for (const Level level : options_.levels) add_hardware(context, BuildOrder::automatic, level);
        if (context.state().tuning().builds_in_input_order && context.properties().ray_query)
            add_hardware(context, BuildOrder::input, options_.levels.front());
    }

    void add_hardware(Context& context, BuildOrder order, Level level) {
        if (HwTlas::capability_on(context.properties(), feature_of(level)).support == Support::unsupported) return;
        const HwTlas probe(context, order);
        const char* path = context.properties().ray_query ? "query" : "pipeline";
        add({.name = order == BuildOrder::input ? "hw query input order" : text("hw ", path, ' ', name_of(level)),
             .backend = "hw",
             .path = probe.trace_path(),
             .order = probe.reorders() ? "sorted" : "input",
             .layout = "driver",
             .builder = "driver",
             .level = std::string(name_of(level))},
            level, [&context, order, level] { return std::make_unique<HwTlas>(context, order, AccelOptions{level}); });
    }

    LineUp line_up;

  private:
    void add(const Labels& labels, Level level, const AccelBackend::Make& make) {
        for (const RayOrder order : options_.ray_orders) {
            Labels ordered = labels;
            ordered.ray_order = twinray::name_of(order);
            if (order == RayOrder::sorted) ordered.name += " sorted";
            if (is_named(ordered.name, options_.only))
                line_up.push_back(std::make_unique<AccelBackend>(std::move(ordered), level, order, make));
        }
    }

    const LineUpOptions& options_;
};

bool is(Baseline baseline, const Labels& labels) {
    switch (baseline) {
        case Baseline::sorted_query: return labels.path == "ray query" && labels.order == "sorted";
        case Baseline::input_query: return labels.path == "ray query" && labels.order == "input";
        case Baseline::pipeline: return labels.path == "ray tracing pipeline";
        case Baseline::embree8: return labels.name == "embree8";
        case Baseline::software: return labels.backend == "sw";
    }
    return false;
}

}  // namespace

const RayBatch::DeviceBuffers& RayBatch::on(Context& context) const {
    const auto found = on_devices_.find(&context);
    if (found != on_devices_.end()) return found->second;
    DeviceBuffers buffers{uploaded(context, "bench rays", rays()),
                          Buffer(context, {.name = "bench hits", .bytes = rays_.size() * sizeof(Hit)})};
    context.wait_for_gpu();
    return on_devices_.emplace(&context, std::move(buffers)).first->second;
}

double total_ms(const std::vector<PassTiming>& timings, const Stopwatch& watch) {
    if (timings.empty()) return watch.ms();
    double sum = 0;
    for (const PassTiming& timing : timings) sum += timing.ms;
    return sum;
}

double trace_ms(AbstractAccel& accel, const std::string& name, const RayBatch& batch, TraceDesc desc) {
    const auto& [rays, hits] = batch.on(accel.context());
    desc.rays = rays.ref<Ray>();
    desc.hits = hits.ref<Hit>();
    desc.count = batch.rays().size();
    desc.query = batch.query();
    Commands commands(accel.context(), name);
    accel.trace(commands, accel.view(), desc);
    const Stopwatch watch;
    commands.submit();
    accel.wait_for_gpu();
    return total_ms(commands.timings(), watch);
}

std::vector<Hit> download_hits(AbstractAccel& accel, const RayBatch& batch) {
    return download<Hit>(accel.context(), batch.on(accel.context()).hits, batch.rays().size());
}

double sync_ms(AbstractAccel& accel) {
    const Stopwatch watch;
    accel.sync();
    accel.wait_for_gpu();
    return total_ms(accel.build_timings(), watch);
}

LineUp make_line_up(Context& context, Context* pipeline, const LineUpOptions& options) {
    LineUpFactory factory(options);
    for (const Layout layout : options.layouts)
        for (const BuildQuality quality : options.build_qualities)
            for (const Level level : options.levels)
                factory.add_software(context,
                                     {.level = level, .layout = layout, .build_quality = quality, .can_move = false});
    factory.add_hardware(context);
    if (pipeline) factory.add_hardware(*pipeline, BuildOrder::automatic, options.levels.front());
    LineUp line_up = std::move(factory.line_up);
    if (options.has_embree)
        for (auto& backend : embree_line_up([&](const std::string& name) { return is_named(name, options.only); }))
            line_up.push_back(std::move(backend));
    if (line_up.empty()) fail("bench: no backend's name contains '", joined(options.only), "'");
    return line_up;
}

std::optional<std::size_t> find(Baseline baseline, const LineUp& line_up) {
    for (std::size_t i = 0; i < line_up.size(); ++i)
        if (is(baseline, line_up[i]->labels())) return i;
    return std::nullopt;
}

#ifndef TWINRAY_BENCH_EMBREE
LineUp embree_line_up(const std::function<bool(const std::string&)>&) { return {}; }

std::string why_no_embree() { return "this twinray was built without Embree 3 (Debian 12: libembree-dev)"; }
#endif

}  // namespace twinray::bench
