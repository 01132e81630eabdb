// SPDX-License-Identifier: MIT
#include "cli/command/help_text.h"

#include <algorithm>

namespace twinray::cli {
namespace {

// Escapes text for roff: hyphens can be copied, and nothing is a control line or an escape.
std::string escaped(const std::string& text) {
    std::string roff;
    for (const char c : text) {
        if (c == '\\')
            roff += "\\e";
        else if (c == '-')
            roff += "\\-";
        else if (c == '\'')
            roff += "\\(aq";
        else if (c == '"')
            roff += "\\(dq";
        else
            roff += c;
    }
    return roff.starts_with('.') ? "\\&" + roff : roff;
}

std::string title(std::string page, const std::string& version) {
    std::ranges::transform(page, page.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return ".TH \"" + page + "\" 1 \"\" \"twinray " + version + "\" \"User Commands\"\n";
}

std::string heading(const std::string& text) { return ".SH " + text + '\n'; }

std::string item(const std::string& head, const std::string& meaning) {
    return ".TP\n.B " + escaped(head) + '\n' + escaped(meaning) + '\n';
}

std::string items(const std::vector<Option>& options) {
    std::string roff;
    for (const Option& option : options) roff += item(head_of(option), text_of(option));
    return roff;
}

std::string section(const std::string& name, const std::vector<Item>& items) {
    std::string roff = heading(name);
    for (const auto& [head, meaning] : items) roff += item(head, meaning);
    return roff;
}

// Returns the sections that end every page.
std::string end(const Command& command, const std::string& see_also) {
    return section("EXIT STATUS", exit_statuses_of(command)) + section("ENVIRONMENT", environment_variables()) +
           heading("SEE ALSO") + see_also;
}

}  // namespace

std::string man_page(const Command& command, const std::string& version) {
    std::string roff = title("twinray-" + command.name, version);
    roff += heading("NAME") + escaped("twinray-" + command.name) + " \\- " + escaped(command.summary) + '\n';
    roff += heading("SYNOPSIS") + escaped(synopsis_of(command)) + '\n';
    roff += heading("DESCRIPTION") + escaped(command.description) + '\n';
    roff += heading("OPTIONS") + items(command.positionals);
    for (const Section& section : command.sections)
        roff += ".SS " + escaped(section.title) + '\n' + items(section.options);
    roff += ".SS Help\n" + items({help_option()});
    roff += section("EXAMPLES", command.examples);
    return roff + end(command, ".BR twinray (1)\n");
}

std::string man_page(std::span<const Command> commands, const std::string& version) {
    std::string roff = title("twinray", version), see_also;
    roff += heading("NAME") + "twinray \\- ray tracing on Vulkan by two accelerators that check each other\n";
    roff += heading("SYNOPSIS") + ".B twinray\n.I COMMAND\n[OPTION]...\n";
    roff += heading("DESCRIPTION") +
            "twinray traces rays on any Vulkan device, with the driver's acceleration structures and with its own "
            "structures and kernels. It shows where the two differ and which is right.\n";
    roff += heading("COMMANDS");
    for (const Command& command : commands) {
        roff += item(command.name, command.summary);
        see_also += (see_also.empty() ? "" : ",\n") + std::string(".BR twinray\\-") + escaped(command.name) + " (1)";
    }
    return roff + end({.fault = "a command that checks for faults found one"}, see_also + '\n');
}

}  // namespace twinray::cli
