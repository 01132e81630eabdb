#include "report/page/verdict.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "engine/core/error.h"
#include "report/conformance/suite.h"
#include "engine/core/statistics.h"
#include "report/page/wording.h"
#include "report/suite/suite.h"

namespace twinray::report {
namespace {

constexpr std::uint64_t fewest_rays = 2048;  // below it, times are mostly those of a dispatch

std::string measurement_of(const Record& record) { return record.case_id + '|' + settings_text(record); }

// Returns the driver's way that most of its users take.
std::string driver_backend(std::span<const Record> records) {
    for (const char* backend : {"hw", "hw-pipeline"})
        for (const Record& record : records)
            if (record.was_run && record.backend == backend) return backend;
    return "";
}

// `second` may be missing; `first` has more to show.
Sentence sentence_of(const Finding& first, const Finding* second) {
    std::string about(name_of(first.mistake));
    about.front() = static_cast<char>(std::toupper(about.front()));
    std::string said = "by " + answerer(first.backend) + ' ' + text_of(first);
    if (second) said += "; by " + answerer(second->backend) + ' ' + text_of(*second);
    said += '.';
    if (first.has_faults() || (second && second->has_faults())) return {Sentence::Kind::wrong, about, said};
    const Finding& fewer = second && second->cases_run < first.cases_run ? *second : first;
    if (fewer.is_complete()) return {Sentence::Kind::right, about, said};
    return {Sentence::Kind::not_measured, about,
            text("not measured (", fewer.cases_run, " of ", fewer.cases, " cases ran): ", said)};
}

const std::set<std::string>& catalogued() {
    static const std::set<std::string> ids = [] {
        std::set<std::string> all;
        for (const suite::SuiteCase& row : suite::catalogue()) all.insert(row.id);
        for (const conformance::Case& row : conformance::catalogue()) all.insert(row.id);
        return all;
    }();
    return ids;
}

bool is_of(std::string_view sections, const std::string& case_id) {
    return sections.find(case_id.front()) != sections.npos;
}

std::size_t catalogued(std::string_view sections) {
    return static_cast<std::size_t>(
        std::ranges::count_if(catalogued(), [&](const std::string& id) { return is_of(sections, id); }));
}

Sentence::Kind kind_of(const CaseResults& results, std::size_t cases) {
    if (!results.failed_by_us.empty() || !results.failed_by_driver.empty()) return Sentence::Kind::wrong;
    return results.run.size() < cases ? Sentence::Kind::not_measured : Sentence::Kind::right;
}

void add_results(Verdict& verdict, std::span<const Record> records, std::string_view sections, std::string about) {
    const CaseResults results = results_of(records, sections);
    if (results.run.empty()) return;
    const std::size_t cases = catalogued(sections);
    const Sentence::Kind kind = kind_of(results, cases);
    const auto said = [&](const auto&... words) {
        return text(kind == Sentence::Kind::not_measured ? "not measured: " : "", results.run.size(), " of ", cases,
                    " cases ", words...);
    };
    const std::string by_driver = ids_text(results.failed_by_driver);
    verdict.sentences.push_back(
        {kind, std::move(about),
         sections == "K"
             ? said("of builds, updates, copies, flags and candidates ran; ", by_driver,
                    " break a requirement of Vulkan, ", ids_text(results.not_as_advised), " a recommendation.")
         : kind == Sentence::Kind::wrong
             ? said("ran; ", ids_text(results.failed_by_us), " fail by twinray, ", by_driver, " by the driver.")
             : said("ran; none of them fails.")});
}

std::string_view mark_of(const Speed& speed) {
    return speed.is_disturbed ? " (disturbed: other programs used the processors, so the figure is not reliable)" : "";
}

void add_speed(Verdict& verdict, std::span<const Speed> speeds, std::string_view driver) {
    const Speed *hardware = find(speeds, driver, "watertight"), *refined = find(speeds, "sw", "refined"),
                *plain = find(speeds, "sw", "watertight");
    if (hardware)
        verdict.sentences.push_back(
            {Sentence::Kind::measured, "Speed",
             text(answerer(driver), " take ", with_interval(hardware->ratio, hardware->ratio_95),
                  " times as long as SwTlas at watertight, over ", hardware->measurements,
                  " measurements of the same rays", mark_of(*hardware), '.')});
    if (refined && plain && refined->median_p99_ulp > 0)
        verdict.sentences.push_back(
            {Sentence::Kind::measured, "Error against run time",
             text("99 % of the hits of SwTlas are within ", number(plain->median_p99_ulp, 2),
                  " units in the last place of t at level watertight, and within ", number(refined->median_p99_ulp, 2),
                  " at level refined, which takes ", with_interval(refined->ratio, refined->ratio_95), " times as long",
                  mark_of(*refined), '.')});
}

std::size_t faults_of(std::span<const Record> records, std::string_view whose) {
    return static_cast<std::size_t>(std::ranges::count(records, whose, &Record::fault_of));
}

// Returns the mistakes of the driver, as the headline lists them; "" for none.
std::string wrongs_of(std::span<const Record> records, std::span<const Finding> findings, std::string_view driver) {
    std::vector<std::string> wrongs;
    for (const Finding& finding : findings)
        if (finding.backend == driver && finding.has_faults()) wrongs.emplace_back(wrong_of(finding.mistake));
    if (!results_of(records, "K").failed_by_driver.empty())
        wrongs.push_back("breaks requirements of Vulkan on acceleration structures");
    if (wrongs.empty()) {
        // Counts cases that no finding counts; a broken recommendation of Vulkan is no fault.
        const auto faults = std::ranges::count_if(
            records, [](const Record& record) { return record.fault_of == "driver" && !is_only_advised(record); });
        return faults == 0 ? "" : text("is wrong in ", faults, faults == 1 ? " measurement" : " measurements");
    }
    std::string all = wrongs.front();
    for (std::size_t i = 1; i < wrongs.size(); ++i) all += (i + 1 < wrongs.size() ? ", " : " and ") + wrongs[i];
    return all;
}

std::string headline_of(const Verdict& verdict, const std::string& wrongs, std::size_t faults_of_ours) {
    const bool has_all = verdict.cases_run == verdict.cases;
    std::string headline;
    if (faults_of_ours)
        headline =
            text("twinray is wrong in ", faults_of_ours, faults_of_ours == 1 ? " measurement. " : " measurements. ");
    if (!verdict.has_driver)
        headline += "This driver has no ray tracing of its own, so only SwTlas was checked.";
    else if (wrongs.empty())
        headline += "This driver's ray tracing showed no fault.";
    else
        headline += "This driver " + wrongs + '.';
    return headline + text(has_all ? " All " : " Only ", has_all ? "" : text(verdict.cases_run, " of "), verdict.cases,
                           " stiff cases ran.");
}

}  // namespace

std::string_view word_of(Sentence::Kind kind) {
    constexpr std::array<std::string_view, 4> words = {"right", "wrong", "measured", "not measured"};
    return words[static_cast<std::size_t>(kind)];
}

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

CaseResults results_of(std::span<const Record> records, std::string_view sections) {
    CaseResults results;
    for (const Record& record : records) {
        if (!record.was_run || !is_of(sections, record.case_id)) continue;
        if (catalogued().contains(record.case_id)) results.run.insert(record.case_id);
        if (record.pass.value_or(true)) continue;
        (record.fault_of == "twinray" ? results.failed_by_us
         : is_only_advised(record)    ? results.not_as_advised
                                      : results.failed_by_driver)
            .insert(record.case_id);
    }
    return results;
}

std::vector<Speed> speeds_of(std::span<const Record> records) {
    std::map<std::string, double> base;
    for (const Record& record : records)
        if (record.time && record.backend == "sw" && record.level == "watertight" && is_users_kernel(record))
            base[measurement_of(record)] = record.time->median;
    std::map<std::pair<std::string, std::string>, std::vector<double>> ratios, errors;
    std::set<std::pair<std::string, std::string>> disturbed;
    for (const Record& record : records) {
        const auto found = base.find(measurement_of(record));
        if (!record.time || record.n < fewest_rays || !record.time->metric.starts_with("ns_per_ray") ||
            !is_users_kernel(record) || found == base.end())
            continue;
        ratios[{record.backend, record.level}].push_back(std::log(record.time->median / found->second));
        if (record.time->is_disturbed()) disturbed.insert({record.backend, record.level});
        if (record.error && record.error->metric == "t_ulp")
            errors[{record.backend, record.level}].push_back(record.error->p99);
    }
    std::vector<Speed> speeds;
    for (auto& [key, logs] : ratios) {
        Speed speed{.backend = key.first, .level = key.second, .measurements = logs.size()};
        speed.is_disturbed = disturbed.contains(key);
        const auto geometric_mean = [&of_key = logs](std::span<const std::size_t> items) {
            double sum = 0;
            for (const std::size_t i : items) sum += of_key[i];
            return std::exp(sum / static_cast<double>(items.size()));
        };
        std::vector<std::size_t> all(logs.size());
        std::iota(all.begin(), all.end(), std::size_t{0});
        speed.ratio = geometric_mean(all);
        speed.ratio_95 = bootstrap_interval_95(logs.size(), geometric_mean);
        if (std::vector<double>& of_t = errors[key]; !of_t.empty()) speed.median_p99_ulp = median(std::move(of_t));
        speeds.push_back(std::move(speed));
    }
    return speeds;
}

const Speed* find(std::span<const Speed> speeds, std::string_view backend, std::string_view level) {
    for (const Speed& speed : speeds)
        if (speed.backend == backend && speed.level == level) return &speed;
    return nullptr;
}

Verdict verdict_of(std::span<const Record> records) {
    Verdict verdict;
    const std::vector<Finding> findings = findings_of(records);
    const std::string driver = driver_backend(records);
    const std::string_view stiff = "WSTNIBFLVRGCDP";
    verdict.has_driver = !driver.empty();
    verdict.are_we_right = faults_of_ours(records) == 0;
    verdict.is_driver_right = faults_of(records, "driver") == 0;
    verdict.cases = catalogued(stiff);
    verdict.cases_run = results_of(records, stiff).run.size();
    verdict.headline = headline_of(verdict, wrongs_of(records, findings, driver), faults_of_ours(records));
    for (const Mistake mistake : all_mistakes) {
        const Finding* ours = find(findings, "sw", mistake);
        const Finding* theirs = find(findings, driver, mistake);
        if (theirs)
            verdict.sentences.push_back(sentence_of(*theirs, ours));
        else if (ours)
            verdict.sentences.push_back(sentence_of(*ours, nullptr));
    }
    add_results(verdict, records, "K", "Acceleration structures");
    add_results(verdict, records, "STNIBF", "Scale, shape, input, instances, builds and arithmetic");
    add_results(verdict, records, "VRGCDP", "View factors, radiosity, light, collisions, distances and pictures");
    add_speed(verdict, speeds_of(records), driver);
    return verdict;
}

void print_summary(std::ostream& out, std::span<const Record> records) {
    const Verdict verdict = verdict_of(records);
    out << verdict.headline << '\n';
    for (const Sentence& sentence : verdict.sentences) {
        const bool is_judged = sentence.kind == Sentence::Kind::wrong || sentence.kind == Sentence::Kind::right;
        out << "  " << (is_judged ? word_of(sentence.kind) : "     ") << "  " << sentence.about << ": " << sentence.text
            << '\n';
    }
    std::map<std::string, std::size_t> sums;
    for (const Record& record : records) {
        ++sums[result_of(record)];
        if (record.fault_of == "twinray")
            out << "  " << record.case_id << ' ' << record.backend << ' ' << record.level << ' ' << result_of(record)
                << ": " << record.faults << " of " << record.n << (record.reason.empty() ? "" : "; ") << record.reason
                << (record.example.empty() ? "" : "; ") << record.example << '\n';
    }
    std::vector<std::string> parts;
    for (const auto& [kind, count] : sums) parts.push_back(text(kind, ' ', count));
    out << "  " << joined(parts) << '\n';
}

}  // namespace twinray::report
