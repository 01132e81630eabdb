// SPDX-License-Identifier: MIT
#include "samples/path_tracer/view.h"

#include <unistd.h>

#include <sstream>

#include "samples/support/text.h"

namespace twinray::path_tracer {
namespace {

void add(std::vector<std::string>& words, const std::string& option, const std::vector<double>& numbers) {
    words.push_back(option);
    for (const double number : numbers) {
        std::ostringstream out;
        out.precision(17);
        out << number;
        words.push_back(out.str());
    }
}

std::vector<std::string> command_line(const Options& options) {
    std::vector<std::string> words = {"twinray", "view", options.scene.string(), "--layer", "path"};
    if (options.accel != "auto") words.insert(words.end(), {"--show", options.accel});
    if (!options.device.empty()) words.insert(words.end(), {"--device", options.device});
    if (!options.look_from.empty()) {
        std::vector<double> camera = options.look_from;
        camera.insert(camera.end(), options.look_at.begin(), options.look_at.end());
        add(words, "--camera", camera);
        add(words, "--up", {options.up.begin(), options.up.end()});
        add(words, "--fov", {options.fov});
    }
    if (options.width && options.height) add(words, "--size", {double(options.width), double(options.height)});
    if (options.exposure) add(words, "--exposure", {*options.exposure});
    return words;
}

}  // namespace

void view(const Options& options) {
    if (options.scene.string().starts_with("builtin:"))
        samples::fail("--view: '", options.scene.string(), "' is no file");
    if ((options.width == 0) != (options.height == 0)) samples::fail("--view: --width and --height go together");
    std::vector<std::string> words = command_line(options);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    std::error_code none;
    const std::filesystem::path beside =
        std::filesystem::read_symlink("/proc/self/exe", none).parent_path() / "twinray";
    execv(beside.c_str(), arguments.data());
    execvp("twinray", arguments.data());
    samples::fail("--view: there is no command twinray, neither in '", beside.parent_path().string(), "' nor in PATH");
}

}  // namespace twinray::path_tracer
