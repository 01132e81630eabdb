// SPDX-License-Identifier: MIT
// Triangles and instances that touch: their classes are known, or computed by exact arithmetic.
#include <twinray/queries.h>

#include <algorithm>
#include <cmath>

#include "report/suite/contacts.h"
#include "report/suite/scenes.h"
#include "engine/collide/exact_class.h"
#include "engine/core/error.h"
#include <twinray/geometry.h>

namespace twinray::suite {
namespace {

using enum PairClass;

const WorldTriangle base = {dvec3(0, 0, 0), dvec3(4, 0, 0), dvec3(0, 4, 0)};

WorldTriangle moved_by(const WorldTriangle& t, const dvec3& by) { return {t.a + by, t.b + by, t.c + by}; }

void touches(CaseRun& run) {
    const dvec3 up(0, 0, 1), above(1, 2, 1);
    ask_classes(run, {{base, {dvec3(0, 0, 0), dvec3(-1, 0, 1), dvec3(0, -1, 1)}, vertex_touch},
                      {base, {dvec3(2, 0, 0), dvec3(2, -1, 1), above}, vertex_touch},
                      {base, {dvec3(1, 1, 0), above, dvec3(2, 1, 1)}, vertex_touch},
                      {base, {dvec3(1, 1, 0), dvec3(1, 2, 0), above}, edge_touch},
                      {base, {dvec3(1, 0, 0), dvec3(3, 0, 0), dvec3(2, -1, 1)}, edge_touch},
                      {base, {dvec3(2, -1, -1), dvec3(2, 1, 1), dvec3(2, -5, 5)}, edge_touch},
                      {base, {dvec3(1, 1, -1), dvec3(1, 1, 1), dvec3(2, 1, 1)}, crossing},
                      {base, moved_by(base, up), separate}});
}

void coplanar(CaseRun& run) {
    ask_classes(run, {{base, base, coplanar_overlap},
                      {base, moved_by(base, dvec3(1, 1, 0)), coplanar_overlap},
                      {base, {dvec3(1, 1, 0), dvec3(2, 1, 0), dvec3(1, 2, 0)}, coplanar_overlap},
                      {base, moved_by(base, dvec3(4, 0, 0)), coplanar_touch},
                      {base, {dvec3(4, 0, 0), dvec3(0, 4, 0), dvec3(4, 4, 0)}, coplanar_touch},
                      {base, {dvec3(1, 0, 0), dvec3(3, 0, 0), dvec3(2, -2, 0)}, coplanar_touch},
                      {base, {dvec3(3, 3, 0), dvec3(4, 3, 0), dvec3(3, 4, 0)}, separate}});
}

// Adds a pair with a vertex above, on or below a face by this gap.
void add_gap(std::vector<KnownPair>& pairs, double level, double gap) {
    const WorldTriangle pointed = {dvec3(1, 1, level + gap), dvec3(1, 1.5, level + 1), dvec3(2, 1, level + 1)};
    pairs.push_back({moved_by(base, dvec3(0, 0, level)), pointed,
                     gap > 0   ? separate
                     : gap < 0 ? crossing
                               : vertex_touch});
}

void ulps(CaseRun& run) {
    std::vector<KnownPair> pairs;
    for (const float level : {0.0f, 1.0f, 1e3f, 1e6f}) {
        const double ulp = double{std::nextafter(level, INFINITY)} - double{level};
        for (int k = -4; k <= 4; ++k) add_gap(pairs, level, k * ulp);
    }
    ask_classes(run, pairs);
}

void colliding_gaps(CaseRun& run) {
    std::vector<KnownPair> pairs;
    for (int exponent = -7; exponent >= -30; --exponent)
        for (const double sign : {-1.0, 1.0}) add_gap(pairs, 0, sign * std::pow(10.0, exponent));
    ask_classes(run, pairs);
}

// Tests triangles that cross at an angle of 10^-8, also as needles of that width, and the same a little apart.
void colliding_slivers(CaseRun& run) {
    std::vector<KnownPair> pairs;
    for (const double width : {1.0, 1e-4, 1e-8}) {
        const auto tilted = [&](double tilt, double lift) {
            return WorldTriangle{dvec3(-width, -0.5, lift - 0.5 * tilt), dvec3(width, -0.5, lift - 0.5 * tilt),
                                 dvec3(0, 0.5, lift + 0.5 * tilt)};
        };
        pairs.push_back({tilted(0, 0), tilted(1e-8, 0), crossing});
        pairs.push_back({tilted(0, 0), tilted(1e-8, 1e-8), separate});
    }
    ask_classes(run, pairs);
}

// After the turn, points that were in one plane or on one line are so but for rounding.
void lattice(CaseRun& run) {
    std::vector<TrianglePair> pairs = lattice_pairs(run.amount(20'000, 1'000'000), run.seed());
    for (const std::size_t part : {64u, 16u, 4u, 1u})
        measure_lattice(run, "as it is", std::span(pairs).first(pairs.size() / part));
    const glm::dmat3 turn(dvec3(2, 2, -1) / 3.0, dvec3(-1, 2, 2) / 3.0, dvec3(2, -1, 2) / 3.0);
    for (TrianglePair& pair : pairs)
        for (WorldTriangle* t : {&pair.a, &pair.b}) *t = {turn * t->a, turn * t->b, turn * t->c};
    measure_lattice(run, "turned", pairs);
}

void orders(CaseRun& run) {
    std::vector<KnownPair> pairs;
    for (const TrianglePair& pair : lattice_pairs(run.amount(200, 10'000), run.seed())) {
        const PairClass known = exact_class(pair.a, pair.b);
        for (const WorldTriangle& a : permutations(pair.a))
            for (const WorldTriangle& b : permutations(pair.b)) {
                pairs.push_back({a, b, known});
                pairs.push_back({b, a, known});
            }
    }
    ask_classes(run, pairs, "exact");
}

// Tests pairs with triangles that are segments or points.
void degenerate(CaseRun& run) {
    std::vector<KnownPair> pairs;
    for (TrianglePair pair : lattice_pairs(run.amount(20'000, 1'000'000), run.seed() + 1)) {
        pair.a.c = pairs.size() % 3 == 0 ? pair.a.a : pair.a.b;
        if (pairs.size() % 2 == 0) pair.b.c = pair.b.a * 2.0 - pair.b.b;
        if (pairs.size() % 7 == 0) pair.a.b = pair.a.c;
        pairs.push_back({pair.a, pair.b, exact_class(pair.a, pair.b)});
    }
    ask_classes(run, pairs, "exact");
}

// ------------------------------------------------------------------------------------------------------------------------

Mesh torus(float tube) {
    Mesh mesh;
    constexpr uint n = 48, m = 24;
    for (uint i = 0; i < n; ++i)
        for (uint j = 0; j < m; ++j) {
            const float u = 6.2831853f * static_cast<float>(i) / n, v = 6.2831853f * static_cast<float>(j) / m;
            const float r = 1 + tube * std::cos(v);
            mesh.positions.push_back({r * std::cos(u), r * std::sin(u), tube * std::sin(v)});
            const auto at = [](uint a, uint b) { return a % n * m + b % m; };
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return mesh;
}

std::size_t triangles_at(const Mesh& mesh, vec3 vertex) {
    std::size_t count = 0;
    for (const uvec3& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) count += mesh.positions[t[k]] == vertex;
    return count;
}

void solids(CaseRun& run) {
    const Mesh ball = make_icosphere(3), outer = make_box(vec3(-1), vec3(1)), inner = make_box(vec3(-0.5f), vec3(0.5f));
    const vec3 top = ball.positions.front();
    const std::size_t around = triangles_at(ball, top);  // each is in one plane with its mirror image in that vertex
    ask_contacts(run, "tangent spheres", {ball}, {{0, {}}, {0, Transform::translation(top * 2.0f)}},
                 {{coplanar_touch, around}, {vertex_touch, around * (around - 1)}});
    ask_contacts(run, "nested boxes", {outer, inner}, {{0, {}}, {1, {}}}, {});
    const Mesh ring = torus(0.25f);
    const Transform across = {{vec4(1, 0, 0, 1), vec4(0, 0, 1, 0), vec4(0, -1, 0, 0)}};
    ask_contacts(run, "interlocked tori", {ring}, {{0, {}}, {0, across}}, {});
}

void walls(CaseRun& run) {
    const Mesh box = make_box(vec3(-1), vec3(1));
    for (const float at : {0.0f, 1024.0f})
        ask_contacts(run, text("boxes wall to wall at ", at), {box},
                     {{0, Transform::translation(vec3(at, 0, 0))}, {0, Transform::translation(vec3(at + 2, 0, 0))}},
                     wall_to_wall(), "exact");
}

void within_a_mesh(CaseRun& run) {
    const Mesh ball = make_icosphere(4);
    ask_contacts(run, "sphere with itself", {ball}, {{0, {}}}, {}, "analytic", true);
    Mesh strip;  // two triangles at one edge, folded flat onto each other
    strip.positions = {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0), vec3(0.5f, 0.75f, 0)};
    strip.triangles = {{0, 1, 2}, {1, 0, 3}};
    ask_contacts(run, "folded strip", {strip}, {{0, {}}}, {{coplanar_overlap, 1}}, "analytic", true);
}

void baked(CaseRun& run) {
    const Mesh ball = make_icosphere(4);
    const vec3 by(0.5f, 0.25f, -0.125f);
    Mesh rounded = ball;
    for (vec3& p : rounded.positions) p = (p + 16.0f) - 16.0f;  // so that moved ones are exact
    const Mesh away = moved(rounded, by);
    ask_same_contacts(run, {rounded, away}, {{0, {}}, {0, Transform::translation(by)}}, {{0, {}}, {1, {}}});
}

void colliding_identical_boxes(CaseRun& run) {
    const std::uint64_t n = run.amount(1'000, 10'000);
    const Mesh box = make_box(vec3(-1), vec3(1));
    for (const Configuration& configuration : run.one_configuration_each()) {
        AbstractAccel& accel = run.devices().empty_accel(configuration);
        accel.push(box, std::vector<Transform>(n));
        BroadPhase broad_phase(accel.context());
        const std::uint64_t expected = n * (n - 1) / 2;
        std::uint64_t wrong = 0;
        const std::vector<double> times =
            ns_each(5, expected, [&] { wrong += broad_phase.instance_pairs(accel).size() != expected; });
        wrong += broad_phase.count(accel) != expected;
        run.expect(configuration, {.params = {{"boxes", n}},
                                   .results = {{"pairs", expected}},
                                   .n = expected,
                                   .faults = wrong,
                                   .what = "another number of pairs than n (n - 1) / 2",
                                   .reference = "analytic",
                                   .time = time_figures("ns_per_pair", times)});
    }
}

// Makes cubes of 10^-30 to 10^37 around points as far from 0 as they are large.
std::vector<Transform> cubes_of_all_sizes(std::size_t count, std::uint64_t seed) {
    Random random(seed);
    std::vector<Transform> cubes;
    for (std::size_t i = 0; i < count; ++i) {
        const float size = std::pow(10.0f, random.between(-30, 37));
        cubes.push_back(Transform::translation(random.in_box(3) * size) * Transform::scaling(vec3(size)));
    }
    return cubes;
}

// Returns whether the cubes' boxes overlap after they grow by a share of their size and place.
bool overlap(const Transform& a, const Transform& b, double margin) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto reach = [&](const Transform& cube) {
            return double{cube.rows[axis][axis]} * (1 + margin) + std::abs(double{cube.rows[axis].w}) * margin;
        };
        if (std::abs(double{a.rows[axis].w} - double{b.rows[axis].w}) > reach(a) + reach(b)) return false;
    }
    return true;
}

// Counts overlapping pairs that were not found, and found pairs that are apart by more than rounding.
std::uint64_t wrong_pairs(const std::vector<Transform>& cubes, std::span<const InstancePair> found) {
    std::uint64_t wrong = 0;
    for (uint a = 0; a < cubes.size(); ++a)
        for (uint b = a + 1; b < cubes.size(); ++b) {
            const bool is_found = std::ranges::binary_search(found, InstancePair{a, b});
            wrong += is_found ? !overlap(cubes[a], cubes[b], 0x1p-20) : overlap(cubes[a], cubes[b], -0x1p-24);
        }
    return wrong;
}

void colliding_sizes(CaseRun& run) {
    const std::vector<Transform> cubes = cubes_of_all_sizes(run.amount(500, 5'000), run.seed());
    const Mesh cube = make_box(vec3(-1), vec3(1));
    for (const Configuration& configuration : run.one_configuration_each()) {
        AbstractAccel& accel = run.devices().empty_accel(configuration);
        accel.push(cube, cubes);
        const std::vector<InstancePair> found = BroadPhase(accel.context()).instance_pairs(accel);
        const CaseRun::Outcome outcome{.results = {{"pairs", found.size()}},
                                       .n = cubes.size() * (cubes.size() - 1) / 2,
                                       .faults = wrong_pairs(cubes, found),
                                       .what = "pairs that are missing, or apart",
                                       .reference = "f64",
                                       .fault_of = "twinray"};
        run.expect(configuration, outcome);
        CaseRun::Outcome control = outcome;
        control.faults = wrong_pairs(cubes, std::span(found).subspan(1));
        control.control = "one pair left out";
        run.expect(configuration, control);
    }
}

}  // namespace

std::vector<SuiteCase> collision_cases() {
    const std::string classes = "triangles of another class";
    const std::string none = "no pair has another class";
    return {
        {"C01", "vertices and edges that touch exactly", classes, none, touches},
        {"C02", "triangles in one plane", classes, none, coplanar},
        {"C03", "-4 to 4 ulp between a vertex and a face, up to 10^6 from the origin", classes, none, ulps},
        {"C04", "a vertex 10^-7 to 10^-30 above and below a face", classes, none, colliding_gaps},
        {"C05", "pairs on the lattice {-2..2}^3", "time and wrong classes, beside signs of plain arithmetic", none,
         lattice},
        {"C06", "triangles and needles that cross at 10^-8", classes, none, colliding_slivers},
        {"C07", "tangent spheres, nested boxes, interlocked tori", "contacts by class", "as many as are known", solids},
        {"C08", "identical boxes", "pairs of instances, time", "n (n - 1) / 2", colliding_identical_boxes},
        {"C09", "boxes wall to wall", "contacts by class", "as many as are known", walls},
        {"C10", "triangles and their vertices in every order", classes, none, orders},
        {"C11", "triangles of one mesh", "contacts by class", "none of neighbours; those of a fold", within_a_mesh},
        {"C12", "triangles without area", classes, none, degenerate},
        {"C13", "an instance that is moved, and its mesh moved", "contacts of only one of them", "the same contacts",
         baked},
        {"C14", "cubes of 10^-30 to 10^37 in one scene", "pairs of instances", "those whose boxes overlap",
         colliding_sizes},
    };
}

}  // namespace twinray::suite
