// SPDX-License-Identifier: MIT
#include "cli/kernels/builds.h"

#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/core/dry_device.h"
#include <twinray/geometry.h>
#include <twinray/tlas.h>
#include "cli/kernels/traffic.h"

namespace twinray::kernels {
namespace {

BuildRow row_of(const char* what, const AccelOptions& options, const BuildTraffic& traffic) {
    const RecordedWork work = take_recorded_work();
    return {what,
            std::string(name_of(options.layout)),
            std::string(name_of(options.build_quality)),
            work.dispatches,
            work.barriers,
            work.copies,
            traffic.read,
            traffic.written};
}

}  // namespace

std::vector<BuildRow> list_builds(Context& context) {
    Mesh mesh = make_icosphere(6);
    std::vector<BuildRow> rows;
    for (const Layout layout : all_layouts)
        for (const BuildQuality quality : all_build_qualities) {
            const AccelOptions options{.layout = layout, .build_quality = quality};
            SwTlas accel(context, options);
            const AccelHandle handle = accel.push(mesh);
            take_recorded_work();
            accel.sync();
            rows.push_back(row_of("build", options, build_traffic(layout, quality)));
            if (quality != BuildQuality::fast) continue;
            // The first move measures the tree as it was built, too.
            for (int move = 0; move < 2; ++move) {
                take_recorded_work();
                accel.update_vertices(handle, mesh.positions);
                accel.sync();
            }
            rows.push_back(row_of("refit", options, refit_traffic(layout)));
        }
    return rows;
}

std::string table_of(std::span<const BuildRow> rows) {
    std::ostringstream out;
    out << std::left << std::setw(7) << "what" << std::setw(13) << "layout" << std::setw(9) << "quality" << std::right
        << std::setw(11) << "dispatches" << std::setw(10) << "barriers" << std::setw(8) << "copies" << std::setw(15)
        << "read/triangle" << std::setw(10) << "written" << '\n';
    for (const BuildRow& row : rows)
        out << std::left << std::setw(7) << row.what << std::setw(13) << row.layout << std::setw(9) << row.quality
            << std::right << std::setw(11) << row.dispatches << std::setw(10) << row.barriers << std::setw(8)
            << row.copies << std::setw(15) << static_cast<long>(row.read + 0.5) << std::setw(10)
            << static_cast<long>(row.written + 0.5) << '\n';
    return out.str();
}

nlohmann::json to_json(const BuildRow& row, const std::string& device) {
    return {{"device", device},
            {row.what, row.layout + ' ' + row.quality},
            {"dispatches", row.dispatches},
            {"barriers", row.barriers},
            {"copies", row.copies},
            {"read_bytes_per_triangle", row.read},
            {"written_bytes_per_triangle", row.written}};
}

}  // namespace twinray::kernels
