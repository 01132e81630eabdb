// SPDX-License-Identifier: MIT
// The common part of the samples with a command line: options of the device, a context and an accelerator for them.
#pragma once

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>

#include <twinray/tlas.h>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace twinray::samples {

struct DeviceOptions {
    std::string accel = "auto";  // for choose_accel()
    std::string device;          // index, or a part of the name; "": the best
    bool validation = false;
    bool quiet = false;
};

// Adds --accel, --device, --validation, --quiet.
void add_device_options(CLI::App& app, DeviceOptions& options, const std::string& validation_help);

// Adds an option that names a file.
CLI::Option* add_path(CLI::App& app, const std::string& name, std::filesystem::path& target, const std::string& help);
// Returns the exit status of a finished run: help was shown (0) or the usage is wrong (2). `program`: its name, for the
// message.
std::optional<int> parse(CLI::App& app, int argc, char** argv, const std::string& program);

// Messages go to stderr after the program's name; with --quiet only those of the validation layer. Ray tracing
// extensions that TWINRAY_DISABLE names, a comma-separated list of ray_query and ray_tracing_pipeline, stay unused.
ContextDesc context_desc(const DeviceOptions& options, const std::string& program);

// Appends a line to a file, as --json does; nothing for an empty name. Throws Error naming the file.
void append_line(const std::filesystem::path& file, const std::string& line);

// Prints the "warning(s)" of a scene after the program's name unless quiet. Throws Error naming the file if there are
// any and is_strict.
void report_warnings(const std::vector<std::string>& warnings, const std::filesystem::path& scene,
                     const std::string& program, bool is_strict, bool is_quiet);

// Runs main() of a program: an exception's text goes to stderr after the program's name, and the exit status is then 1.
template <class Run>
int run_program(const char* program, const Run& run) {
    try {
        const int status = run();
        if (std::fflush(stdout) == 0 && std::cout.flush() && !std::ferror(stdout)) return status;
        throw Error("the standard output cannot be written");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: %s\n", program, error.what());
        return 1;
    }
}

}  // namespace twinray::samples
