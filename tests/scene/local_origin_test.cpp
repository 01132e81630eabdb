// SPDX-License-Identifier: MIT
// Files whose coordinates float32 cannot hold.
#include "engine/scene/local_origin.h"

#include "tests/scene/far_houses.h"

namespace twinray::test {
namespace {

Bounds64 box(const dvec3& lo, const dvec3& hi) {
    Bounds64 bounds;
    bounds.include(lo), bounds.include(hi);
    return bounds;
}

TEST(LocalOrigin, OrdinaryPlacesAreLeftAlone) {
    EXPECT_EQ(choose_local_origin({}), dvec3(0));
    EXPECT_EQ(choose_local_origin(box(dvec3(0), dvec3(0))), dvec3(0));
    EXPECT_EQ(choose_local_origin(box(dvec3(-3), dvec3(5))), dvec3(0));
    EXPECT_EQ(choose_local_origin(box(dvec3(15, 0, 0), dvec3(16, 0.1, 0))), dvec3(0));        // 16 extents away
    EXPECT_EQ(choose_local_origin(box(dvec3(0, 5e6, 0), dvec3(400e3, 5.4e6, 0))), dvec3(0));  // a whole country
    EXPECT_EQ(choose_local_origin(box(dvec3(1e-40), dvec3(1.00001e-40))), dvec3(0));          // float32 has no more
    EXPECT_EQ(choose_local_origin(box(dvec3(-1e308), dvec3(1e308))), dvec3(0));
}

TEST(LocalOrigin, FarPlacesGetARoundNumberNearTheirMiddle) {
    EXPECT_EQ(choose_local_origin(box(dvec3(15.1, 0, 0), dvec3(16.1, 0.1, 0))), dvec3(16, 0, 0));
    EXPECT_EQ(choose_local_origin(box(dvec3(500e3, 5.4e6, 0), dvec3(500'010, 5'400'009, 3))), dvec3(500'010, 5.4e6, 0));
    EXPECT_EQ(choose_local_origin(box(dvec3(490e3, 5.4e6, 400), dvec3(510e3, 5'412'300, 812))),
              dvec3(500e3, 5'410'000, 0));
    EXPECT_EQ(choose_local_origin(box(dvec3(-2'000'000.37), dvec3(-2'000'000.31))), dvec3(-2'000'000.34375));
    EXPECT_EQ(choose_local_origin(box(dvec3(3e20), dvec3(3.001e20))), dvec3(3.001e20));
    // A point, as float32 may leave of what is small and far.
    EXPECT_EQ(choose_local_origin(box(dvec3(1e6, 0, 0), dvec3(1e6, 0, 0))), dvec3(1e6, 0, 0));
}

TEST(LocalOrigin, NoCoordinateIsThenLargerThanTheExtent) {
    for (double extent = 1e-3; extent < 1e5; extent *= 1.7)
        for (double at = -7e6; at < 7e6; at += 123'456.789) {
            const Bounds64 bounds = box(dvec3(at, -at, 2 * at), dvec3(at + extent, -at + 0.3 * extent, 2 * at));
            const dvec3 origin = choose_local_origin(bounds);
            if (origin == dvec3(0)) continue;
            EXPECT_LE(box(bounds.lo - origin, bounds.hi - origin).reach(), extent * 1.000001) << extent << ' ' << at;
        }
}

TEST(LocalOrigin, PositionsAreRoundedAfterTheOriginIsSubtracted) {
    const std::vector<dvec3> far = {far_away + dvec3(0.13, 0.27, 3.21), dvec3(NAN, 0, INFINITY)};
    const std::vector<vec3> local = local_positions(far, far_away);
    EXPECT_EQ(local[0], vec3(dvec3(far[0] - far_away)));
    EXPECT_NEAR(local[0].y, 0.27, 2e-8);
    EXPECT_TRUE(std::isnan(local[1].x));
    EXPECT_EQ(local[1].z, INFINITY);
    const std::vector<dvec3> near = {dvec3(0.1, -0.0, 1e60)};
    EXPECT_EQ(std::bit_cast<std::uint32_t>(local_positions(near, dvec3(0))[0].y), 0x80000000u);
}

TEST(LocalOrigin, IsWrittenInFull) {
    EXPECT_EQ(origin_text(dvec3(500e3, -5'400'000.25, 0)), "500000 -5400000.25 0");
    EXPECT_EQ(origin_text(dvec3(1e20, 1e-7, 123456789)), "100000000000000000000 0.0000001 123456789");
}

Scene load(const std::string& name, const std::string& content, const std::optional<dvec3>& origin = {}) {
    const TempDir folder;
    return load_scene(folder.write(name, content), origin);
}

TEST(FarPly, KeepsItsMillimetres) {
    for (const char* type : {"double", "float"}) {
        const Scene scene = load("a.ply", far_houses_ply(type));
        EXPECT_EQ(scene.origin, dvec3(500'010, 5'400'010, 0));
        expect_far_houses(scene, rounding);
        const Scene as_given = load("a.ply", far_houses_ply(type), dvec3(0));
        EXPECT_EQ(as_given.origin, dvec3(0));
        EXPECT_EQ(as_given.meshes[0].positions[1].x, static_cast<float>(500'010.13));
        const Scene chosen = load("a.ply", far_houses_ply(type), far_away + 3.5);
        EXPECT_EQ(chosen.origin, far_away + 3.5);
        expect_far_houses(chosen, rounding);
    }
}

TEST(FarPly, StrayVerticesThatNoFaceUsesDoNotCount) {
    std::string file = far_houses_ply("double");
    file.replace(file.find("vertex 32"), 9, "vertex 33");
    const std::size_t body = file.find("end_header\n") + 11;
    std::string lines = file.substr(body);
    std::size_t end = 0;
    for (int i = 0; i < 32; ++i) end = lines.find('\n', end) + 1;
    lines.insert(end, "0 0 0\n");
    EXPECT_EQ(load("a.ply", file.substr(0, body) + lines).origin, dvec3(500'010, 5'400'010, 0));
}

}  // namespace
}  // namespace twinray::test
