// SPDX-License-Identifier: MIT
#include "cli/command/help_text.h"

#include <algorithm>
#include <sstream>

#include "engine/core/platform.h"

namespace twinray::cli {
namespace {

constexpr std::size_t text_indent = 4, item_indent = 12, least_width = 40, most_width = 110;

// Adds a head on a line of its own and, indented under it, its meaning.
void add_item(std::string& page, const std::string& head, const std::string& meaning, std::size_t width) {
    page += std::string(text_indent, ' ') + head + '\n' + wrapped(meaning, width, item_indent);
}

void add_heading(std::string& page, const std::string& heading) { page += (page.empty() ? "" : "\n") + heading + '\n'; }

void add_options(std::string& page, const std::string& title, const std::vector<Option>& options, std::size_t width) {
    add_heading(page, "  " + title);
    for (const Option& option : options) add_item(page, head_of(option), text_of(option), width);
}

void add_items(std::string& page, const std::string& heading, const std::vector<Item>& items, std::size_t width) {
    add_heading(page, heading);
    for (const auto& [head, meaning] : items) add_item(page, head, meaning, width);
}

}  // namespace

std::string wrapped(const std::string& paragraph, std::size_t width, std::size_t indent) {
    const std::string blanks(indent, ' ');
    std::istringstream in(paragraph);
    std::string lines, line;
    for (std::string word; in >> word;) {
        if (!line.empty() && indent + line.size() + 1 + word.size() > width) {
            lines += blanks + line + '\n';
            line.clear();
        }
        line += (line.empty() ? "" : " ") + word;
    }
    return line.empty() ? lines : lines + blanks + line + '\n';
}

std::string help_text(const Command& command, std::size_t width) {
    std::string page;
    add_heading(page, "NAME");
    page += wrapped("twinray " + command.name + " - " + command.summary, width, text_indent);
    add_heading(page, "SYNOPSIS");
    page += wrapped(synopsis_of(command), width, text_indent);
    add_heading(page, "DESCRIPTION");
    page += wrapped(command.description, width, text_indent);
    add_heading(page, "OPTIONS");
    for (const Option& positional : command.positionals)
        add_item(page, head_of(positional), text_of(positional), width);
    for (const Section& section : command.sections) add_options(page, section.title, section.options, width);
    add_options(page, "Help", {help_option()}, width);
    add_items(page, "EXAMPLES", command.examples, width);
    add_items(page, "EXIT STATUS", exit_statuses_of(command), width);
    add_items(page, "ENVIRONMENT", environment_variables(), width);
    return page;
}

std::string list_text(std::span<const Command> commands, std::size_t width) {
    std::size_t longest = 0;
    for (const Command& command : commands) longest = std::max(longest, command.name.size());
    std::string page = "usage: twinray COMMAND [OPTION]...\n", group;
    for (const Command& command : commands) {
        if (command.group != group) add_heading(page, group = command.group);
        std::string item = wrapped(command.summary, width, text_indent + longest + 2);
        item.replace(text_indent, command.name.size(), command.name);
        page += item;
    }
    return page + '\n' +
           wrapped("Run 'twinray help COMMAND' for the help of a command, and 'twinray --version' for the version.",
                   width, 0);
}

std::size_t terminal_width() {
    const std::size_t columns = platform::terminal_width();
    return columns ? std::clamp(columns, least_width, most_width) : 80;
}

}  // namespace twinray::cli
