#include "engine/analysis/pair_plan.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/core/error.h"
#include "engine/core/parallel.h"

namespace twinray {
namespace {

Polygon64 polygon_of(const Transform& transform, const MeshView& mesh, uvec3 triangle) {
    const auto point = [&](uint vertex) { return in_world(transform, mesh.positions[vertex]); };
    return {point(triangle.x), point(triangle.y), point(triangle.z)};
}

// `part` has 3 or 4 vertices in the plane of `triangle`, whose vertices are in the order of the mesh.
FacePart part_of_face(const Polygon64& triangle, const Polygon64& part) {
    const dvec3 normal = triangle.area_vector();
    const auto weight = [&](const dvec3& point, std::size_t vertex) {
        const Polygon64 below(point, triangle.vertices[(vertex + 1) % 3], triangle.vertices[(vertex + 2) % 3]);
        return dot(below.area_vector(), normal) / dot(normal, normal);
    };
    FacePart result;
    for (std::size_t i = 0; i < 4; ++i) {
        const dvec3& point = part.vertices[std::min(i, part.count - 1)];
        result.corners[i] = vec2(static_cast<float>(weight(point, 1)), static_cast<float>(weight(point, 2)));
    }
    const Polygon64 first(part.vertices[0], part.vertices[1], part.vertices[2]);
    result.first = part.count == 3 ? 1.0f : static_cast<float>(first.area() / part.area());
    return result;
}

// The known geometry of two faces.
struct FacePair {
    uint a, b;
    std::vector<FacingPair> parts;   // that see each other, of each pair of sides
    std::optional<uint> in_between;  // a face that may be
    double gap_over_size;
};

class Planner {
  public:
    Planner(const FacePolygons& polygons, std::span<const std::vector<uint>> members, const PairPlanOptions& options)
        : polygons_(polygons), members_(members), options_(options) {}

    struct Row {
        std::vector<PlannedPair> pairs;
        std::uint64_t left_to_hits = 0;
        std::string refusal;  // why the estimator that is asked for does not fit
    };
    Row row(uint i) const {
        Row row;
        for (uint j = i; j < members_.size() && row.refusal.empty(); ++j) {
            PlannedPair pair{i, j, {}, {}};
            if (plan(pair, row.refusal)) {
                if (pair.contour.flow > 0 || !pair.sampled.empty()) row.pairs.push_back(std::move(pair));
            } else {
                ++row.left_to_hits;
            }
        }
        return row;
    }

  private:
    // Returns false if hits are to be used.
    bool plan(PlannedPair& pair, std::string& refusal) const {
        for (const uint a : members_[pair.i])
            for (const uint b : members_[pair.j]) {
                if (a == b || (pair.i == pair.j && a > b)) continue;
                const std::optional<FacePair> faces = look_at(a, b);
                if (!faces) continue;
                if (!take(*faces, pair, refusal) || is_too_much(pair)) return false;
            }
        if (pair.i == pair.j) {  // each saw the other once
            pair.contour.flow *= 2;
            pair.contour.error *= 2;
        }
        return true;
    }

    // Returns whether a row's rays do not suffice for all faces of the pair.
    bool is_too_much(const PlannedPair& pair) const {
        return options_.estimator == PairEstimator::automatic && pair.sampled.size() * CHUNK > options_.rays;
    }

    // Returns nothing if they do not see each other.
    std::optional<FacePair> look_at(uint a, uint b) const {
        const Polygon64 &of_a = polygons_.faces[a], &of_b = polygons_.faces[b];
        const double rounding = rounding_of(std::max(polygons_.sizes[a], polygons_.sizes[b]));
        FacePair pair{a, b, {}, {}, gap_over_size(of_a, of_b)};
        const auto add = [&](const Polygon64& side_a, const Polygon64& side_b) {
            const FacingPair parts = facing_parts(side_a, side_b, rounding);
            if (!parts.is_empty()) pair.parts.push_back(parts);
        };
        add(of_a, of_b);
        if (options_.sides == Sides::both) {
            add(of_a.flipped(), of_b);
            add(of_a, of_b.flipped());
            add(of_a.flipped(), of_b.flipped());
        }
        if (pair.parts.empty()) return std::nullopt;
        for (const FacingPair& parts : pair.parts)
            if (!pair.in_between) pair.in_between = first_between(Shaft(parts, rounding), a, b);
        return pair;
    }

