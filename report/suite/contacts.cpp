// Meshes and instances that touch.
#include "report/suite/sections.h"

#include <twinray/queries.h>
#include "engine/collide/exact_class.h"

namespace twinray::suite {
namespace {

using enum PairClass;
using ContactCounts = std::map<PairClass, std::uint64_t>;

std::string told(const ContactCounts& counts) {
    std::vector<std::string> parts;
    for (const auto& [pair_class, count] : counts) parts.push_back(text(count, ' ', name_of(pair_class)));
    return parts.empty() ? "none" : joined(parts);
}

// Checks contacts between instances, or within them.
void ask_contacts(CaseRun& run, const std::string& what, const std::vector<MeshView>& meshes,
                  const std::vector<MeshInstance>& instances, const ContactCounts& known,
                  const std::string& reference = "analytic", bool self = false) {
    NarrowPhase narrow_phase(query_context(run));
    const Contacts contacts = narrow_phase.find(meshes, instances, {.self = self});
    ContactCounts found;
    for (const TriangleContact& contact : contacts.list) ++found[contact.pair_class];
    Record record = query_record(run, reference);
    record.params = {{"scene", what}};
    record.n = std::max<std::uint64_t>(1, contacts.candidates);
    for (const auto& [pair_class, count] : found) record.counts[std::string(name_of(pair_class))] = count;
    add_checked(run, record, found == known ? 0 : 1, "contacts: " + told(found) + "; known are " + told(known));
}

// Returns the contacts of two boxes of make_box() with a common wall, counted by brute force with exact classes.
// In the common wall, two triangles meet two, cut along the same diagonal or across it; the walls around also touch.
ContactCounts wall_to_wall() {
    const Mesh box = make_box(vec3(-1), vec3(1));
    const auto placed = [&](const uvec3& t, double x) {
        const auto vertex = [&](uint i) { return dvec3(box.positions[i]) + dvec3(x, 0, 0); };
        return WorldTriangle{vertex(t.x), vertex(t.y), vertex(t.z)};
    };
    ContactCounts counts;
    for (const uvec3& a : box.triangles)
        for (const uvec3& b : box.triangles)
            if (const PairClass found = exact_class(placed(a, 0), placed(b, 2)); found != PairClass::separate)
                ++counts[found];
    return counts;
}

void ask_same_contacts(CaseRun& run, const std::vector<MeshView>& meshes, const std::vector<MeshInstance>& some,
                       const std::vector<MeshInstance>& others) {
    NarrowPhase narrow_phase(query_context(run));
    const std::vector<TriangleContact> a = narrow_phase.find(meshes, some).list,
                                       b = narrow_phase.find(meshes, others).list;
    std::vector<TriangleContact> only;
    std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(only));
    Record record = query_record(run, "invariance");
    record.n = std::max<std::uint64_t>(1, a.size());
    record.results = {{"contacts", a.size()}};
    add_checked(run, record, a.empty() ? 1 : only.size(), a.empty() ? "no contact" : "contacts of only one of them");
}

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

}  // namespace

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

}  // namespace twinray::suite
