// `twinray help` and `twinray completion`: what the commands say of themselves, for terminals, man and shells.
#include "cli/common.h"
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
    Option command{.value = choice(options->command, names), .help = "command to describe; without it, all are listed"};
    command.value.metavar = "COMMAND";
    return {.name = "help",
            .group = "Help",
            .summary = "print the help of a command, or list the commands",
            .description = "Prints the same text as `twinray COMMAND --help`, or the man page.",
            .positionals = {command},
            .sections = {{"Man pages",
                          {{.name = "--man", .value = flag(options->is_man), .help = "print roff, for man"},
                           {.name = "--output",
                            .letter = 'o',
                            .value = folder(options->folder),
                            .help = "write the pages of all commands and twinray.1 to this folder",
                            .needs = {"--man"},
                            .excludes = {"COMMAND"}}}}},
            .examples = {{"twinray help --man trace | man -l -", "show a man page without installing it"}},
            .run = done_after([options] { run(*options); })};
}

Command completion_command() {
    const auto options = std::make_shared<CompletionOptions>();
    Option shell{
        .value = choice(options->shell, {"bash", "zsh", "fish"}), .help = "shell to complete for", .is_required = true};
    shell.value.metavar = "SHELL";
    return {.name = "completion",
            .group = "Help",
            .summary = "print a script with which a shell completes commands, options and values",
            .description =
                "Prints a script for bash, zsh or fish. An installed twinray already has its scripts in the folders "
                "that these shells search.",
            .positionals = {shell},
            .sections = {{"Output",
                          {output_option(file(options->file),
                                         "write the script to this file instead of standard output")}}},
            .examples = {{"source <(twinray completion bash)", "complete in this shell; in ~/.bashrc, in all shells"}},
            .run = done_after([options] { run(*options); })};
}

}  // namespace twinray::cli
