// Pairs of faces: their exchanges by contours, what may come between them, and the plan of how each is estimated.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <twinray/geometry.h>
#include <twinray/scene.h>

#include "engine/analysis/polygon64.h"
#include "engine/analysis/pair_plan.h"
#include "tests/analysis/scenes.h"

namespace twinray::test {
namespace {

// Polygons whose exchange is known in closed form.
using Surface = std::vector<Polygon64>;

// Makes two triangles, as make_quad() does.
Surface quad(const dvec3& vertex, const dvec3& u, const dvec3& v) {
    return {{vertex, vertex + u, vertex + u + v}, {vertex, vertex + u + v, vertex + v}};
}

double area_of(const Surface& surface) {
    double area = 0;
    for (const Polygon64& polygon : surface) area += length(polygon.area_vector());
    return area;
}

// Sums the exchanges by contours alone, since nothing is in between; coordinates are up to `largest`.
ContourExchange exchange_of(const Surface& a, const Surface& b, double largest = 1) {
    ContourExchange sum;
    for (const Polygon64& one : a)
        for (const Polygon64& other : b) {
            const FacingPair pair = facing_parts(one, other, rounding_of(largest));
            if (pair.is_empty()) continue;
            const ContourExchange part = contour_exchange(pair.a, pair.b);
            sum.flow += part.flow;
            sum.error += part.error;
            sum.evaluations += part.evaluations;
        }
    return sum;
}

struct KnownPair {
    std::string name;
    Surface a, b;
    double value;  // F from a to b
};

KnownPair parallel_squares64(double distance, double value) {
    return {"parallel, distance " + std::to_string(distance), quad(dvec3(0), dvec3(1, 0, 0), dvec3(0, 1, 0)),
            quad(dvec3(0, 0, distance), dvec3(0, 1, 0), dvec3(1, 0, 0)), value};
}

KnownPair perpendicular64(double w, double h, double value) {
    return {"perpendicular, " + std::to_string(w) + " by " + std::to_string(h),
            quad(dvec3(0), dvec3(w, 0, 0), dvec3(0, 1, 0)), quad(dvec3(0), dvec3(0, 1, 0), dvec3(0, 0, h)), value};
}

// Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", C-11 and C-14, evaluated with 30 digits.
std::vector<KnownPair> known_pairs() {
    return {parallel_squares64(1, 0.199824895698387383),     parallel_squares64(0.5, 0.415253283577146735),
            parallel_squares64(2, 0.0685895888185524478),    parallel_squares64(0.1, 0.826994522397256578),
            parallel_squares64(10, 0.00316205683875760197),  parallel_squares64(1e-3, 0.998005631907579727),
            parallel_squares64(1e-6, 0.9999980000100295),    parallel_squares64(1e3, 3.18309673977380258e-7),
            perpendicular64(1, 1, 0.200043776075403154),     perpendicular64(1, 2, 0.232852602795361888),
            perpendicular64(2, 1, 0.116426301397680944),     perpendicular64(0.5, 0.5, 0.240636006176961697),
            perpendicular64(10, 10, 0.0550239795284105898),  perpendicular64(1, 0.01, 0.00489584926850668304),
            perpendicular64(1, 1e-6, 4.99997492619688762e-7)};
}

TEST(Contour, IsExactWhereTheFactorIsKnown) {
    for (const KnownPair& known : known_pairs()) {
        const ContourExchange exchange = exchange_of(known.a, known.b);
        const double flow = known.value * area_of(known.a);
        EXPECT_NEAR(exchange.flow / flow, 1, 1e-12) << known.name;
        EXPECT_LE(std::abs(exchange.flow - flow), exchange.error + 1e-16 * flow) << known.name;
        EXPECT_LE(exchange.error, 1e-10 * flow) << known.name << ": the bound is not far above the error";
    }
}

TEST(Contour, DoesNotDependOnPlaceAndScale) {
    const KnownPair known = perpendicular64(1, 1, 0.200043776075403154);
    for (const double scale : {1e-12, 1.0, 1e12}) {
        const auto moved = [&](Surface surface) {
            for (Polygon64& polygon : surface)
                for (dvec3& vertex : polygon.vertices)
                    vertex = scale * dvec3(vertex.y - vertex.z, vertex.y + vertex.z, std::sqrt(2.0) * vertex.x);
            return surface;
        };
        const double flow = known.value * 2 * scale * scale;
        EXPECT_NEAR(exchange_of(moved(known.a), moved(known.b), 2 * scale).flow / flow, 1, 1e-12) << scale;
    }
}

constexpr std::uint64_t most_evaluations = 20'000;  // of two polygons: 4 ms

// A strip cut off a square at a hair's breadth from an edge, and the rest of the square, together are the square.
TEST(Contour, OfSliversIsWhatIsLeftOfTheWhole) {
    const Surface floor = quad(dvec3(0), dvec3(1, 0, 0), dvec3(0, 1, 0));
    for (const double gap : {0.0, 1e-8, 0.5})
        for (const double width : {1e-6, 1e-9, 1e-12}) {
            const auto wall = [&](double low, double high) {
                return quad(dvec3(-gap, 0, low), dvec3(0, 1, 0), dvec3(0, 0, high - low));
            };
            const ContourExchange whole = exchange_of(floor, wall(0, 1));
            const ContourExchange sliver = exchange_of(floor, wall(0, width));
            const ContourExchange rest = exchange_of(floor, wall(width, 1));
            const double error = whole.error + sliver.error + rest.error;
            EXPECT_LE(std::abs(sliver.flow + rest.flow - whole.flow), error + 1e-16) << gap << ' ' << width;
            EXPECT_LE(error, 1e-12 * whole.flow) << gap << ' ' << width;
            EXPECT_GE(sliver.flow + sliver.error, 0);
            EXPECT_LE(sliver.flow - sliver.error, width);
            EXPECT_LE(sliver.evaluations, 4 * most_evaluations);
        }
}

// Clipping leaves edges of 1e-8, since vertices miss the planes of other walls by that much.
TEST(Contour, OfRoomsRoundedToFloat32IsAsExactAsOfOthers) {
    for (const double angle : {0.1, 0.3, 0.7, 1.3}) {
        const Surface room = FacePolygons(rounded_room(2, angle)).faces;
        for (std::size_t i = 0; i < room.size(); i += 5) {
            ContourExchange sum;
            for (const Polygon64& other : room) {
                const ContourExchange part = exchange_of({room[i]}, {other});
                sum.flow += part.flow;
                sum.error += part.error;
                EXPECT_LE(part.evaluations, most_evaluations) << angle;
            }
            const double area = length(room[i].area_vector());
            EXPECT_LE(std::abs(sum.flow - area), sum.error + 1e-15 * area) << angle << ": the room is closed";
            EXPECT_LE(sum.error, 1e-11 * area) << angle;
        }
    }
}

// A regular polygon with n vertices on a circle about the z axis, which looks up.
Surface disc(int n, double z, bool looks_up) {
    const auto vertex = [&](int i) {
        const double angle = 2 * std::numbers::pi * i / n;
        return dvec3(std::cos(angle), std::sin(angle), z);
    };
    Surface surface;
    for (int i = 0; i < n; ++i) {
        const Polygon64 piece(dvec3(0, 0, z), vertex(i), vertex(i + 1));
        surface.push_back(looks_up ? piece : piece.flipped());
    }
    return surface;
}

TEST(Contour, OfPolygonsWithMoreCornersNearsThatOfDiscs) {
    constexpr double known = 0.381966011250105152;  // Howell C-41, radii of 1 at distance 1
    double last = 0;
    for (const int n : {8, 16, 32}) {
        const Surface a = disc(n, 0, true), b = disc(n, 1, false);
        const double error = std::abs(exchange_of(a, b).flow / area_of(a) - known);
        EXPECT_TRUE(n == 8 || std::abs(last / error - 4) <= 0.2) << n << ": the error falls as 1 / n^2";
        last = error;
    }
    EXPECT_LT(last, 2e-3);
}

Surface sphere_surface(uint subdivisions, const dvec3& middle, double radius) {
    const Mesh mesh = make_icosphere(subdivisions);
    Surface surface;
    for (const uvec3& t : mesh.triangles) {
        const auto vertex = [&](uint i) { return middle + radius * dvec3(mesh.positions[i]); };
        surface.push_back({vertex(t.x), vertex(t.y), vertex(t.z)});
    }
    return surface;
}

TEST(Contour, SpheresThatFaceEachOtherAreCutAtTheirHorizons) {
    constexpr double known = 0.016156244369874;  // radii of 1, centres 4 apart
    double last = 0;
    for (const uint subdivisions : {0u, 1u, 2u}) {
        const Surface a = sphere_surface(subdivisions, dvec3(0), 1),
                      b = sphere_surface(subdivisions, dvec3(4, 0, 0), 1);
        const double factor = exchange_of(a, b).flow / area_of(a);
        EXPECT_TRUE(!subdivisions || std::abs((last - known) / (factor - known) - 4) <= 0.9) << subdivisions;
        last = factor;
    }
    EXPECT_NEAR(last / known, 1, 0.03);
}

TEST(FacingParts, AreWhatLiesBeforeTheOther) {
    const Polygon64 floor(dvec3(-1, -1, 0), dvec3(1, -1, 0), dvec3(0, 1, 0));
    const Polygon64 through(dvec3(0, 0, -1), dvec3(0, 1, 1), dvec3(0, -1, 1));  // looks to -x
    const FacingPair pair = facing_parts(floor, through, rounding_of(1));
    EXPECT_NEAR(length(pair.b.area_vector()), 1.5, 1e-15) << "above the floor";
    EXPECT_EQ(pair.b.count, 4u);
    EXPECT_NEAR(length(pair.a.area_vector()), 1, 1e-15) << "on the side to which the other looks";
    EXPECT_TRUE(facing_parts(floor, floor, rounding_of(1)).is_empty()) << "in one plane";
    const Polygon64 above(dvec3(-1, -1, 1), dvec3(1, -1, 1), dvec3(0, 1, 1));
    EXPECT_TRUE(facing_parts(floor, above, rounding_of(1)).is_empty()) << "that one looks away";
    EXPECT_FALSE(facing_parts(floor, above.flipped(), rounding_of(1)).is_empty());
    EXPECT_EQ(gap_over_size(floor, above), 1 / std::sqrt(5.0));
}

const Polygon64 bottom(dvec3(0, 0, 0), dvec3(1, 0, 0), dvec3(1, 1, 0));
const Polygon64 top(dvec3(0, 0, 1), dvec3(1, 1, 1), dvec3(1, 0, 1));

bool is_blocked(const Polygon64& face) {
    const double rounding = rounding_of(1);
    const Shaft shaft(facing_parts(bottom, top, rounding), rounding);
    EXPECT_EQ(shaft.may_be_blocked_by(face, box_of(face)), shaft.may_be_blocked_by(face.flipped(), box_of(face)));
    return shaft.may_be_blocked_by(face, box_of(face));
}

TEST(Shaft, IsBlockedByWhatReachesIntoIt) {
    EXPECT_TRUE(is_blocked({dvec3(0.7, 0.2, 0.5), dvec3(0.8, 0.2, 0.5), dvec3(0.7, 0.3, 0.6)}));
    EXPECT_TRUE(is_blocked({dvec3(-9, -9, 0.5), dvec3(20, -9, 0.5), dvec3(0, 20, 0.5)})) << "all of it";
    EXPECT_TRUE(is_blocked({dvec3(0.5, 0.5 - 1e-9, 0.5), dvec3(0, 1, 0.5), dvec3(0, 1, 0.6)})) << "by a tip";
}

TEST(Shaft, IsNotBlockedByWhatTouchesItFromOutside) {
    EXPECT_FALSE(is_blocked({dvec3(0.5, 0.5, 0.5), dvec3(0, 1, 0.5), dvec3(0, 1, 0.6)})) << "by a tip";
    EXPECT_FALSE(is_blocked({dvec3(1, 0, 0), dvec3(1, 1, 0), dvec3(1, 1, 1)})) << "a wall";
    EXPECT_FALSE(is_blocked({dvec3(0, 0, 0), dvec3(1, 1, 0), dvec3(0, 1, 0)})) << "the rest of the floor";
    EXPECT_FALSE(is_blocked({dvec3(-9, -9, -0.1), dvec3(20, -9, -0.1), dvec3(0, 20, -0.1)})) << "beyond the floor";
    EXPECT_FALSE(is_blocked({dvec3(0.3, 0.9, 0.1), dvec3(0.4, 0.9, 0.1), dvec3(0.3, 0.9, 0.9)})) << "within its box";
}

// Only planes of one kind part each of these faces.
TEST(Shaft, TriesAllPlanesThatMayPart) {
    // This plane goes through the edge of the shaft from (0, 0, 0) to (0, 0, 1) and the closest one of the face.
    const dvec3 near(-0.01, -0.004, 0.5), along(-0.15, 0.37, 0.2), away(-0.28, -0.11, 0.3);
    EXPECT_FALSE(is_blocked({near - along, near + along, near + away}));
    EXPECT_TRUE(is_blocked({near - along + dvec3(0.1, 0.04, 0), near + along + dvec3(0.1, 0.04, 0), near + away}));

    // A wall beyond the rest of the floor sees the floor's other half across a tip that lies in its plane.
    const double rounding = rounding_of(1);
    const Polygon64 wall(dvec3(0, 0, 0), dvec3(0, 1, 0), dvec3(0, 1, 1));
    const Shaft shaft(facing_parts(bottom, wall, rounding), rounding);
    const Polygon64 tile(dvec3(0.4, 0.5, 0), dvec3(0.3, 0.95, 0), dvec3(0.1, 0.95, 0));
    EXPECT_FALSE(shaft.may_be_blocked_by(tile, box_of(tile)));
    const Polygon64 over(dvec3(0.5, 0.4, 0), dvec3(0.3, 0.95, 0), dvec3(0.1, 0.95, 0));
    EXPECT_TRUE(shaft.may_be_blocked_by(over, box_of(over)));
}

TEST(Shaft, IsBlockedByWhatLiesOnAFace) {
    EXPECT_TRUE(is_blocked(bottom)) << "as another face in the same place";
    EXPECT_TRUE(is_blocked({dvec3(0.5, 0.1, 0), dvec3(0.6, 0.1, 0), dvec3(0.6, 0.2, 0)}));
    EXPECT_TRUE(is_blocked({dvec3(-3, -9, 1), dvec3(20, -9, 1), dvec3(0, 20, 1)}));
}

TEST(Shaft, InAConvexRoomNothingIsBetweenWalls) {
    // Turned by angles that leave no coordinate exact.
    const auto turned = [](const dvec3& p) {
        const double c = std::cos(0.3), s = std::sin(0.3);
        const dvec3 q(c * p.x - s * p.y, s * p.x + c * p.y, p.z);
        return dvec3(q.x, c * q.y - s * q.z, s * q.y + c * q.z);
    };
    const Mesh box = make_box(vec3(-1), vec3(1));
    Surface faces;
    for (const uvec3& t : box.triangles)
        faces.push_back({turned(box.positions[t.x]), turned(box.positions[t.z]), turned(box.positions[t.y])});
    const double rounding = rounding_of(2);
    int pairs = 0;
    for (const Polygon64& a : faces)
        for (const Polygon64& b : faces) {
            const FacingPair pair = facing_parts(a, b, rounding);
            if (&a == &b || pair.is_empty()) continue;
            ++pairs;
            const Shaft shaft(pair, rounding);
            for (const Polygon64& face : faces)
                EXPECT_FALSE(&face != &a && &face != &b && shaft.may_be_blocked_by(face, box_of(face)));
        }
    EXPECT_EQ(pairs, 12 * 10);
}

std::vector<std::vector<uint>> each_face(const FacePolygons& polygons) {
    std::vector<std::vector<uint>> members(polygons.faces.size());
    for (uint i = 0; i < members.size(); ++i)
        if (polygons.faces[i].count) members[i] = {i};
    return members;
}

PairPlan plan_of(const Scene& scene, const PairPlanOptions& options = {}) {
    const FacePolygons polygons(scene);
    return plan_pairs(polygons, each_face(polygons), options);
}

TEST(PairPlan, ContoursTellAllOfAConvexRoom) {
    const PairPlan plan =
        plan_of(scene_of({turned(make_box(vec3(-1, -2, -3), vec3(1, 0, 5)))}, {Transform::scaling(vec3(-1, 1, 1))}));
    EXPECT_EQ(plan.left_to_hits, 0u);
    ASSERT_EQ(plan.pairs.size(), 12u * 10 / 2);
    double total = 0;
    for (const PlannedPair& pair : plan.pairs) {
        EXPECT_TRUE(pair.sampled.empty());
        EXPECT_LT(pair.i, pair.j);
        total += 2 * pair.contour.flow;
    }
    EXPECT_NEAR(total, 2 * (2 * 2 + 2 * 8 + 2 * 8), 1e-12 * total) << "all that the walls radiate meets walls";
}

TEST(PairPlan, WhatIsFarAwayDoesNotMakeOthersTouch) {
    const Scene scene = scene_of({make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)),
                                  make_quad(vec3(0, 0, 1e-6f), vec3(0, 1, 0), vec3(1, 0, 0)),
                                  make_quad(vec3(1e9f, 0, 9), vec3(1e9f, 0, 0), vec3(0, 1e9f, 0))});
    const PairPlan plan = plan_pairs(FacePolygons(scene), std::vector<std::vector<uint>>{{0, 1}, {2, 3}, {4, 5}}, {});
    ASSERT_FALSE(plan.pairs.empty());
    EXPECT_EQ(plan.pairs[0].j, 1u);
    EXPECT_NEAR(plan.pairs[0].contour.flow, 0.9999980000100295, 1e-12);
}

