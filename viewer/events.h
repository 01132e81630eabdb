// A user's actions, as data and as lines of text, so that they can be recorded and played; and the function of each
// key: one table, which the program and its sheet of keys read.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "viewer/state.h"

namespace twinray::viewer {

enum class Action : std::uint8_t {
    frame_all,
    center_here,
    side,
    orthographic,
    layer,
    flip_accelerators,
    next_level,
    next_camera,
    wipe,
    difference,
    tree_deeper,
    tree_higher,
    tree_areas,
    all_features,
    darker,
    brighter,
    play,
    copy_camera,
    copy_bookmark,
    reload,
    panel,
    sheet,
    screenshot,
    export_values,
    quit,
};

struct Key {
    std::string_view name;  // "F2", "Tab", "[": as events have it
    Action action;
    std::string_view what;          // for the sheet
    Layer layer = Layer::eyelight;  // of Action::layer
    Side side = Side::front;        // of Action::side
};
std::span<const Key> all_keys();
// Returns null if the key does nothing.
const Key* find_key(std::string_view name);

// Returns whether the key flies while the right button is down.
bool is_flight(std::string_view name);

// Returns the state that a key changes, for the sheet: "on", "sw", ...; empty if there is none.
std::string state_of(const Key& key, const State& state);

enum class Button : unsigned char { left, middle, right };

struct KeyDown {
    std::string key;  // Key::name
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
