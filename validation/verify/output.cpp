// SPDX-License-Identifier: MIT
#include "validation/verify/output.h"

#include <iomanip>
#include <nlohmann/json.hpp>

#include "engine/core/statistics.h"

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

// Of ours.
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

}  // namespace twinray