TEST(PairPlan, WhatMayBeBlockedIsLeftToAreasOrHitsByItsGap) {
    for (const float distance : {2.0f, 0.1f}) {
        const PairPlan plan = plan_of(plate_between(distance));
        for (const PlannedPair& pair : plan.pairs) {
            const bool is_between_squares = pair.i < 2 && pair.j >= 2 && pair.j < 4;
            EXPECT_EQ(pair.sampled.empty(), !is_between_squares) << pair.i << ' ' << pair.j;
            for (const SampledPair& sampled : pair.sampled) EXPECT_TRUE(sampled.may_be_blocked);
        }
        EXPECT_EQ(plan.left_to_hits, distance < 1 ? 4u : 0u);
    }
}

// Makes a triangle, another that it sees only by a corner of `height` above its plane, and a square between them.
Scene corner_behind_plate(float height) {
    Mesh seen, corner;
    seen.positions = {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)};
    corner.positions = {vec3(1.5f, 0, height), vec3(1.5f, 1, height - 1), vec3(1.5f, 0, height - 1)};
    seen.triangles = corner.triangles = {{0, 1, 2}};
    return scene_of({seen, corner, make_quad(vec3(1.2f, -1, -1), vec3(0, 2, 0), vec3(0, 0, 2))});
}

