// SPDX-License-Identifier: MIT
// The command `twinray`.
#include <iostream>

#include "cli/common.h"

int main(int argc, char** argv) {
    CLI::App app("twinray: Vulkan ray tracing with two acceleration structures that check each other");
    app.require_subcommand(1);
    int exit_code = 0;
    twinray::cli::add_devices(app, exit_code);
    twinray::cli::add_trace(app, exit_code);
    twinray::cli::add_verify(app, exit_code);
    twinray::cli::add_leaks(app, exit_code);
    twinray::cli::add_bench(app, exit_code);
    twinray::cli::add_report(app, exit_code);
    twinray::cli::add_viewfactors(app, exit_code);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    } catch (const std::exception& error) {
        std::cerr << "twinray: " << error.what() << '\n';
        return 1;
    }
    return exit_code;
}
