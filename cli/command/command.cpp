#include "cli/command/command.h"

#include <algorithm>

namespace twinray::cli {

const Option& help_option() {
    static const Option option{.name = "--help", .letter = 'h', .help = "print this text"};
    return option;
}

std::vector<const Option*> options_of(const Command& command) {
    std::vector<const Option*> options;
    for (const Section& section : command.sections)
        for (const Option& option : section.options) options.push_back(&option);
    options.push_back(&help_option());
    return options;
}

std::vector<std::string> names_of(std::span<const Command> commands) {
    std::vector<std::string> names;
    for (const Command& command : commands) names.push_back(command.name);
    return names;
}

std::string head_of(const Option& option) {
    if (option.name.empty()) return option.value.metavar;
    std::string head = option.letter ? std::string("-") + option.letter + ", " + option.name : option.name;
    if (option.value.most > 0)
        head += option.value.least > 0 ? ' ' + option.value.metavar : " [" + option.value.metavar + ']';
    return head;
}

std::string text_of(const Option& option) {
    const Value& value = option.value;
    std::string extra;
    const auto add = [&](const std::string& what) { extra += (extra.empty() ? "" : ", ") + what; };
    if (!value.limits.empty()) add(value.limits);
    if (value.is_repeatable) add("may be given more than once");
    if (!value.initial.empty()) add("default: " + value.initial);
    return extra.empty() ? option.help : option.help + " (" + extra + ')';
}

std::string synopsis_of(const Command& command) {
    std::string line = command.name.empty() ? "twinray" : "twinray " + command.name;
    const auto long_head = [](const Option& option) {
        return option.letter ? head_of(option).substr(4) : head_of(option);
    };
    for (const Option& positional : command.positionals)
        line += positional.is_required ? ' ' + head_of(positional) : " [" + head_of(positional) + ']';
    const std::vector<const Option*> options = options_of(command);
    for (const Option* option : options)
        if (option->is_required) line += ' ' + long_head(*option);
    for (const Alternatives& alternatives : command.alternatives) {
        if (!alternatives.is_required) continue;
        std::string any;
        for (const std::string& name : alternatives.names)
            any += (any.empty() ? "" : " | ") + long_head(**std::ranges::find(options, name, &Option::name));
        line += " (" + any + ')';
    }
    return line + " [OPTION]...";
}

std::vector<Item> exit_statuses_of(const Command& command) {
    const std::string failure =
        "the command failed; a line on standard error names the cause, such as no device, a file that cannot be read "
        "or written, or no memory";
    return {{"0", "done" + (command.fault.empty() ? std::string() : ", and no fault was found")},
            {"1", command.fault.empty() ? failure : command.fault + "; or " + failure},
            {"2", "the command line is wrong"}};
}

std::vector<Item> environment_variables() {
    return {
        {"TWINRAY_DISABLE",
         "comma-separated list of ray_query and ray_tracing_pipeline: features of the device that twinray does not "
         "use"},
        {"TWINRAY_TUNING",
         "gpu or cpu_driver: the kind of device to tune kernels for, instead of the detected kind; hits are the same"}};
}

}  // namespace twinray::cli
