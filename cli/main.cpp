// The command `twinray`.
#include <cerrno>
#include <cstring>

#include "cli/common.h"
#include "engine/core/platform.h"
#include "twinray_version.h"
#include <twinray/context.h>

namespace twinray::cli {
namespace {

constexpr int done = 0, failed = 1, wrong_use = 2;

int refuse(const std::string& program, const std::string& why, const std::string& help) {
    std::cerr << program << ": " << why << (why.ends_with('?') ? " See '" : "; see '") << help << "'\n";
    return wrong_use;
}

int run(const Command& command, const std::vector<std::string>& arguments) {
    const std::string program = "twinray " + command.name;
    try {
        if (!parse(command, arguments)) {
            std::cout << help_text(command, terminal_width());
            return done;
        }
        return command.run();
    } catch (const UsageError& error) {
        return refuse(program, error.what(), program + " --help");
    } catch (const std::exception& error) {
        std::cerr << "twinray: " << error.what() << '\n';
        return failed;
    }
}

int refuse_command(const std::string& word, const std::vector<Command>& commands) {
    const std::vector<std::string> names = names_of(commands);
    const std::string nearest = nearest_to(word, names);
    const std::string meant = nearest.empty() ? ", but " + either_of(names) : "; did you mean " + nearest + '?';
    return refuse("twinray", "there is no command '" + word + '\'' + meant, "twinray help");
}

int run(const std::vector<std::string>& words) {
    const std::vector<Command> commands = all_commands();
    if (words.empty()) {
        std::cerr << list_text(commands, terminal_width());
        return wrong_use;
    }
    if (words[0] == "--help" || words[0] == "-h") {
        std::cout << list_text(commands, terminal_width());
        return done;
    }
    if (words[0] == "--version") {
        std::cout << "twinray " << twinray_version << '\n';
        return done;
    }
    const auto found = std::ranges::find(commands, words[0], &Command::name);
    if (found == commands.end()) return refuse_command(words[0], commands);
    return run(*found, {words.begin() + 1, words.end()});
}

}  // namespace

std::vector<Command> all_commands() {
    std::vector<Command> commands = {view_command(), trace_command(), devices_command(), verify_command(),
                                     leaks_command()};
#ifdef TWINRAY_HAS_REPORT
    for (const auto& make : {report_command, qualify_command}) commands.push_back(make());
#endif
#ifdef TWINRAY_HAS_BENCH
    commands.push_back(bench_command());
#endif
    for (const auto& make : {kernels_command, distance_command, collide_command, viewfactors_command,
                             illumination_command, visible_command, centroid_command, completion_command})
        commands.push_back(make());
    std::vector<std::string> names = names_of(commands);
    names.emplace_back("help");
    commands.push_back(help_command(names));
    return commands;
}

}  // namespace twinray::cli

int main(int argc, char** argv) {
    const int status = twinray::cli::run(twinray::platform::arguments_of(argc, argv));
    errno = 0;
    if (std::cout.flush()) return status;
    std::cerr << "twinray: the standard output cannot be written: "
              << (errno ? std::strerror(errno) : "an earlier line failed") << '\n';
    return status ? status : 1;
}
