// SPDX-License-Identifier: MIT
// A user's actions, as data and as lines of text, so that they can be recorded and played.
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace twinray::viewer {

enum class Button : unsigned char { left, middle, right };

struct KeyDown {
    std::string key;  // as in keys.h
};
struct KeyUp {
    std::string key;
};
struct ButtonDown {
    Button button;
    double x, y;  // pixels, from the upper left
    bool has_shift = false;
};
struct ButtonUp {
    Button button;
};
struct Moved {
    double x, y;
};
struct DoubleClick {
    double x, y;
};
struct Scrolled {
    double steps;
};
struct Resized {
    unsigned width, height;
};
struct Dropped {
    std::filesystem::path file;
};
// The given number of frames passes.
struct Frames {
    unsigned count;
};
// The picture is written.
struct Shot {
    std::filesystem::path file;
};
struct Closed {};
using Event = std::variant<KeyDown, KeyUp, ButtonDown, ButtonUp, Moved, DoubleClick, Scrolled, Resized, Dropped, Frames,
                           Shot, Closed>;

// "key F2", "keyup A", "down left 320 200 [shift]", "up left", "move 330 210", "double 320 200", "scroll 1",
// "resize 800 600", "drop FILE", "frames 10", "shot FILE", "close"
std::string text_of(const Event& event);
// Skips lines that are empty or begin with #. Throws Error naming the file, the line and what is wrong with it.
std::vector<Event> read_events(const std::filesystem::path& file);

}  // namespace twinray::viewer
