// SPDX-License-Identifier: MIT
#include "viewer/face_values.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <twinray/queries.h>

#include "twinray/glsl/vector_math.h"
#include "viewer/picture/face_picture.h"

namespace twinray::viewer {
namespace {

constexpr uint side_of_light = 1024;              // rays along each side of the grid
constexpr std::uint64_t rays_of_row = 1u << 18u;  // of view factors

}  // namespace

dvec3 sun_at(double hour, UpAxis up) {
    const double turn = std::numbers::pi * (hour - 6) / 12;
    const double east = std::cos(turn), height = std::sin(turn), north = -0.3;
    return up == UpAxis::y ? dvec3(east, height, -north) : dvec3(east, north, height);
}

Values light_on(Stage& stage, double hour, UpAxis up) {
    const dvec3 sun = sun_at(hour, up);
    const Illumination lit = illuminate(stage.software(), stage.faces(),
                                        {.grid = {.direction = -sun, .side = side_of_light}, .sides = Sides::both});
    Values values{.numbers = {}, .scale = ValueScale::linear(0, 1), .what = "sunlit share"};
    for (const LitArea& face : lit.groups) values.numbers.push_back(face.unobstructed > 0 ? face.fraction() : NAN);
    return values;
}

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

}  // namespace twinray::viewer
