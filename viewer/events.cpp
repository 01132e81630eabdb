#include "viewer/events.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>

#include "engine/core/error.h"
#include "engine/core/platform.h"

namespace twinray::viewer {
namespace {

constexpr Key table[] = {
    {"Home", Action::frame_all, "show the whole scene"},
    {"F", Action::center_here, "set the orbit centre to the point under the pointer (or double-click)"},
    {.name = "1", .action = Action::side, .what = "view from the front", .side = Side::front},
    {.name = "3", .action = Action::side, .what = "view from the right", .side = Side::right},
    {.name = "7", .action = Action::side, .what = "from above", .side = Side::top},
    {.name = "9", .action = Action::side, .what = "isometric", .side = Side::isometric},
    {"5", Action::orthographic, "orthographic or perspective projection"},
    {"F1", Action::layer, "path-traced picture", Layer::path},
    {"F2", Action::layer, "base colours lit from the camera", Layer::eyelight},
    {"F3", Action::layer, "hit or miss", Layer::occlusion},
    {"F4", Action::layer, "barycentric u, v", Layer::uv},
    {"F5", Action::layer, "geometric normals", Layer::normal},
    {"F6", Action::layer, "one colour per mesh", Layer::geometry},
    {"F7", Action::layer, "one colour per triangle", Layer::primitive},
    {"F8", Action::layer, "distance", Layer::depth},
    {"F9", Action::layer, "steps a ray", Layer::steps},
    {"F10", Action::layer, "sunlight on each face", Layer::light},
    {"F11", Action::layer, "view factors from the picked face", Layer::factors},
    {"F12", Action::layer, "triangles that touch or cross others, by class", Layer::collisions},
    {"0", Action::layer, "distances on a plane through the orbit centre", Layer::distance},
    {"L", Action::next_level, "next level of the triangle test"},
    {"N", Action::next_camera, "next camera of the file"},
    {"Tab", Action::flip_accelerators, "software or hardware"},
    {"W", Action::wipe, "both accelerators, with a movable divider"},
    {"D", Action::difference, "pixels where the two disagree"},
    {"]", Action::tree_deeper, "boxes of the tree, one level deeper"},
    {"[", Action::tree_higher, "one level higher, then off"},
    {"T", Action::tree_areas, "colour the boxes by their share of the root's area (SAH)"},
    {"A", Action::all_features, "path-trace with kernels for every scene, or for this scene only"},
    {"-", Action::darker, "half the exposure; one hour earlier"},
    {"=", Action::brighter, "twice the exposure; one hour later"},
    {"Space", Action::play, "play the animation"},
    {"C", Action::copy_camera, "print the camera as options, and copy it to the clipboard"},
    {"B", Action::copy_bookmark, "print the display as a command line, and copy it to the clipboard"},
    {"R", Action::reload, "reload the file"},
    {"S", Action::screenshot, "write view.png"},
    {"E", Action::export_values, "write the values of faces to view.csv and view.glb"},
    {"P", Action::panel, "show the panel of settings and statistics"},
    {"H", Action::sheet, "this sheet"},
    {"Escape", Action::quit, "end"},
};

std::string on_if(bool is_on) { return is_on ? "on" : ""; }

constexpr std::array<std::string_view, 3> button_names = {"left", "middle", "right"};
constexpr std::array<std::string_view, std::variant_size_v<Event>> words = {  // that begin the line of an event
    "key", "keyup", "down", "up", "move", "double", "scroll", "resize", "drop", "frames", "shot", "close"};

// Gives the fields of an event to a Writer or a Reader, in the order of its line.
template <class Io, class E>
void pass_fields(Io& io, E& e) {
    if constexpr (requires { e.key; }) io(e.key);
    if constexpr (requires { e.button; }) io(e.button);
    if constexpr (requires { e.x; }) io(e.x), io(e.y);
    if constexpr (requires { e.has_shift; }) io(e.has_shift);
    if constexpr (requires { e.steps; }) io(e.steps);
    if constexpr (requires { e.width; }) io(e.width), io(e.height);
    if constexpr (requires { e.file; }) io(e.file);
    if constexpr (requires { e.count; }) io(e.count);
}

struct Writer {
    std::ostringstream out;

    template <class T>
    void operator()(const T& value) {
        out << ' ' << value;
    }
    void operator()(const Button& button) { out << ' ' << button_names.at(static_cast<std::size_t>(button)); }
    void operator()(const bool& has_shift) { out << (has_shift ? " shift" : ""); }
    void operator()(const std::filesystem::path& file) { out << ' ' << file.string(); }
};

// The stream fails if something is wrong.
struct Reader {
    std::istringstream in;

    void check(bool is_right) {
        if (!is_right) in.setstate(std::ios::failbit);
    }
    void operator()(double& number) { in >> number; }
    // Reads whole numbers, for which a stream would also accept negative ones.
    void operator()(unsigned& count) {
        long long number = -1;
        in >> number;
        check(number >= 0 && number <= 1'000'000);
        count = static_cast<unsigned>(number);
    }
    // Only a key with a function is one.
    void operator()(std::string& key) {
        std::getline(in >> std::ws, key);
        check(find_key(key) || is_flight(key));
    }
    void operator()(std::filesystem::path& file) {
        std::string rest;
        std::getline(in >> std::ws, rest);
        file = platform::path_of(rest);
    }
    void operator()(Button& button) {
        std::string word;
        in >> word;
        const auto* const found = std::ranges::find(button_names, word);
        check(found != button_names.end());
        button = static_cast<Button>(found - button_names.begin());
    }
    void operator()(bool& has_shift) {
        std::string word;
        if (in.fail()) return;
        if (in >> word)
            check(has_shift = word == "shift");
        else
            in.clear(std::ios::eofbit);
    }
};

// Returns nothing if it is not one of these.
template <std::size_t i = 0>
std::optional<Event> event_of(const std::string& line) {
    if constexpr (i < words.size()) {
        Reader reader{std::istringstream(line)};
        std::string word;
        reader.in >> word;
        if (word != words[i]) return event_of<i + 1>(line);
        std::variant_alternative_t<i, Event> event{};
        pass_fields(reader, event);
        if (!reader.in.fail() && !(reader.in >> word)) return event;
    }
    return {};
}

}  // namespace

std::span<const Key> all_keys() { return table; }

const Key* find_key(std::string_view name) {
    const auto* found = std::ranges::find(table, name, &Key::name);
    return found == std::end(table) ? nullptr : found;
}

bool is_flight(std::string_view name) {
    return name.size() == 1 && std::string_view("WASDQE").find(name) != std::string_view::npos;
}

std::string state_of(const Key& key, const State& state) {
    switch (key.action) {
        case Action::layer: return on_if(state.layer == key.layer);
        case Action::flip_accelerators: return std::string(name_of(state.shown));
        case Action::next_level: return std::string(name_of(state.level));
        case Action::wipe: return on_if(state.shown == Shown::wipe);
        case Action::difference: return on_if(state.shown == Shown::difference);
        case Action::tree_areas: return on_if(state.has_area_colors);
        case Action::all_features: return on_if(state.has_all_features);
        case Action::orthographic: return on_if(state.orbit.is_orthographic);
        case Action::tree_deeper: return state.tree_depth ? "level " + std::to_string(*state.tree_depth) : "";
        default: return "";
    }
}

std::string text_of(const Event& event) {
    Writer writer;
    writer.out << words.at(event.index());
    std::visit([&](const auto& e) { pass_fields(writer, e); }, event);
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
