// SPDX-License-Identifier: MIT
#include "viewer/events.h"

#include <array>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>

#include "engine/core/platform.h"
#include "engine/core/error.h"
#include "viewer/keys.h"

namespace twinray::viewer {
namespace {

constexpr std::array<std::string_view, 3> button_names = {"left", "middle", "right"};

std::string name_of(Button button) { return std::string(button_names.at(static_cast<std::size_t>(button))); }

struct Writer {
    std::ostringstream out;
    void operator()(const KeyDown& e) { out << "key " << e.key; }
    void operator()(const KeyUp& e) { out << "keyup " << e.key; }
    void operator()(const ButtonDown& e) {
        out << "down " << name_of(e.button) << ' ' << e.x << ' ' << e.y << (e.has_shift ? " shift" : "");
    }
    void operator()(const ButtonUp& e) { out << "up " << name_of(e.button); }
    void operator()(const Moved& e) { out << "move " << e.x << ' ' << e.y; }
    void operator()(const DoubleClick& e) { out << "double " << e.x << ' ' << e.y; }
    void operator()(const Scrolled& e) { out << "scroll " << e.steps; }
    void operator()(const Resized& e) { out << "resize " << e.width << ' ' << e.height; }
    void operator()(const Dropped& e) { out << "drop " << e.file.string(); }
    void operator()(const Frames& e) { out << "frames " << e.count; }
    void operator()(const Shot& e) { out << "shot " << e.file.string(); }
    void operator()(const Closed&) { out << "close"; }
};

std::istream& operator>>(std::istream& in, Button& button) {
    std::string word;
    in >> word;
    for (std::size_t i = 0; i < button_names.size(); ++i)
        if (word == button_names.at(i)) {
            button = static_cast<Button>(i);
            return in;
        }
    in.setstate(std::ios::failbit);
    return in;
}

std::string rest_of(std::istream& in) {
    std::string rest;
    std::getline(in >> std::ws, rest);
    return rest;
}

// Returns "" and a failed stream for a key without a function.
std::string key_of(std::istream& in) {
    std::string name = rest_of(in);
    if (find_key(name) || is_flight(name)) return name;
    in.setstate(std::ios::failbit);
    return {};
}

// Reads whole numbers, for which a stream would also accept negative ones.
bool read_count(std::istream& in, unsigned& count) {
    long long number = -1;
    if (!(in >> number) || number < 0 || number > 1'000'000) return false;
    count = static_cast<unsigned>(number);
    return true;
}

// Returns nothing if it is not one of these.
std::optional<Event> event_of(const std::string& line) {
    std::istringstream in(line);
    std::string what;
    in >> what;
    std::optional<Event> event;
    if (what == "key")
        event = KeyDown{key_of(in)};
    else if (what == "keyup")
        event = KeyUp{key_of(in)};
    else if (what == "drop")
        event = Dropped{platform::path_of(rest_of(in))};
    else if (what == "shot")
        event = Shot{rest_of(in)};
    else if (what == "close")
        event = Closed{};
    else if (what == "down") {
        ButtonDown down{};
        std::string shift;
        if (in >> down.button >> down.x >> down.y && (!(in >> shift) || shift == "shift")) {
            down.has_shift = !shift.empty();
            return down;
        }
    } else if (what == "up") {
        if (ButtonUp up{}; in >> up.button) event = up;
    } else if (what == "move") {
        if (Moved moved{}; in >> moved.x >> moved.y) event = moved;
    } else if (what == "double") {
        if (DoubleClick click{}; in >> click.x >> click.y) event = click;
    } else if (what == "scroll") {
        if (Scrolled scrolled{}; in >> scrolled.steps) event = scrolled;
    } else if (what == "resize") {
        if (Resized resized{}; read_count(in, resized.width) && read_count(in, resized.height)) event = resized;
    } else if (what == "frames") {
        if (Frames frames{}; read_count(in, frames.count)) event = frames;
    }
    if (event && (in.fail() || in >> what)) return {};
    return event;
}

}  // namespace

std::string text_of(const Event& event) {
    Writer writer;
    std::visit(writer, event);
    return writer.out.str();
}

std::vector<Event> read_events(const std::filesystem::path& file) {
    std::ifstream in(file);
    if (!in) fail("'", file.string(), "': cannot be read");
    std::vector<Event> events;
    std::string line;
    for (std::size_t number = 1; std::getline(in, line); ++number) {
        if (!line.empty() && line.back() == '\r') line.pop_back();
        if (line.empty() || line[0] == '#') continue;
        const std::optional<Event> event = event_of(line);
        if (!event) fail("'", file.string(), "': line ", number, ": '", line, "' is not an event");
        events.push_back(*event);
    }
    return events;
}

}  // namespace twinray::viewer
