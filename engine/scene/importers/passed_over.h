// SPDX-License-Identifier: MIT
// What importers skip.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>

namespace twinray {

// What a reader has no use for, to be said once.
class PassedOver {
  public:
    void add(std::string_view word, std::size_t line) { first_lines_.emplace(word, line); }
    bool empty() const { return first_lines_.empty(); }
    // "'cstype' (line 2), 'vp' (line 7)", in the order of lines; of many the first.
    std::string list() const;

  private:
    std::map<std::string, std::size_t, std::less<>> first_lines_;
};

}  // namespace twinray
