// SPDX-License-Identifier: MIT
#include "engine/scene/importers/obj_lines.h"

#include <algorithm>

#include "engine/scene/importers/words.h"

namespace twinray {
namespace {

// Returns where a comment begins: at a #, unless the # is in a number of Microsoft's C library.
std::size_t comment_begin(std::string_view line) {
    const auto is_in_number = [&](std::size_t at) {
        const std::string_view after = line.substr(at + 1);
        return at > 0 && line[at - 1] == '.' &&
               (after.starts_with("IN") || after.starts_with("QNAN") || after.starts_with("SNAN"));
    };
    std::size_t at = line.find('#');
    while (at != line.npos && is_in_number(at)) at = line.find('#', at + 1);
    return std::min(at, line.size());
}

}  // namespace

bool ObjLines::next() {
    while (!rest_.empty()) {
        interruption_.look();
        line_ = lines_cut_ + 1;
        value_ = cut_joined_line();
        keyword_ = cut_word(value_);
        if (!keyword_.empty() && !keyword_.starts_with('#')) return true;
    }
    return false;
}

std::string_view ObjLines::cut_joined_line() {
    const auto cut = [&] {
        ++lines_cut_;
        return trimmed(cut_line(rest_));
    };
    const auto goes_on = [](std::string_view line) {
        return line.ends_with('\\') && comment_begin(line) == line.size();
    };
    std::string_view line = cut();
    if (!goes_on(line)) return line;
    for (joined_.clear(); goes_on(line); line = cut()) {
        joined_ += line.substr(0, line.size() - 1);
        joined_ += ' ';
    }
    joined_ += line;
    return joined_;
}

std::string_view ObjLines::numbers() const { return value_.substr(0, comment_begin(value_)); }

std::string_view ObjLines::name() const {
    std::string_view rest = value_;
    for (std::string_view word = cut_word(rest); !word.empty(); word = cut_word(rest))
        if (word == "#") return trimmed({value_.begin(), word.begin()});
    return trimmed(value_);
}

}  // namespace twinray
