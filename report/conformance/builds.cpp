// Builds: flags, several geometries, empty builds, inactive primitives, offsets of data, formats of indices and
// vertices, and bytes between them.
#include <algorithm>

#include "report/conformance/case_run.h"

namespace twinray::conformance {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

void every_preference(CaseRun& run) {
    constexpr VkBuildAccelerationStructureFlagsKHR trace = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR,
                                                   build = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_BUILD_BIT_KHR,
                                                   small = VK_BUILD_ACCELERATION_STRUCTURE_LOW_MEMORY_BIT_KHR,
                                                   update = VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_UPDATE_BIT_KHR,
                                                   compact = VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_COMPACTION_BIT_KHR;
    SceneInput scene = usual_scene(run.draws());
    for (const auto flags : {trace, build, trace | small, build | small, trace | update, build | update | compact}) {
        scene.bottoms[0].flags = scene.top.flags = flags;
        run.check_hits(scene, run.shots(6));
    }
}

void several_geometries(CaseRun& run) {
    std::vector<GeometryInput> geometries;
    for (uint i = 0; i < 4; ++i) geometries.push_back(random_triangles(run.draws(), 2 + 4 * i));
    geometries[1].flags = geometries[2].flags = 0;
    std::vector<Shot> shots = run.shots();
    for (Shot& shot : shots) shot.refused = run.draws().below(256);
    run.check_hits(scene_of(geometries), shots);
}

void one_command(CaseRun& run) {
    SceneInput scene;
    for (uint i = 0; i < 3; ++i) {
        scene.bottoms.push_back({{random_triangles(run.draws(), 6 + i)}});
        scene.top.instances.push_back({.bottom = i});
    }
    const std::vector<Bottom> bottoms = run.driver().build_together(scene.bottoms);
    run.check_hits(scene, run.driver().build(scene.top, bottoms), run.shots());
}

void nothing(CaseRun& run) {
    SceneInput scene = usual_scene(run.draws());
    GeometryInput empty;
    empty.positions = {vec3(0)};
    scene.bottoms.push_back({{empty}});
    scene.bottoms.push_back({});
    scene.top.instances.insert(scene.top.instances.begin(), {.bottom = 1});
    scene.top.instances.push_back({.bottom = 2});
    run.check_hits(scene, run.shots());
    run.check_hits(SceneInput{}, run.shots());
}

void inactive_triangles(CaseRun& run) {
    GeometryInput geometry = random_triangles(run.draws());
    for (uint i = 0; i < usual_triangle_count; i += 3) geometry.positions[3 * i + run.draws().below(3)].x = nan;
    run.check_hits(scene_of(geometry), run.shots());
}

void degenerate_triangles(CaseRun& run) {
    GeometryInput geometry = random_triangles(run.draws());
    for (uint i = 0; i < usual_triangle_count; i += 3)
        geometry.positions[3 * i + 2] = geometry.positions[3 * i + run.draws().below(2)];
    run.check_hits(scene_of(geometry), run.shots());
}

void inactive_boxes(CaseRun& run) {
    GeometryInput geometry = layered_boxes(6);
    geometry.boxes[run.draws().below(3)].lo.x = nan;
    std::vector<Shot> shots = box_shots(run.draws(), run.rays());
    for (Shot& shot : shots) shot.refused = run.draws().below(64);
    run.check_hits(scene_of(geometry), shots);
    run.check_candidates(scene_of(geometry), shots);
}

void inactive_instances(CaseRun& run) {
    SceneInput scene = usual_scene(run.draws());
    scene.top.instances.insert(scene.top.instances.begin(), {.bottom = no_bottom});
    run.check_hits(scene, run.shots());
}

void pointers(CaseRun& run) {
    SceneInput scene = usual_scene(run.draws());
    scene.top.instances.resize(3);
    for (uint i = 0; i < 3; ++i) scene.top.instances[i].custom_index = 7 + i;
    for (uint i = 0; i < 3; ++i) scene.top.instances[i].mask = 1u << i;
    scene.top.has_pointers = true;
    std::vector<Shot> shots = run.shots();
    for (Shot& shot : shots) shot.cull_mask = 1 + run.draws().below(7);
    run.check_hits(scene, shots);
}

// Puts one to four times `step` items that the build must skip in front.
template <std::uint32_t GeometryInput::*earlier, std::uint32_t step>
void later(CaseRun& run) {
    for (const Indices indices : {Indices::none, Indices::bits16, Indices::bits32}) {
        GeometryInput geometry = random_triangles(run.draws());
        geometry.indices = indices;
        geometry.*earlier = step * (1 + run.draws().below(4));
        run.check_hits(scene_of(geometry), run.shots(3));
    }
}

void later_boxes(CaseRun& run) {
    GeometryInput geometry = layered_boxes(5);
    geometry.earlier_items = 1 + run.draws().below(4);
    run.check_candidates(scene_of(geometry), layer_shots(run.draws(), run.rays()));
}

// Returns an exact transform: a turn, mirrors, a scale by a power of two and a move.
Transform exact_placement(Draws& draws) {
    Transform placement;
    const uint turn = draws.below(3);
    const float size = draws.chance(0.5) ? 0.5f : 2.0f;
    for (std::size_t row = 0; row < 3; ++row) {
        vec4& entries = placement.rows[row];
        entries = vec4(0, 0, 0, draws.coordinate(1));
        entries[(row + turn) % 3] = draws.chance(0.5) ? size : -size;
    }
    return placement;
}

void placed_geometries(CaseRun& run) {
    std::vector<GeometryInput> geometries;
    for (uint i = 0; i < 3; ++i) {
        geometries.push_back(random_triangles(run.draws(), 8));
        if (i != 1) geometries[i].transform = exact_placement(run.draws());
    }
    geometries[2].earlier_places = 2;
    run.check_hits(scene_of(geometries), run.shots());
}

// Makes triangles that share vertices, in no order.
GeometryInput shared_vertices(Draws& draws, uint count) {
    GeometryInput geometry = random_triangles(draws, count);
    const uint vertices = static_cast<uint>(geometry.positions.size());
    for (uint i = 0; i < count; ++i) {
        uvec3 corners(draws.below(vertices), draws.below(vertices), draws.below(vertices));
        const vec3 a = geometry.positions[corners.x], b = geometry.positions[corners.y],
                   c = geometry.positions[corners.z];
        if (length(cross(dvec3(b - a), dvec3(c - a))) > 0.1) geometry.triangles.push_back(corners);
    }
    return geometry;
}

void index_formats(CaseRun& run) {
    for (const Indices indices : {Indices::bits16, Indices::bits32, Indices::none}) {
        GeometryInput geometry = indices == Indices::none ? random_triangles(run.draws())
                                                          : shared_vertices(run.draws(), usual_triangle_count);
        geometry.indices = indices;
        run.check_hits(scene_of(geometry), run.shots(3));
    }
}

bool is_flat(VkFormat format) {
    return format == VK_FORMAT_R32G32_SFLOAT || format == VK_FORMAT_R16G16_SFLOAT || format == VK_FORMAT_R16G16_SNORM;
}
bool is_normalized(VkFormat format) {
    return format == VK_FORMAT_R16G16_SNORM || format == VK_FORMAT_R16G16B16A16_SNORM;
}

// Returns the nearest position that the format can hold.
vec3 held(VkFormat format, vec3 p) {
    if (is_flat(format)) p.z = 0;
    if (!is_normalized(format)) return p;
    const auto snorm = [](float value) { return std::round(std::clamp(value, -1.0f, 1.0f) * 32767) / 32767; };
    return {snorm(p.x), snorm(p.y), snorm(p.z)};
}

void vertex_formats(CaseRun& run) {
    for (const VkFormat format :
         {VK_FORMAT_R32G32_SFLOAT, VK_FORMAT_R32G32B32_SFLOAT, VK_FORMAT_R16G16_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT,
          VK_FORMAT_R16G16_SNORM, VK_FORMAT_R16G16B16A16_SNORM}) {
        GeometryInput geometry = random_triangles(run.draws());
        geometry.format = format;
        for (vec3& position : geometry.positions) position = held(format, position);
        run.check_hits(scene_of(geometry), run.shots(6));
    }
}

void vertex_strides(CaseRun& run) {
    for (const std::uint32_t padding : {4u, 8u, 20u}) {
        GeometryInput geometry = random_triangles(run.draws());
        geometry.padding = padding;
        geometry.format = padding == 8 ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_R32G32B32_SFLOAT;
        geometry.indices = padding == 20 ? Indices::none : Indices::bits32;
        run.check_hits(scene_of(geometry), run.shots(3));
    }
}

void box_strides(CaseRun& run) {
    GeometryInput geometry = layered_boxes(5);
    geometry.padding = 8 * (1 + run.draws().below(3));
    run.check_candidates(scene_of(geometry), layer_shots(run.draws(), run.rays()));
}

}  // namespace

