// SPDX-License-Identifier: MIT
#include "samples/support/program.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "engine/core/platform.h"
#include "samples/support/text.h"

namespace twinray::samples {

void add_device_options(CLI::App& app, DeviceOptions& options, const std::string& validation_help) {
    app.add_option("--accel", options.accel,
                   "accelerator: hw (ray tracing extensions), sw (compute shaders), or auto: hw if the device supports "
                   "it and is not a CPU, else sw")
        ->check(CLI::IsMember({"auto", "sw", "hw"}))
        ->option_text("auto|sw|hw [auto]");
    app.add_option(
        "--device", options.device,
        "index of the device or part of its name, as `twinray devices` prints them; default: the fastest device");
    app.add_flag("--validation", options.validation, validation_help);
    app.add_flag("--quiet", options.quiet, "print only errors");
}

CLI::Option* add_path(CLI::App& app, const std::string& name, std::filesystem::path& target, const std::string& help) {
    const auto take = [&target](const std::string& word) { target = platform::path_of(word); };
    return app.add_option_function<std::string>(name, take, help);
}

std::optional<int> parse(CLI::App& app, int argc, char** argv, const std::string& program) {
    app.allow_windows_style_options(false);  // a name of a file may begin with a slash on every system
    try {
        std::vector<std::string> words = platform::arguments_of(argc, argv);
        std::ranges::reverse(words);  // as CLI11 takes them
        app.parse(std::move(words));
    } catch (const CLI::Success& help) {
        return app.exit(help);
    } catch (const CLI::ParseError& error) {
        std::fprintf(stderr, "%s: %s (see %s --help)\n", program.c_str(), error.what(), program.c_str());
        return 2;
    }
    return {};
}

ContextDesc context_desc(const DeviceOptions& options, const std::string& program) {
    ContextDesc desc;
    desc.name = program;
    desc.device = options.device;
    desc.validation = options.validation;
    desc.log = [program, is_silent = options.quiet && !options.validation](std::string_view message) {
        if (!is_silent)
            std::fprintf(stderr, "%s: %.*s\n", program.c_str(), static_cast<int>(message.size()), message.data());
    };
    if (const char* disabled = std::getenv("TWINRAY_DISABLE")) disable_features(desc, disabled);
    return desc;
}

void append_line(const std::filesystem::path& file, const std::string& line) {
    if (file.empty()) return;
    std::ofstream out(file, std::ios::app);
    if (!(out << line << '\n').flush()) fail("'", file.string(), "': cannot be written");
}

void report_warnings(const std::vector<std::string>& warnings, const std::filesystem::path& scene,
                     const std::string& program, bool is_strict, bool is_quiet) {
    if (!is_quiet || is_strict)
        for (const std::string& warning : warnings) std::fprintf(stderr, "%s: %s\n", program.c_str(), warning.c_str());
    if (is_strict && !warnings.empty())
        fail("'", scene.string(), "': ", warnings.size(), " warning(s), which --strict treats as errors");
}

}  // namespace twinray::samples
