// SPDX-License-Identifier: MIT
#include "cli/command/values.h"

#include <algorithm>

#include "engine/core/platform.h"
#include "engine/core/error.h"

namespace twinray::cli {
namespace {

using Words = std::span<const std::string>;

// Makes a value of one word, of any kind.
template <class Take>
Value text_value(Value::Kind kind, const std::string& metavar, const std::string& initial, const Take& take) {
    Value value{.kind = kind, .metavar = metavar, .least = 1, .most = 1};
    value.initial = initial;
    value.store = [take](Words words) -> const std::string* {
        take(words);
        return nullptr;
    };
    return value;
}

bool has_suffix(const std::string& file, const std::vector<std::string>& suffixes) {
    std::string name = file;
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return suffixes.empty() ||
           std::ranges::any_of(suffixes, [&](const std::string& suffix) { return name.ends_with(suffix); });
}

Value file_value(std::vector<std::string> suffixes, std::function<void(Words)> take) {
    Value value{.kind = Value::Kind::file, .metavar = "FILE" + joined(suffixes, "|"), .least = 1, .most = 1};
    value.suffixes = suffixes;
    value.allowed = suffixes.empty() ? "a file" : "a file whose name ends in " + either_of(suffixes);
    value.store = [suffixes = std::move(suffixes), take = std::move(take)](Words words) -> const std::string* {
        for (const std::string& word : words)
            if (!has_suffix(word, suffixes)) return &word;
        take(words);
        return nullptr;
    };
    return value;
}

Value choice_value(std::vector<std::string> names, const std::string& initial,
                   std::function<void(const std::vector<std::size_t>&)> take) {
    Value value{.kind = Value::Kind::choice, .metavar = joined(names, "|"), .least = 1, .most = 1};
    value.choices = names;
    value.allowed = either_of(names);
    value.initial = initial;
    value.store = [names = std::move(names), take = std::move(take)](Words words) -> const std::string* {
        std::vector<std::size_t> chosen;
        for (const std::string& word : words) {
            const auto found = std::ranges::find(names, word);
            if (found == names.end()) return &word;
            chosen.push_back(static_cast<std::size_t>(found - names.begin()));
        }
        take(chosen);
        return nullptr;
    };
    return value;
}

void take_paths(std::vector<std::filesystem::path>& target, Words words) {
    target.clear();
    for (const std::string& word : words) target.push_back(platform::path_of(word));
}

}  // namespace

std::string either_of(const std::vector<std::string>& words) {
    std::string all;
    for (std::size_t i = 0; i < words.size(); ++i)
        all += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
    return all;
}

Value flag(std::function<void()> take) {
    Value value = text_value(Value::Kind::flag, "", "", [take = std::move(take)](Words) { take(); });
    value.least = value.most = 0;
    return value;
}

Value flag(bool& target) {
    return flag([&target] { target = true; });
}

Value word(std::string& target, const std::string& metavar) {
    return text_value(Value::Kind::word, metavar, target, [&target](Words words) { target = words.front(); });
}

Value words(std::vector<std::string>& target, const std::string& metavar) {
    Value value = text_value(Value::Kind::word, metavar, joined(target, ","),
                             [&target](Words given) { target.assign(given.begin(), given.end()); });
    value.is_list = true;
    return value;
}

Value file(std::filesystem::path& target, std::vector<std::string> suffixes) {
    return file_value(std::move(suffixes), [&target](Words words) { target = platform::path_of(words.front()); });
}

Value files(std::vector<std::filesystem::path>& target, std::vector<std::string> suffixes) {
    Value value = file_value(std::move(suffixes), [&target](Words words) { take_paths(target, words); });
    value.is_repeatable = true;
    return value;
}

Value file_list(std::vector<std::filesystem::path>& target) {
    Value value = file_value({}, [&target](Words words) { take_paths(target, words); });
    value.metavar = "FILE,...";
    value.is_list = true;
    return value;
}

Value paths(std::vector<std::filesystem::path>& target, std::size_t least, const std::string& metavar) {
    Value value = file_value({}, [&target](Words words) { take_paths(target, words); });
    value.metavar = metavar;
    value.least = least;
    value.most = 1000;
    return value;
}

Value folder(std::filesystem::path& target) {
    return text_value(Value::Kind::folder, "FOLDER", target.string(),
                      [&target](Words words) { target = platform::path_of(words.front()); });
}

Value choice(std::vector<std::string> names, const std::string& initial, std::function<void(std::size_t)> take) {
    return choice_value(std::move(names), initial,
                        [take = std::move(take)](const std::vector<std::size_t>& chosen) { take(chosen.front()); });
}

Value choice(std::string& target, std::vector<std::string> names) {
    return choice(names, target, [&target, names](std::size_t index) { target = names[index]; });
}

Value choices(std::vector<std::string> names, const std::string& initial,
              std::function<void(const std::vector<std::size_t>&)> take) {
    Value value = choice_value(std::move(names), initial, std::move(take));
    value.metavar += ",...";
    value.is_list = true;
    return value;
}

Value choices(std::vector<std::string>& target, std::vector<std::string> names) {
    return choices(names, joined(target, ","), [&target, names](const std::vector<std::size_t>& chosen) {
        target.clear();
        for (const std::size_t index : chosen) target.push_back(names[index]);
    });
}

}  // namespace twinray::cli
