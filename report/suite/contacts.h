// SPDX-License-Identifier: MIT
// What cases of collisions ask, and how they are checked. The GPU answers, and the host where it is in doubt; neither
// accelerator takes part but for the boxes of instances.
#pragma once

#include <twinray/queries.h>

#include <map>

#include "report/suite/queries.h"

namespace twinray::suite {

struct KnownPair {
    WorldTriangle a, b;
    PairClass known;
};

// Vertices among {-2..2}^3, of every fourth pair in one plane.
std::vector<TrianglePair> lattice_pairs(std::size_t count, std::uint64_t seed);
// The six orders of its vertices.
std::vector<WorldTriangle> permutations(const WorldTriangle& triangle);

void ask_classes(CaseRun& run, const std::vector<KnownPair>& pairs, const std::string& reference = "analytic");
// Time and wrong classes of the GPU, of exact arithmetic on the host, and, as controls, of the same decisions by signs
// that float32 and float64 give without a bound.
void measure_lattice(CaseRun& run, const std::string& lattice, std::span<const TrianglePair> pairs);

using ContactCounts = std::map<PairClass, std::uint64_t>;
// Between instances, or within them.
void ask_contacts(CaseRun& run, const std::string& what, const std::vector<MeshView>& meshes,
                  const std::vector<MeshInstance>& instances, const ContactCounts& known,
                  const std::string& reference = "analytic", bool self = false);
// The contacts of two boxes of make_box() with a common wall, counted by brute force with exact classes.
ContactCounts wall_to_wall();
void ask_same_contacts(CaseRun& run, const std::vector<MeshView>& meshes, const std::vector<MeshInstance>& some,
                       const std::vector<MeshInstance>& others);

}  // namespace twinray::suite
