#include "viewer/viewer.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "engine/core/error.h"
#include "report/explain/explain.h"
#include "report/replay/replay.h"
#include "twinray/glsl/vector_math.h"
#include "viewer/files.h"

namespace twinray::viewer {
namespace {

constexpr double dolly_a_step = 1.15;
constexpr double flight_a_frame = 0.03;  // share of the distance
constexpr double least_drag = 3;         // pixels; less is a click
constexpr uint least_side = 1, most_side = 16384;

// Quotes a word for a shell.
std::string quoted(const std::string& word) {
    if (word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%") ==
        std::string::npos)
        return word;
    std::string in_quotes = "'";
    for (const char letter : word) in_quotes += letter == '\'' ? "'\\''" : std::string(1, letter);
    return in_quotes + '\'';
}

double aspect_of(const State& state) { return static_cast<double>(state.width) / state.height; }

uvec2 pixel_at(const State& state, double x, double y) {
    return {static_cast<uint>(std::clamp(x, 0.0, state.width - 1.0)),
            static_cast<uint>(std::clamp(y, 0.0, state.height - 1.0))};
}

std::string text_of(const Hit& hit) {
    std::ostringstream out;
    out.precision(9);
    if (hit.hit == 0) return "a miss";
    out << "t " << hit.t << ", instance " << hit.instance_index << ", triangle " << hit.primitive_index << ", u "
        << hit.u << ", v " << hit.v;
    return out.str();
}

std::string text_of(const ReferenceHit& hit) {
    std::ostringstream out;
    out.precision(17);
    if (!hit.hit) return "a miss";
    out << "t " << hit.t << ", instance " << hit.instance << ", triangle " << hit.primitive;
    return out.str();
}

Pick pick(Stage& stage, const Ray& ray) {
    Pick found;
    found.ray = ray;
    const std::span<const Ray> one(&ray, 1);
    found.software = stage.software().closest_hits(one)[0];
    found.reference = stage.reference().closest_hit(ray);
    found.software_class = stage.reference().classify(ray, found.software, TracedBy::software);
    if (stage.hardware()) {
        found.has_hardware = true;
        found.hardware = stage.hardware()->closest_hits(one)[0];
        found.hardware_class = stage.reference().classify(ray, found.hardware, TracedBy::hardware);
    }
    if (found.software.hit) {
        found.point = dvec3(ray.origin) + dvec3(ray.direction) * double(found.software.t);
        found.face = first_faces(stage.scene())[found.software.instance_index] + found.software.primitive_index;
    }
    reference::Scene::take_steps();
    (void)stage.cpu_reference().trace(ray);
    const TraversalSteps steps = reference::Scene::take_steps();
    found.nodes = steps.nodes, found.boxes = steps.boxes, found.primitives = steps.primitives;
    return found;
}

// Makes a replay for `twinray verify --replay`. `version`: that of twinray.
replay::Replay replay_of(Stage& stage, const Pick& pick, const std::string& version) {
    const bool is_of_hardware = pick.has_hardware && is_fault_of_hardware(pick.hardware_class);
    const DeviceProperties& device = stage.context().properties();
    return {.scene = std::filesystem::absolute(stage.file()),
            .scene_hash = replay::hash_of(stage.scene()),
            .backend = is_of_hardware ? "hw" : "sw",
            .level = std::string(name_of(Level::watertight)),
            .kind = std::string(name_of(is_of_hardware ? pick.hardware_class : pick.software_class)),
            .ray = pick.ray,
            .answer = is_of_hardware ? pick.hardware : pick.software,
            .reference = pick.reference,
            .device = device.name,
            .driver = device.driver,
            .twinray = version};
}

}  // namespace

std::string text_of(const Pick& pick) {
    std::ostringstream out;
    out.precision(9);
    out << "ray from " << pick.ray.origin.x << ' ' << pick.ray.origin.y << ' ' << pick.ray.origin.z << " along "
        << pick.ray.direction.x << ' ' << pick.ray.direction.y << ' ' << pick.ray.direction.z << '\n'
        << "software: " << text_of(pick.software) << ": " << name_of(pick.software_class) << '\n';
    if (pick.has_hardware)
        out << "hardware: " << text_of(pick.hardware) << ": " << name_of(pick.hardware_class) << '\n';
    out << "float64: " << text_of(pick.reference) << '\n'
        << "steps of the software tree: " << pick.nodes << " nodes, " << pick.boxes << " boxes, " << pick.primitives
        << " triangles\n";
    return out.str();
}

std::string explanation_of(Stage& stage, const Pick& pick) {
    std::vector<exact::TriangleId> triangles;
    const auto add = [&](bool is_hit, uint instance, uint primitive) {
        if (is_hit && !std::ranges::count(triangles, exact::TriangleId{instance, primitive}))
            triangles.push_back({instance, primitive});
    };
    add(pick.software.hit != 0, pick.software.instance_index, pick.software.primitive_index);
    add(pick.has_hardware && pick.hardware.hit != 0, pick.hardware.instance_index, pick.hardware.primitive_index);
    add(pick.reference.hit, pick.reference.instance, pick.reference.primitive);
    std::ostringstream out;
    const replay::Explainer explainer(stage.scene(), stage.reference().scene(), pick.ray, Level::watertight);
    for (const exact::TriangleId& triangle : triangles) {
        explainer.print_test(out, triangle);
        explainer.print_boxes(out, triangle);
    }
    return out.str();
}

Viewer::Viewer(Context& context, const ViewerDesc& desc)
    : context_(context), say_(desc.say), version_(desc.version), state_(desc.state) {
    open(desc.file);
    stage_->set_time(state_.seconds);
    const Orbit asked = state_.orbit;
    if (desc.camera) {
        const dvec3 origin = stage_->scene().origin;
        state_.orbit = looking((*desc.camera)[0] - origin, (*desc.camera)[1] - origin, asked.up, asked.vertical_fov);
    } else if (!stage_->scene().cameras.empty()) {
        state_.orbit = orbit_of(stage_->scene().cameras[0], stage_->bounds(), asked.up);
    } else {
        look_at_all();
    }
    if (asked.is_orthographic) state_.orbit.is_orthographic = true;
    set_reach();
    shown_ = state_;
    if (desc.state.picked) pick_at(desc.state.picked->x, desc.state.picked->y);
}

void Viewer::look_at_all() {
    const std::optional<vec3> direction =
        state_.orbit.up == UpAxis::z ? std::optional(vec3(-0.55f, 0.75f, -0.45f)) : std::nullopt;
    const Camera camera = frame_scene(stage_->scene(), static_cast<float>(aspect_of(state_)), direction);
    state_.orbit = orbit_of(camera, stage_->bounds(), state_.orbit.up);
}

// Leaves all as it was if the file cannot be shown.
void Viewer::open(const std::filesystem::path& file) {
    auto opened = std::make_unique<Stage>(context_, file);
    paths_ = {};
    forget_pick();
    values_of_.reset();
    stage_ = std::move(opened);
    is_playing_ = false;
    state_.seconds = std::min(state_.seconds, stage_->animation_seconds());
    std::error_code none;
    written_ = std::filesystem::last_write_time(file, none);
    is_stale_ = true;
}

void Viewer::set_reach() {
    const Bounds& box = stage_->bounds();
    const dvec3 half = (dvec3(box.hi) - dvec3(box.lo)) * 0.5;
    state_.orbit.reach = box.is_empty() ? 0 : length(dvec3(box.lo) + half - state_.orbit.center) + 1.01 * length(half);
}

void Viewer::recover(const std::string& why) {
    message_ = why;
    state_.layer = Layer::eyelight;
    state_.shown = Shown::software;
    state_.tree_depth.reset();
    forget_pick();
    is_stale_ = true;
}

void Viewer::forget_pick() {
    pick_.reset();
    state_.picked.reset();
}

bool Viewer::try_open(const std::filesystem::path& file) {
    try {
        open(file);
        return true;
    } catch (const DeviceLost&) {
        throw;
    } catch (const Error& error) {
        message_ = error.what();
        return false;
    }
}

void Viewer::reload() {
    // A copy, since opening ends the stage.
    if (try_open(std::filesystem::path(stage_->file()))) message_ = "read again";
}

void Viewer::reload_if_changed() {
    std::error_code none;
    const auto written = std::filesystem::last_write_time(stage_->file(), none);
    if (none || written == written_) return;
    written_ = written;
    reload();
}

void Viewer::set_state(const State& state) {
    state_ = state;
    state_.width = std::clamp(state_.width, least_side, most_side);
    state_.height = std::clamp(state_.height, least_side, most_side);
}

std::string Viewer::command_line() const {
    return "twinray view " + quoted(stage_->file().string()) + ' ' + options_of(state_, stage_->scene().origin);
}

void Viewer::handle(const Event& event) {
    if (const auto* down = std::get_if<KeyDown>(&event)) {
        if (button_ == Button::right && is_flight(down->key))
            held_.push_back(down->key);
        else if (const Key* key = find_key(down->key))
            press(*key);
    } else if (const auto* up = std::get_if<KeyUp>(&event)) {
        std::erase(held_, up->key);
    } else if (const auto* button = std::get_if<ButtonDown>(&event)) {
        button_ = button->button;
        has_shift_ = button->has_shift;
        has_dragged_ = false;
        x_ = button->x, y_ = button->y;
    } else if (std::get_if<ButtonUp>(&event)) {
        if (button_ == Button::left && !has_dragged_ && !is_double_) pick_at(x_, y_);
        is_double_ = false;
        button_.reset();
        held_.clear();
    } else if (const auto* moved = std::get_if<Moved>(&event)) {
        drag(moved->x, moved->y);
    } else if (const auto* click = std::get_if<DoubleClick>(&event)) {
        center_at(click->x, click->y);
        is_double_ = true;  // its second release is no click
    } else if (const auto* scrolled = std::get_if<Scrolled>(&event)) {
        state_.orbit = dollied(state_.orbit, std::pow(dolly_a_step, scrolled->steps));
    } else if (const auto* resized = std::get_if<Resized>(&event)) {
        if (resized->width == 0 || resized->height == 0) return;  // minimised: the last picture stays
        State state = state_;
        state.width = resized->width, state.height = resized->height;
        state.picked.reset();  // it is a pixel of the former size
        set_state(state);
    } else if (const auto* dropped = std::get_if<Dropped>(&event)) {
        if (!try_open(dropped->file)) return;
        look_at_all();
        message_ = "shows " + dropped->file.string();
    } else if (std::get_if<Closed>(&event)) {
        is_closed_ = true;
    }
}

void Viewer::drag(double x, double y) {
    const double dx = x - x_, dy = y_ - y;
    if (!button_) {
        x_ = x, y_ = y;
        return;
    }
    if (!has_dragged_ && std::hypot(dx, dy) < least_drag) return;
    has_dragged_ = true;
    x_ = x, y_ = y;
    const double right = dx / state_.height, up = dy / state_.height;
    if (*button_ == Button::middle || (*button_ == Button::left && has_shift_))
        state_.orbit = panned(state_.orbit, right, up);
    else
        state_.orbit = turned(state_.orbit, right, up);
}

void Viewer::fly() {
    for (const std::string& key : held_) {
        const double right = key == "D" ? 1 : key == "A" ? -1 : 0;
        const double up = key == "E" ? 1 : key == "Q" ? -1 : 0;
        const double forward = key == "W" ? 1 : key == "S" ? -1 : 0;
        state_.orbit = flown(state_.orbit, right * flight_a_frame, up * flight_a_frame, forward * flight_a_frame);
    }
}

void Viewer::pick_at(double x, double y) {
    const uvec2 pixel = pixel_at(state_, x, y);
    stage_->set_time(state_.seconds);
    set_reach();
    pick_ = pick(*stage_, ray_of_pixel(state_.orbit, state_.width, state_.height, pixel));
    explanation_.clear();
    state_.picked = pixel;
    state_.picked_from = state_.orbit;
    is_stale_ = true;
}

const std::string& Viewer::explanation() {
    if (explanation_.empty() && pick_) explanation_ = explanation_of(*stage_, *pick_);
    return explanation_;
}

void Viewer::center_at(double x, double y) {
    set_reach();
    const Ray ray = ray_of_pixel(state_.orbit, state_.width, state_.height, pixel_at(state_, x, y));
    const Hit hit = stage_->software().closest_hits(std::span(&ray, 1))[0];
    if (hit.hit) state_.orbit = centered(state_.orbit, dvec3(ray.origin) + dvec3(ray.direction) * double(hit.t));
}

void Viewer::press(const Key& key) {
    const auto toggle = [&](Shown shown) { state_.shown = state_.shown == shown ? Shown::software : shown; };
    message_.clear();
    switch (key.action) {
        case Action::frame_all: state_.orbit = framed(state_.orbit, stage_->bounds(), aspect_of(state_)); break;
        case Action::center_here: center_at(x_, y_); break;
        case Action::side: state_.orbit = seen_from(state_.orbit, key.side); break;
        case Action::orthographic: state_.orbit.is_orthographic = !state_.orbit.is_orthographic; break;
        case Action::layer: state_.layer = key.layer; break;
        case Action::flip_accelerators:
            state_.shown = state_.shown == Shown::software ? Shown::hardware : Shown::software;
            break;
        case Action::next_level: {
            const auto next = static_cast<std::size_t>(state_.level) + 1;
            state_.level = next < all_levels.size() ? all_levels.at(next) : all_levels.front();
            break;
        }
        case Action::next_camera: {
            const std::vector<Camera>& cameras = stage_->scene().cameras;
            if (cameras.empty()) {
                message_ = "the file has no camera";
                break;
            }
            state_.orbit =
                orbit_of(cameras[camera_ = (camera_ + 1) % cameras.size()], stage_->bounds(), state_.orbit.up);
            break;
        }
        case Action::wipe: toggle(Shown::wipe); break;
        case Action::difference: toggle(Shown::difference); break;
        case Action::tree_deeper: state_.tree_depth = state_.tree_depth.value_or(-1) + 1; break;
        case Action::tree_higher:
            if (state_.tree_depth.value_or(0) == 0)
                state_.tree_depth.reset();
            else
                --*state_.tree_depth;
            break;
        case Action::tree_areas: state_.has_area_colors = !state_.has_area_colors; break;
        case Action::all_features: state_.has_all_features = !state_.has_all_features; break;
        case Action::darker:
        case Action::brighter: {
            const double step = key.action == Action::brighter ? 1 : -1;
            if (state_.layer == Layer::light)
                state_.hour = std::clamp(state_.hour + step, 6.0, 18.0);
            else
                state_.exposure += static_cast<float>(step);
            break;
        }
        case Action::play: is_playing_ = !is_playing_ && stage_->animation_seconds() > 0; break;
        case Action::copy_camera: say_(options_of(state_.orbit, stage_->scene().origin)); break;
        case Action::copy_bookmark:
            if (pick_ && stage_->animation_seconds() == 0 &&
                (is_fault_of_hardware(pick_->hardware_class) || is_fault_of_ours(pick_->software_class))) {
                replay::write("view.replay.json", replay_of(*stage_, *pick_, version_));
                say_("twinray verify --replay view.replay.json");
            }
            say_(command_line());
            break;
        case Action::reload: reload(); break;
        case Action::panel: shows_panel_ = !shows_panel_; break;
        case Action::sheet: shows_sheet_ = !shows_sheet_; break;
        case Action::screenshot:
            write_png("view.png", raster_.width, raster_.height, raster_.pixels);
            message_ = "wrote view.png";
            break;
        case Action::export_values:
            try {
                for (const char* file : {"view.csv", "view.glb"}) write_values(file, stage_->scene(), values_);
                message_ = "wrote view.csv and view.glb";
            } catch (const Error& error) {
                message_ = error.what();
            }
            break;
        case Action::quit: is_closed_ = true; break;
    }
    if (!stage_->has_level(state_.level)) {
        message_ = text("level ", name_of(state_.level), " requires float64, which the device lacks");
        state_.level = Level::watertight;
    }
    if (state_.shown != Shown::software && !stage_->hardware()) {
        message_ = "only the software accelerator: " + stage_->why_no_hardware();
        state_.shown = Shown::software;
    }
}

}  // namespace twinray::viewer