std::vector<Case> build_cases() {
    using enum Misdeed;
    constexpr Topic topic = Topic::builds;
    const std::string same = "hits are those of float64";
    return {
        {"K01", topic, "fast trace, fast build, low memory, updates, compaction", "VK-GL-CTS builds", same,
         forgets_later_half, every_preference},
        {"K02", topic, "four geometries in a bottom level, two of them not opaque", "VK-GL-CTS builds", same,
         forgets_later_half, several_geometries},
        {"K03", topic, "three bottom levels by one command", "VK-GL-CTS builds", same, forgets_later_half, one_command},
        {"K04", topic, "no geometry, no triangle, no instance", "VK-GL-CTS empty structures",
         "nothing is hit there, and other hits are those of float64", forgets_later_half, nothing},
        {"K05", topic, "triangles with NaN as an x", "VK-GL-CTS inactive triangles",
         "they are not hit, and others keep their index", forgets_later_half, inactive_triangles},
        {"K06", topic, "triangles with two equal vertices", "VK-GL-CTS degenerate triangles",
         "they are not hit, and others keep their index", forgets_later_half, degenerate_triangles},
        {"K07", topic, "boxes with NaN as the least x", "VK-GL-CTS inactive boxes",
         "they are not offered, and others keep their index", forgets_later_half, inactive_boxes},
        {"K08", topic, "an instance of address 0", "VK-GL-CTS inactive instances",
         "it is not hit, and others keep their index", forgets_later_half, inactive_instances},
        {"K09", topic, "instances by an array of pointers", "VK-GL-CTS array of pointers", same, forgets_instance_ids,
         pointers},
        {"K10", topic, "triangles from primitiveOffset on", "VK-GL-CTS build offsets", same, forgets_later_half,
         later<&GeometryInput::earlier_items, 1>},
        {"K11", topic, "boxes from primitiveOffset on", "VK-GL-CTS build offsets",
         "the boxes that a ray meets are offered", forgets_later_half, later_boxes},
        {"K12", topic, "vertices from firstVertex on", "VK-GL-CTS build offsets", same, forgets_later_half,
         later<&GeometryInput::first_vertex, 3>},
        {"K13", topic, "geometries with transforms, one from transformOffset on", "VK-GL-CTS transforms", same,
         forgets_transforms, placed_geometries},
        {"K14", topic, "indices of 16 and 32 bits, and none", "VK-GL-CTS index formats", same, forgets_later_half,
         index_formats},
        {"K15", topic, "the six vertex formats that every driver has", "VK-GL-CTS vertex formats", same,
         forgets_later_half, vertex_formats},
        {"K16", topic, "vertices with bytes between them", "VK-GL-CTS vertex strides", same, forgets_later_half,
         vertex_strides},
        {"K17", topic, "boxes with bytes between them", "VK-GL-CTS box strides",
         "the boxes that a ray meets are offered", forgets_later_half, box_strides},
    };
}

}  // namespace twinray::conformance
