#include "report/suite/tracing.h"

#include <algorithm>

#include <twinray/scene.h>
#include "control_contracted.spv.h"
#include "control_without_padding.spv.h"
#include "control_without_precise.spv.h"

namespace twinray::suite {
namespace {

// The accelerator of a backend with the world in it, and the rays in its context's memory.
struct Stage {
    AbstractAccel& accel;
    Buffer rays;
    std::unique_ptr<TraceProgram> control = {};
    double build_ms = 0;
    double upload_ms = 0;
};

Stage make_stage(Devices& devices, const Configuration& configuration, const World& world, const Tracing& tracing) {
    const std::span<const Ray> rays = tracing.rays;
    AbstractAccel& accel = devices.empty_accel(configuration, tracing.control ? tracing.control->layout : std::nullopt);
    world.fill(accel);
    accel.sync();
    Context& context = accel.context();
    Stage stage{accel, Buffer(context, {.name = "suite rays", .bytes = rays.size_bytes()})};
    if (tracing.control) stage.control = accel.make_program(tracing.control->code);
    stage.build_ms = total_ms(accel.build_timings());
    Commands commands(context, "suite rays");
    {
        const auto pass = commands.pass("upload rays");
        commands.upload(stage.rays, rays);
    }
    const Stopwatch start;
    commands.submit();
    context.wait_for_gpu();
    stage.upload_ms = start.ms();
    return stage;
}

struct Timing {
    double gpu_ms = 0;
    double wall_ms = 0;
    bool has_timestamps = true;
};

Timing trace_once(const Stage& stage, const Configuration& configuration, const Tracing& tracing, const Buffer& hits) {
    const Stopwatch start;
    Commands commands(stage.accel.context(), "suite trace");
    stage.accel.trace(commands, stage.accel.view(),
                      {.rays = stage.rays.ref<Ray>(),
                       .hits = hits.ref<Hit>(),
                       .count = tracing.rays.size(),
                       .query = tracing.query,
                       .level = configuration.level,
                       .program = stage.control.get()});
    commands.submit();
    const std::vector<PassTiming> timings = commands.timings();
    stage.accel.context().wait_for_gpu();
    return {total_ms(timings), start.ms(), !timings.empty()};
}

// Runs the first trace, which compiles, and keeps its hits.
Traced trace_first(const Stage& stage, const Configuration& configuration, const Tracing& tracing, const Buffer& hits) {
    Traced traced{.configuration = configuration, .hits = {}, .ns_per_ray = {}, .phases_ms = {}};
    traced.phases_ms["build"] = stage.build_ms;
    traced.phases_ms["first_trace"] = trace_once(stage, configuration, tracing, hits).wall_ms;
    const Stopwatch start;
    traced.hits = download<Hit>(stage.accel.context(), hits, tracing.rays.size());
    traced.phases_ms["copy"] = stage.upload_ms + start.ms();
    return traced;
}

Control of_code(Control control, const char* name, std::span<const std::uint32_t> software) {
    control.code.name = name;
    control.code.software = software;
    return control;
}

}  // namespace

Control without_precise() { return of_code({{}, false}, "control: without precise", control_without_precise_spirv); }
Control contracted() { return of_code({{}, true}, "control: contracted", control_contracted_spirv); }
Control without_padding() {
    return of_code({{}, true, 0.01, Layout::bvh2}, "control: without padding", control_without_padding_spirv);
}

World world_of(const Scene& scene) {
    return {[scene](AbstractAccel& accel) { push_scene(accel, scene); }, ReferenceScene::of(scene)};
}

World world_of(const Mesh& mesh, const Transform& transform, const InstanceOptions& options) {
    const MeshView view = mesh;
    const ReferenceInstance instance{0, transform, options};
    return {[=](AbstractAccel& accel) { accel.push(mesh, transform, options); },
            ReferenceScene(std::span(&view, 1), std::span(&instance, 1))};
}

std::vector<Traced> trace(Devices& devices, std::span<const Configuration> configurations, const World& world,
                          const Tracing& tracing) {
    std::map<std::pair<Backend, Level>, Stage> stages;
    const auto key = [](const Configuration& configuration) {
        return std::pair(configuration.backend, Devices::level_to_make(configuration));
    };
    std::vector<Buffer> hits;
    std::vector<Traced> all;
    for (const Configuration& configuration : configurations) {
        auto stage = stages.find(key(configuration));
        if (stage == stages.end())
            stage = stages.emplace(key(configuration), make_stage(devices, configuration, world, tracing)).first;
        hits.emplace_back(stage->second.accel.context(),
                          BufferDesc{.name = "suite hits", .bytes = tracing.rays.size() * sizeof(Hit)});
        all.push_back(trace_first(stage->second, configuration, tracing, hits.back()));
    }
    for (std::size_t rep = 0; rep < tracing.reps; ++rep)
        for (std::size_t i = 0; i < configurations.size(); ++i) {
            const Timing timing = trace_once(stages.at(key(configurations[i])), configurations[i], tracing, hits[i]);
            all[i].has_timestamps = timing.has_timestamps;
            all[i].ns_per_ray.push_back((timing.has_timestamps ? timing.gpu_ms : timing.wall_ms) * 1e6 /
                                        static_cast<double>(tracing.rays.size()));
        }
    return all;
}

std::vector<uint> crossings_of(Devices& devices, const Configuration& configuration, const World& world,
                               std::span<const Ray> rays) {
    AbstractAccel& accel = devices.empty_accel(configuration);
    world.fill(accel);
    accel.sync();
    return devices.crossing_counter(configuration).count(accel, rays);
}

double total_ms(const std::vector<PassTiming>& timings) {
    double sum = 0;
    for (const PassTiming& timing : timings) sum += timing.ms;
    return sum;
}

TimeFigures time_figures(const std::string& metric, std::vector<double> samples) {
    std::sort(samples.begin(), samples.end());
    return {
        metric,          quantile(samples, 0.5), quantile_interval_95(samples, 0.5), median_absolute_deviation(samples),
        samples.front(), samples.size()};
}

TimeFigures time_figures(const Traced& traced) {
    TimeFigures figures = time_figures(traced.has_timestamps ? "ns_per_ray" : "ns_per_ray_wall", traced.ns_per_ray);
    figures.phases_ms = traced.phases_ms;
    return figures;
}

}  // namespace twinray::suite
