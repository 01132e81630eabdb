// Lines, words and numbers of text formats, files of nothing but numbers, and the parts of files that readers ignore.
#pragma once

#include <map>

#include "engine/core/error.h"
#include "engine/core/files.h"

namespace twinray {

// Returns the bytes without a byte order mark. Throws Error naming `object` if a zero byte shows that they are no text.
std::string_view text_of(const Bytes& bytes, const std::string& object);

// Cuts off and returns the first line or word of `rest`. A line ends with LF, CR LF, or CR alone, which it does not
// keep; a word ends with a blank, and is empty if none is left.
std::string_view cut_line(std::string_view& rest);
std::string_view cut_word(std::string_view& rest);

std::string_view trimmed(std::string_view text);

// Parses the whole word as a number, rounded once; beyond the range of double it is infinite or 0. Accepts nan, inf,
// and those of Microsoft's C library until 2015 (-1.#IND, 1.#QNAN, 1.#INF). Returns nothing for other words.
std::optional<double> parse_number(std::string_view word);

// Parts of a file that a reader ignores; each is reported once.
class PassedOver {
  public:
    void add(std::string_view word, std::size_t line) { first_lines_.emplace(word, line); }
    bool empty() const { return first_lines_.empty(); }
    // Returns "'cstype' (line 2), 'vp' (line 7)", in the order of lines; the first ones if there are many.
    std::string list() const;

  private:
    std::map<std::string, std::size_t, std::less<>> first_lines_;
};

// Calls back for each line that holds the numbers of `fields` ("x,y,z"), between commas, semicolons or blanks, with its
// number, from 1. Left out are empty lines, text after a #, and a heading: the first line with contents, if no word of
// it is a number and the first does not begin as one. Throws Error that names `what` and the file if it cannot be read
// or has no such line, and the line if that is anything else; numbers are finite.
void read_number_lines(const std::filesystem::path& file, const std::string& what, const std::string& fields,
                       const std::function<void(std::span<const double>, std::size_t)>& take);

}  // namespace twinray
