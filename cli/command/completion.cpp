// SPDX-License-Identifier: MIT
#include "cli/command/help_text.h"

#include "engine/core/error.h"

namespace twinray::cli {
namespace {

using Kind = Value::Kind;

// Returns the first words of a help, up to where it goes into details.
std::string brief(const std::string& help) { return help.substr(0, help.find_first_of(";.:")); }

std::string replaced(const std::string& text, const std::string& special, const std::string& by) {
    std::string result;
    for (const char c : text) result += special.find(c) != std::string::npos ? by + c : std::string(1, c);
    return result;
}

// Puts the text between single quotes, where sh has no escapes.
std::string quoted(const std::string& text) {
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
            return (value.is_list ? "_twinray_list " : "_twinray_words ") + quoted(joined(value.choices, " "));
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
           "        esac\n        case $current in\n" + "            -*) _twinray_words " + quoted(options) +
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
    if (!option.letter) return quoted(repeat + option.name + help);
    const std::string letter = std::string("-") + option.letter;
    return quoted('(' + letter + ' ' + option.name + ')') + '{' + letter + ',' + option.name + '}' + quoted(help);
}

std::string fish_option(const Command& command, const Option& option) {
    std::string line = "complete -c twinray -n '__fish_seen_subcommand_from " + command.name + "'";
    if (option.letter) line += std::string(" -s ") + option.letter;
    line += " -l " + option.name.substr(2);
    switch (option.value.kind) {
        case Kind::flag: break;
        case Kind::word: line += " -x"; break;
        case Kind::choice: line += " -x -a " + quoted(joined(option.value.choices, " ")); break;
        case Kind::file: line += " -r -F"; break;
        case Kind::folder: line += " -x -a '(__fish_complete_directories)'"; break;
    }
    return line + " -d " + quoted(brief(option.help)) + '\n';
}

}  // namespace

std::string bash_completion(std::span<const Command> commands) {
    std::string script = bash_head;
    script += "        _twinray_words " + quoted(joined(names_of(commands), " ") + " --help --version") +
              "\n        return\n    fi\n    case ${COMP_WORDS[1]} in\n";
    for (const Command& command : commands) script += bash_case(command);
    return script + "    esac\n}\ncomplete -F _twinray twinray\n";
}

std::string zsh_completion(std::span<const Command> commands) {
    std::string names, cases;
    for (const Command& command : commands) {
        names += "        " + quoted(command.name + ':' + replaced(command.summary, "\\:", "\\")) + '\n';
        cases += "        " + command.name + ")\n            _arguments -s -S";
        for (const Option* option : options_of(command)) cases += " \\\n                " + zsh_spec(*option);
        for (const Option& positional : command.positionals)
            cases += " \\\n                " + quoted(zsh_values(positional.value));
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
                  quoted(command.summary) + '\n';
        for (const Option& positional : command.positionals) {
            const std::string from = "complete -c twinray -n '__fish_seen_subcommand_from " + command.name + "' ";
            if (positional.value.kind == Kind::file) script += from + "-F\n";
            if (positional.value.kind == Kind::choice)
                script += from + "-a " + quoted(joined(positional.value.choices, " ")) + '\n';
        }
        for (const Option* option : options_of(command)) script += fish_option(command, *option);
    }
    return script;
}

}  // namespace twinray::cli
