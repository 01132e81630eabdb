// Triangles and instances that touch: their classes are known, or computed by exact arithmetic. The GPU answers, and
// the host where the GPU is in doubt. The accelerators only provide the boxes of instances. Meshes are in contacts.cpp.
#include "report/suite/sections.h"

#include <twinray/queries.h>
#include "engine/collide/exact_class.h"

namespace twinray::suite {
namespace {

using enum PairClass;

// Returns the sign of det(a - d, b - d, c - d).
template <class Real>
int plain_volume_sign(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
    using Vector = Vec<3, Real>;
    const Vector from(d);
    const Real volume = dot(Vector(a) - from, cross(Vector(b) - from, Vector(c) - from));
    return (volume > 0) - (volume < 0);
}

// Returns the sign of det(a - c, b - c) as seen along an axis.
template <class Real>
int plain_area_sign(const dvec3& a, const dvec3& b, const dvec3& c, uint axis) {
    using Vector = Vec<3, Real>;
    const Vector from(c);
    const Real area = cross(Vector(a) - from, Vector(b) - from)[static_cast<int>(axis)];
    return (area > 0) - (area < 0);
}

// Classes of triangles by signs of plain arithmetic, with which exact arithmetic is compared. Each includes a shared
// header with its own kind of number.
#include "twinray/glsl/cpp_begin.h"
#include "shaders/collide/orient.h"
namespace by_float32 {
constexpr auto* volume_sign = plain_volume_sign<float>;
constexpr auto* area_sign = plain_area_sign<float>;
#include "shaders/collide/triangle_pair.h"
}  // namespace by_float32
#undef TWINRAY_COLLIDE_TRIANGLE_PAIR_H
namespace by_float64 {
constexpr auto* volume_sign = plain_volume_sign<double>;
constexpr auto* area_sign = plain_area_sign<double>;
#include "shaders/collide/triangle_pair.h"
}  // namespace by_float64
#include "twinray/glsl/cpp_end.h"

template <class ClassOf>
void measure_host(CaseRun& run, const std::string& lattice, std::span<const TrianglePair> pairs,
                  const std::vector<PairClass>& known, const std::string& variant, const ClassOf& class_of) {
    std::uint64_t wrong = 0;
    const std::vector<double> times = ns_each(5, pairs.size(), [&] {
        wrong = 0;
        for (std::size_t i = 0; i < pairs.size(); ++i)
            wrong += class_of(pairs[i].a, pairs[i].b) != class_number(known[i]);
    });
    Record record = cpu_record(run, "exact", variant);
    record.params = {{"lattice", lattice}, {"pairs", pairs.size()}};
    set_faults(record, wrong, pairs.size());
    record.time = time_figures("ns_per_pair", times);
    record.criterion = "none: for comparison";
    run.add(record);
}

struct KnownPair {
    WorldTriangle a, b;
    PairClass known;
};

// Returns pairs with vertices among {-2..2}^3; every fourth pair lies in one plane.
std::vector<TrianglePair> lattice_pairs(std::size_t count, std::uint64_t seed) {
    std::mt19937 random(static_cast<std::uint32_t>(seed));
    const auto coordinate = [&] { return static_cast<double>(random() % 5) - 2; };
    const auto triangle = [&](bool is_flat) {
        std::array<double, 9> c;
        for (double& each : c) each = coordinate();
        if (is_flat) c[2] = c[5] = c[8] = 0;
        return WorldTriangle{dvec3(c[0], c[1], c[2]), dvec3(c[3], c[4], c[5]), dvec3(c[6], c[7], c[8])};
    };
    std::vector<TrianglePair> pairs;
    for (std::size_t i = 0; i < count; ++i) {
        const WorldTriangle a = triangle(i % 4 == 0);
        pairs.push_back({a, triangle(i % 4 == 0)});
    }
    return pairs;
}

// Returns the six orders of its vertices.
std::vector<WorldTriangle> permutations(const WorldTriangle& t) {
    return {{t.a, t.b, t.c}, {t.a, t.c, t.b}, {t.b, t.a, t.c}, {t.b, t.c, t.a}, {t.c, t.a, t.b}, {t.c, t.b, t.a}};
}

void ask_classes(CaseRun& run, const std::vector<KnownPair>& pairs, const std::string& reference = "analytic") {
    std::vector<TrianglePair> asked;
    for (const KnownPair& pair : pairs) asked.push_back({pair.a, pair.b});
    NarrowPhase narrow_phase(query_context(run));
    const std::vector<PairClass> found = narrow_phase.classify(asked);
    std::uint64_t wrong = 0;
    std::string first;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (found[i] == pairs[i].known) continue;
        if (wrong++ == 0) first = text("pair ", i, " is ", name_of(found[i]), ", not ", name_of(pairs[i].known));
    }
    Record record = query_record(run, reference);
    record.n = pairs.size();
    add_checked(run, record, wrong, first);
}

// Measures time and wrong classes of the GPU, of exact arithmetic on the host and, as controls, of the same decisions
// by signs that float32 and float64 give without a bound.
void measure_lattice(CaseRun& run, const std::string& lattice, std::span<const TrianglePair> pairs) {
    std::vector<PairClass> known;
    for (const TrianglePair& pair : pairs) known.push_back(exact_class(pair.a, pair.b));
    NarrowPhase narrow_phase(query_context(run));
    std::vector<PairClass> found;
    const std::vector<double> times = ns_each(5, pairs.size(), [&] { found = narrow_phase.classify(pairs); });
    std::uint64_t wrong = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) wrong += found[i] != known[i];
    Record record = query_record(run, "exact");
    record.params = {{"lattice", lattice}, {"pairs", pairs.size()}};
    record.n = pairs.size();
    record.time = time_figures("ns_per_pair", times);
    add_checked(run, record, wrong, "classes differ from those of exact arithmetic");
    measure_host(run, lattice, pairs, known, "exact, on the host alone",
                 [](const WorldTriangle& a, const WorldTriangle& b) { return class_number(exact_class(a, b)); });
    measure_host(run, lattice, pairs, known, "control: float64 without a bound", by_float64::class_of);
    measure_host(run, lattice, pairs, known, "control: float32 without a bound", by_float32::class_of);
}

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
