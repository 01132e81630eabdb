// SPDX-License-Identifier: MIT
#include "engine/analysis/contour.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/analysis/pair_plan.h"
#include <twinray/geometry.h>
#include "tests/analysis/plain_scenes.h"
#include "tests/analysis/polygon_scenes.h"

namespace twinray {
namespace {

using test::Surface;

TEST(Contour, IsExactWhereTheFactorIsKnown) {
    for (const test::KnownPair& known : test::known_pairs()) {
        const ContourExchange exchange = test::exchange_of(known.a, known.b);
        const double flow = known.value * test::area_of(known.a);
        EXPECT_NEAR(exchange.flow / flow, 1, 1e-12) << known.name;
        EXPECT_LE(std::abs(exchange.flow - flow), exchange.error + 1e-16 * flow) << known.name;
        EXPECT_LE(exchange.error, 1e-10 * flow) << known.name << ": the bound is not far above the error";
    }
}

TEST(Contour, DoesNotDependOnPlaceAndScale) {
    const test::KnownPair known = test::perpendicular64(1, 1, 0.200043776075403154);
    for (const double scale : {1e-12, 1.0, 1e12}) {
        const auto moved = [&](Surface surface) {
            for (Polygon64& polygon : surface)
                for (dvec3& vertex : polygon.vertices)
                    vertex = scale * dvec3(vertex.y - vertex.z, vertex.y + vertex.z, std::sqrt(2.0) * vertex.x);
            return surface;
        };
        ContourExchange sum;
        for (const Polygon64& a : moved(known.a))
            for (const Polygon64& b : moved(known.b)) {
                const FacingPair pair = facing_parts(a, b, rounding_of(2 * scale));
                if (!pair.is_empty()) sum.flow += contour_exchange(pair.a, pair.b).flow;
            }
        const double flow = known.value * 2 * scale * scale;
        EXPECT_NEAR(sum.flow / flow, 1, 1e-12) << scale;
    }
}

constexpr std::uint64_t most_evaluations = 20'000;  // of two polygons: 4 ms

// What is cut off a square a hair from an edge, and the rest of it, are the square.
TEST(Contour, OfSliversIsWhatIsLeftOfTheWhole) {
    const Surface floor = test::quad(dvec3(0), dvec3(1, 0, 0), dvec3(0, 1, 0));
    for (const double gap : {0.0, 1e-8, 0.5})
        for (const double width : {1e-6, 1e-9, 1e-12}) {
            const auto wall = [&](double low, double high) {
                return test::quad(dvec3(-gap, 0, low), dvec3(0, 1, 0), dvec3(0, 0, high - low));
            };
            const ContourExchange whole = test::exchange_of(floor, wall(0, 1));
            const ContourExchange sliver = test::exchange_of(floor, wall(0, width));
            const ContourExchange rest = test::exchange_of(floor, wall(width, 1));
            const double error = whole.error + sliver.error + rest.error;
            EXPECT_LE(std::abs(sliver.flow + rest.flow - whole.flow), error + 1e-16) << gap << ' ' << width;
            EXPECT_LE(error, 1e-12 * whole.flow) << gap << ' ' << width;
            EXPECT_GE(sliver.flow + sliver.error, 0);
            EXPECT_LE(sliver.flow - sliver.error, width);
            EXPECT_LE(sliver.evaluations, 4 * most_evaluations);
        }
}

// Clipping leaves edges of 1e-8, of vertices that miss the planes of other walls by that.
TEST(Contour, OfRoomsRoundedToFloat32IsAsExactAsOfOthers) {
    for (const double angle : {0.1, 0.3, 0.7, 1.3}) {
        const Surface room = FacePolygons(test::rounded_room(2, angle)).faces;
        for (std::size_t i = 0; i < room.size(); i += 5) {
            ContourExchange sum;
            for (const Polygon64& other : room) {
                const ContourExchange part = test::exchange_of({room[i]}, {other});
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
        const double error = std::abs(test::exchange_of(a, b).flow / test::area_of(a) - known);
        if (n > 8) {
            EXPECT_NEAR(last / error, 4, 0.2) << n << ": the error falls as 1 / n^2";
        }
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
        const double factor = test::exchange_of(a, b).flow / test::area_of(a);
        if (subdivisions) {
            EXPECT_NEAR((last - known) / (factor - known), 4, 0.9) << subdivisions;
        }
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

}  // namespace
}  // namespace twinray
