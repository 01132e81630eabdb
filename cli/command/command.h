// A command as data: what it takes, what it says, what it does. The parser, --help, man pages and the completions of
// shells are made of it.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace twinray::cli {

// The command line is wrong: exit status 2.
class UsageError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

// A value that follows an option, or a positional argument; cli/command/values.h makes it.
struct Value {
    enum class Kind : std::uint8_t { flag, word, choice, file, folder };
    Kind kind = Kind::flag;
    std::string metavar = {};                // "N", "X Y Z", "closest|any|all"; empty for a flag
    std::size_t least = 0, most = 0;         // how many words follow
    bool is_list = false;                    // a word holds several values, separated by commas
    bool is_repeatable = false;              // the option may be given more than once
    std::vector<std::string> choices = {};   // of Kind::choice
    std::vector<std::string> suffixes = {};  // of Kind::file, which must have one of them; empty: any
    std::string allowed = {};                // "a whole number from 1 to 65535"
    std::string limits = {};                 // "from 1 to 65535"; empty: none worth telling
    std::string initial = {};  // the value that holds if the option is not given; empty: none, or the help says it
    // Takes all values. Returns the first that is not what is allowed, or null.
    std::function<const std::string*(std::span<const std::string>)> store = {};
};

struct Option {
    std::string name = {};  // "--rays"; a positional has none
    char letter = 0;        // 'o' of "-o"
    Value value = {};
    std::string help = {};  // begins in lower case; ends without a full stop
    bool is_required = false;
    std::vector<std::string> needs = {}, excludes = {};  // other options, by name
    std::string former_name = {};  // its name in the version before: still taken, with a warning, and shown nowhere
};

// Options under one heading.
struct Section {
    std::string title = {};
    std::vector<Option> options = {};
};

// Options of which at most one, or exactly one, is given.
struct Alternatives {
    std::vector<std::string> names;
    bool is_required = false;
};

// A line and what it means: an example, an exit status or a variable of the environment.
struct Item {
    std::string head, meaning;
};

struct Command {
    std::string name = {}, group = {};
    std::string summary = {};      // in lower case, without a full stop
    std::string description = {};  // sentences
    std::vector<Option> positionals = {};
    std::vector<Section> sections = {};
    std::vector<Alternatives> alternatives = {};
    std::vector<Item> examples = {};
    std::string fault = {};  // "SwTlas shows a fault": ends with exit status 1; empty: it finds no faults
    std::function<int()> run = {};
};

// Makes a Command::run of work that ends with exit status 0 unless it throws.
template <class Work>
std::function<int()> done_after(Work work) {
    return [work = std::move(work)] {
        work();
        return 0;
    };
}

// Returns -h, --help, which each command has.
const Option& help_option();

// Returns all options in the order of the sections, then --help.
std::vector<const Option*> options_of(const Command& command);
std::vector<std::string> names_of(std::span<const Command> commands);

// Returns "-o, --output FILE", or "SCENE" for a positional.
std::string head_of(const Option& option);
// Returns the help with the allowed values and the default: "how many; from 1 to 9, default: 5".
std::string text_of(const Option& option);
// Returns "twinray trace SCENE --rays FILE --hits FILE [OPTION]...".
std::string synopsis_of(const Command& command);
std::vector<Item> exit_statuses_of(const Command& command);
std::vector<Item> environment_variables();  // those that commands heed

// Reads the arguments after the command's name into what its values are bound to. Returns false if they ask for --help.
// Throws UsageError that names the option, the value and what is allowed.
bool parse(const Command& command, const std::vector<std::string>& arguments);

// Returns how many letters must be inserted, removed, replaced or swapped with their neighbour to turn one into the
// other (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b);

// Returns the first candidate that begins with the whole word, of two or more letters; else the nearest one, the first
// among equals; empty if none is near: at most a third of the word's letters may be wrong, and one always may.
std::string nearest_to(std::string_view word, std::span<const std::string> candidates);

// The texts that describe commands: --help, man pages, and scripts that let shells complete words ---------------------

// Breaks a paragraph into lines of at most `width` letters, each after `indent` blanks. A longer word has its own line.
std::string wrapped(const std::string& paragraph, std::size_t width, std::size_t indent);

// Returns the help of one command, in the style of a man page.
std::string help_text(const Command& command, std::size_t width);
// Returns a line for each command, under the headings of their groups.
std::string list_text(std::span<const Command> commands, std::size_t width);

// Returns the width of the terminal that stdout is, else 80.
std::size_t terminal_width();

// Returns a man page of section 1, in roff with the macros of man(7): twinray-COMMAND.1, or twinray.1 of all commands.
std::string man_page(const Command& command, const std::string& version);
std::string man_page(std::span<const Command> commands, const std::string& version);

std::string bash_completion(std::span<const Command> commands);
std::string zsh_completion(std::span<const Command> commands);
std::string fish_completion(std::span<const Command> commands);

}  // namespace twinray::cli
