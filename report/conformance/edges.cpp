// Edges and vertices that triangles share, and answers that must not depend on when they are asked for.
#include <algorithm>
#include <cstring>
#include <set>

#include "report/conformance/case_run.h"

namespace twinray::conformance {
namespace {

GeometryInput geometry_of(const Mesh& mesh) { return {.positions = mesh.positions, .triangles = mesh.triangles}; }

// Returns a vertex of a random triangle, or a point of one of its edges, in float64.
dvec3 edge_point(Draws& draws, const GeometryInput& geometry) {
    const uvec3 corners = geometry.triangles[draws.below(static_cast<uint>(geometry.triangles.size()))];
    const uint first = draws.below(3);
    const dvec3 a(geometry.positions[corners[first]]), b(geometry.positions[corners[(first + 1) % 3]]);
    const double along = draws.chance(0.5) ? 0 : draws.unit();
    return a + along * (b - a);
}

Shot aimed(vec3 origin, const dvec3& target) {
    return shot_of({origin, 0, vec3(normalize(target - dvec3(origin))), INFINITY});
}

Transform sphere_placement(Draws& draws) {
    return Transform::translation(vec3(draws.point(2))) * random_instance_transform(draws);
}

// Checks that every ray from inside hits something.
void check_closed(CaseRun& run, const Transform& placement) {
    SceneInput scene = scene_of(geometry_of(make_icosphere(2)));
    scene.top.instances[0].to_world = placement;
    std::vector<Shot> shots;
    for (std::size_t i = 0; i < run.rays(); ++i) {
        const vec3 inside = transform_point(placement, run.draws().point(0.375f));
        const dvec3 target(transform_point(placement, vec3(edge_point(run.draws(), scene.bottoms[0].geometries[0]))));
        shots.push_back(aimed(inside, target));
    }
    const DriverScene built = run.driver().build(scene);
    const Traced traced = run.driver().trace(built.top, shots);
    for (std::size_t i = 0; i < shots.size(); ++i)
        run.tally().add(traced.answers[i].kind == ANSWER_MISS ? Finding::leak : Finding::agrees, shots[i].ray);
}

void closed_mesh(CaseRun& run) { check_closed(run, {}); }
void closed_instance(CaseRun& run) { check_closed(run, sphere_placement(run.draws())); }

// Checks rays from above, where nothing overlaps: each must meet exactly one triangle of an edge or a vertex.
template <bool is_rough>
void single(CaseRun& run) {
    GeometryInput geometry = geometry_of(make_grid(8, 8, is_rough ? 0.0625f : 0, run.draws().below(1000)));
    geometry.flags = 0;
    std::vector<Shot> shots;
    while (shots.size() < run.rays()) {
        const dvec3 target = edge_point(run.draws(), geometry);
        // The rim has one owner only, and rounding may take a ray past it.
        if (std::min(target.x, target.z) < 0.0625 || std::max(target.x, target.z) > 0.9375) continue;
        const float x = is_rough ? run.draws().coordinate(0.25f) : 0, z = is_rough ? run.draws().coordinate(0.25f) : 0;
        shots.push_back(aimed(vec3(target + dvec3(x, 4, z)), target));
        shots.back().refused = refuse_all;
    }
    const DriverScene built = run.driver().build(scene_of(geometry));
    const Traced traced = run.driver().trace(built.top, shots, candidate_slots);
    for (std::size_t i = 0; i < shots.size(); ++i) {
        const std::span<const uint> offered = traced.candidates_of(i);
        const std::size_t owners = std::set<uint>(offered.begin(), offered.end()).size();
        run.tally().add(owners == 0   ? Finding::leak
                        : owners == 1 ? Finding::agrees
                                      : Finding::double_hit,
                        shots[i].ray);
    }
}

// Checks that a hit at an edge names one of its owners, with the values of float64.
void owners(CaseRun& run) {
    const GeometryInput geometry = geometry_of(make_grid(3, 3, 0.25f, run.draws().below(1000)));
    std::vector<Shot> shots = run.shots(2);
    for (std::size_t i = 0; i < run.rays() / 2; ++i) {
        const vec3 origin = run.draws().point(1) + vec3(0.5f, 4, 0.5f);
        shots.push_back(aimed(origin, edge_point(run.draws(), geometry)));
    }
    run.check_hits(scene_of(geometry), shots);
}

bool is_same(const Answer& a, const Answer& b) { return std::memcmp(&a, &b, sizeof(Answer)) == 0; }

void compare(CaseRun& run, std::span<const Shot> shots, std::span<const Answer> first, std::span<const Answer> second) {
    for (std::size_t i = 0; i < shots.size(); ++i)
        run.tally().add(is_same(first[i], second[i]) ? Finding::agrees : Finding::differs, shots[i].ray);
}

SceneInput dense(CaseRun& run) {
    SceneInput scene = scene_of(random_triangles(run.draws(), 48));
    scene.top.instances.resize(3);
    for (InstanceInput& instance : scene.top.instances) instance.to_world = random_instance_transform(run.draws());
    return scene;
}

void same_trace(CaseRun& run) {
    const DriverScene built = run.driver().build(dense(run));
    const std::vector<Shot> shots = run.shots();
    const Traced first = run.driver().trace(built.top, shots);
    compare(run, shots, first.answers, run.driver().trace(built.top, shots).answers);
}

void same_build(CaseRun& run) {
    const SceneInput scene = dense(run);
    const std::vector<Shot> shots = run.shots();
    const Traced first = run.driver().trace(run.driver().build(scene).top, shots);
    const DriverScene again = run.driver().build(scene);
    compare(run, shots, first.answers, run.driver().trace(again.top, shots).answers);
}

void other_order(CaseRun& run) {
    const DriverScene built = run.driver().build(dense(run));
    const std::vector<Shot> shots = run.shots();
    const std::vector<Shot> reversed(shots.rbegin(), shots.rend());
    const Traced first = run.driver().trace(built.top, shots);
    Traced second = run.driver().trace(built.top, reversed);
    std::ranges::reverse(second.answers);
    compare(run, shots, first.answers, second.answers);
}

}  // namespace

std::vector<Case> edge_cases() {
    using enum Misdeed;
    return {
        {"K79", Topic::edges, "rays at edges and vertices from inside a closed mesh", "VK-GL-CTS watertightness",
         "every ray hits a triangle", leaks, closed_mesh, Demand::should},
        {"K80", Topic::edges, "the same in an instance that is turned and sheared", "VK-GL-CTS watertightness",
         "every ray hits a triangle", leaks, closed_instance, Demand::should},
        {"K81", Topic::edges, "rays straight at edges and vertices of a flat grid of one winding",
         "VK-GL-CTS single hit", "one triangle each, whichever", leaks, single<false>, Demand::should},
        {"K82", Topic::edges, "rays aslant at edges and vertices of a rough field of one winding",
         "VK-GL-CTS single hit", "one triangle each, whichever", leaks, single<true>, Demand::should},
        {"K83", Topic::edges, "rays at edges and vertices, and between", "VK-GL-CTS, slang-rhi closest hits",
         "hits are those of float64, of either owner at an edge", forgets_later_half, owners},
        {"K84", Topic::determinism, "the same rays twice", "repeated commands", "the same bits", wavers, same_trace,
         Demand::should},
        {"K85", Topic::determinism, "the same scene built twice", "repeated commands", "the same bits", wavers,
         same_build, Demand::should},
        {"K86", Topic::determinism, "the same rays in reversed order", "order of invocations", "the same bits", wavers,
         other_order, Demand::should},
    };
}

}  // namespace twinray::conformance
