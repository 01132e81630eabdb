// SPDX-License-Identifier: MIT
#include "viewer/picture/marks.h"
#include "twinray/glsl/vector_math.h"

#include <algorithm>

namespace twinray {
namespace {

// A point of a picture, in pixels from its upper left corner.
struct Placed {
    vec2 at;
    float depth;
};

std::optional<Placed> place(const FacePicture& picture, dvec3 position) {
    const std::optional<Projected> projected = project(picture.plane, position);
    if (!projected) return {};
    const vec2 size(picture.raster.width, picture.raster.height);
    return Placed{(projected->point * vec2(1, -1) + 1.0f) * 0.5f * size, projected->depth};
}

// Returns the size of a pixel at this depth, in world space.
float pixel_size(const FacePicture& picture, float depth) {
    const float at_one = 2 * length(picture.plane.right) / static_cast<float>(picture.raster.width);
    return picture.plane.is_orthographic ? at_one : at_one * depth;
}

// The stretch between two points, which may be one, covers the pixels that are no farther from it than the radius.
struct Stretch {
    Placed from, to;
    float radius;
    Rgb color;
    float behind;
};

// Returns the position on the stretch that is nearest to `at`, from 0 to 1.
float nearest(const Stretch& stretch, vec2 at) {
    const vec2 way = stretch.to.at - stretch.from.at;
    const float square = dot(way, way);
    return square > 0 ? std::clamp(dot(at - stretch.from.at, way) / square, 0.0f, 1.0f) : 0;
}

// Along a line in perspective the inverse of depth is linear in the picture.
float depth_at(const FacePicture& picture, const Stretch& stretch, float place) {
    const float a = stretch.from.depth, b = stretch.to.depth;
    return picture.plane.is_orthographic ? mix(a, b, place) : 1 / mix(1 / a, 1 / b, place);
}

void draw(FacePicture& picture, const Stretch& stretch) {
    const float reach = stretch.radius + 1;
    const vec2 size(picture.raster.width, picture.raster.height);
    const vec2 low = clamp(min(stretch.from.at, stretch.to.at) - reach, vec2(0), size);
    const vec2 high = clamp(max(stretch.from.at, stretch.to.at) + reach, vec2(0), size);
    for (uint y = static_cast<uint>(low.y); static_cast<float>(y) < high.y; ++y)
        for (uint x = static_cast<uint>(low.x); static_cast<float>(x) < high.x; ++x) {
            const vec2 center = vec2(x, y) + 0.5f;
            const float place = nearest(stretch, center);
            const float distance = length(center - mix(stretch.from.at, stretch.to.at, place));
            const float coverage = std::clamp(stretch.radius + 0.5f - distance, 0.0f, 1.0f);
            if (coverage == 0) continue;
            const float depth = depth_at(picture, stretch, place), thickness = 2 * std::max(stretch.radius, 1.0f);
            const float bulge = std::sqrt(std::max(thickness * thickness - distance * distance, 0.0f));
            const float front = depth - bulge * pixel_size(picture, depth);
            const bool is_seen = front <= picture.depths[std::size_t{y} * picture.raster.width + x];
            const float share = is_seen ? 1 : stretch.behind;
            if (share > 0) blend(picture.raster.at(x, y), stretch.color, coverage * share);
        }
}

constexpr int label_border = 3;

bool overlap(const Rect& a, const Rect& b) {
    return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

// Places a label beside a point: to the right if there is room, else to the left, and off the others, above or below.
Rect label_box(const Raster& raster, const Placed& at, int text_wide, std::span<const Rect> taken) {
    constexpr int away = 8, most_steps = 16;
    const int dot = static_cast<int>(at.at.x), width = text_wide + 2 * label_border,
              height = text_height + 2 * label_border;
    const bool has_room = dot + away + width <= static_cast<int>(raster.width);
    Rect box{has_room ? dot + away : dot - away - width, static_cast<int>(at.at.y) - height / 2, width, height};
    const int level = box.y;
    for (int step = 1; step <= most_steps; ++step) {
        if (std::ranges::none_of(taken, [&](const Rect& other) { return overlap(box, other); })) break;
        box.y = level + (step % 2 ? 1 : -1) * (step + 1) / 2 * height;
    }
    return box;
}

}  // namespace

std::optional<vec2> place_of(const FacePicture& picture, dvec3 position) {
    const std::optional<Placed> at = place(picture, position);
    return at ? std::optional(at->at) : std::nullopt;
}

void draw_dots(FacePicture& picture, std::span<const Dot> dots) {
    for (const Dot& dot : dots)
        if (const std::optional<Placed> at = place(picture, dot.position))
            draw(picture, {*at, *at, dot.radius, dot.color, dot.behind});
}

void draw_strokes(FacePicture& picture, std::span<const Stroke> strokes) {
    for (const Stroke& stroke : strokes) {
        const std::optional<Placed> from = place(picture, stroke.from), to = place(picture, stroke.to);
        if (from && to) draw(picture, {*from, *to, stroke.radius, stroke.color, stroke.behind});
    }
}

void draw_labels(FacePicture& picture, std::span<const Note> notes) {
    std::vector<Rect> taken;
    for (const Note& note : notes) {
        const std::optional<Placed> at = place(picture, note.position);
        if (!at || note.label.empty()) continue;
        const Rect box = label_box(picture.raster, *at, text_width(note.label), taken);
        taken.push_back(box);
        fill(picture.raster, box, paper);
        draw_text(picture.raster, box.x + label_border, box.y + label_border, note.label);
    }
}

}  // namespace twinray
