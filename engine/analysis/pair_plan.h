// Chooses the estimator for each pair of groups of faces: pure functions.
#pragma once

#include <span>
#include <vector>

#include "engine/analysis/faces.h"
#include "engine/analysis/polygon64.h"

namespace twinray {

// All faces of a scene, in its order; those without an area have no vertices.
struct FacePolygons {
    std::vector<Polygon64> faces;
    std::vector<PolygonBox> boxes;
    std::vector<double> sizes;       // the largest magnitude of a coordinate of each
    std::vector<char> are_mirrored;  // their vertices are in the opposite order of the mesh's

    FacePolygons() = default;
    explicit FacePolygons(const PlacedMeshes& placed);
};

// Two faces whose areas are sampled, each by its part on the front side of the other's plane.
struct SampledPair {
    uint a, b;
    FacePart part_a, part_b;
    double fraction;   // the parts' share of the product of both areas
    double distance;   // of the parts' centers
    double unblocked;  // A F if nothing were in between
    bool may_be_blocked;
};

// The exchange of groups i and j, i <= j: A_i F_ij, the sum of `contour` from contours and the rest from areas.
struct PlannedPair {
    uint i, j;
    ContourExchange contour;
    std::vector<SampledPair> sampled;
};

struct PairPlan {
    std::vector<PlannedPair> pairs;  // ascending
    std::uint64_t left_to_hits = 0;  // how many more see each other
};

struct PairPlanOptions {
    PairEstimator estimator = PairEstimator::automatic;
    Sides sides = Sides::front;
    std::uint64_t rays = 1 << 14;  // of a row: the most that areas may take in `automatic`
};

// Areas have less variance than hits if the gap is at least this part of the longest edge: at 0.2 both have as much,
// for parallel squares and for perpendicular ones (docs/view-factors.md).
inline constexpr double least_gap_for_area = 0.25;
// Below this, a few samples in narrow places decide, and intervals of areas do not hold.
inline constexpr double least_gap_asked_for = 1.0 / 16;

// `members`: the faces with an area of each group. Throws Error naming faces and limit if the requested estimator does
// not fit a pair, or if there are more than most_paired_faces.
// `progress` gets numbers of groups.
PairPlan plan_pairs(const FacePolygons& polygons, std::span<const std::vector<uint>> members,
                    const PairPlanOptions& options, const ProgressCallback& progress = {});

}  // namespace twinray
