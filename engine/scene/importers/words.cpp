#include "engine/scene/importers/words.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <fstream>
#include <iterator>

namespace twinray {
namespace {

constexpr double INFINITE = std::numeric_limits<double>::infinity();

bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

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
