// The frames of a Viewer, and the results of analyses for each face in them.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "engine/core/error.h"
#include "engine/core/stopwatch.h"
#include "engine/core/parallel.h"
#include "twinray/glsl/vector_math.h"
#include "viewer/layers.h"
#include "viewer/viewer.h"

namespace twinray::viewer {
namespace {

constexpr double seconds_while_moving = 0.07;     // of a frame
constexpr uint coarsest = 8;                      // pixels of a coarse frame, along each side
constexpr uint side_of_light = 1024;              // rays along each side of the grid
constexpr std::uint64_t rays_of_row = 1u << 18u;  // of view factors

constexpr Rgb ours = categorical::vermilion, of_driver = categorical::purple, harmless = categorical::blue;
constexpr Rgb pick_color = categorical::vermilion;

// Returns whether samples of one do not fit the other.
bool is_another_picture(const State& a, const State& b) {
    return a.orbit != b.orbit || a.layer != b.layer || a.shown != b.shown || a.width != b.width ||
           a.height != b.height || a.seconds != b.seconds || a.has_all_features != b.has_all_features;
}

bool has_face_values(Layer layer) {
    return layer == Layer::light || layer == Layer::factors || layer == Layer::collisions;
}

Rgb color_of_classes(HitClass software, HitClass hardware) {
    return is_fault_of_ours(software) ? ours : is_fault_of_hardware(hardware) ? of_driver : harmless;
}

Raster by_pixel(const Traced& traced, const std::function<Rgb(std::size_t)>& color) {
    Raster raster(traced.width, traced.height);
    parallel_for(raster.pixels.size(), [&](std::size_t i) { raster.pixels[i] = color(i); });
    return raster;
}

std::vector<float> depths_of(const Traced& traced, uint width, uint height, uint grain) {
    std::vector<float> depths(std::size_t{width} * height);
    for (uint y = 0; y < height; ++y)
        for (uint x = 0; x < width; ++x) {
            const std::size_t i = std::size_t{std::min(y / grain, traced.height - 1)} * traced.width +
                                  std::min(x / grain, traced.width - 1);
            depths[std::size_t{y} * width + x] = traced.hits[i].hit ? traced.hits[i].t : INFINITY;
        }
    return depths;
}

std::string range_text(const ValueScale& scale) {
    std::ostringstream out;
    out.precision(3);
    out << scale.lo() << " to " << scale.hi() << "  ";
    return out.str();
}

// Returns the direction to the sun on a day when it rises at 6 along +x and is highest at 12; z is up if `up` says so.
dvec3 sun_at(double hour, UpAxis up) {
    const double turn = std::numbers::pi * (hour - 6) / 12;
    const double east = std::cos(turn), height = std::sin(turn), north = -0.3;
    return up == UpAxis::y ? dvec3(east, height, -north) : dvec3(east, north, height);
}

// Returns the lit fraction of the area that is turned to the sun, from 0 to 1.
Values light_on(Stage& stage, double hour, UpAxis up) {
    const dvec3 sun = sun_at(hour, up);
    const Illumination lit = illuminate(stage.software(), stage.faces(),
                                        {.grid = {.direction = -sun, .side = side_of_light}, .sides = Sides::both});
    Values values{.numbers = {}, .scale = ValueScale::linear(0, 1), .what = "sunlit share"};
    for (const LitArea& face : lit.groups) values.numbers.push_back(face.unobstructed > 0 ? face.fraction() : NAN);
    return values;
}

// Returns view factors from a face to all others.
Values factors_from(Stage& stage, std::size_t face) {
    const Faces& faces = stage.faces();
    const ViewFactorOptions options{.sides = Sides::both, .rays = rays_of_row};
    ViewFactors factors(stage.software(), faces, options);
    Values values{.numbers = std::vector<double>(factors.row_count(), NAN), .scale = {}, .what = "view factor"};
    const std::vector<ViewFactorRow> rows = factors.rows(face, face + 1);
    for (const ViewFactor& factor : rows[0].factors) values.numbers[factor.target] = static_cast<double>(factor.value);
    const bool has_any = std::ranges::any_of(values.numbers, [](double number) { return number > 0; });
    if (has_any) values.scale = ValueScale::logarithmic_for(values.numbers);
    return values;
}

// Returns the worst class of contact, by its number in PairClass; and the segments where triangles cross.
Values contacts_of(Stage& stage, std::vector<Stroke>& segments) {
    const std::vector<std::size_t> first = first_faces(stage.scene());
    Values values{.numbers = std::vector<double>(count_triangles(stage.scene()), NAN), .scale = {}, .what = "contact"};
    const Contacts contacts = NarrowPhase(stage.context()).find(stage.software(), {.segments = true});
    segments.clear();
    for (std::size_t i = 0; i < contacts.segments.size(); ++i)
        if (contacts.list[i].pair_class == PairClass::crossing)
            segments.push_back({.from = contacts.segments[i].from, .to = contacts.segments[i].to});
    for (const TriangleContact& contact : contacts.list)
        for (const std::size_t face :
             {first[contact.instance_a] + contact.triangle_a, first[contact.instance_b] + contact.triangle_b}) {
            const auto of = static_cast<double>(contact.pair_class);
            if (!(values.numbers[face] >= of)) values.numbers[face] = of;
        }
    values.scale = ValueScale::linear(0, static_cast<double>(all_pair_classes.size() - 1));
    return values;
}

}  // namespace

AbstractAccel& Viewer::accel_of(Shown shown) {
    if (shown == Shown::hardware) return *stage_->hardware();
    return stage_->software();
}

bool Viewer::is_refining() const {
    return is_stale_ || is_coarse_ || state_ != shown_ || traces_paths() || is_playing_ || !held_.empty();
}

const Raster& Viewer::frame(bool may_be_coarse) {
    const Stopwatch start;
    fly();
    is_playing_ = is_playing_ && stage_->animation_seconds() > 0;
    if (is_playing_) state_.seconds = std::fmod(state_.seconds + frame_seconds_, stage_->animation_seconds());
    const std::uint64_t version = stage_->version();
    stage_->set_time(state_.seconds);
    if (version != stage_->version()) forget_pick();
    set_reach();
    if (state_.shown != Shown::software && !stage_->hardware())
        fail("view: the device has no hardware accelerator: ", stage_->why_no_hardware());
    const bool is_new = is_stale_ || state_ != shown_ || is_coarse_ || is_playing_;
    const bool has_moved = state_.orbit != shown_.orbit || is_playing_;
    // It comes before the first sample of another picture.
    const bool wants_preview = traces_paths() && (is_stale_ || is_another_picture(state_, shown_));
    if (!is_new && !traces_paths()) return raster_;
    const uint grain = may_be_coarse && has_moved ? grain_ : 1;
    const bool is_preview = may_be_coarse && (has_moved || wants_preview);
    update_values();
    raster_ = drawn(grain, is_preview).raster;
    if (state_.shown != Shown::difference) draw_legend(raster_);
    shown_ = state_;
    is_coarse_ = is_preview;
    is_stale_ = false;
    frame_seconds_ = start.seconds();
    const double ideal = grain * std::sqrt(frame_seconds_ / seconds_while_moving);
    if (is_coarse_ || !traces_paths()) grain_ = std::clamp(static_cast<uint>(std::ceil(ideal)), 1u, coarsest);
    return raster_;
}

// Traces at the requested level, or the highest that the accelerator has.
std::vector<Hit> Viewer::hits_of(AbstractAccel& accel, std::span<const Ray> rays) {
    const Stopwatch start;
    std::vector<Hit> hits = accel.closest_hits(rays, {.level = std::min(state_.level, accel.options().level)});
    rays_a_second_ = static_cast<double>(rays.size()) / start.seconds();
    return hits;
}

FacePicture Viewer::drawn(uint grain, bool is_moving) {
    const uint width = (state_.width + grain - 1) / grain, height = (state_.height + grain - 1) / grain;
    Traced traced{width, height, rays_of(state_.orbit, width, height), {}};
    Raster coarse(width, height);
    if (state_.shown == Shown::wipe || state_.shown == Shown::difference) {
        Traced other = traced;
        traced.hits = hits_of(stage_->software(), traced.rays);
        other.hits = hits_of(*stage_->hardware(), other.rays);
        if (state_.shown == Shown::difference) {
            coarse = difference(traced, other, grain);
        } else {
            coarse = shaded(Shown::software, traced, is_moving);
            const Raster right = shaded(Shown::hardware, other, is_moving);
            const uint cut = std::min(width, static_cast<uint>(std::lround(state_.wipe * static_cast<float>(width))));
            for (uint y = 0; y < height; ++y)
                for (uint x = cut; x < width; ++x) coarse.at(x, y) = right.at(x, y);
        }
    } else {
        traced.hits = hits_of(accel_of(state_.shown), traced.rays);
        coarse = shaded(state_.shown, traced, is_moving);
    }
    FacePicture picture{.raster = grain == 1 ? std::move(coarse) : enlarged(coarse, state_.width, state_.height, grain),
                        .depths = depths_of(traced, state_.width, state_.height, grain),
                        .plane = image_plane(camera_of(state_.orbit),
                                             static_cast<float>(state_.width) / static_cast<float>(state_.height))};
    draw_over(picture);
    return picture;
}

Raster Viewer::shaded(Shown shown, const Traced& traced, bool is_moving) {
    const Scene& scene = stage_->scene();
    if (state_.layer == Layer::path && !is_moving) {
        std::unique_ptr<PathPicture>& path = paths_.at(static_cast<std::size_t>(shown));
        if (!path || !path->is_of(stage_->version(), state_.has_all_features))
            path = std::make_unique<PathPicture>(context_, scene, stage_->version(), state_.has_all_features);
        path->look(state_.orbit, traced.width, traced.height);
        path->add_sample(accel_of(shown));
        return path->picture(state_.exposure);
    }
    if (state_.layer == Layer::distance || (state_.layer == Layer::steps && shown == Shown::software)) {
        values_ = state_.layer == Layer::distance ? distances_of(traced) : steps_of(traced);
        return by_pixel(traced, [&](std::size_t i) { return values_.color(values_.numbers[i]); });
    }
    if (state_.layer == Layer::steps && shown == state_.shown) values_ = {};
    if (state_.layer == Layer::steps)  // no driver tells
        return by_pixel(traced, [&](std::size_t i) { return traced.hits[i].hit ? no_value_color : background; });
    if (!has_face_values(state_.layer) || values_.numbers.empty())
        return by_pixel(traced, [&](std::size_t i) {
            return color_of(state_.layer, scene, traced.rays[i], traced.hits[i], stage_->bounds());
        });
    const std::vector<std::size_t> first = first_faces(scene);
    return by_pixel(traced, [&](std::size_t i) {
        const Hit& hit = traced.hits[i];
        if (hit.hit == 0) return background;
        const double value = values_.numbers[first[hit.instance_index] + hit.primitive_index];
        return lit(scene, traced.rays[i], hit, values_.color(value));
    });
}

// Draws grey if both agree; else the colour of the one that is wrong.
Raster Viewer::difference(const Traced& software, const Traced& hardware, uint grain) {
    const Scene& scene = stage_->scene();
    Raster raster = by_pixel(software, [&](std::size_t i) {
        const Rgb color = color_of(Layer::eyelight, scene, software.rays[i], software.hits[i], stage_->bounds());
        return rgb_of_linear(vec3(0.25f) + linear_of(color) * 0.45f);
    });
    std::vector<std::size_t> unlike;
    for (std::size_t i = 0; i < software.hits.size(); ++i)
        if (!agree(software.hits[i], hardware.hits[i])) unlike.push_back(i);
    disagreements_ = unlike.size() * grain * grain;
    if (unlike.empty()) return raster;
    const Reference& reference = stage_->reference();
    std::vector<Rgb> colors(unlike.size());
    parallel_for(unlike.size(), [&](std::size_t k) {
        const std::size_t i = unlike[k];
        colors[k] = color_of_classes(reference.classify(software.rays[i], software.hits[i], TracedBy::software),
                                     reference.classify(hardware.rays[i], hardware.hits[i], TracedBy::hardware));
    });
    for (std::size_t k = 0; k < unlike.size(); ++k) {
        const auto x = static_cast<int>(unlike[k] % software.width), y = static_cast<int>(unlike[k] / software.width);
        fill(raster, {x - 1, y - 1, 3, 3}, colors[k]);
    }
    return raster;
}

// Measures on the plane through the camera's centre that faces it.
Values Viewer::distances_of(const Traced& traced) {
    const dvec3 forward = directions_of(state_.orbit).forward;
    std::vector<dvec3> points;
    for (const Ray& ray : traced.rays) {
        const dvec3 origin(ray.origin), direction(ray.direction);
        points.push_back(origin + direction * (dot(state_.orbit.center - origin, forward) / dot(direction, forward)));
    }
    Values values{.numbers = {}, .scale = {}, .what = "distance"};
    for (const ClosestPoint& found : stage_->points().closest(points))
        values.numbers.push_back(found.is_found ? found.distance : NAN);
    if (std::ranges::any_of(values.numbers, [](double number) { return number > 0; }))
        values.scale = ValueScale::linear_for(values.numbers);
    return values;
}

Values Viewer::steps_of(const Traced& traced) {
    const reference::Scene& cpu_reference = stage_->cpu_reference();
    Values values{.numbers = std::vector<double>(traced.rays.size()), .scale = {}, .what = "steps a ray"};
    parallel_for(traced.rays.size(), [&](std::size_t begin, std::size_t end) {
        reference::Scene::take_steps();
        for (std::size_t i = begin; i < end; ++i) {
            (void)cpu_reference.trace(traced.rays[i]);
            const TraversalSteps steps = reference::Scene::take_steps();
            values.numbers[i] = static_cast<double>(steps.nodes + steps.primitives);
        }
    });
    values.scale = ValueScale::linear_for(values.numbers);
    return values;
}

void Viewer::update_values() {
    const std::optional<std::size_t> face = state_.layer == Layer::factors && pick_ ? pick_->face : std::nullopt;
    const double hour = state_.layer == Layer::light ? state_.hour : 0;
    const ValuesKey key{state_.layer, stage_->version(), face, hour};
    if (values_of_ == key) return;
    values_of_.reset();
    values_ = {};
    if (state_.layer == Layer::light) values_ = light_on(*stage_, hour, state_.orbit.up);
    segments_.clear();
    if (state_.layer == Layer::collisions) values_ = contacts_of(*stage_, segments_);
    if (face) values_ = factors_from(*stage_, *face);
    values_of_ = key;
    if (state_.layer == Layer::factors && !face) message_ = "click a face to see view factors from it";
}

void Viewer::draw_over(FacePicture& picture) {
    if (state_.tree_depth) {
        const std::vector<Box> boxes = boxes_at(stage_->scene(), stage_->cpu_reference(), *state_.tree_depth);
        tree_boxes_ = boxes.size();
        tree_area_ = 0;
        for (const Box& box : boxes) tree_area_ += box.share;
        draw_strokes(picture, strokes_of(boxes, state_.has_area_colors ? BoxColor::area : BoxColor::kind));
    }
    draw_strokes(picture, segments_);
    Raster& raster = picture.raster;
    if (state_.shown == Shown::wipe) {
        const auto x = static_cast<int>(std::lround(state_.wipe * static_cast<float>(raster.width)));
        fill(raster, {x - 1, 0, 2, static_cast<int>(raster.height)}, ink);
    }
    if (pick_ && pick_->point)
        draw_dots(picture,
                  std::vector<Dot>{{.position = *pick_->point, .radius = 4, .color = pick_color, .behind = 0.5f}});
}

void Viewer::draw_legend(Raster& raster) const {
    if (!values_.scale || raster.width < 200 || raster.height < 60) return;
    constexpr int margin = 12, bar_width = 300, bar_height = 10;
    const int top = static_cast<int>(raster.height) - margin - bar_height;
    fill(raster, {margin - 6, top - text_height - 8, bar_width + 12, bar_height + text_height + 14}, paper);
    for (int x = 0; x < bar_width; ++x)
        fill(raster, {margin + x, top, 1, bar_height},
             values_.scale->color(values_.scale->value_at((x + 0.5) / bar_width)));
    draw_text(raster, margin, top - text_height - 2, fitted(range_text(*values_.scale) + values_.what, bar_width));
}

std::vector<std::string> Viewer::figures() const {
    std::vector<std::string> lines;
    const auto add_memory = [&](const char* whose, const MemoryUsage& usage) {
        lines.push_back(text(whose, ": ", usage.geometries >> 10, " KiB geometries, ", usage.scene >> 10,
                             " KiB scene, ", usage.instances >> 10, " KiB instances"));
    };
    lines.push_back(context_.properties().name + ", " + context_.properties().driver);
    lines.push_back(text(count_triangles(stage_->scene()), " triangles, ", stage_->scene().instances.size(),
                         " instances; built in ", std::lround(1000 * stage_->build_seconds()), " ms"));
    add_memory("software", stage_->software().memory_usage());
    if (stage_->hardware())
        add_memory("hardware", stage_->hardware()->memory_usage());
    else
        lines.push_back("hardware: none: " + stage_->why_no_hardware());
    if (stage_->refit_seconds() > 0)
        lines.push_back(text("posed and refitted in ", std::lround(1000 * stage_->refit_seconds()), " ms"));
    lines.push_back(text(state_.width, " x ", state_.height, ", ", std::lround(1000 * frame_seconds_),
                         " ms a frame; hits at level ", name_of(state_.level), ": ",
                         static_cast<double>(std::lround(1e-5 * rays_a_second_)) / 10, " Mrays/s with copies"));
    if (state_.layer == Layer::path && samples() > 0)
        lines.push_back(text(samples(), " samples a pixel, ",
                             static_cast<double>(std::lround(1e-5 * path_rays_a_second())) / 10, " Mrays/s, error ",
                             std::isfinite(path_error())
                                 ? text(static_cast<double>(std::lround(1000 * path_error())) / 10, " %")
                                 : "?"));
    if (state_.shown == Shown::difference) lines.push_back(text(disagreements_, " pixels where the two disagree"));
    if (state_.tree_depth)
        lines.push_back(text("level ", *state_.tree_depth, ": ", tree_boxes_, " boxes, together ",
                             static_cast<double>(std::lround(100 * tree_area_)) / 100, " of the root's area"));
    return lines;
}

const PathPicture* Viewer::shown_path() const { return paths_.at(state_.shown == Shown::hardware ? 1 : 0).get(); }

uint Viewer::samples() const { return shown_path() ? shown_path()->samples() : 0; }

double Viewer::path_error() const { return shown_path() ? shown_path()->error() : INFINITY; }

double Viewer::path_rays_a_second() const {
    const PathPicture* path = shown_path();
    return path && path->seconds() > 0 ? static_cast<double>(path->rays()) / path->seconds() : 0;
}

}  // namespace twinray::viewer