    std::optional<uint> first_between(const Shaft& shaft, uint a, uint b) const {
        for (uint face = 0; face < polygons_.faces.size(); ++face)
            if (face != a && face != b && polygons_.faces[face].count &&
                shaft.may_be_blocked_by(polygons_.faces[face], polygons_.boxes[face]))
                return face;
        return std::nullopt;
    }

    bool take(const FacePair& faces, PlannedPair& pair, std::string& refusal) const {
        switch (options_.estimator) {
            case PairEstimator::hits: return false;
            case PairEstimator::contour:
                if (faces.in_between)
                    refusal = text("view factors: face ", *faces.in_between, " may come between faces ", faces.a,
                                   " and ", faces.b, "; contours are for pairs that nothing can come between");
                else
                    add(contour_of(faces), pair);
                return !faces.in_between;
            case PairEstimator::area:
                if (faces.gap_over_size < least_gap_asked_for)
                    refusal = text("view factors: the gap between faces ", faces.a, " and ", faces.b, " is ",
                                   faces.gap_over_size, " of their longest edge; areas are sampled from ",
                                   least_gap_asked_for, " on");
                else
                    sample(faces, pair);
                return refusal.empty();
            case PairEstimator::automatic: break;
        }
        return choose(faces, pair);
    }

    // Contours are kept unless areas are sure to be better, which need 10^4 rays and more for an error of 2^-12.
    bool choose(const FacePair& faces, PlannedPair& pair) const {
        const bool is_far = faces.gap_over_size >= least_gap_for_area;
        if (!faces.in_between) {
            constexpr double worse = 0x1p-12;
            const ContourExchange contour = contour_of(faces);
            if (contour.error <= worse * contour.flow || !is_far) {
                add(contour, pair);
                return true;
            }
        }
        if (!is_far) return false;
        sample(faces, pair);
        return true;
    }

    void sample(const FacePair& faces, PlannedPair& pair) const {
        if (can_be_sampled(faces))
            pair.sampled.push_back(sampled(faces));
        else
            add(faces.in_between ? anything_up_to(contour_of(faces)) : contour_of(faces), pair);
    }

    // Returns whether a part reaches so far in front of the other's plane that float32 keeps its samples there. Samples
    // are also moved away from edges, by some 2^-18 of the coordinates, which matters if only a corner is seen.
    bool can_be_sampled(const FacePair& faces) const {
        const double size = std::max(polygons_.sizes[faces.a], polygons_.sizes[faces.b]);
        return std::any_of(faces.parts.begin(), faces.parts.end(), [&](const FacingPair& parts) {
            const bool are_whole =
                parts.a.area() == polygons_.faces[faces.a].area() && parts.b.area() == polygons_.faces[faces.b].area();
            const double least = (are_whole ? 0x1p-14 : 0x1p-10) * size;
            return height_before(parts.a, parts.b) >= least && height_before(parts.b, parts.a) >= least;
        });
    }

    // Returns the bounds if an obstacle may be in front of any part of it.
    static ContourExchange anything_up_to(const ContourExchange& unblocked) {
        const double half = (unblocked.flow + unblocked.error) / 2;
        return {half, half, unblocked.evaluations};
    }

