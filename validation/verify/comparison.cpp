#include "validation/verify/comparison.h"

#include <iomanip>
#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "engine/core/stopwatch.h"
#include "engine/core/statistics.h"
#include "validation/reference/aimed_rays.h"

namespace twinray {
namespace {

constexpr std::size_t max_printed_faults = 5;

void print_classes(std::ostream& out, const char* accel, const HitClassCounts& classes) {
    out << "    " << accel;
    for (std::size_t kind = 0; kind < hit_class_count; ++kind)
        if (const std::uint64_t n = classes[static_cast<HitClass>(kind)])
            out << "  " << name_of(static_cast<HitClass>(kind)) << ' ' << n;
    out << '\n';
}

// Prints the faults of SwTlas.
void print_faulty(std::ostream& out, const std::vector<Fault>& faults) {
    std::size_t printed = 0;
    for (const auto& [ray, answer, kind, is_of_software] : faults)
        if (is_of_software && printed++ < max_printed_faults)
            out << std::hexfloat << "    faulty: origin " << ray.origin.x << ' ' << ray.origin.y << ' ' << ray.origin.z
                << " direction " << ray.direction.x << ' ' << ray.direction.y << ' ' << ray.direction.z << " t "
                << ray.t_min << ' ' << ray.t_max << std::defaultfloat << '\n';
}

nlohmann::json counts_json(const HitClassCounts& classes) {
    nlohmann::json counts = nlohmann::json::object();
    for (std::size_t kind = 0; kind < hit_class_count; ++kind)
        counts[std::string(name_of(static_cast<HitClass>(kind)))] = classes[static_cast<HitClass>(kind)];
    return counts;
}

struct Part {
    const char* backend;
    std::string path;
    const HitClassCounts& classes;
    std::uint64_t faults;
    const char* criterion;
    double seconds;
};

nlohmann::json record_of(nlohmann::json record, const RaySet& set, const Part& part) {
    record.update({{"case", "verify." + set.name},
                   {"backend", part.backend},
                   {"path", part.path},
                   {"reference", "f64"},
                   {"n", set.rays.size()},
                   {"counts", counts_json(part.classes)},
                   {"bound95", upper_bound_95(part.faults, set.rays.size())},
                   {"seconds", part.seconds},
                   {"pass", part.faults == 0},
                   {"criterion", part.criterion}});
    return record;
}

bool is_same(const Hit& a, const Hit& b) {
    return a.hit == b.hit && a.instance_index == b.instance_index && a.primitive_index == b.primitive_index;
}

template <class Call>
auto timed(double& seconds, const Call& call) {
    const Stopwatch start;
    auto result = call();
    seconds += start.seconds();
    return result;
}

void keep(std::vector<Fault>& faults, const Fault& fault) {
    if (!is_fault_of_ours(fault.kind) && !is_fault_of_hardware(fault.kind)) return;
    const auto alike = std::ranges::count(faults, fault.kind, &Fault::kind);
    if (static_cast<std::size_t>(alike) < (fault.is_of_software ? max_faults_of_ours : max_faults_of_driver))
        faults.push_back(fault);
}

AccelOptions options_for(Level level) { return {.level = std::max(level, Level::watertight)}; }

// Fills the accelerator, builds it and compiles its kernel.
void build(AbstractAccel& accel, const Verifier::Fill& fill, Level level) {
    fill(accel);
    const Ray ray{vec3(0), 0, vec3(1), 1};
    static_cast<void>(accel.closest_hits(std::span(&ray, 1), {.level = level}));
}

std::string lacking_for_hardware(const DeviceProperties& device, Level level) {
    if (const std::vector<std::string> missing = missing_for_hardware(device); !missing.empty())
        return "the device lacks " + joined(missing);
    const Capability able = HwTlas::capability_on(device, feature_of(level));
    return able.support == Support::unsupported ? text(name_of(able.feature), ": ", able.note) : "";
}

}  // namespace

void print(std::ostream& out, const RaySet& set, const Comparison& comparison, bool has_hardware) {
    const std::uint64_t faults = comparison.software.faults_of_ours();
    out << "  " << set.name << ": " << set.rays.size() << " rays\n";
    print_classes(out, "SW", comparison.software);
    out << "        SW_LEAK " << comparison.software[HitClass::sw_leak] << ", SW_FALSE "
        << comparison.software[HitClass::sw_false] << ", T_ERR " << comparison.software[HitClass::t_err]
        << "; true rate below " << std::setprecision(2) << upper_bound_95(faults, set.rays.size()) << " (95 %)\n";
    print_faulty(out, comparison.faults);
    if (!has_hardware) return;
    print_classes(out, "HW", comparison.hardware);
    out << "    SW and HW name different hits on " << comparison.disagreeing() << " rays\n";
    for (const auto& [classes, count] : comparison.disagreements)
        out << "        SW " << name_of(classes.first) << ", HW " << name_of(classes.second) << ": " << count << '\n';
}

std::vector<nlohmann::json> records_of(const nlohmann::json& base, const RaySet& set, const Comparison& comparison,
                                       const HwTlas* hardware) {
    std::vector<nlohmann::json> records = {
        record_of(base, set,
                  {"sw", "compute", comparison.software, comparison.software.faults_of_ours(),
                   "SW_LEAK, SW_FALSE and T_ERR are 0", comparison.software_seconds})};
    if (hardware)
        records.push_back(
            record_of(base, set,
                      {"hw", hardware->trace_path(), comparison.hardware, comparison.hardware.faults_of_hardware(),
                       "HW_LEAK, HW_FALSE, HW_T_ERR and HW_RANGE are 0", comparison.hardware_seconds}));
    return records;
}

std::vector<RaySet> test_rays(const ReferenceScene& reference, const Bounds& bounds, std::size_t random,
                              std::size_t aimed, std::uint64_t seed) {
    return {{"random", random_rays(bounds, random, seed)},
            {"vertex", vertex_aimed_rays(reference, aimed, seed)},
            {"edge", edge_aimed_rays(reference, aimed, seed)}};
}

std::uint64_t Comparison::disagreeing() const {
    std::uint64_t count = 0;
    for (const auto& [classes, n] : disagreements) count += n;
    return count;
}

Verifier::Verifier(Context& context, ReferenceScene reference, const Fill& fill, Level level)
    : level_(level),
      reference_(std::move(reference)),
      why_no_hardware_(lacking_for_hardware(context.properties(), level)),
      software_(context, options_for(level)) {
    build(software_, fill, level);
    if (!why_no_hardware_.empty()) return;
    hardware_ = std::make_unique<HwTlas>(context, BuildOrder::automatic, options_for(level));
    build(*hardware_, fill, level);
}

Comparison Verifier::compare(std::span<const Ray> rays, const Arbiter& arbiter,
                             const std::function<void(std::size_t)>& progress) {
    constexpr std::size_t batch_size = 1 << 18;
    Comparison comparison;
    for (std::size_t first = 0; first < rays.size(); first += batch_size) {
        const auto batch = rays.subspan(first, std::min(batch_size, rays.size() - first));
        compare_batch(batch, arbiter, comparison);
        progress(batch.size());
    }
    return comparison;
}

void Verifier::compare_batch(std::span<const Ray> rays, const Arbiter& arbiter, Comparison& comparison) {
    const TraceDesc desc{.level = level_};
    const std::vector<Hit> software =
        timed(comparison.software_seconds, [&] { return software_.closest_hits(rays, desc); });
    std::vector<Hit> hardware;
    if (hardware_) hardware = timed(comparison.hardware_seconds, [&] { return hardware_->closest_hits(rays, desc); });
    const std::vector<RayResult> results = classify_all(reference_, rays, software, hardware, arbiter);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const HitClass of_software = *results[i].software;
        comparison.software.add(of_software);
        keep(comparison.faults, {rays[i], software[i], of_software, true});
        if (!hardware_) continue;
        const HitClass of_hardware = *results[i].hardware;
        comparison.hardware.add(of_hardware);
        keep(comparison.faults, {rays[i], hardware[i], of_hardware, false});
        if (!is_same(software[i], hardware[i])) ++comparison.disagreements[{of_software, of_hardware}];
    }
}

}  // namespace twinray
