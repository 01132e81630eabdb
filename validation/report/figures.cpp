// SPDX-License-Identifier: MIT
#include "validation/report/figures.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "draw_plots.py.h"
#include "engine/core/error.h"

namespace twinray::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr int no_matplotlib = 3, no_program = 127;

Json json_of(const Interval& interval) { return {interval.low, interval.high}; }

Json json_of(const PlotCurve& curve) {
    Json points = Json::array();
    for (const PlotPoint& point : curve.points)
        points.push_back({{"label", point.label},
                          {"error", point.error},
                          {"error_95", json_of(point.error_95)},
                          {"time", point.time},
                          {"time_95", json_of(point.time_95)},
                          {"is_zero", point.is_zero}});
    Json fit;
    if (curve.fit)
        fit = {{"slope", curve.fit->slope}, {"scale", curve.fit->scale}, {"slope_95", json_of(curve.fit->slope_95)}};
    return {{"name", curve.name}, {"style", curve.style}, {"fit", fit}, {"points", points}};
}

void write_file(const std::filesystem::path& file, std::string_view text) {
    std::ofstream out(file);
    out << text;
    if (!out.flush()) fail("'", file.string(), "' cannot be written");
}

// Exit status of a program with its output discarded; no_program where it cannot be started.
int status_of(const char* program, const std::filesystem::path& script, const std::filesystem::path& folder) {
    std::string name = program, script_text = script.string(), folder_text = folder.string();
    char* const arguments[] = {name.data(), script_text.data(), folder_text.data(), nullptr};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    pid_t child = 0;
    const int failure = posix_spawnp(&child, program, &actions, nullptr, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    int status = 0;
    if (failure != 0 || waitpid(child, &status, 0) != child) return no_program;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

}  // namespace

std::string to_json(std::span<const Plot> plots) {
    Json all = Json::array();
    for (const Plot& plot : plots) {
        Json curves = Json::array();
        for (const PlotCurve& curve : plot.curves) curves.push_back(json_of(curve));
        all.push_back({{"id", plot.id},
                       {"title", plot.title},
                       {"error_label", plot.error_label},
                       {"time_label", plot.time_label},
                       {"floor", plot.floor ? Json(*plot.floor) : Json(nullptr)},
                       {"curves", curves}});
    }
    return all.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string draw_figures(const std::filesystem::path& folder, std::span<const Plot> plots) {
    const std::filesystem::path script = folder / "draw_plots.py";
    write_file(folder / "plots.json", to_json(plots));
    write_file(script, draw_plots_script);
    int status = no_program;
    // A python3 that comes first on the path may be another than Debian's, without its packages.
    for (const char* python : {"python3", "/usr/bin/python3"}) {
        status = status_of(python, script, folder);
        if (status != no_program && status != no_matplotlib) break;
    }
    const std::string again = "; then run: python3 " + script.string() + ' ' + folder.string();
    switch (status) {
        case 0: return text(plots.size(), " plots as SVG and PNG in ", (folder / "plots").string());
        case no_matplotlib:
            return "no PNG: matplotlib is missing (Debian: apt-get install python3-matplotlib" + again + ")";
        case no_program: return "no PNG: python3 is missing (Debian: apt-get install python3-matplotlib" + again + ")";
        default: return text("no PNG: ", script.string(), " failed with status ", status);
    }
}

}  // namespace twinray::report
