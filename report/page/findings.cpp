#include "report/page/verdict.h"

#include <algorithm>
#include <functional>
#include <map>

#include "engine/core/error.h"
#include "report/page/wording.h"
#include "report/suite/suite.h"

namespace twinray::report {
namespace {

// A row for each mistake, in their order: what is counted, what an accelerator that makes it does, and the cases that
// ask.
struct MistakeRow {
    std::string_view name, of_driver;
    suite::Subject subject;
};
constexpr std::array<MistakeRow, all_mistakes.size()> mistakes = {{
    {"rays lost at edges and vertices", "loses rays at edges and vertices", suite::Subject::aimed_rays},
    {"hits that do not exist", "reports hits that do not exist", suite::Subject::hits},
    {"distances beyond the error bound", "returns wrong distances", suite::Subject::hits},
    {"hits that are not finite", "returns numbers that are not finite", suite::Subject::hits},
    {"shared edges not counted exactly once", "does not count shared edges exactly once", suite::Subject::crossings},
}};
const MistakeRow& row_for(Mistake mistake) { return mistakes[static_cast<std::size_t>(mistake)]; }

// Returns whether a class is this mistake: SwTlas and the driver have their own classes.
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

// Returns whether the record's rays were checked for it. Level fast is its own negative control.
bool can_show(Mistake mistake, const Record& record) {
    if (!record.was_run || !(is_users_kernel(record) || record.level == "fast")) return false;
    if (record.params.contains("counted")) return mistake == Mistake::counted_wrong;
    return mistake != Mistake::counted_wrong && record.reference == "f64" && !record.counts.empty();
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

// Returns how many of these cases have rays among them.
std::size_t cases_run_of(std::span<const std::string_view> ids, std::span<const RayKind> kinds) {
    return static_cast<std::size_t>(std::ranges::count_if(ids, [&](std::string_view id) {
        return std::ranges::any_of(kinds, [&](const RayKind& kind) { return kind.case_id == id; });
    }));
}

// Makes each kind of rays a stratum, so that all kinds of one case together weigh as much as another case.
std::vector<Stratum> strata_of(std::span<const RayKind> kinds) {
    std::map<std::string, std::size_t> kinds_of_case;
    for (const RayKind& kind : kinds) ++kinds_of_case[kind.case_id];
    std::vector<Stratum> strata;
    for (const RayKind& kind : kinds)
        strata.push_back({kind.faults, kind.n, 1.0 / static_cast<double>(kinds_of_case[kind.case_id])});
    return strata;
}

std::uint64_t faults_in(std::span<const RayKind> kinds) {
    std::uint64_t sum = 0;
    for (const RayKind& kind : kinds) sum += kind.faults;
    return sum;
}

// Returns the finding of the level with the most faults, among the levels that promise to make none.
Finding finding_of(std::span<const Record> records, std::string_view backend, Mistake mistake) {
    std::vector<std::string> levels;
    for (const Record& record : records)
        if (record.backend == backend && record.level != "fast" && can_show(mistake, record) &&
            std::ranges::count(levels, record.level) == 0)
            levels.push_back(record.level);
    Finding worst;
    std::uint64_t most = 0;
    for (const std::string& level : levels) {
        Finding finding = finding_at(records, backend, level, mistake);
        const std::uint64_t faults = faults_in(finding.kinds) + faults_in(finding.elsewhere);
        if (!worst.level.empty() && faults <= most) continue;
        worst = std::move(finding);
        most = faults;
    }
    return worst;
}

// Returns "W04 {aim vertex}, 4.6 % (4.2 to 5)": the interval holds for all kinds together.
std::string worst_of(const Finding& finding) {
    const RayKind& worst =
        *std::ranges::max_element(finding.kinds, {}, [](const RayKind& kind) { return share(kind.faults, kind.n); });
    const double miss = 0.05 / static_cast<double>(finding.kinds.size());
    return worst.case_id + (worst.settings.empty() ? "" : " {" + worst.settings + '}') + ", " +
           rate_text(share(worst.faults, worst.n), rate_interval(worst.faults, worst.n, miss));
}

// Returns "N01 28 of 8,192, S02 ...": the three cases with the highest rates among the rays that show faults.
std::string text_of_elsewhere(std::span<const RayKind> kinds) {
    std::map<std::string, RayKind> by_case;
    for (const RayKind& kind : kinds) {
        RayKind& whole = by_case[kind.case_id];
        whole = {kind.case_id, "", whole.faults + kind.faults, whole.n + kind.n};
    }
    std::vector<RayKind> cases;  // one for all settings of a case
    for (auto& [id, whole] : by_case) cases.push_back(std::move(whole));
    std::ranges::stable_sort(cases, std::greater(), [](const RayKind& kind) { return share(kind.faults, kind.n); });
    std::vector<std::string> parts;
    for (const RayKind& whole : std::span(cases).first(std::min<std::size_t>(cases.size(), 3)))
        parts.push_back(whole.case_id + ' ' + count_text(whole.faults) + " of " + count_text(whole.n));
    if (cases.size() > 3) parts.push_back(text(cases.size() - 3, " more cases"));
    return joined(parts);
}

}  // namespace

bool Finding::has_faults() const { return faults_in(kinds) + faults_in(elsewhere) > 0; }

std::uint64_t Finding::n() const {
    std::uint64_t sum = 0;
    for (const RayKind& kind : kinds) sum += kind.n;
    return sum;
}

double Finding::rate() const { return mean_rate(strata_of(kinds)); }
Interval Finding::rate_95() const {
    // An interval from 0 can miss the truth on its upper side alone, which then gets the whole 5 %.
    return mean_rate_interval(strata_of(kinds), faults_in(kinds) ? 0.05 : 0.1);
}

std::string text_of(const Finding& finding) {
    const std::string cases = text(finding.cases_run, finding.cases_run == 1 ? " case" : " cases");
    std::string said;
    if (faults_in(finding.kinds))
        said = rate_text(finding.rate(), finding.rate_95()) + " over " + cases + ", most in " + worst_of(finding);
    else if (finding.n())
        said = text("0 of ", count_text(finding.n()), " rays of ", cases, " (below ",
                    share_text(finding.rate_95().high), ')');
    if (!finding.elsewhere.empty()) said += (said.empty() ? "in " : ", and in ") + text_of_elsewhere(finding.elsewhere);
    return finding.level == "watertight" ? said : "at " + finding.level + ' ' + said;
}

std::string_view name_of(Mistake mistake) { return row_for(mistake).name; }
std::string_view wrong_of(Mistake mistake) { return row_for(mistake).of_driver; }

Finding finding_at(std::span<const Record> records, std::string_view backend, std::string_view level, Mistake mistake) {
    const suite::Subject subject = row_for(mistake).subject;
    Finding finding{.backend = std::string(backend), .level = std::string(level), .mistake = mistake};
    for (const Record& record : records) {
        if (record.backend != backend || record.level != level || !can_show(mistake, record)) continue;
        const RayKind kind{record.case_id, settings_and_variant(record), count_of(mistake, record), record.n};
        if (suite::is_about(record.case_id, subject))
            finding.kinds.push_back(kind);
        else if (kind.faults)
            finding.elsewhere.push_back(kind);
    }
    const std::span<const std::string_view> ids = suite::cases_about(subject);
    finding.cases = ids.size();
    finding.cases_run = cases_run_of(ids, finding.kinds);
    return finding;
}

const Finding* find(std::span<const Finding> findings, std::string_view backend, Mistake mistake) {
    for (const Finding& finding : findings)
        if (finding.backend == backend && finding.mistake == mistake) return &finding;
    return nullptr;
}

std::vector<Finding> findings_of(std::span<const Record> records) {
    std::vector<Finding> findings;
    for (const char* backend : {"sw", "hw", "hw-pipeline"})
        for (const Mistake mistake : all_mistakes) {
            Finding finding = finding_of(records, backend, mistake);
            if (finding.n() || finding.has_faults()) findings.push_back(std::move(finding));
        }
    return findings;
}

}  // namespace twinray::report
