// SPDX-License-Identifier: MIT
#include "cli/verify/output.h"

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/places.h"
#include "engine/report/statistics.h"

namespace twinray::cli {
namespace {

constexpr std::size_t max_printed_faults = 5;

void print_classes(const char* accel, const Classes& classes) {
    std::cout << "    " << accel;
    for (std::size_t kind = 0; kind < class_count; ++kind)
        if (const std::uint64_t n = classes[static_cast<Class>(kind)])
            std::cout << "  " << name(static_cast<Class>(kind)) << ' ' << n;
    std::cout << '\n';
}

// Of ours.
void print_faulty(const std::vector<Fault>& faults) {
    std::size_t printed = 0;
    for (const auto& [ray, answer, kind, is_of_software] : faults)
        if (is_of_software && printed++ < max_printed_faults)
            std::cout << std::hexfloat << "    faulty: origin " << ray.origin.x << ' ' << ray.origin.y << ' '
                      << ray.origin.z << " direction " << ray.direction.x << ' ' << ray.direction.y << ' '
                      << ray.direction.z << " t " << ray.t_min << ' ' << ray.t_max << std::defaultfloat << '\n';
}

}  // namespace

void print(const RaySet& set, const Outcome& outcome, bool has_hardware) {
    const std::uint64_t faults = outcome.software.faults_of_ours();
    std::cout << "  " << set.name << ": " << set.rays.size() << " rays\n";
    print_classes("SW", outcome.software);
    std::cout << "        SW_LEAK " << outcome.software[Class::sw_leak] << ", SW_FALSE "
              << outcome.software[Class::sw_false] << ", T_ERR " << outcome.software[Class::t_err]
              << "; true rate below " << std::setprecision(2) << upper_bound_95(faults, set.rays.size()) << " (95 %)\n";
    print_faulty(outcome.faults);
    if (!has_hardware) return;
    print_classes("HW", outcome.hardware);
    std::cout << "    SW and HW name different hits on " << outcome.disagreeing() << " rays\n";
    for (const auto& [classes, count] : outcome.disagreements)
        std::cout << "        SW " << name(classes.first) << ", HW " << name(classes.second) << ": " << count << '\n';
}

namespace {

nlohmann::json counts_json(const Classes& classes) {
    nlohmann::json counts = nlohmann::json::object();
    for (std::size_t kind = 0; kind < class_count; ++kind)
        counts[std::string(name(static_cast<Class>(kind)))] = classes[static_cast<Class>(kind)];
    return counts;
}

struct Judgement {
    const char* backend;
    std::string path;
    const Classes& classes;
    std::uint64_t faults;
    const char* criterion;
    double seconds;
};

void append_record(const VerifyOptions& options, const JudgedSet& of, const Judgement& judged) {
    append_json(options.common.json, {{"schema", "twinray-report/1"},
                                      {"device", describe(of.context)},
                                      {"case", "verify." + of.set.name},
                                      {"scene", options.scene.string()},
                                      {"origin", list_of(of.scene.origin)},
                                      {"backend", judged.backend},
                                      {"path", judged.path},
                                      {"level", name_of(options.level)},
                                      {"reference", "f64"},
                                      {"n", of.set.rays.size()},
                                      {"seed", options.common.seed},
                                      {"counts", counts_json(judged.classes)},
                                      {"bound95", upper_bound_95(judged.faults, of.set.rays.size())},
                                      {"seconds", judged.seconds},
                                      {"pass", judged.faults == 0},
                                      {"criterion", judged.criterion}});
}

}  // namespace

void append_records(const VerifyOptions& options, const JudgedSet& judged) {
    const Outcome& outcome = judged.outcome;
    append_record(options, judged,
                  {"sw", "compute", outcome.software, outcome.software.faults_of_ours(),
                   "SW_LEAK, SW_FALSE and T_ERR are 0", outcome.software_seconds});
    if (judged.hw)
        append_record(options, judged,
                      {"hw", judged.hw->trace_path(), outcome.hardware, outcome.hardware.faults_of_hardware(),
                       "HW_LEAK, HW_FALSE, HW_T_ERR and HW_RANGE are 0", outcome.hardware_seconds});
}

}  // namespace twinray::cli
