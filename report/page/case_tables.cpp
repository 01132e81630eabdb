#include "report/page/page.h"

#include <algorithm>
#include <map>

#include "engine/core/error.h"
#include "report/page/verdict.h"
#include "report/page/wording.h"

namespace twinray::report {
namespace {

using Key = std::array<std::string, 3>;  // backend, level, variant

// The records of a case that share an accelerator, a level and a variant.
struct Group {
    std::vector<const Record*> records;

    std::uint64_t n() const { return sum(&Record::n); }
    std::uint64_t faults() const { return sum(&Record::faults); }
    bool is_disturbed() const {
        return std::ranges::any_of(records, [](const Record* r) { return r->time && r->time->is_disturbed(); });
    }
    // Returns the worst of them: a fault of twinray, then one of the driver, then a pass.
    const Record& worst() const {
        const auto rank = [](const Record* record) {
            return !record->pass ? 0 : *record->pass ? 1 : record->fault_of == "twinray" ? 3 : 2;
        };
        return **std::ranges::max_element(records, {}, rank);
    }

  private:
    std::uint64_t sum(std::uint64_t Record::*of) const {
        std::uint64_t total = 0;
        for (const Record* record : records) total += record->*of;
        return total;
    }
};

// Returns "120 to 340" over all settings.
template <class Of>
std::string range(const Group& group, const Of& of) {
    std::optional<Interval> all;
    for (const Record* record : group.records)
        if (const std::optional<double> value = of(*record))
            all = all ? Interval{std::min(all->low, *value), std::max(all->high, *value)} : Interval{*value, *value};
    if (!all) return "";
    return number(all->low) + (all->low == all->high ? "" : " to " + number(all->high));
}

std::string unit_of(const Group& group, bool of_time) {
    for (const Record* record : group.records) {
        if (of_time && record->time) return record->time->metric == "ns_per_ray" ? "" : ' ' + record->time->metric;
        if (!of_time && record->error) return record->error->metric == "t_ulp" ? "" : ' ' + record->error->metric;
    }
    return "";
}

std::string style_of(const Record& record) {
    if (!record.pass) return "measured";
    return *record.pass ? "pass" : record.fault_of;
}

std::string classes_of(const Group& group) {
    std::map<std::string, std::uint64_t> sums;
    for (const Record* record : group.records)
        for (const auto& [kind, count] : record->counts)
            if (kind != "AGREE" && kind != "TIE") sums[kind] += count;
    std::vector<std::string> parts;
    for (const auto& [kind, count] : sums) parts.push_back(kind + ' ' + count_text(count));
    return joined(parts);
}

std::string fault_text(const Record& record) {
    return escaped(settings_text(record)) + ' ' + escaped(record.reason) + " <code>" + escaped(record.example) +
           "</code>";
}

constexpr std::array<const char*, 8> columns{"by", "settings", "n", "faults", "classes", "error", "time", "result"};

// A row of a case's table.
struct TableRow {
    std::array<std::string, columns.size()> cells;
    std::string style;  // of the result
    std::string fault;  // the worst, with its replay; empty: none
};

// `told`: the faults in the rows above, which are not repeated.
TableRow row_of(const Key& key, const Group& group, std::set<std::string>& told) {
    const Record& worst = group.worst();
    TableRow row{{escaped(key[1].empty() ? key[0] : key[0] + ' ' + key[1]) +
                      (key[2].empty() ? "" : " (" + escaped(key[2]) + ')'),
                  text(group.records.size()), count_text(group.n()),
                  group.faults() ? rate_text(group.faults(), group.n()) : "0", escaped(classes_of(group)),
                  range(group, [](const Record& r) { return r.error ? std::optional(r.error->p99) : std::nullopt; }) +
                      escaped(unit_of(group, false)),
                  range(group, [](const Record& r) { return r.time ? std::optional(r.time->median) : std::nullopt; }) +
                      escaped(unit_of(group, true)) + (group.is_disturbed() ? " &#8224;" : ""),
                  escaped(result_of(worst))},
                 style_of(worst),
                 ""};
    if (worst.pass.value_or(true) || (worst.reason.empty() && worst.example.empty())) return row;
    const std::string fault = fault_text(worst);
    row.fault = told.insert(fault).second ? fault : "as above";
    if (!worst.replay.empty()) row.fault += " <a href=\"" + escaped(worst.replay) + "\">replay</a>";
    return row;
}

// Leaves out the columns that are empty in every row.
void write_table(std::ostream& out, const std::vector<TableRow>& rows) {
    std::vector<std::size_t> used;
    for (std::size_t i = 0; i < columns.size(); ++i)
        if (std::ranges::any_of(rows, [i](const TableRow& row) { return !row.cells[i].empty(); })) used.push_back(i);
    out << "<div class=\"wide\"><table><tr>";
    for (const std::size_t i : used) out << "<th>" << columns[i] << "</th>";
    out << "</tr>\n";
    for (const TableRow& row : rows) {
        out << "<tr>";
        for (const std::size_t i : used)
            out << (i + 1 == columns.size() ? "<td class=\"" + row.style + "\">" : "<td>") << row.cells[i] << "</td>";
        out << "</tr>\n";
        if (!row.fault.empty()) out << "<tr><td colspan=\"" << used.size() << "\">" << row.fault << "</td></tr>\n";
    }
    out << "</table></div>";
}

// Returns whether it is a control that shows faults, as it must.
bool is_control_that_passes(const Record& record) { return !is_users_kernel(record) && record.pass == true; }

void write_case(std::ostream& out, const frame::Case& row, const std::vector<const Record*>& records) {
    std::vector<Key> order;
    std::map<Key, Group> groups;
    std::size_t controls = 0;
    for (const Record* record : records) {
        if (is_control_that_passes(*record)) {
            ++controls;
            continue;
        }
        const Key key{record->backend, record->level, record->variant};
        if (groups[key].records.empty()) order.push_back(key);
        groups[key].records.push_back(record);
    }
    const Group all{records};
    out << "<details id=\"" << row.id << "\"><summary><span class=\"" << style_of(all.worst()) << "\">" << row.id
        << "</span> " << escaped(row.title) << "</summary>\n<p>Measures " << escaped(row.measures)
        << ". Passes with: " << escaped(row.criterion) << '.'
        << (controls ? text(" Controls that show faults, as they must: ", controls, '.') : "") << "</p>\n";
    std::set<std::string> told;
    std::vector<TableRow> rows;
    for (const Key& key : order) rows.push_back(row_of(key, groups[key], told));
    if (!rows.empty()) write_table(out, rows);
    out << "</details>\n";
}

}  // namespace

void write_case_tables(std::ostream& out, const PageInput& input) {
    char section = 0;
    for (const frame::Case& row : input.catalogue) {
        std::vector<const Record*> records;
        for (const Record& record : input.records)
            if (record.case_id == row.id && record.was_run) records.push_back(&record);
        if (records.empty()) continue;
        if (row.id.front() != section) {
            section = row.id.front();
            out << "<h3 id=\"" << section << "\">" << section << ": " << escaped(suite::section_of(row.id))
                << "</h3>\n";
        }
        write_case(out, row, records);
    }
}

void write_not_run(std::ostream& out, const PageInput& input) {
    std::map<std::pair<std::string, std::string>, std::set<std::string>> groups;
    for (const Record& record : input.records)
        if (!record.was_run) groups[{record.backend + ' ' + record.level, record.reason}].insert(record.case_id);
    if (groups.empty()) {
        out << "<p>Every case ran on every selected accelerator and level.</p>\n";
        return;
    }
    out << "<div class=\"wide\"><table><tr><th>on</th><th>cases</th><th>why</th></tr>\n";
    for (const auto& [key, cases] : groups)
        out << "<tr><td>" << escaped(key.first == " " ? "all" : key.first) << "</td><td>"
            << (cases.size() > 12 ? count_text(cases.size()) + " cases"
                                  : escaped(joined({cases.begin(), cases.end()}, " ")))
            << "</td><td>" << escaped(key.second) << "</td></tr>\n";
    out << "</table></div>\n";
}

}  // namespace twinray::report
