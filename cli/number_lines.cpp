// SPDX-License-Identifier: MIT
#include "cli/number_lines.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/core/error.h"

namespace twinray::cli {
namespace {

bool is_gap(char c) { return c == ',' || c == ' ' || c == '\t' || c == '\r'; }

std::vector<std::string_view> fields_of(std::string_view line) {
    std::vector<std::string_view> fields;
    for (std::size_t at = 0; at < line.size();) {
        std::size_t end = at;
        while (end < line.size() && !is_gap(line[end])) ++end;
        if (end > at) fields.push_back(line.substr(at, end - at));
        at = end + 1;
    }
    return fields;
}

std::optional<double> number_of(std::string_view field) {
    if (field.starts_with('+')) field.remove_prefix(1);
    double number = 0;
    const auto [after, error] = std::from_chars(field.data(), field.data() + field.size(), number);
    if (error != std::errc{} || after != field.data() + field.size()) return std::nullopt;
    return number;
}

}  // namespace

void read_number_lines(const std::filesystem::path& file, const std::string& what, const std::string& fields,
                       const std::function<void(std::span<const double>, std::size_t)>& take) {
    std::ifstream in(file);
    if (!in || std::filesystem::is_directory(file)) fail(what, " '", file.string(), "' cannot be read");
    const auto count = static_cast<std::size_t>(1 + std::count(fields.begin(), fields.end(), ','));
    std::string line;
    for (std::size_t number = 1; std::getline(in, line); ++number) {
        constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
        if (number == 1 && line.starts_with(byte_order_mark)) line.erase(0, byte_order_mark.size());
        const std::vector<std::string_view> words = fields_of(line);
        if (words.empty() || words[0].starts_with('#')) continue;
        std::vector<double> numbers;
        for (const std::string_view word : words)
            if (const std::optional<double> value = number_of(word)) numbers.push_back(*value);
        if (numbers.size() == count && words.size() == count)
            take(numbers, number);
        else if (number != 1 || !numbers.empty())
            fail(what, " '", file.string(), "', line ", number, ": '", line.substr(0, 40), "' is not ", fields);
    }
}

}  // namespace twinray::cli