    ContourExchange contour_of(const FacePair& faces) const {
        ContourExchange sum;
        for (const FacingPair& parts : faces.parts) {
            const ContourExchange part = contour_exchange(parts.a, parts.b);
            sum.flow += part.flow;
            sum.error += part.error;
            sum.evaluations += part.evaluations;
        }
        const double share = options_.sides == Sides::both ? 0.5 : 1;
        return {std::max(0.0, share * sum.flow), share * sum.error, sum.evaluations};
    }

    static void add(const ContourExchange& contour, PlannedPair& pair) {
        pair.contour.flow += contour.flow;
        pair.contour.error += contour.error;
        pair.contour.evaluations += contour.evaluations;
    }

    // Samples whole faces with two sides: all points of both then see each other on one side or the other.
    SampledPair sampled(const FacePair& faces) const {
        const Polygon64 &a = polygons_.faces[faces.a], &b = polygons_.faces[faces.b];
        const FacingPair parts = options_.sides == Sides::both ? FacingPair{a, b} : faces.parts.front();
        return {.a = faces.a,
                .b = faces.b,
                .part_a = part_of_face(in_order_of_mesh(faces.a), parts.a),
                .part_b = part_of_face(in_order_of_mesh(faces.b), parts.b),
                .fraction = parts.a.area() / a.area() * (parts.b.area() / b.area()),
                .distance = length(parts.a.center() - parts.b.center()),
                .unblocked = contour_of(faces).flow,
                .may_be_blocked = faces.in_between.has_value()};
    }

    Polygon64 in_order_of_mesh(uint face) const {
        return polygons_.are_mirrored[face] ? polygons_.faces[face].flipped() : polygons_.faces[face];
    }

    const FacePolygons& polygons_;
    std::span<const std::vector<uint>> members_;
    PairPlanOptions options_;
};

}  // namespace

FacePolygons::FacePolygons(const PlacedMeshes& placed) {
    for (uint i = 0; i < placed.instances.size(); ++i) {
        const MeshView& mesh = placed.mesh_of(i);
        const Transform& transform = placed.instances[i].transform;
        const bool is_mirrored = determinant(transform) < 0;
        for (uint primitive = 0; primitive < mesh.triangles.size(); ++primitive) {
            const bool has_area = area_vector(placed, {i, primitive}) != dvec3(0);
            const Polygon64 face = has_area ? polygon_of(transform, mesh, mesh.triangles[primitive]) : Polygon64();
            faces.push_back(is_mirrored ? face.flipped() : face);
            are_mirrored.push_back(is_mirrored);
            boxes.push_back(box_of(faces.back()));
            double& largest = sizes.emplace_back(0);
            for (const dvec3& point : faces.back().points())
                largest = std::max({largest, std::abs(point.x), std::abs(point.y), std::abs(point.z)});
        }
    }
}

PairPlan plan_pairs(const FacePolygons& polygons, std::span<const std::vector<uint>> members,
                    const PairPlanOptions& options, const ProgressCallback& progress) {
    if (options.estimator == PairEstimator::hits) return {};
    std::size_t faces = 0;
    for (const std::vector<uint>& group : members) faces += group.size();
    if (faces > most_paired_faces)
        fail("view factors: ", faces, " faces; the estimators of pairs take at most ", most_paired_faces,
             "; for more, use the estimator hits");
    const Planner planner(polygons, members, options);
    std::vector<Planner::Row> rows(members.size());
    constexpr std::size_t batch = 64;  // groups between two calls of `progress`
    for (std::size_t first = 0; first < rows.size(); first += batch) {
        const std::size_t count = std::min(batch, rows.size() - first);
        parallel_for(count, [&](std::size_t i) { rows[first + i] = planner.row(static_cast<uint>(first + i)); });
        if (progress) progress(count);
    }
    PairPlan plan;
    for (Planner::Row& row : rows) {
        if (!row.refusal.empty()) fail(row.refusal);
        plan.left_to_hits += row.left_to_hits;
        std::move(row.pairs.begin(), row.pairs.end(), std::back_inserter(plan.pairs));
    }
    return plan;
}

}  // namespace twinray
