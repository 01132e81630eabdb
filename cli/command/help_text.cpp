// SPDX-License-Identifier: MIT
#include "cli/command/help_text.h"

#include <algorithm>
#include <sstream>

#include "engine/core/platform.h"

namespace twinray::cli {
namespace {

constexpr std::size_t text_indent = 4, item_indent = 12, least_width = 40, most_width = 110;

void add_paragraph(std::string& page, const std::string& paragraph, std::size_t width,
                   std::size_t indent = text_indent) {
    page += wrapped(paragraph, width, indent);
}

// A head on a line of its own and under it, indented, what it means.
void add_item(std::string& page, const std::string& head, const std::string& meaning, std::size_t width) {
    page += std::string(text_indent, ' ') + head + '\n';
    add_paragraph(page, meaning, width, item_indent);
}

void add_heading(std::string& page, const std::string& heading) { page += (page.empty() ? "" : "\n") + heading + '\n'; }

void add_options(std::string& page, const std::string& title, const std::vector<Option>& options, std::size_t width) {
    add_heading(page, "  " + title);
    for (const Option& option : options) add_item(page, head_of(option), text_of(option), width);
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
    add_paragraph(page, "twinray " + command.name + " - " + command.summary, width);
    add_heading(page, "SYNOPSIS");
    add_paragraph(page, synopsis_of(command), width);
    add_heading(page, "DESCRIPTION");
    add_paragraph(page, command.description, width);
    add_heading(page, "OPTIONS");
    for (const Option& positional : command.positionals)
        add_item(page, head_of(positional), text_of(positional), width);
    for (const Section& section : command.sections) add_options(page, section.title, section.options, width);
    add_options(page, "Help", {help_option()}, width);
    add_heading(page, "EXAMPLES");
    for (const Example& example : command.examples) add_item(page, example.line, example.what, width);
    add_heading(page, "EXIT STATUS");
    for (const auto& [status, meaning] : exit_statuses_of(command)) add_item(page, status, meaning, width);
    add_heading(page, "ENVIRONMENT");
    for (const auto& [name, meaning] : environment_variables()) add_item(page, name, meaning, width);
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
    page += '\n';
    add_paragraph(page,
                  "Run 'twinray help COMMAND' for the help of a command, and 'twinray --version' for the version.",
                  width, 0);
    return page;
}

std::size_t terminal_width() {
    const std::size_t columns = platform::terminal_width();
    return columns ? std::clamp(columns, least_width, most_width) : 80;
}

}  // namespace twinray::cli
