// The cost and worth of each level on scenes of an ordinary size, and the cost of kernel features in a scene that does
// not need them.
#include "report/suite/sections.h"

#include <twinray/tlas.h>
#include "engine/accel/trace_desc.h"
#include "engine/core/commands.h"
#include "feature_costs_program.trace_program.h"

namespace twinray::suite {
namespace {

struct Step {
    const char* name;
    std::unique_ptr<TraceProgram> program;
    std::vector<double> ns_per_ray = {};
    std::vector<Hit> hits = {};
};

std::vector<Step> steps_of(const AbstractAccel& accel, Query query) {
    std::vector<Step> steps;
    uint features = accel.features_for({.query = query, .occlusion_only = true});
    const auto add = [&](const char* name) {
        steps.push_back({name, accel.make_program(feature_costs_program, features)});
    };
    add("needed");
    for (const FeatureAddition& addition : feature_additions) {
        if ((addition.features & ~features) == 0) continue;
        features |= addition.features;
        add(addition.name);
    }
    return steps;
}

// Traces all steps in turn, in each round.
void trace_rounds(AbstractAccel& accel, std::span<const Ray> rays, Query query, std::size_t rounds,
                  std::vector<Step>& steps) {
    Context& context = accel.context();
    const Buffer on_device = uploaded(context, "rays of features", rays);
    const Buffer hits(context, {.name = "hits of features", .bytes = rays.size() * sizeof(Hit)});
    for (std::size_t round = 0; round <= rounds; ++round)  // the first compiles
        for (Step& step : steps) {
            Commands commands(context, "features");
            accel.trace(commands, accel.view(),
                        {.rays = on_device.ref<Ray>(),
                         .hits = hits.ref<Hit>(),
                         .count = rays.size(),
                         .query = query,
                         .occlusion_only = true,
                         .program = step.program.get()});
            commands.submit();
            const double ns = total_ms(commands.timings()) * 1e6 / static_cast<double>(rays.size());
            context.wait_for_gpu();
            if (round == 0)
                step.hits = download<Hit>(context, hits, rays.size());
            else
                step.ns_per_ray.push_back(ns);
        }
}

void add_records(CaseRun& run, const char* rays, const std::vector<Step>& steps) {
    const Step& needed = steps.front();
    for (const Step& step : steps) {
        std::vector<double> ratios;
        for (std::size_t i = 0; i < step.ns_per_ray.size(); ++i)
            ratios.push_back(step.ns_per_ray[i] / needed.ns_per_ray[i]);
        std::sort(ratios.begin(), ratios.end());
        const Interval ratio_95 = quantile_interval_95(ratios, 0.5);
        std::uint64_t faults = 0;
        for (std::size_t i = 0; i < step.hits.size(); ++i) faults += !same_bits(step.hits[i], needed.hits[i]);
        run.expect({Backend::software, Level::watertight}, {.params = {{"features", step.name}, {"rays", rays}},
                                                            .results = {{"of_needed", quantile(ratios, 0.5)},
                                                                        {"of_needed_low", ratio_95.low},
                                                                        {"of_needed_high", ratio_95.high}},
                                                            .n = step.hits.size(),
                                                            .faults = faults,
                                                            .what = "another hit than without the feature",
                                                            .reference = "invariance",
                                                            .time = time_figures("ns_per_ray", step.ns_per_ray)});
    }
}

// Adds a record for each added feature, for closest and for any hits: the time over that of the kernel with only what
// is needed (of_needed, the median over rounds in which all take turns, with its 95 % interval of_needed_low and
// of_needed_high). A fault is a ray that finds another hit.
void feature_costs(CaseRun& run) {
    const std::vector<Configuration> able = run.configurations();
    if (std::find(able.begin(), able.end(), Configuration{}) == able.end()) return;
    const Mesh mesh = make_icosphere(static_cast<uint>(run.amount(5, 8)));
    const std::vector<Ray> rays = primary_rays(bounds_of(mesh), static_cast<uint>(run.amount(96, 1024)));
    SwTlas accel(run.devices().context(Backend::software), {.can_move = false});
    accel.push(mesh);
    accel.sync();
    for (const auto& [query, name] : {std::pair{Query::closest, "closest"}, std::pair{Query::any, "any"}}) {
        std::vector<Step> steps = steps_of(accel, query);
        trace_rounds(accel, rays, query, run.amount(5, 25), steps);
        add_records(run, name, steps);
    }
}

// Returns 65,536 to 2^20 rays.
std::vector<Ray> camera_rays(CaseRun& run, const Bounds& bounds) {
    return primary_rays(bounds, static_cast<uint>(run.amount(256, 1024)));
}

void measure_scene(CaseRun& run, const Scene& scene, std::span<const Ray> rays, std::string_view kind) {
    run.measure(world_of(scene), rays,
                {.params = {{"triangles", count_triangles(scene)},
                            {"instances", scene.instances.size()},
                            {"rays", std::string(kind)}}});
}

void closed_mesh(CaseRun& run) {
    const Scene scene = instances_of(make_icosphere(static_cast<uint>(run.amount(6, 8))));
    measure_scene(run, scene, camera_rays(run, bounds_of(scene)), "primary");
}

void room(CaseRun& run) {
    const Scene scene = cornell_box_scene();
    measure_scene(run, scene, random_rays(bounds_of(scene), run.amount(65'536, 1 << 20), run.seed()), "incoherent");
}

void instanced_spheres(CaseRun& run) {
    std::vector<Transform> transforms;
    const int side = static_cast<int>(run.amount(8, 32));
    for (int x = 0; x < side; ++x)
        for (int y = 0; y < side; ++y) {
            const vec3 place(2.5f * static_cast<float>(x), static_cast<float>((x * 7 + y * 3) % 5),
                             2.5f * static_cast<float>(y));
            transforms.push_back(Transform::translation(place) * Transform::scaling({1, 0.7f, 1.3f}));
        }
    const Scene scene = instances_of(make_icosphere(3), transforms);
    measure_scene(run, scene, camera_rays(run, bounds_of(scene)), "primary");
}

}  // namespace

std::vector<SuiteCase> price_cases() {
    const std::string criterion = "0 faults; the time is measured";
    return {
        {"L01", "a closed mesh, a camera's rays", "time and error of each level", criterion, closed_mesh},
        {"L02", "a room of few triangles, incoherent rays", "time and error of each level", criterion, room},
        {"L03", "many instances, a camera's rays", "time and error of each level", criterion, instanced_spheres},
        {"L04", "a closed mesh, by kernels to which features are added that it does not need",
         "time over the needed alone", "the same hits; the time is measured", feature_costs},
    };
}

std::vector<SuiteCase> scene_cases(std::span<const std::filesystem::path> files) {
    std::vector<SuiteCase> cases;
    for (const std::filesystem::path& file : files) {
        const std::string id = text("L", cases.size() + 11);
        cases.push_back({id, file.filename().string() + ", a camera's rays", "time and error of each level",
                         "0 faults; the time is measured", [file](CaseRun& run) {
                             const Scene scene = load_scene(file);
                             measure_scene(run, scene, camera_rays(run, bounds_of(scene)), "primary");
                         }});
    }
    return cases;
}

}  // namespace twinray::suite
