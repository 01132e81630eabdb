// SPDX-License-Identifier: MIT
#include "engine/scene/number_lines.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/error.h"
#include "engine/scene/importers/words.h"

namespace twinray {
namespace {

// read_file() is not used, since the output of another program may come through a pipe.
Bytes bytes_of(const std::filesystem::path& file, const std::string& what) {
    std::ifstream in(file, std::ios::binary);
    if (!in || std::filesystem::is_directory(file)) fail(what, " '", file.string(), "' cannot be read");
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

// Returns the fields up to a comment. A comma in a line with semicolons is a decimal point, as spreadsheets write it in
// half of Europe, and no number has one here.
std::vector<std::string_view> fields_of(std::string_view line) {
    line = line.substr(0, line.find('#'));
    const char separator = line.find(';') == line.npos ? ',' : ';';
    std::vector<std::string_view> fields;
    while (!line.empty()) {
        std::string_view between = line.substr(0, line.find(separator));
        line.remove_prefix(std::min(between.size() + 1, line.size()));
        for (std::string_view word = cut_word(between); !word.empty(); word = cut_word(between)) fields.push_back(word);
    }
    return fields;
}

// Returns whether they are names of columns, without a number in another notation.
bool is_heading(const std::vector<std::string_view>& fields) {
    return std::string_view("0123456789+-.").find(fields[0][0]) == std::string_view::npos &&
           std::ranges::none_of(fields, [](std::string_view field) { return parse_number(field).has_value(); });
}

// NaN, and a number beyond the range of double, are invalid in all these files.
std::optional<std::vector<double>> numbers_of(const std::vector<std::string_view>& fields) {
    std::vector<double> numbers;
    for (const std::string_view field : fields) {
        const std::optional<double> number = parse_number(field);
        if (!number || !std::isfinite(*number)) return std::nullopt;
        numbers.push_back(*number);
    }
    return numbers;
}

}  // namespace

void read_number_lines(const std::filesystem::path& file, const std::string& what, const std::string& fields,
                       const std::function<void(std::span<const double>, std::size_t)>& take) {
    const Bytes bytes = bytes_of(file, what);
    const auto count = static_cast<std::size_t>(1 + std::count(fields.begin(), fields.end(), ','));
    std::string_view rest = twinray::text_of(bytes, file.string());
    bool is_first = true, has_any = false;
    for (std::size_t line_number = 1; !rest.empty(); ++line_number) {
        const std::string_view line = cut_line(rest);
        const std::vector<std::string_view> words = fields_of(line);
        if (words.empty() || (std::exchange(is_first, false) && is_heading(words))) continue;
        const std::optional<std::vector<double>> numbers = numbers_of(words);
        if (!numbers || numbers->size() != count)
            fail(what, " '", file.string(), "', line ", line_number, ": '", line.substr(0, 40), "' is not ", fields);
        take(*numbers, line_number);
        has_any = true;
    }
    if (!has_any) fail(what, " '", file.string(), "' has no line ", fields);
}

}  // namespace twinray
