// SPDX-License-Identifier: MIT
#include "engine/scene/importers/words.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

#include "engine/core/error.h"

namespace twinray {
namespace {

constexpr double INFINITE = std::numeric_limits<double>::infinity();

bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

}  // namespace

std::string_view text_of(const Bytes& bytes, const std::string& object) {
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (const std::size_t at = text.find('\0'); at != std::string_view::npos)
        fail("'", object, "': not a text file in ASCII or UTF-8 (byte ", at, " is zero)");
    constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
    if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
    return text;
}

std::string_view cut_line(std::string_view& rest) {
    const auto end = std::ranges::find_if(rest, [](char c) { return c == '\n' || c == '\r'; });
    const std::string_view line(rest.begin(), end);
    rest.remove_prefix(line.size());
    rest.remove_prefix(rest.starts_with("\r\n") ? 2 : rest.empty() ? 0 : 1);
    return line;
}

std::string_view cut_word(std::string_view& rest) {
    const auto first = std::ranges::find_if_not(rest, is_blank);
    const auto last = std::find_if(first, rest.end(), is_blank);
    const std::string_view word(first, last);
    rest = {last, rest.end()};
    return word;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

std::string lowered(std::string_view text) {
    std::string lower(text);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return lower;
}

std::optional<double> parse_number(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const char* const last = word.data() + word.size();
    const auto [end, error] = std::from_chars(word.data(), last, value);
    if (error == std::errc::invalid_argument) return std::nullopt;
    if (end != last) {
        const std::string_view after(end, last);
        if (end[-1] != '.' || !after.starts_with('#') || std::abs(value) != 1) return std::nullopt;
        return after.starts_with("#INF") ? value * INFINITE : std::numeric_limits<double>::quiet_NaN();
    }
    if (error == std::errc::result_out_of_range) {  // from_chars does not say on which side
        value = std::strtod(std::string(word).c_str(), nullptr);
        return std::abs(value) < 1 ? 0.0 : std::copysign(INFINITE, value);
    }
    return value;
}

std::string PassedOver::list() const {
    constexpr std::size_t most = 8, longest = 20;
    std::vector<std::pair<std::size_t, std::string_view>> words;
    for (const auto& [word, line] : first_lines_) words.emplace_back(line, word);
    std::ranges::sort(words);
    std::string all;
    for (std::size_t i = 0; i < std::min(words.size(), most); ++i)
        all += text(i ? ", '" : "'", words[i].second.substr(0, longest), "' (line ", words[i].first, ")");
    return words.size() > most ? text(all, " and ", words.size() - most, " more") : all;
}

}  // namespace twinray
