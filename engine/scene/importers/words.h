// SPDX-License-Identifier: MIT
// Lines, words and numbers of text formats.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "engine/core/files.h"

namespace twinray {

// The bytes without a byte order mark. Throws Error naming `object` where a zero byte shows that they are no text.
std::string_view text_of(const Bytes& bytes, const std::string& object);

// What `rest` begins with, which is left with what follows. A line ends with LF, CR LF, or CR alone, none of which it
// keeps; a word with a blank, and is empty where none is left.
std::string_view cut_line(std::string_view& rest);
std::string_view cut_word(std::string_view& rest);

std::string_view trimmed(std::string_view text);
std::string lowered(std::string_view text);

// The whole word as a number, rounded once; beyond the range of double it is infinite or 0. Also nan, inf, and what
// Microsoft's C library printed in their place until 2015 (-1.#IND, 1.#QNAN, 1.#INF). Nothing if it is anything else.
std::optional<double> parse_number(std::string_view word);

}  // namespace twinray
