// SPDX-License-Identifier: MIT
// Cases of collisions: what they ask and how they are checked. The GPU answers, and the host where the GPU is in doubt.
// The accelerators only provide the boxes of instances.
#pragma once

#include <twinray/queries.h>

#include <map>

#include "report/suite/queries.h"

namespace twinray::suite {

struct KnownPair {
    WorldTriangle a, b;
    PairClass known;
};

// Returns pairs with vertices among {-2..2}^3; every fourth pair lies in one plane.
std::vector<TrianglePair> lattice_pairs(std::size_t count, std::uint64_t seed);
// Returns the six orders of its vertices.
std::vector<WorldTriangle> permutations(const WorldTriangle& triangle);

void ask_classes(CaseRun& run, const std::vector<KnownPair>& pairs, const std::string& reference = "analytic");
// Measures time and wrong classes of the GPU, of exact arithmetic on the host and, as controls, of the same decisions
// by signs that float32 and float64 give without a bound.
void measure_lattice(CaseRun& run, const std::string& lattice, std::span<const TrianglePair> pairs);

using ContactCounts = std::map<PairClass, std::uint64_t>;
// Checks contacts between instances, or within them.
void ask_contacts(CaseRun& run, const std::string& what, const std::vector<MeshView>& meshes,
                  const std::vector<MeshInstance>& instances, const ContactCounts& known,
                  const std::string& reference = "analytic", bool self = false);
// Returns the contacts of two boxes of make_box() with a common wall, counted by brute force with exact classes.
ContactCounts wall_to_wall();
void ask_same_contacts(CaseRun& run, const std::vector<MeshView>& meshes, const std::vector<MeshInstance>& some,
                       const std::vector<MeshInstance>& others);

}  // namespace twinray::suite