TEST(PairPlan, AreasAreSampledWhereTheyLieBeforeTheOthersPlane) {
    const SampledPair sampled =
        plan_of(corner_behind_plate(0.25f), {.estimator = PairEstimator::area}).pairs.at(0).sampled.at(0);
    EXPECT_NEAR(sampled.fraction, 1.0 / 16, 1e-6);
    EXPECT_EQ(sampled.part_a.corners[1], vec2(1, 0));
    EXPECT_EQ(sampled.part_a.first, 1);
    EXPECT_NEAR(std::abs(sampled.part_b.corners[1].x), 0.25, 1e-6);
    EXPECT_NEAR(sampled.part_b.corners[1].y, 0, 1e-6);
    for (const vec2& u : {vec2(0.1f, 0.2f), vec2(0.7f, 0.9f), vec2(0.99f, 0.01f)}) {
        const vec2 at = sample_part(sampled.part_b, u);
        EXPECT_GE(at.x, 0);
        EXPECT_GE(at.y, 0);
        EXPECT_LE(at.x + at.y, 0.25f + 1e-6f) << "of the corner above the plane";
    }
}

TEST(PairPlan, OfCornersThatFloat32DoesNotHoldOnlyTheBoundIsTold) {
    const PairPlan plan = plan_of(corner_behind_plate(1e-4f), {.estimator = PairEstimator::area});
    const PlannedPair& pair = plan.pairs.at(0);
    EXPECT_TRUE(pair.sampled.empty());
    EXPECT_GT(pair.contour.flow, 0);
    EXPECT_EQ(pair.contour.flow, pair.contour.error) << "from none to all of it";
}

