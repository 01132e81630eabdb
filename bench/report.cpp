#include "bench/report.h"

#include <algorithm>
#include <iomanip>
#include <numeric>
#include <sstream>

#include "engine/core/fnv1a.h"
#include "engine/core/statistics.h"

namespace twinray::bench {
namespace {

using Row = std::vector<std::string>;

struct BaselineNames {
    Baseline baseline;
    const char* field;
    const char* heading;
};
// The last baseline has no column.
constexpr BaselineNames baselines[] = {{Baseline::sorted_query, "vs_ray_query_presorted", "vs query sorted"},
                                       {Baseline::input_query, "vs_ray_query", "vs query input"},
                                       {Baseline::pipeline, "vs_pipeline", "vs pipeline"},
                                       {Baseline::embree8, "vs_embree8", "vs embree8"},
                                       {Baseline::software, "vs_sw", nullptr}};
static_assert(std::size(baselines) == baseline_count);

std::string range(const Spread& spread) { return number_text(spread.min, 3) + ".." + number_text(spread.max, 3); }

double per_triangle(std::uint64_t amount, const Results& results) {
    return static_cast<double>(amount) /
           static_cast<double>(std::max<std::size_t>(count_mesh_triangles(results.scene.scene), 1));
}

template <class T>
nlohmann::json or_null(const std::optional<T>& value) {
    return value ? nlohmann::json(*value) : nlohmann::json();
}

Row trace_row(const Results& results, std::span<const TraceRounds> traces, std::size_t index) {
    const TraceRounds& rounds = traces[index];
    const Spread rate = mrays_per_s(rounds);
    Row row = {results.line_up[index]->labels().name, number_text(rate.median, 3), range(rate),
               std::to_string(rounds.n)};
    for (const BaselineNames& names : baselines) {
        if (!names.heading || !find(names.baseline, results.line_up)) continue;
        row.push_back(number_text(*speed_up(results.line_up, traces, index, names.baseline), 3));
    }
    const std::optional<Soundness>& soundness = rounds.soundness;
    row.push_back(soundness ? fixed_text(100 * soundness->sound, 4) : "-");
    row.push_back(soundness ? std::to_string(soundness->faults) : "-");
    row.push_back(rounds.hash ? hexadecimal(*rounds.hash) : "-");
    return row;
}

void add_build(nlohmann::json& record, const Results& results, const BuildRounds& build) {
    record["build_ms"] = record["build_wall_ms"] = nullptr;
    record["bytes_per_triangle"] = per_triangle(build.last.bytes, results);
    record["scratch_bytes_per_triangle"] = per_triangle(build.last.scratch_bytes, results);
    if (build.ms.empty()) return;
    const Spread ms = spread_of(build.ms);
    record["build_ms"] = ms.median;
    record["build_ms_min"] = ms.min;
    record["build_ms_max"] = ms.max;
    record["build_wall_ms"] = spread_of(build.wall_ms).median;
}

}  // namespace

void print_builds(std::ostream& out, const Results& results) {
    std::vector<Row> rows = {
        {"builds", "ms", "min..max", "wall ms", "ns/triangle", "bytes/triangle", "scratch bytes/triangle"}};
    const auto triangles = static_cast<double>(std::max<std::size_t>(count_mesh_triangles(results.scene.scene), 1));
    for (std::size_t i = 0; i < results.builds.size(); ++i) {
        const BuildRounds& build = results.builds[i];
        const Spread ms = spread_of(build.ms);
        rows.push_back({results.line_up[i]->labels().name, number_text(ms.median, 3), range(ms),
                        number_text(spread_of(build.wall_ms).median, 3), number_text(ms.median * 1e6 / triangles, 3),
                        number_text(per_triangle(build.last.bytes, results), 3),
                        number_text(per_triangle(build.last.scratch_bytes, results), 3)});
    }
    print_table(out, rows);
}

void print_traces(std::ostream& out, const Results& results, std::string_view title,
                  std::span<const TraceRounds> traces) {
    Row heading = {std::string(title), "Mrays/s", "min..max", "rays"};
    for (const BaselineNames& names : baselines)
        if (names.heading && find(names.baseline, results.line_up)) heading.emplace_back(names.heading);
    heading.insert(heading.end(), {"sound %", "faults", "hash of hits"});
    std::vector<Row> rows = {heading};
    for (std::size_t i = 0; i < traces.size(); ++i) rows.push_back(trace_row(results, traces, i));
    print_table(out, rows);
}

void record_traces(const RecordSink& record_one, const nlohmann::json& base, const Results& results, RayKind kind,
                   std::span<const TraceRounds> traces) {
    const dvec3& origin = results.scene.scene.origin;
    for (std::size_t i = 0; i < traces.size(); ++i) {
        const Labels& labels = results.line_up[i]->labels();
        const Spread rate = mrays_per_s(traces[i]);
        nlohmann::json record = base;
        record.update({{"schema", record_schema},
                       {"scene", results.scene.name},
                       {"origin", {origin.x, origin.y, origin.z}},
                       {"triangles", count_triangles(results.scene.scene)},
                       {"rays", name_of(kind)},
                       {"n", traces[i].n},
                       {"rounds", traces[i].ns_per_ray.size()},
                       {"contestant", labels.name},
                       {"backend", labels.backend},
                       {"path", labels.path},
                       {"order", labels.order},
                       {"layout", labels.layout},
                       {"builder", labels.builder},
                       {"level", labels.level},
                       {"ray_order", labels.ray_order},
                       {"mrays_per_s", rate.median},
                       {"mrays_per_s_min", rate.min},
                       {"mrays_per_s_max", rate.max}});
        add_build(record, results, results.builds[i]);
        for (const BaselineNames& names : baselines)
            record[names.field] = or_null(speed_up(results.line_up, traces, i, names.baseline));
        const std::optional<Soundness>& soundness = traces[i].soundness;
        record["agreement"] = soundness ? nlohmann::json(soundness->sound) : nlohmann::json();
        record["faults"] = soundness ? nlohmann::json(soundness->faults) : nlohmann::json();
        record["judged"] = soundness ? nlohmann::json(soundness->n) : nlohmann::json();
        record["hits_hash"] = traces[i].hash ? nlohmann::json(hexadecimal(*traces[i].hash)) : nlohmann::json();
        record_one(record);
    }
}

Spread spread_of(std::span<const double> values) {
    const auto [min, max] = std::ranges::minmax_element(values);
    return {median({values.begin(), values.end()}), *min, *max};
}

Spread mrays_per_s(const TraceRounds& rounds) {
    std::vector<double> rates;
    for (const double ns : rounds.ns_per_ray) rates.push_back(1e3 / ns);
    return spread_of(rates);
}

double speed_up(const TraceRounds& rounds, const TraceRounds& baseline) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < rounds.ns_per_ray.size(); ++i)
        ratios.push_back(baseline.ns_per_ray[i] / rounds.ns_per_ray[i]);
    return median(std::move(ratios));
}

