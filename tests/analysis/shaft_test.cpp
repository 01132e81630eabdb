// SPDX-License-Identifier: MIT
#include "engine/analysis/shaft.h"

#include <gtest/gtest.h>

#include <twinray/geometry.h>
#include "tests/analysis/polygon_scenes.h"

namespace twinray {
namespace {

using test::quad;
using test::Surface;

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

// Each is parted by planes of one kind alone.
TEST(Shaft, TriesAllPlanesThatMayPart) {
    // Through the edge of the shaft from (0, 0, 0) to (0, 0, 1) and the closest one of the face.
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

}  // namespace
}  // namespace twinray