TEST(PairPlan, BothSidesAreSeenByHalf) {
    const FacePolygons polygons(scene_of({square(0), square(1)}));
    const std::vector<std::vector<uint>> meshes = {{0, 1}, {2, 3}};
    EXPECT_TRUE(plan_pairs(polygons, meshes, {}).pairs.empty()) << "the upper one looks away";
    const PairPlan plan = plan_pairs(polygons, meshes, {.sides = Sides::both});
    ASSERT_EQ(plan.pairs.size(), 1u);
    EXPECT_NEAR(plan.pairs[0].contour.flow, 0.199824895698387383 / 2, 1e-15);
}

TEST(PairPlan, AreasThatNeedMoreRaysThanARowHasAreLeftToHits) {
    const FacePolygons polygons(plate_between(2));
    const std::vector<std::vector<uint>> meshes = {{0, 1}, {2, 3}, {4, 5}};
    EXPECT_EQ(plan_pairs(polygons, meshes, {.rays = 256}).left_to_hits, 0u);
    EXPECT_EQ(plan_pairs(polygons, meshes, {.rays = 255}).left_to_hits, 1u);
}

TEST(PairPlan, AnEstimatorThatDoesNotFitIsRefused) {
    const auto expect_refused = [](const Scene& scene, PairEstimator estimator, const char* why) {
        expect_error(why, [&] { plan_of(scene, {.estimator = estimator}); });
    };
    expect_refused(plate_between(2), PairEstimator::contour, "face 4 may come between faces 0 and 2");
    EXPECT_NO_THROW(plan_of(plate_between(2), {.estimator = PairEstimator::area}));
    expect_refused(plate_between(0.05f), PairEstimator::area, "the gap between faces 0 and 2 is 0.035");
    expect_refused(scene_of({make_icosphere(3)}), PairEstimator::automatic, "1280 faces");
}

TEST(PairPlan, FacesWithoutAreaHaveNoPairs) {
    Scene scene = plate_between(2);
    scene.meshes[2].positions[0].x = NAN;
    scene.meshes[2].triangles = {uvec3(0, 1, 2), uvec3(1, 1, 2)};
    const PairPlan plan = plan_of(scene, {.estimator = PairEstimator::contour});
    EXPECT_EQ(plan.pairs.size(), 4u) << "nothing is between the squares";
}

}  // namespace
}  // namespace twinray::test