std::optional<double> speed_up(const LineUp& line_up, std::span<const TraceRounds> all, std::size_t index,
                               Baseline baseline) {
    const std::optional<std::size_t> other = find(baseline, line_up);
    if (!other) return std::nullopt;
    return speed_up(all[index], all[*other]);
}

Line fit_line(std::span<const double> x, std::span<const double> y) {
    const auto n = static_cast<double>(x.size());
    const double mean_x = std::reduce(x.begin(), x.end()) / n, mean_y = std::reduce(y.begin(), y.end()) / n;
    double xx = 0, xy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        xy += (x[i] - mean_x) * (y[i] - mean_y);
    }
    return {mean_y - xy / xx * mean_x, xy / xx};
}

void print_table(std::ostream& out, const std::vector<std::vector<std::string>>& rows) {
    std::vector<std::size_t> widths(rows.front().size());
    for (const auto& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    for (const auto& row : rows) {
        for (std::size_t i = 0; i < row.size(); ++i)
            out << "  " << (i == 0 ? std::left : std::right) << std::setw(static_cast<int>(widths[i])) << row[i];
        out << '\n';
    }
}

std::string fixed_text(double value, int decimals) {
    std::ostringstream text;
    text << std::fixed << std::setprecision(decimals) << value;
    return text.str();
}

std::string number_text(double value, int digits) {
    if (!std::isfinite(value)) return "-";
    const int magnitude = value == 0 ? 0 : static_cast<int>(std::floor(std::log10(std::abs(value))));
    return fixed_text(value, std::max(0, digits - 1 - magnitude));
}

}  // namespace twinray::bench
