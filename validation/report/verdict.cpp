// SPDX-License-Identifier: MIT
#include "validation/report/verdict.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "engine/core/error.h"
#include "validation/records/bootstrap.h"
#include "validation/report/wording.h"

namespace twinray::report {
namespace {

// Names of classes that are this mistake: of SwTlas, of the driver.
bool is_class_of(Mistake mistake, std::string_view kind) {
    switch (mistake) {
        case Mistake::leak: return kind == "SW_LEAK" || kind == "HW_LEAK";
        case Mistake::false_hit: return kind == "SW_FALSE" || kind == "HW_FALSE";
        case Mistake::wrong_distance: return kind == "T_ERR" || kind == "HW_T_ERR";
        case Mistake::not_finite: return kind == "HW_RANGE";
        case Mistake::counted_wrong: return kind.starts_with("CROSSED_");
    }
    return false;
}

bool counts_for(Mistake mistake, const Record& record) {
    if (!record.was_run || !is_users_kernel(record) || record.level == "fast") return false;
    if (mistake == Mistake::counted_wrong) return record.params.contains("counted");
    if (record.reference != "f64" || record.counts.empty()) return false;
    return mistake != Mistake::leak || record.case_id.starts_with('W');
}

std::uint64_t count_of(Mistake mistake, const Record& record) {
    std::uint64_t sum = 0;
    for (const auto& [kind, count] : record.counts)
        if (is_class_of(mistake, kind)) sum += count;
    return sum;
}

double share(std::uint64_t count, std::uint64_t n) {
    return n ? static_cast<double>(count) / static_cast<double>(n) : 0.0;
}

void add(Finding& finding, const Record& record) {
    const std::uint64_t faults = count_of(finding.mistake, record);
    finding.faults += faults;
    finding.n += record.n;
    if (share(faults, record.n) <= share(finding.worst_faults, finding.worst_n)) return;
    finding.worst_case = record.case_id;
    finding.worst_faults = faults;
    finding.worst_n = record.n;
}

constexpr std::uint64_t fewest_rays = 2048;  // below, times are mostly those of a dispatch

std::string measurement_of(const Record& record) { return record.case_id + '|' + settings_text(record); }

const Finding* find(std::span<const Finding> findings, std::string_view backend, Mistake mistake) {
    const auto found = std::find_if(findings.begin(), findings.end(), [&](const Finding& finding) {
        return finding.backend == backend && finding.mistake == mistake;
    });
    return found == findings.end() ? nullptr : &*found;
}

// The driver's way that most of its users take.
std::string driver_backend(std::span<const Record> records) {
    for (const char* backend : {"hw", "hw-pipeline"})
        for (const Record& record : records)
            if (record.was_run && record.backend == backend) return backend;
    return "";
}

Sentence sentence_of(const Finding& finding, const Finding* ours) {
    std::string about(name_of(finding.mistake));
    about.front() = static_cast<char>(std::toupper(about.front()));
    std::string sentence = "by " + answerer(finding.backend) + ' ' + rate_text(finding.faults, finding.n);
    if (finding.faults && share(finding.worst_faults, finding.worst_n) > 1.5 * share(finding.faults, finding.n))
        sentence += ", up to " + number(100 * share(finding.worst_faults, finding.worst_n), 2) + " % in case " +
                    finding.worst_case;
    if (ours) sentence += "; by SwTlas " + rate_text(ours->faults, ours->n);
    const bool is_right = finding.faults == 0 && (!ours || ours->faults == 0);
    return {is_right ? Sentence::Kind::right : Sentence::Kind::wrong, about, sentence + '.'};
}

void add_own_structures(Verdict& verdict, const OwnStructures& cases) {
    if (cases.all.empty()) return;
    const auto listed = [](const std::set<std::string>& ids) {
        return text(ids.size(), ids.empty() ? "" : " (" + joined({ids.begin(), ids.end()}) + ')');
    };
    verdict.sentences.push_back(
        {cases.musts.empty() ? Sentence::Kind::right : Sentence::Kind::wrong, "Acceleration structures",
         text("of ", cases.all.size(), " cases of builds, updates, copies, flags and candidates, ", listed(cases.musts),
              " fail what Vulkan demands, ", listed(cases.shoulds), " what it advises.")});
}

void add_speed(Verdict& verdict, std::span<const Speed> speeds, std::string_view driver) {
    const auto find = [&](std::string_view backend, std::string_view level) {
        return std::find_if(speeds.begin(), speeds.end(),
                            [&](const Speed& speed) { return speed.backend == backend && speed.level == level; });
    };
    const auto hardware = find(driver, "watertight"), refined = find("sw", "refined"), plain = find("sw", "watertight");
    if (hardware != speeds.end())
        verdict.sentences.push_back(
            {Sentence::Kind::measured, "Speed",
             text(answerer(driver), " take ", with_interval(hardware->ratio, hardware->ratio_95),
                  " times as long as SwTlas at watertight, over ", hardware->measurements,
                  " measurements of the same rays.")});
    if (refined != speeds.end() && plain != speeds.end() && refined->median_p99_ulp > 0)
        verdict.sentences.push_back({Sentence::Kind::measured, "Error against run time",
                                     text("99 % of the hits of SwTlas are within ", number(plain->median_p99_ulp, 2),
                                          " units in the last place of t at level watertight, and within ",
                                          number(refined->median_p99_ulp, 2), " at level refined, which takes ",
                                          with_interval(refined->ratio, refined->ratio_95), " times as long.")});
}

std::size_t faults_of(std::span<const Record> records, std::string_view whose) {
    return static_cast<std::size_t>(std::ranges::count(records, whose, &Record::fault_of));
}

std::string headline_of(std::span<const Record> records, std::span<const Finding> findings, const OwnStructures& cases,
                        std::string_view driver) {
    std::vector<std::string> wrongs;
    for (const Finding& finding : findings) {
        if (finding.backend != driver || finding.faults == 0) continue;
        switch (finding.mistake) {
            case Mistake::leak: wrongs.push_back("loses rays at edges and vertices"); break;
            case Mistake::false_hit: wrongs.push_back("reports hits that are not there"); break;
            case Mistake::wrong_distance: wrongs.push_back("gets distances wrong"); break;
            case Mistake::not_finite: wrongs.push_back("answers with numbers that are not finite"); break;
            case Mistake::counted_wrong: wrongs.push_back("counts shared edges other than once"); break;
        }
    }
    if (!cases.musts.empty()) wrongs.push_back("fails what Vulkan demands of acceleration structures");
    if (wrongs.empty()) {
        // Of cases that no finding counts; what Vulkan only advises is no fault.
        const auto faults = std::ranges::count_if(
            records, [](const Record& record) { return record.fault_of == "driver" && !is_only_advised(record); });
        return faults == 0 ? "No fault of this driver's ray tracing was seen."
                           : text("This driver is wrong in ", faults, faults == 1 ? " measurement." : " measurements.");
    }
    std::string all = wrongs.front();
    for (std::size_t i = 1; i < wrongs.size(); ++i) all += (i + 1 < wrongs.size() ? ", " : " and ") + wrongs[i];
    return "This driver " + all + '.';
}

}  // namespace

bool is_only_advised(const Record& record) {
    const auto demand = record.results.find("demand");
    return demand != record.results.end() && demand->second.text() == "should";
}

std::string result_of(const Record& record) {
    if (!record.was_run) return "not run";
    if (!record.pass) return "measured";
    return *record.pass ? "pass" : "fault of " + record.fault_of;
}

std::size_t faults_of_ours(std::span<const Record> records) { return faults_of(records, "twinray"); }

std::string_view name_of(Mistake mistake) {
    switch (mistake) {
        case Mistake::leak: return "rays lost at edges and vertices";
        case Mistake::false_hit: return "hits that are not there";
        case Mistake::wrong_distance: return "distances beyond the error bound";
        case Mistake::not_finite: return "hits that are not finite";
        case Mistake::counted_wrong: return "shared edges counted other than once";
    }
    return "";
}

std::vector<Finding> findings_of(std::span<const Record> records) {
    std::vector<Finding> findings;
    for (const char* backend : {"sw", "hw", "hw-pipeline"})
        for (const Mistake mistake : all_mistakes) {
            Finding finding{.backend = backend, .mistake = mistake};
            for (const Record& record : records)
                if (record.backend == backend && counts_for(mistake, record)) add(finding, record);
            if (finding.n) findings.push_back(finding);
        }
    return findings;
}

OwnStructures own_structures_of(std::span<const Record> records) {
    OwnStructures cases;
    for (const Record& record : records) {
        if (!record.was_run || !record.case_id.starts_with('K') || !is_users_kernel(record)) continue;
        cases.all.insert(record.case_id);
        if (record.pass.value_or(true)) continue;
        (is_only_advised(record) ? cases.shoulds : cases.musts).insert(record.case_id);
    }
    return cases;
}

std::vector<Speed> speeds_of(std::span<const Record> records) {
    std::map<std::string, double> base;
    for (const Record& record : records)
        if (record.time && record.backend == "sw" && record.level == "watertight" && is_users_kernel(record))
            base[measurement_of(record)] = record.time->median;
    std::map<std::pair<std::string, std::string>, std::vector<double>> ratios, errors;
    for (const Record& record : records) {
        const auto found = base.find(measurement_of(record));
        if (!record.time || record.n < fewest_rays || !record.time->metric.starts_with("ns_per_ray") ||
            !is_users_kernel(record) || found == base.end())
            continue;
        ratios[{record.backend, record.level}].push_back(std::log(record.time->median / found->second));
        if (record.error && record.error->metric == "t_ulp")
            errors[{record.backend, record.level}].push_back(record.error->p99);
    }
    std::vector<Speed> speeds;
    for (auto& [key, logs] : ratios) {
        Speed speed{.backend = key.first, .level = key.second, .measurements = logs.size()};
        const auto geometric_mean = [&of_key = logs](std::span<const std::size_t> items) {
            double sum = 0;
            for (const std::size_t i : items) sum += of_key[i];
            return std::exp(sum / static_cast<double>(items.size()));
        };
        std::vector<std::size_t> all(logs.size());
        std::iota(all.begin(), all.end(), std::size_t{0});
        speed.ratio = geometric_mean(all);
        speed.ratio_95 = bootstrap_interval_95(logs.size(), geometric_mean);
        if (std::vector<double>& of_t = errors[key]; !of_t.empty()) {
            speed.worst_p99_ulp = *std::max_element(of_t.begin(), of_t.end());
            speed.median_p99_ulp = median(std::move(of_t));
        }
        speeds.push_back(std::move(speed));
    }
    return speeds;
}

Verdict verdict_of(std::span<const Record> records) {
    Verdict verdict;
    const std::vector<Finding> findings = findings_of(records);
    const OwnStructures own = own_structures_of(records);
    const std::string driver = driver_backend(records);
    verdict.has_driver = !driver.empty();
    verdict.are_we_right = faults_of_ours(records) == 0;
    verdict.is_driver_right = faults_of(records, "driver") == 0;
    verdict.headline = verdict.has_driver ? headline_of(records, findings, own, driver)
                                          : "This driver traces no rays by itself: SwTlas alone was checked.";
    if (!verdict.are_we_right)
        verdict.headline = text("twinray is wrong in ", faults_of_ours(records),
                                faults_of_ours(records) == 1 ? " measurement. " : " measurements. ", verdict.headline);
    for (const Mistake mistake : all_mistakes) {
        const Finding* ours = find(findings, "sw", mistake);
        const Finding* theirs = find(findings, driver, mistake);
        if (theirs)
            verdict.sentences.push_back(sentence_of(*theirs, ours));
        else if (ours)
            verdict.sentences.push_back(sentence_of(*ours, nullptr));
    }
    add_own_structures(verdict, own);
    add_speed(verdict, speeds_of(records), driver);
    return verdict;
}

}  // namespace twinray::report
