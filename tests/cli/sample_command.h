// A command with a value of each kind.
#pragma once

#include <optional>
#include <string>

#include "cli/command/values.h"

namespace twinray::cli {

inline bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

struct SampleValues {
    std::filesystem::path scene, output;
    std::vector<std::filesystem::path> pictures;
    std::string accel = "auto";
    std::vector<std::string> levels = {"fast"};
    unsigned count = 5;
    std::optional<double> within;
    std::vector<float> up = {0, 1, 0};
    bool is_growth = false, quiet = false;
    std::vector<double> growth = {20, 30};
};

inline Command sample_command(SampleValues& values) {
    Option scene{.value = file(values.scene), .help = "a mesh", .is_required = true};
    scene.value.metavar = "SCENE";
    return {
        .name = "probe",
        .group = "Tracing",
        .summary = "try values",
        .description = "Takes one of each.",
        .positionals = {scene},
        .sections =
            {{"Values",
              {{.name = "--accel", .value = choice(values.accel, {"auto", "sw", "hw"}), .help = "what traces"},
               {.name = "--levels",
                .value = choices(values.levels, {"fast", "watertight"}),
                .help = "levels; any of them"},
               {.name = "--count", .value = number(values.count, {1, 9}), .help = "how many", .former_name = "--rays"},
               {.name = "--within", .value = number(values.within, {.least = 0}), .help = "how far"},
               {.name = "--up", .value = numbers(values.up, "X Y Z"), .help = "where up is", .needs = {"--count"}},
               {.name = "--growth", .value = optional_list(values.is_growth, values.growth, {1, 1e6}), .help = "sizes"},
               {.name = "--picture",
                .value = files(values.pictures, {".png", ".glb"}),
                .help = "written",
                .excludes = {"--output"}}}},
             {"Output",
              {{.name = "--output", .letter = 'o', .value = folder(values.output), .help = "where to"},
               {.name = "--quiet", .value = flag(values.quiet), .help = "say nothing: not a word"}}}},
        .alternatives = {{.names = {"--within", "--growth"}}},
        .examples = {{"twinray probe a.ply --count 3", "three"}},
        .fault = "something is wrong"};
}

}  // namespace twinray::cli
