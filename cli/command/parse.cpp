// Parses arguments into values: CLI11 tells which words belong to which option; everything else about them is decided
// here.
#include "cli/command/command.h"

#include <algorithm>
#include <iostream>

#include <CLI/CLI.hpp>

#include "engine/core/error.h"

namespace twinray::cli {
namespace {

template <class... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
    throw UsageError(text(parts...));
}

// One option and the words that were given for it.
struct Given {
    const Option* option;
    CLI::Option* parsed;

    bool is_there() const { return parsed->count() > 0; }
    std::string name() const { return option->name.empty() ? option->value.metavar : option->name; }
};

std::string names_for_parser(const Option& option) {
    if (option.name.empty()) return "positional";
    std::string names = option.letter ? std::string("-") + option.letter + ',' + option.name : option.name;
    return option.former_name.empty() ? names : names + ',' + option.former_name;
}

CLI::Option* declare(CLI::App& app, const Option& option) {
    const Value& value = option.value;
    if (value.most == 0) return app.add_flag(names_for_parser(option))->disable_flag_override();
    return app.add_option(names_for_parser(option))
        ->expected(static_cast<int>(value.least), static_cast<int>(value.most))
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

bool is_named(const Option& option, const std::string& word) {
    return word == option.name || (option.letter && word == std::string("-") + option.letter) ||
           (!option.former_name.empty() && word == option.former_name);
}

// Refuses an option that wants a value and is the last argument, or comes before another option.
void check_values_follow(const Command& command, const std::vector<std::string>& arguments) {
    const std::vector<const Option*> options = options_of(command);
    const auto find = [&](const std::string& word) {
        return std::ranges::find_if(options, [&](const Option* option) { return is_named(*option, word); });
    };
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const auto found = find(arguments[i]);
        if (found == options.end() || (*found)->value.least == 0) continue;
        const std::string wanted = (*found)->name + " needs " + (*found)->value.metavar;
        if (i + 1 == arguments.size()) refuse(wanted, ", but nothing follows");
        if (find(arguments[i + 1]) != options.end()) refuse(wanted, ", but ", arguments[i + 1], " follows");
    }
}

// Tells the new name of an option that is called as in the version before.
void tell_new_names(const Command& command, const std::vector<std::string>& arguments) {
    for (const std::string& word : arguments)
        for (const Option* option : options_of(command))
            if (!option->former_name.empty() && word.substr(0, word.find('=')) == option->former_name)
                std::cerr << "twinray: " << option->former_name << " is now called " << option->name << '\n';
}

void check_known(const Command& command, const std::vector<std::string>& left) {
    for (const std::string& word : left) {
        if (word.size() < 2 || word[0] != '-') continue;
        const std::string name = word.substr(0, word.find('='));
        std::vector<std::string> names;
        for (const Option* option : options_of(command)) names.push_back(option->name);
        const std::string nearest = nearest_to(name, names);
        refuse("there is no option ", name, nearest.empty() ? "" : "; did you mean " + nearest + "?");
    }
    if (!left.empty()) refuse("'", left.front(), "' is one argument too many");
}

std::vector<std::string> split(const std::string& list) {
    std::vector<std::string> parts;
    std::istringstream in(list + ',');
    for (std::string part; std::getline(in, part, ',');) parts.push_back(part);
    return parts;
}

void store(const Given& given) {
    const Value& value = given.option->value;
    std::vector<std::string> words = given.parsed->results();
    if (value.most == 0) words.clear();
    if (value.least == 0) std::erase(words, std::string());
    if (value.most == 1 && words.size() > 1 && !value.is_repeatable) refuse(given.name(), " is given more than once");
    if (words.size() < value.least || (words.size() > value.most && !value.is_repeatable))
        refuse(given.name(), " needs ", value.least, " values, ", value.metavar, ", not ", words.size());
    if (value.is_list && !words.empty()) words = split(words.front());  // there is one: no list is repeatable
    if (const std::string* refused = value.store(words)) {
        const std::string nearest = nearest_to(*refused, value.choices);
        refuse(given.name(), " is '", *refused, "', but must be ", value.allowed,
               nearest.empty() ? "" : "; did you mean " + nearest + "?");
    }
}

void check_together(const Command& command, const std::vector<Given>& all) {
    const auto is_there = [&](const std::string& name) {
        return std::ranges::any_of(all, [&](const Given& given) { return given.name() == name && given.is_there(); });
    };
    for (const Given& given : all) {
        if (given.option->is_required && !given.is_there()) refuse(given.name(), " is required");
        if (!given.is_there()) continue;
        for (const std::string& other : given.option->needs)
            if (!is_there(other)) refuse(given.name(), " requires ", other);
        for (const std::string& other : given.option->excludes)
            if (is_there(other)) refuse(given.name(), " excludes ", other);
    }
    for (const Alternatives& alternatives : command.alternatives) {
        const std::string names = joined(alternatives.names);
        const auto count = std::ranges::count_if(alternatives.names, is_there);
        if (count > 1) refuse("only one of ", names, " may be given");
        if (count == 0 && alternatives.is_required) refuse("one of ", names, " is required");
    }
}

// Reverses the arguments, as CLI11 wants them. CLI11 takes "-.5" for an option, "-0.5" for a number.
std::vector<std::string> reversed(std::vector<std::string> arguments) {
    std::ranges::reverse(arguments);
    for (std::string& word : arguments)
        if (word.size() > 2 && word.starts_with("-.") && std::isdigit(static_cast<unsigned char>(word[2])))
            word.insert(1, "0");
    return arguments;
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
    // rows[i % 3][j]: the distance of the first i letters of a to the first j of b.
    std::vector<std::vector<std::size_t>> rows(3, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t j = 0; j <= b.size(); ++j) rows[0][j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::vector<std::size_t>&row = rows[i % 3], &above = rows[(i - 1) % 3];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], rows[(i - 2) % 3][j - 2] + 1);
        }
    }
    return rows[a.size() % 3][b.size()];
}

std::string nearest_to(std::string_view word, std::span<const std::string> candidates) {
    for (const std::string& candidate : candidates)
        if (word.size() > 1 && candidate.starts_with(word)) return candidate;
    std::string nearest;
    std::size_t best = std::max<std::size_t>(word.size() / 3, 1) + 1;
    for (const std::string& candidate : candidates) {
        const std::size_t distance = edit_distance(word, candidate);
        if (distance < best) best = distance, nearest = candidate;
    }
    return nearest;
}

bool parse(const Command& command, const std::vector<std::string>& arguments) {
    for (const std::string& word : arguments)
        if (is_named(help_option(), word)) return false;
    check_values_follow(command, arguments);
    tell_new_names(command, arguments);
    CLI::App app;
    app.set_help_flag();
    app.allow_extras();
    app.allow_windows_style_options(false);  // a name of a file may begin with a slash on every system
    std::vector<Given> all;
    for (const Option& positional : command.positionals) all.push_back({&positional, declare(app, positional)});
    for (const Option* option : options_of(command)) all.push_back({option, declare(app, *option)});
    try {
        app.parse(reversed(arguments));
    } catch (const CLI::ParseError& error) {
        refuse(error.what());
    }
    for (const Given& given : all)
        if (given.option == &help_option() && given.is_there()) return false;  // among letters: "-hq"
    check_known(command, app.remaining());
    for (const Given& given : all)
        if (given.is_there()) store(given);
    check_together(command, all);
    return true;
}

}  // namespace twinray::cli
