#include "cli/command/command.h"

#include <algorithm>
#include <sstream>

#include "engine/core/error.h"
#include "engine/core/platform.h"

namespace twinray::cli {
namespace {

constexpr std::size_t text_indent = 4, item_indent = 12, least_width = 40, most_width = 110;

// The contents of a page, in the form that a subclass gives them.
class Page {
  public:
    virtual ~Page() = default;
    virtual void heading(const std::string& name) = 0;
    virtual void subheading(const std::string& name) = 0;
    virtual void paragraph(const std::string& words) = 0;
    virtual void item(const std::string& head, const std::string& meaning) = 0;

    void section(const std::string& name, const std::vector<Item>& items) {
        heading(name);
        for (const auto& [head, meaning] : items) item(head, meaning);
    }
    // Adds the sections of a command. `name`: "twinray trace".
    void describe(const Command& command, const std::string& name) {
        heading("NAME");
        paragraph(name + " - " + command.summary);
        heading("SYNOPSIS");
        paragraph(synopsis_of(command));
        heading("DESCRIPTION");
        paragraph(command.description);
        heading("OPTIONS");
        add(command.positionals);
        for (const Section& of_command : command.sections) {
            subheading(of_command.title);
            add(of_command.options);
        }
        subheading("Help");
        add({help_option()});
        section("EXAMPLES", command.examples);
        end(command);
    }
    // Adds the sections that end every page.
    void end(const Command& command) {
        section("EXIT STATUS", exit_statuses_of(command));
        section("ENVIRONMENT", environment_variables());
    }

    std::string text;

  private:
    void add(const std::vector<Option>& options) {
        for (const Option& option : options) item(head_of(option), text_of(option));
    }
};

// Lines for a terminal, with what belongs to a head indented under it.
class HelpPage : public Page {
  public:
    explicit HelpPage(std::size_t width) : width_(width) {}
    void heading(const std::string& name) override { text += (text.empty() ? "" : "\n") + name + '\n'; }
    void subheading(const std::string& name) override { heading("  " + name); }
    void paragraph(const std::string& words) override { text += wrapped(words, width_, text_indent); }
    void item(const std::string& head, const std::string& meaning) override {
        text += std::string(text_indent, ' ') + head + '\n' + wrapped(meaning, width_, item_indent);
    }

