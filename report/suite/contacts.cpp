// SPDX-License-Identifier: MIT
#include "report/suite/contacts.h"

#include <algorithm>
#include <random>

#include "report/suite/plain_class.h"
#include "engine/collide/exact_class.h"
#include "engine/core/error.h"
#include <twinray/geometry.h>

namespace twinray::suite {
namespace {

template <class ClassOf>
void measure_host(CaseRun& run, const std::string& lattice, std::span<const TrianglePair> pairs,
                  const std::vector<PairClass>& known, const std::string& variant, const ClassOf& class_of) {
    std::uint64_t wrong = 0;
    const std::vector<double> times = ns_each(5, pairs.size(), [&] {
        wrong = 0;
        for (std::size_t i = 0; i < pairs.size(); ++i) wrong += class_of(pairs[i].a, pairs[i].b) != known[i];
    });
    Record record = cpu_record(run, "exact", variant);
    record.params = {{"lattice", lattice}, {"pairs", pairs.size()}};
    set_faults(record, wrong, pairs.size());
    record.time = time_figures("ns_per_pair", times);
    record.criterion = "none: for comparison";
    run.add(record);
}

std::string told(const ContactCounts& counts) {
    std::vector<std::string> parts;
    for (const auto& [pair_class, count] : counts) parts.push_back(text(count, ' ', name_of(pair_class)));
    return parts.empty() ? "none" : joined(parts);
}

}  // namespace

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

std::vector<WorldTriangle> permutations(const WorldTriangle& t) {
    return {{t.a, t.b, t.c}, {t.a, t.c, t.b}, {t.b, t.a, t.c}, {t.b, t.c, t.a}, {t.c, t.a, t.b}, {t.c, t.b, t.a}};
}

void ask_classes(CaseRun& run, const std::vector<KnownPair>& pairs, const std::string& reference) {
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
                 [](const WorldTriangle& a, const WorldTriangle& b) { return exact_class(a, b); });
    measure_host(run, lattice, pairs, known, "control: float64 without a bound", class_by_float64);
    measure_host(run, lattice, pairs, known, "control: float32 without a bound", class_by_float32);
}

void ask_contacts(CaseRun& run, const std::string& what, const std::vector<MeshView>& meshes,
                  const std::vector<MeshInstance>& instances, const ContactCounts& known, const std::string& reference,
                  bool self) {
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

}  // namespace twinray::suite
