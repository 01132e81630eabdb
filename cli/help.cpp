// SPDX-License-Identifier: MIT
// `twinray help` and `twinray completion`: what the commands say of themselves, for terminals, man and shells.
#include <algorithm>
#include <fstream>
#include <iostream>
#include <memory>

#include "cli/command/completion.h"
#include "cli/command/help_text.h"
#include "cli/command/man_page.h"
#include "cli/command/values.h"
#include "cli/commands.h"
#include "engine/core/error.h"
#include "twinray_version.h"

namespace twinray::cli {
namespace {

struct HelpOptions {
    std::string command;
    std::filesystem::path folder;
    bool is_man = false;
};

struct CompletionOptions {
    std::string shell;
    std::filesystem::path file;
};

void write_text(const std::filesystem::path& file, const std::string& text) {
    std::ofstream out(file);
    if (!(out << text).flush()) fail("'", file.string(), "' cannot be written");
}

void write_man_pages(const std::filesystem::path& folder, const std::vector<Command>& commands) {
    std::filesystem::create_directories(folder);
    write_text(folder / "twinray.1", man_page(std::span(commands), twinray_version));
    for (const Command& command : commands)
        write_text(folder / ("twinray-" + command.name + ".1"), man_page(command, twinray_version));
}

void run(const HelpOptions& options) {
    const std::vector<Command> commands = all_commands();
    if (!options.folder.empty()) return write_man_pages(options.folder, commands);
    if (options.command.empty()) {
        std::cout << (options.is_man ? man_page(std::span(commands), twinray_version)
                                     : list_text(commands, terminal_width()));
        return;
    }
    const Command& command = *std::ranges::find(commands, options.command, &Command::name);
    std::cout << (options.is_man ? man_page(command, twinray_version) : help_text(command, terminal_width()));
}

void run(const CompletionOptions& options) {
    const std::vector<Command> commands = all_commands();
    const std::string script = options.shell == "bash"  ? bash_completion(commands)
                               : options.shell == "zsh" ? zsh_completion(commands)
                                                        : fish_completion(commands);
    if (options.file.empty())
        std::cout << script;
    else
        write_text(options.file, script);
}

}  // namespace

Command help_command(const std::vector<std::string>& names) {
    const auto options = std::make_shared<HelpOptions>();
    Option command{.value = choice(options->command, names), .help = "which; if not given, all are listed"};
    command.value.metavar = "COMMAND";
    return {.name = "help",
            .group = "Help",
            .summary = "tell all of a command, or list the commands",
            .description = "Prints what `twinray COMMAND --help` prints, or the page for man.",
            .positionals = {command},
            .sections = {{"Man pages",
                          {{.name = "--man", .value = flag(options->is_man), .help = "in roff, for man"},
                           {.name = "--output",
                            .letter = 'o',
                            .value = folder(options->folder),
                            .help = "written: the pages of all commands, and twinray.1",
                            .needs = {"--man"},
                            .excludes = {"COMMAND"}}}}},
            .examples = {{"twinray help --man trace | man -l -", "a man page without installing it"}},
            .run = [options] {
                run(*options);
                return 0;
            }};
}

Command completion_command() {
    const auto options = std::make_shared<CompletionOptions>();
    Option shell{.value = choice(options->shell, {"bash", "zsh", "fish"}), .help = "which", .is_required = true};
    shell.value.metavar = "SHELL";
    return {
        .name = "completion",
        .group = "Help",
        .summary = "print a script by which a shell completes commands, options and their values",
        .description =
            "Prints a script for bash, zsh or fish. Where twinray is installed, its scripts are in the places where "
            "these shells look for them.",
        .positionals = {shell},
        .sections = {{"Output",
                      {{.name = "--output",
                        .letter = 'o',
                        .value = file(options->file),
                        .help = "written instead of standard output"}}}},
        .examples = {{"source <(twinray completion bash)", "in this shell; in ~/.bashrc, in all of them"}},
        .run = [options] {
            run(*options);
            return 0;
        }};
}

}  // namespace twinray::cli