  private:
    std::size_t width_;
};

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

class ManPage : public Page {
  public:
    ManPage(std::string name, const std::string& version) {
        std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
        text = ".TH \"" + name + "\" 1 \"\" \"twinray " + version + "\" \"User Commands\"\n";
    }
    void heading(const std::string& name) override { text += ".SH " + name + '\n'; }
    void subheading(const std::string& name) override { text += ".SS " + escaped(name) + '\n'; }
    void paragraph(const std::string& words) override { text += escaped(words) + '\n'; }
    void item(const std::string& head, const std::string& meaning) override {
        text += ".TP\n.B " + escaped(head) + '\n' + escaped(meaning) + '\n';
    }
};

using Kind = Value::Kind;

// Returns the first words of a help, up to where it goes into details.
std::string brief(const std::string& help) { return help.substr(0, help.find_first_of(";.:")); }

std::string replaced(const std::string& text, const std::string& special, const std::string& by) {
    std::string result;
    for (const char c : text) result += special.find(c) != std::string::npos ? by + c : std::string(1, c);
    return result;
}

// Puts the text between single quotes, where sh has no escapes.
std::string in_quotes(const std::string& text) {
    std::string result = "'";
    for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + '\'';
}

std::string patterns_of(const Option& option) {
    return option.letter ? option.name + "|-" + option.letter : option.name;
}

// Returns the bash command that completes one value.
std::string bash_action(const Value& value) {
    switch (value.kind) {
        case Kind::choice:
            return (value.is_list ? "_twinray_list " : "_twinray_words ") + in_quotes(joined(value.choices, " "));
        case Kind::file: return "_twinray_files";
        case Kind::folder: return "_twinray_folders";
        default: return ":";
    }
}

std::string bash_case(const Command& command) {
    std::string options, cases;
    for (const Option* option : options_of(command)) {
        options += (options.empty() ? "" : " ") + option->name;
        if (option->value.most > 0)
            cases += "            " + patterns_of(*option) + ") " + bash_action(option->value) + "; return ;;\n";
    }
    std::string positional = ":";
    if (!command.positionals.empty()) positional = bash_action(command.positionals.front().value);
    return "    " + command.name + ")\n        case $previous in\n" + cases +
           "        esac\n        case $current in\n" + "            -*) _twinray_words " + in_quotes(options) +
           " ;;\n            *) " + positional + " ;;\n        esac ;;\n";
}

constexpr const char* bash_head = R"(# bash completion for twinray, as `twinray completion bash` prints it

_twinray_words() { mapfile -t COMPREPLY < <(compgen -W "$1" -- "$current"); }
_twinray_files() { compopt -o filenames 2>/dev/null; mapfile -t COMPREPLY < <(compgen -f -- "$current"); }
_twinray_folders() { compopt -o filenames 2>/dev/null; mapfile -t COMPREPLY < <(compgen -d -- "$current"); }
# The last of a list that commas separate.
_twinray_list() {
    local before=
    [[ $current == *,* ]] && before=${current%,*},
    compopt -o nospace 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -P "$before" -W "$1" -- "${current##*,}")
}

_twinray() {
    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
    COMPREPLY=()
    # --option=value is three words here.
    if [[ $current == = ]]; then
        current=
    elif [[ $previous == = ]]; then
        previous=${COMP_WORDS[COMP_CWORD - 2]}
    fi
    if ((COMP_CWORD == 1)); then
)";

std::string zsh_action(const Value& value) {
    switch (value.kind) {
        case Kind::choice:
            return value.is_list ? "_values -s , value " + joined(value.choices, " ")
                                 : "(" + joined(value.choices, " ") + ")";
        case Kind::file: return "_files";
        case Kind::folder: return "_files -/";
        default: return " ";
    }
}

// Returns ":what:action" for each word.
std::string zsh_values(const Value& value) {
    const std::string what = replaced(value.metavar, "\\:[]", "\\"), action = zsh_action(value);
    std::string all;
    for (std::size_t i = 0; i < value.most; ++i) all += (value.least == 0 ? "::" : ":") + what + ':' + action;
    return all;
}

std::string zsh_spec(const Option& option) {
    const std::string help = '[' + replaced(brief(option.help), "\\[]:", "\\") + ']' + zsh_values(option.value);
    const std::string repeat = option.value.is_repeatable ? "*" : "";
    if (!option.letter) return in_quotes(repeat + option.name + help);
    const std::string letter = std::string("-") + option.letter;
    return in_quotes('(' + letter + ' ' + option.name + ')') + '{' + letter + ',' + option.name + '}' + in_quotes(help);
}

std::string fish_option(const Command& command, const Option& option) {
    std::string line = "complete -c twinray -n '__fish_seen_subcommand_from " + command.name + "'";
    if (option.letter) line += std::string(" -s ") + option.letter;
    line += " -l " + option.name.substr(2);
    switch (option.value.kind) {
        case Kind::flag: break;
        case Kind::word: line += " -x"; break;
        case Kind::choice: line += " -x -a " + in_quotes(joined(option.value.choices, " ")); break;
        case Kind::file: line += " -r -F"; break;
        case Kind::folder: line += " -x -a '(__fish_complete_directories)'"; break;
    }
    return line + " -d " + in_quotes(brief(option.help)) + '\n';
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
    HelpPage page(width);
    page.describe(command, "twinray " + command.name);
    return page.text;
}

std::string list_text(std::span<const Command> commands, std::size_t width) {
    std::size_t longest = 0;
    for (const Command& command : commands) longest = std::max(longest, command.name.size());
    HelpPage page(width);
    page.text = "usage: twinray COMMAND [OPTION]...\n";
    std::string group;
    for (const Command& command : commands) {
        if (command.group != group) page.heading(group = command.group);
        std::string item = wrapped(command.summary, width, text_indent + longest + 2);
        page.text += item.replace(text_indent, command.name.size(), command.name);
    }
    return page.text + '\n' +
           wrapped("Run 'twinray help COMMAND' for the help of a command, and 'twinray --version' for the version.",
                   width, 0);
}

std::size_t terminal_width() {
    const std::size_t columns = platform::terminal_width();
    return columns ? std::clamp(columns, least_width, most_width) : 80;
}

std::string man_page(const Command& command, const std::string& version) {
    ManPage page("twinray-" + command.name, version);
    page.describe(command, "twinray-" + command.name);
    page.heading("SEE ALSO");
    return page.text + ".BR twinray (1)\n";
}

std::string man_page(std::span<const Command> commands, const std::string& version) {
    ManPage page("twinray", version);
    page.heading("NAME");
    page.paragraph("twinray - ray tracing on Vulkan by two accelerators that check each other");
    page.heading("SYNOPSIS");
    page.text += ".B twinray\n.I COMMAND\n[OPTION]...\n";
    page.heading("DESCRIPTION");
    page.text +=
        "twinray traces rays on any Vulkan device, with the driver's acceleration structures and with its own "
        "structures and kernels. It shows where the two differ and which is right.\n";
    page.heading("COMMANDS");
    std::string see_also;
    for (const Command& command : commands) {
        page.item(command.name, command.summary);
        see_also += (see_also.empty() ? "" : ",\n") + std::string(".BR twinray\\-") + escaped(command.name) + " (1)";
    }
    page.end({.fault = "a command that checks for faults found one"});
    page.heading("SEE ALSO");
    return page.text + see_also + '\n';
}

std::string bash_completion(std::span<const Command> commands) {
    std::string script = bash_head;
    script += "        _twinray_words " + in_quotes(joined(names_of(commands), " ") + " --help --version") +
              "\n        return\n    fi\n    case ${COMP_WORDS[1]} in\n";
    for (const Command& command : commands) script += bash_case(command);
    return script + "    esac\n}\ncomplete -F _twinray twinray\n";
}

std::string zsh_completion(std::span<const Command> commands) {
    std::string names, cases;
    for (const Command& command : commands) {
        names += "        " + in_quotes(command.name + ':' + replaced(command.summary, "\\:", "\\")) + '\n';
        cases += "        " + command.name + ")\n            _arguments -s -S";
        for (const Option* option : options_of(command)) cases += " \\\n                " + zsh_spec(*option);
        for (const Option& positional : command.positionals)
            cases += " \\\n                " + in_quotes(zsh_values(positional.value));
        cases += " ;;\n";
    }
    return "#compdef twinray\n# zsh completion for twinray, as `twinray completion zsh` prints it\n\n_twinray() {\n"
           "    local -a commands=(\n" +
           names +
           "    )\n    if (( CURRENT == 2 )); then\n        _describe command commands\n"
           "        _arguments '--help[list the commands]' '--version[which twinray this is]'\n        return\n    fi\n"
           "    local command=$words[2]\n    shift words\n    (( CURRENT-- ))\n    case $command in\n" +
           cases +
           "    esac\n}\n\n"
           "if [ \"$funcstack[1]\" = _twinray ]; then _twinray \"$@\"; else compdef _twinray twinray; fi\n";
}

std::string fish_completion(std::span<const Command> commands) {
    std::string script =
        "# fish completion for twinray, as `twinray completion fish` prints it\n\ncomplete -c twinray -f\n"
        "complete -c twinray -n __fish_use_subcommand -l help -d 'list the commands'\n"
        "complete -c twinray -n __fish_use_subcommand -l version -d 'which twinray this is'\n";
    for (const Command& command : commands) {
        script += "\ncomplete -c twinray -n __fish_use_subcommand -a " + command.name + " -d " +
                  in_quotes(command.summary) + '\n';
        for (const Option& positional : command.positionals) {
            const std::string from = "complete -c twinray -n '__fish_seen_subcommand_from " + command.name + "' ";
            if (positional.value.kind == Kind::file) script += from + "-F\n";
            if (positional.value.kind == Kind::choice)
                script += from + "-a " + in_quotes(joined(positional.value.choices, " ")) + '\n';
        }
        for (const Option* option : options_of(command)) script += fish_option(command, *option);
    }
    return script;
}

}  // namespace twinray::cli
