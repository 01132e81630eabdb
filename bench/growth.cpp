// SPDX-License-Identifier: MIT
#include "bench/growth.h"

#include <algorithm>
#include <cmath>

#include "bench/report.h"
#include "bench/table.h"
#include "engine/core/statistics.h"

namespace twinray::bench {
namespace {

struct RayColumn {
    const char* field;
    const char* heading;
    double GrowthPoint::*value;
};
constexpr RayColumn ray_columns[] = {{"primary_ns_per_ray", "primary ns/ray", &GrowthPoint::primary},
                                     {"incoherent_ns_per_ray", "incoherent ns/ray", &GrowthPoint::incoherent}};

double median_ns(const Measured& measured, RayKind kind, std::size_t backend) {
    const auto traces = measured.traces.find(kind);
    return traces == measured.traces.end() ? NAN : spread_of(traces->second[backend].ns_per_ray).median;
}

std::vector<double> values_of(std::span<const GrowthPoint> points, double GrowthPoint::*value) {
    std::vector<double> values;
    for (const GrowthPoint& point : points) values.push_back(point.*value);
    return values;
}

std::vector<double> sizes_of(std::span<const GrowthPoint> points) {
    std::vector<double> sizes;
    for (const GrowthPoint& point : points) sizes.push_back(static_cast<double>(point.triangles));
    return sizes;
}

// Over log2 of the sizes; nothing for fewer than two, or where a point was not measured.
std::optional<Line> line_of(std::span<const GrowthPoint> points, const RayColumn& column) {
    std::vector<double> x = sizes_of(points);
    const std::vector<double> y = values_of(points, column.value);
    for (double& size : x) size = std::log2(size);
    const bool is_measured = std::all_of(y.begin(), y.end(), [](double value) { return std::isfinite(value); });
    if (!is_measured || x.front() == x.back()) return std::nullopt;
    return fit_line(x, y);
}

std::optional<PowerLaw> build_power_of(std::span<const GrowthPoint> points) {
    return fit_power_law(sizes_of(points), values_of(points, &GrowthPoint::build_ms));
}

}  // namespace

GrowthPoint growth_point(const BenchScene& scene, const Measured& measured, std::size_t backend) {
    GrowthPoint point{.triangles = count_mesh_triangles(scene.scene)};
    if (const std::vector<double>& ms = measured.builds[backend].ms; !ms.empty()) {
        point.build_ms = spread_of(ms).median;
        point.build = point.build_ms * 1e6 / static_cast<double>(point.triangles);
    }
    point.primary = median_ns(measured, RayKind::primary, backend);
    point.incoherent = median_ns(measured, RayKind::incoherent, backend);
    return point;
}

void print_growth(std::ostream& out, const std::string& backend, std::span<const GrowthPoint> points) {
    std::vector<std::vector<std::string>> rows = {{backend, "build ms", "ns/triangle"}};
    for (const RayColumn& column : ray_columns) rows.back().emplace_back(column.heading);
    for (const GrowthPoint& point : points) {
        rows.push_back({std::to_string(point.triangles) + " triangles", number_text(point.build_ms, 3),
                        number_text(point.build, 3)});
        for (const RayColumn& column : ray_columns) rows.back().push_back(number_text(point.*column.value, 3));
    }
    const std::optional<PowerLaw> power = build_power_of(points);
    rows.push_back({"growth", power ? "n^" + fixed_text(power->slope, 2) : "-", ""});
    for (const RayColumn& column : ray_columns) {
        const std::optional<Line> line = line_of(points, column);
        rows.back().push_back(line ? number_text(line->slope, 3) + " a doubling" : "-");
    }
    print_table(out, rows);
}

nlohmann::json growth_record(const nlohmann::json& base, const Labels& labels, std::span<const GrowthPoint> points) {
    nlohmann::json growth = {{"build_ms", nullptr}};
    if (const std::optional<PowerLaw> power = build_power_of(points)) growth["build_ms"] = {{"power", power->slope}};
    for (const RayColumn& column : ray_columns) {
        growth[column.field] = nullptr;
        if (const std::optional<Line> line = line_of(points, column))
            growth[column.field] = {{"offset", line->offset}, {"per_doubling", line->slope}};
    }
    nlohmann::json record = base;
    record.update({{"schema", record_schema},
                   {"contestant", labels.name},
                   {"backend", labels.backend},
                   {"layout", labels.layout},
                   {"builder", labels.builder},
                   {"level", labels.level},
                   {"triangles_from", points.front().triangles},
                   {"triangles_to", points.back().triangles},
                   {"growth", growth}});
    return record;
}

}  // namespace twinray::bench
