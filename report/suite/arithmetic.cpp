// Self-intersection and arithmetic.
#include "report/suite/sections.h"

#include "validation/cpu_reference/flush_denormals.h"
#include "validation/reference/float_probe.h"

namespace twinray::suite {
namespace {

constexpr std::size_t batch_size = 1 << 20;

// Compares the answers of a configuration with those of the CPU reference, batch by batch.
Difference compared(CaseRun& run, const Configuration& configuration, const Scene& scene, std::span<const Ray> rays,
                    const std::optional<Control>& control = {}) {
    const World world = world_of(scene);
    const std::unique_ptr<reference::Scene> on_cpu = cpu_reference_of(scene, run.devices().trees());
    Difference sum;
    for (std::size_t first = 0; first < rays.size(); first += batch_size) {
        const auto batch = rays.subspan(first, std::min(batch_size, rays.size() - first));
        const std::vector<Traced> traced = trace(run.devices(), std::span(&configuration, 1), world,
                                                 {.rays = batch, .reps = 0, .control = control ? &*control : nullptr});
        sum += difference(batch, traced.front().hits, trace_cpu_reference(*on_cpu, batch, configuration.level));
    }
    return sum;
}

// Returns SwTlas's configurations with `precise` arithmetic throughout.
std::vector<Configuration> precise_configurations(CaseRun& run) {
    std::vector<Configuration> chosen;
    for (const Configuration& configuration : run.configurations())
        if (is_ours(configuration.backend) && configuration.level != Level::fast) chosen.push_back(configuration);
    return chosen;
}

// Makes edges of cells far from the origin, where contraction does harm.
Mesh far_grid() { return moved(scaled(make_grid(32, 32), 32), vec3(1e7f, 0, 1e7f)); }

// `excuse`: why nothing is demanded; "" = it is.
void add_difference(CaseRun& run, Record record, const Difference& found, std::uint64_t faults, std::size_t count,
                    const std::string& excuse) {
    record.reference = "invariance";
    set_faults(record, faults, count);
    record.results.emplace("other_decisions", found.decisions);
    record.results.emplace("other_bits", found.bits);
    record.example = found.example;
    if (excuse.empty())
        frame::decide(record, "twinray");
    else
        record.criterion = "none: " + excuse;
    run.add(record);
}

void record_contraction(CaseRun& run, const Configuration& configuration, const Difference& found, std::size_t count,
                        const std::optional<Control>& control) {
    Record record = run.record(configuration);
    if (control) record.variant = control->code.name;
    add_difference(run, record, found, found.decisions, count,
                   control ? "without `precise` the driver may contract" : why_bits_may_differ(run, configuration));
}

// Returns rotations and uneven scales of instances, so that the inverse and the transformed ray are also used.
std::vector<Transform> uneven_transforms() {
    return {Transform{},
            Transform{{vec4(0.3f, 0.8f, 0.1f, 2), vec4(-0.7f, 0.2f, 0.4f, 0.5f), vec4(0.1f, -0.3f, 1.7f, 1)}},
            Transform::translation({-3, 0.2f, 1}) * Transform::scaling({2, 0.01f, -1})};
}

std::vector<std::pair<const char*, Scene>> scenes_for_both() {
    return {{"soup", instances_of(make_soup(2000, 5, 0.2f))},
            {"sphere", instances_of(make_icosphere(5))},
            {"height field", instances_of(make_grid(64, 64, 0.2f, 3))},
            {"instances", instances_of(make_soup(500, 6, 0.3f), uneven_transforms())}};
}

// Makes each coordinate of origins and directions a denormal, half of the time; the rest is as it was.
std::vector<Ray> with_denormals(std::vector<Ray> rays, std::uint64_t seed) {
    std::mt19937 random(static_cast<std::uint32_t>(seed));
    const auto denormal = [&] {
        const float magnitude = std::ldexp(1.0f, -127 - static_cast<int>(random() % 20));
        return random() % 2 ? magnitude : -magnitude;
    };
    for (Ray& ray : rays) {
        const auto kept = static_cast<int>(random() % 3);  // so that the direction is not 0
        for (int axis = 0; axis < 3; ++axis) {
            if (random() % 2) ray.origin[axis] = denormal();
            if (axis != kept && random() % 2) ray.direction[axis] = denormal();
        }
        if (std::abs(ray.direction[kept]) < 0x1p-24f) ray.direction[kept] = 1;
    }
    return rays;
}

void contraction(CaseRun& run) {
    const Scene scene = instances_of(far_grid());
    const ReferenceScene reference = ReferenceScene::of(scene);
    const std::vector<Ray> rays = edge_aimed_rays(reference, run.amount(1'024, 1'000'000), run.seed());
    for (const Configuration& configuration : precise_configurations(run)) {
        record_contraction(run, configuration, compared(run, configuration, scene, rays), rays.size(), {});
        if (configuration.level != Level::watertight) continue;
        const std::optional<Control> control = without_precise();
        record_contraction(run, configuration, compared(run, configuration, scene, rays, control), rays.size(),
                           control);
    }
}

void float_probe(CaseRun& run) {
    for (const Configuration& configuration : run.one_configuration_each()) {
        if (!is_ours(configuration.backend)) continue;
        const FloatFacts& properties = probe_floats(run.devices().context(configuration.backend));
        const std::vector<std::string> faults = robust_faults(properties);
        run.expect(configuration, {.results = {{"product_ulp", properties.product_ulp},
                                               {"sum_ulp", properties.sum_ulp},
                                               {"quotient_ulp", properties.quotient_ulp},
                                               {"keeps_denormals", properties.keeps_denormals},
                                               {"has_exact_float64", properties.has_exact_float64}},
                                   .n = robust_conditions,
                                   .faults = faults.size(),
                                   .what = "watertightness cannot be claimed: " + joined(faults),
                                   .fault_of = "driver"});
    }
}

// A ray displaced by a denormal passes a shared edge on the other side, so that the triangle may change, but no answer
// may become wrong.
void denormals(CaseRun& run) {
    for (const Configuration& configuration : precise_configurations(run)) {
        if (!FlushDenormals::is_able()) {
            run.add_not_run("the host's denormals cannot be flushed", &configuration);
            continue;
        }
        for (const auto& [name, scene] : scenes_for_both()) {
            const World world = world_of(scene);
            const std::size_t count = run.amount(2'000, 1'000'000);
            const std::vector<Ray> rays = with_denormals(
                random_and_aimed(world.reference, bounds_of(scene), count, count / 4, run.seed()), run.seed());
            const std::unique_ptr<reference::Scene> on_cpu = cpu_reference_of(scene, run.devices().trees());
            const std::vector<Hit> flushed =
                trace_cpu_reference(*on_cpu, rays, configuration.level, Denormals::flushed);
            const std::vector<Traced> traced =
                trace(run.devices(), std::span(&configuration, 1), world, {.rays = rays, .reps = 0});
            const Difference changed =
                difference(rays, flushed, trace_cpu_reference(*on_cpu, rays, configuration.level));
            CheckResult checked = check(world.reference, rays, flushed, configuration.backend);
            checked += check(world.reference, rays, traced.front().hits, configuration.backend);
            run.add_checked(configuration, checked,
                            {.params = {{"scene", name}}, .results = {{"changed_by_flushing", changed.decisions}}});
        }
    }
}

void device_against_cpu(CaseRun& run) {
    for (const Configuration& configuration : precise_configurations(run)) {
        const std::string excuse = why_bits_may_differ(run, configuration);
        for (const auto& [name, scene] : scenes_for_both()) {
            const std::vector<Ray> rays =
                random_and_aimed(ReferenceScene::of(scene), bounds_of(scene), run.amount(25'000, 2'500'000),
                                 run.amount(2'500, 250'000), run.seed());
            const Difference found = compared(run, configuration, scene, rays);
            Record record = run.record(configuration);
            record.params = {{"scene", name}};
            record.results = {{"worst_t_ulp", found.worst_ulp}};
            add_difference(run, record, found, found.total(), rays.size(), excuse);
        }
    }
}

}  // namespace

std::vector<SuiteCase> arithmetic_cases() {
    return {
        {"F01",
         "outward rays from points of a convex sphere, by twinray/glsl/spawn.glsl, without offset, and otherwise",
         "hits of the sphere", "0 self-hits; without offset about half (control)", leave_a_sphere},
        {"F02", "separate triangles: ten settings of size, position, shape and instance, and four more",
         "rays that meet the triangle they leave", "0", leave_triangles_of_all_kinds},
        {"F03", "two plates 1e-3 to 1e-7 apart, rays from the lower one", "rays that miss the upper one",
         "0 where the gap is wider than twice the offset that the point tells; else flagged", leave_between_plates},
        {"F04", "shadow terminator: coarse spheres with smooth normals under a small far light, beside a fine one",
         "black pixels where the fine one is lit, energy",
         "none: measured; the path tracer leaves by the geometric normal and corrects nothing", shadow_terminator},
        {"F05", "a concave corner of 1 to 179 degrees, rays that end on its wall or lead away from it",
         "leaks, false occlusion", "0 where the wall and its edges are farther than twice the offset; else flagged",
         leave_a_concave_corner},
        {"F06",
         "rays at the edges of a grid far from the origin; kernels with and without `precise`, and the CPU reference",
         "decisions other than the CPU reference's", "0 with `precise`, where the device divides as IEEE 754 does",
         contraction},
        {"F07", "float probe: roundings, contraction, NaN, denormals", "what watertightness rests on and is not so",
         "0, else the robust levels cannot be claimed", float_probe},
        {"F08", "rays with denormal coordinates, on the device, and on its CPU reference with denormals flushed",
         "classes of both; triangles that change by flushing", "0 SW_LEAK, SW_FALSE, T_ERR", denormals},
        {"F09", "random and aimed rays on SwTlas and on its CPU reference, the same code compiled for the CPU",
         "hits that differ in a bit: ids, t, u, v",
         "0 where the device divides as IEEE 754 does; elsewhere measured only", device_against_cpu},
    };
}

}  // namespace twinray::suite
