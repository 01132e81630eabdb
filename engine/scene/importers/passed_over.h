// SPDX-License-Identifier: MIT
// Lists the parts of files that importers skip.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>

namespace twinray {

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

}  // namespace twinray
