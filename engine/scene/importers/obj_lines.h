// SPDX-License-Identifier: MIT
// The common part of .obj and .mtl files.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "engine/core/interruption.h"

namespace twinray {

// The lines with contents, one after the other. A backslash at the end of a line joins the next one to it, unless a
// comment has begun.
class ObjLines {
  public:
    explicit ObjLines(std::string_view text) : rest_(text) {}

    bool next();  // false at the end
    std::string_view keyword() const { return keyword_; }
    // Returns the text after the keyword, without a comment, which # begins anywhere. In a name it has to stand alone,
    // since there are materials called "Material #25".
    std::string_view numbers() const;
    std::string_view name() const;
    std::size_t line() const { return line_; }  // number of its first line, from 1

  private:
    std::string_view cut_joined_line();

    std::string_view rest_, keyword_, value_;
    std::string joined_;
    std::size_t line_ = 0, lines_cut_ = 0;
    LoopInterruption interruption_;
};

}  // namespace twinray
