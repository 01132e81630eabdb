// SPDX-License-Identifier: MIT
#include "cli/number_lines.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <fstream>
#include <string_view>
#include <vector>

#include "engine/core/error.h"

namespace twinray::cli {
namespace {

bool parse(std::string_view line, std::span<double> numbers) {
    const char* at = line.data();
    const char* end = at + line.size();
    const auto is_gap = [](char c) { return c == ',' || c == ' ' || c == '\t' || c == '\r'; };
    for (double& number : numbers) {
        while (at != end && is_gap(*at)) ++at;
        const auto [after, error] = std::from_chars(at, end, number);
        if (error != std::errc{} || (after != end && !is_gap(*after))) return false;
        at = after;
    }
    return std::all_of(at, end, is_gap);
}

}  // namespace

void read_number_lines(const std::filesystem::path& file, const std::string& what, const std::string& fields,
                       const std::function<void(std::span<const double>)>& take) {
    std::ifstream in(file);
    if (!in || std::filesystem::is_directory(file)) fail(what, " '", file.string(), "' cannot be read");
    std::vector<double> numbers(1 + static_cast<std::size_t>(std::count(fields.begin(), fields.end(), ',')));
    std::string line;
    for (std::size_t number = 1; std::getline(in, line); ++number) {
        const std::size_t first = line.find_first_not_of(" \t\r");
        if (first == std::string::npos || line[first] == '#') continue;
        if (parse(line, numbers))
            take(numbers);
        else if (number != 1 || !std::isalpha(static_cast<unsigned char>(line[first])))
            fail(what, " '", file.string(), "', line ", number, ": '", line.substr(0, 40), "' is not ", fields);
    }
}

}  // namespace twinray::cli
