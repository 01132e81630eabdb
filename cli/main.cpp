// SPDX-License-Identifier: MIT
// The command `twinray`.
#include <cctype>
#include <iostream>

#include "cli/common.h"
#include "engine/core/cpu_vectors.h"

namespace {

// The arguments from the last to the first, as the parser wants them. It takes "-.5" for an option, "-0.5" for a
// number.
std::vector<std::string> reversed(int argc, char** argv) {
    std::vector<std::string> all;
    for (int i = argc; i-- > 1;) {
        std::string argument = argv[i];
        if (argument.size() > 2 && argument.starts_with("-.") && std::isdigit(static_cast<unsigned char>(argument[2])))
            argument.insert(1, "0");
        all.push_back(std::move(argument));
    }
    return all;
}

}  // namespace

int main(int argc, char** argv) {
    twinray::widen_cpu_vectors();
    CLI::App app("twinray: Vulkan ray tracing with two acceleration structures that check each other", "twinray");
    app.require_subcommand(1);
    int exit_code = 0;
    twinray::cli::add_devices(app, exit_code);
    twinray::cli::add_trace(app, exit_code);
    twinray::cli::add_verify(app, exit_code);
    twinray::cli::add_collide(app, exit_code);
    twinray::cli::add_distance(app, exit_code);
    twinray::cli::add_leaks(app, exit_code);
    twinray::cli::add_illumination(app, exit_code);
    twinray::cli::add_centroid(app, exit_code);
    twinray::cli::add_bench(app, exit_code);
    twinray::cli::add_report(app, exit_code);
    twinray::cli::add_viewfactors(app, exit_code);
    try {
        app.parse(reversed(argc, argv));
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    } catch (const std::exception& error) {
        std::cerr << "twinray: " << error.what() << '\n';
        return 1;
    }
    return exit_code;
}
