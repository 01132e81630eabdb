#include "report/conformance/inputs.h"

namespace twinray::conformance {
namespace {

constexpr std::array<std::string_view, misdeed_count> misdeed_names = {"none",
                                                                       "forgets the later half of the primitives",
                                                                       "forgets flags of geometries",
                                                                       "forgets transforms",
                                                                       "forgets masks of instances",
                                                                       "forgets flags of instances",
                                                                       "forgets ids of instances",
                                                                       "forgets updates",
                                                                       "copies in part",
                                                                       "forgets flags of rays",
                                                                       "forgets masks of rays",
                                                                       "forgets refusals",
                                                                       "forgets t_min and t_max",
                                                                       "moves what boxes hold",
                                                                       "loses candidates",
                                                                       "offers candidates twice",
                                                                       "leaks",
                                                                       "wavers",
                                                                       "garbles headers",
                                                                       "takes any file"};

constexpr std::size_t every = 8;

void shorten(GeometryInput& geometry) {
    geometry.boxes.resize((geometry.boxes.size() + 1) / 2);
    geometry.triangles.resize((geometry.triangles.size() + 1) / 2);
}

void change_last_candidate(Traced& traced, std::size_t shot, bool is_doubled) {
    Answer& answer = traced.answers[shot];
    if (answer.triangles == 0 || answer.triangles + answer.boxes >= traced.slots) return;
    const std::size_t end = shot * traced.slots + answer.triangles + answer.boxes;
    if (is_doubled) traced.candidates[end] = traced.candidates[end - 1];
    answer.triangles += is_doubled ? 1 : -1;
}

}  // namespace

float Draws::coordinate(float extent) {
    const int steps = static_cast<int>(extent * 0x1p10f);
    return static_cast<float>(static_cast<int>(below(static_cast<uint>(2 * steps + 1))) - steps) * 0x1p-10f;
}

vec3 Draws::point(float extent) {
    const float x = coordinate(extent), y = coordinate(extent);
    return {x, y, coordinate(extent)};
}

vec3 Draws::direction() {
    for (;;) {
        const vec3 point = this->point(2);
        const vec3 rounded(std::round(point.x * 0x1p8f) * 0x1p-8f, std::round(point.y * 0x1p8f) * 0x1p-8f,
                           std::round(point.z * 0x1p8f) * 0x1p-8f);
        const float square = dot(rounded, rounded);
        if (square >= 0.25f && square <= 4) return rounded;
    }
}

GeometryInput random_triangles(Draws& draws, uint count) {
    GeometryInput geometry;
    while (geometry.triangles.size() < count) {
        const vec3 center = draws.point(1);
        const std::array<vec3, 3> corners = {center + draws.point(0.5f), center + draws.point(0.5f),
                                             center + draws.point(0.5f)};
        const dvec3 normal = cross(dvec3(corners[1] - corners[0]), dvec3(corners[2] - corners[0]));
        if (length(normal) < 0.1) continue;
        const uint first = static_cast<uint>(geometry.positions.size());
        geometry.positions.insert(geometry.positions.end(), corners.begin(), corners.end());
        geometry.triangles.emplace_back(first, first + 1, first + 2);
    }
    return geometry;
}

GeometryInput layered_boxes(uint count) {
    GeometryInput geometry;
    for (uint i = 0; i < count; ++i) {
        const float z = 2 * static_cast<float>(i);
        geometry.boxes.push_back({vec3(-1, -1, z), vec3(1, 1, z + 1)});
    }
    return geometry;
}

GeometryInput layered_triangles(uint count) {
    GeometryInput geometry;
    for (uint i = 0; i < count; ++i) {
        const float z = 2 * static_cast<float>(i);
        geometry.positions.insert(geometry.positions.end(), {vec3(-4, -4, z), vec3(8, -4, z), vec3(-4, 8, z)});
        geometry.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    return geometry;
}

SceneInput scene_of(GeometryInput geometry) { return scene_of(std::vector<GeometryInput>{std::move(geometry)}); }

SceneInput scene_of(std::vector<GeometryInput> geometries) {
    SceneInput scene;
    scene.bottoms.push_back({std::move(geometries), VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR});
    scene.top.instances.push_back({});
    return scene;
}

SceneInput scene_of_both(std::vector<GeometryInput> triangles, std::vector<GeometryInput> boxes) {
    SceneInput scene = scene_of(std::move(triangles));
    scene.bottoms.push_back({std::move(boxes), scene.bottoms[0].flags});
    scene.top.instances.push_back({.bottom = 1});
    return scene;
}

Shot shot_of(const Ray& ray) {
    return {.ray = ray,
            .flags = no_flags,
            .cull_mask = all_instances,
            .refused = 0,
            .box_t = 0,
            .box_step = 0,
            .reserved = 0};
}

std::vector<Shot> random_shots(Draws& draws, std::size_t count, float extent) {
    constexpr float inf = std::numeric_limits<float>::infinity();
    std::vector<Shot> shots;
    while (shots.size() < count) {
        const vec3 direction = draws.direction();
        const vec3 target = draws.point(extent);
        shots.push_back(shot_of({target - 4.0f * direction, 0, direction, inf}));
    }
    return shots;
}

std::vector<Shot> layer_shots(Draws& draws, std::size_t count) {
    std::vector<Shot> shots;
    for (std::size_t i = 0; i < count; ++i) {
        const float x = draws.coordinate(0.75f), y = draws.coordinate(0.75f);
        shots.push_back(shot_of({vec3(x, y, -1), 0, vec3(0, 0, 1), std::numeric_limits<float>::infinity()}));
    }
    return shots;
}

std::vector<Shot> box_shots(Draws& draws, std::size_t count) {
    std::vector<Shot> shots = layer_shots(draws, count);
    for (Shot& shot : shots) shot.box_t = 1.5f, shot.box_step = 2;
    return shots;
}

Transform random_instance_transform(Draws& draws) {
    for (;;) {
        Transform placement;
        for (vec4& row : placement.rows) {
            const vec3 linear = draws.point(1.5f);
            row = vec4(linear, draws.coordinate(2));
        }
        const double size = std::abs(determinant(placement));
        if (size > 0.5 && size < 4) return placement;
    }
}

std::string_view name_of(Misdeed misdeed) { return misdeed_names[static_cast<std::size_t>(misdeed)]; }

void shorten(BottomInput& input) {
    for (GeometryInput& geometry : input.geometries) shorten(geometry);
}

void shorten(TopInput& input) { input.instances.resize((input.instances.size() + 1) / 2); }

void spoil(Misdeed misdeed, BottomInput& input) {
    if (misdeed == Misdeed::forgets_later_half) shorten(input);
    for (GeometryInput& geometry : input.geometries) {
        if (misdeed == Misdeed::forgets_geometry_flags) geometry.flags = VK_GEOMETRY_OPAQUE_BIT_KHR;
        if (misdeed == Misdeed::forgets_transforms && geometry.transform) geometry.transform = Transform{};
    }
}

void spoil(Misdeed misdeed, TopInput& input) {
    for (InstanceInput& instance : input.instances) {
        if (misdeed == Misdeed::forgets_transforms) instance.to_world = {};
        if (misdeed == Misdeed::forgets_instance_masks) instance.mask = 0xff;
        if (misdeed == Misdeed::forgets_instance_flags) instance.flags = 0;
        if (misdeed == Misdeed::forgets_instance_ids) instance.custom_index = instance.sbt_offset = 0;
    }
}

void spoil(Misdeed misdeed, std::vector<Shot>& shots) {
    for (Shot& shot : shots) {
        if (misdeed == Misdeed::forgets_ray_flags) shot.flags = no_flags;
        if (misdeed == Misdeed::forgets_ray_masks) shot.cull_mask = all_instances;
        if (misdeed == Misdeed::forgets_refusals) shot.refused = 0;
        if (misdeed == Misdeed::moves_boxes) shot.box_t += 1;
        if (misdeed == Misdeed::forgets_limits) {
            shot.ray.t_min = 0;
            shot.ray.t_max = std::numeric_limits<float>::infinity();
        }
    }
}

void spoil(Misdeed misdeed, Traced& traced, std::size_t turn) {
    std::size_t hits = 0;
    for (std::size_t i = 0; i < traced.answers.size(); ++i) {
        Answer& answer = traced.answers[i];
        if (misdeed == Misdeed::loses_candidates) change_last_candidate(traced, i, false);
        if (misdeed == Misdeed::doubles_candidates) change_last_candidate(traced, i, true);
        if (answer.kind == ANSWER_MISS && answer.triangles + answer.boxes == 0) continue;
        if (misdeed == Misdeed::leaks && ++hits % every == turn % every) answer = Answer{};
        if (misdeed == Misdeed::wavers && turn % 2 == 1) {
            answer.t = std::nextafter(answer.t, 0.0f);
            answer.uv.x = std::nextafter(answer.uv.x, 1.0f);
        }
    }
}

}  // namespace twinray::conformance
