#include "viewer/picture/face_picture.h"

#include <algorithm>

#include <twinray/scene.h>
#include "twinray/glsl/vector_math.h"
#include "viewer/picture/scene_picture.h"

#include "tests/accel/accel_fixture.h"
#include "tests/scene/temp_dir.h"

namespace twinray::test {
namespace {

constexpr Rgb left_color = {68, 1, 84}, right_color = {253, 231, 37}, behind_color = {10, 120, 200};
constexpr Rgb mark_color = {255, 0, 0};

// Seen along -z from z = 10, 8 x 8 wide: two triangles from x = -2 to 0 and from 0 to 2, and a larger square behind.
class FacePictureTest : public AccelTest {
  protected:
    void SetUp() override {
        AccelTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        Mesh front;
        front.positions = {{-2, -2, 1}, {0, -2, 1}, {-2, 2, 1}, {2, -2, 1}, {2, 2, 1}};
        front.triangles = {{0, 1, 2}, {3, 4, 1}};
        scene_.meshes = {front, make_quad({-3, -3, -1}, {6, 0, 0}, {0, 6, 0})};
        scene_.instances = {{"front", 0, {}}, {"behind", 1, {}}};
        push_scene(accel(), scene_);
        camera_.camera_to_world = Transform::translation({0, 0, 10});
        camera_.orthographic_half_height = 4.0f;
    }
    FacePicture drawn(Cull cull = Cull::none) {
        const std::vector<Rgb> colors = {left_color, right_color, behind_color, behind_color};
        return draw_faces(accel(), scene_, colors, {.width = 16, .height = 16, .camera = camera_, .cull = cull});
    }

    Scene scene_;
    Camera camera_;
};
TWINRAY_OVER_EVERY_ACCEL(FacePictureTest);

TEST_P(FacePictureTest, ShowsEachFaceInItsColor) {
    const FacePicture picture = drawn();
    const auto at = [&](uint x, uint y) { return picture.raster.at(x, y); };
    EXPECT_EQ(at(4, 10), left_color);
    EXPECT_EQ(at(11, 10), right_color);
    EXPECT_EQ(at(3, 3), behind_color);
    EXPECT_EQ(at(0, 0), at(15, 15));
    EXPECT_NE(at(0, 0), behind_color);
    const auto depth = [&](uint x, uint y) { return picture.depths[y * 16 + x]; };
    EXPECT_EQ(depth(4, 10), 9);
    EXPECT_EQ(depth(3, 3), 11);
    EXPECT_EQ(depth(0, 0), INFINITY);
}

TEST_P(FacePictureTest, EdgesAreMixed) {
    camera_.orthographic_half_height = 3.75f;  // the left edge of the square covers 0.4 of pixel 1
    const FacePicture picture = drawn();
    const Rgb outside = picture.raster.at(0, 8), edge = picture.raster.at(1, 8), inside = picture.raster.at(2, 12);
    EXPECT_EQ(inside, behind_color);
    const float covered = (linear_of(outside).x - linear_of(edge).x) / (linear_of(outside).x - linear_of(inside).x);
    EXPECT_NEAR(covered, 0.4f, 0.125f);
}

TEST_P(FacePictureTest, FacesTurnedAwayAreDarker) {
    // The camera looks from 60 degrees to the side.
    camera_.camera_to_world = {{vec4(0.5f, 0, 0.8660254f, 8.660254f), vec4(0, 1, 0, 0), vec4(-0.8660254f, 0, 0.5f, 5)}};
    EXPECT_NEAR(linear_of(drawn().raster.at(8, 2)).z, 0.75f * linear_of(behind_color).z, 0.01f);
}

TEST_P(FacePictureTest, CutsAwayWhatIsSeenFromBehind) {
    EXPECT_EQ(drawn(Cull::back).raster.at(4, 10), left_color);
    camera_.camera_to_world = {{vec4(-1, 0, 0, 0), vec4(0, 1, 0, 0), vec4(0, 0, -1, -10)}};
    EXPECT_EQ(drawn().raster.at(4, 4), behind_color);
    EXPECT_NE(drawn(Cull::back).raster.at(4, 4), behind_color);
}

TEST_P(FacePictureTest, DotsAreHiddenByWhatIsInFrontOfThem) {
    FacePicture picture = drawn();
    const auto dot_at = [](dvec3 at, float behind = 0) { return Dot{at, 0.5f, mark_color, behind}; };
    const std::vector<Dot> dots = {dot_at({-1.75, -1.25, 1}), dot_at({1.75, -1.25, -1}), dot_at({-2.25, 1.75, -4}),
                                   dot_at({2.75, 2.75, -4}, 1), dot_at({0, 0, 20})};
    draw_dots(picture, dots);
    EXPECT_EQ(picture.raster.at(4, 10), mark_color);   // in the surface
    EXPECT_NE(picture.raster.at(11, 10), mark_color);  // behind one
    EXPECT_NE(picture.raster.at(3, 4), mark_color);
    EXPECT_EQ(picture.raster.at(13, 2), mark_color);  // behind one, on top
    EXPECT_EQ(std::count(picture.raster.pixels.begin(), picture.raster.pixels.end(), mark_color), 2);
}

TEST_P(FacePictureTest, StrokesAreHiddenWhereSomethingIsInFront) {
    FacePicture picture = drawn();
    // This stroke follows the row of y = -1.75, from the square's left to its right, in its plane.
    const std::vector<Stroke> strokes = {{{-2.75, -1.75, -1}, {2.75, -1.75, -1}, 0.5f, mark_color},
                                         {{0, -2, -1}, {0, -2, 20}, 1, mark_color}};
    draw_strokes(picture, strokes);
    for (uint x = 0; x < 16; ++x) {
        const bool is_in_front = x >= 4 && x < 12;  // of both triangles, which are broad down there
        EXPECT_EQ(picture.raster.at(x, 11) == mark_color, x >= 2 && x < 14 && !is_in_front) << x;
    }
}

TEST_P(FacePictureTest, LabelsOfOnePlaceLieApart) {
    const std::vector<Rgb> colors(4, behind_color);
    const auto ink_of = [&](std::size_t count) {
        FacePicture picture = draw_faces(accel(), scene_, colors, {.width = 240, .height = 200, .camera = camera_});
        draw_labels(picture, std::vector<Note>(count, {.position = {0, 0, 1}, .label = "3: 12.5", .detail = ""}));
        return std::ranges::count(picture.raster.pixels, ink);
    };
    EXPECT_GT(ink_of(1), 10);
    EXPECT_EQ(ink_of(4), 4 * ink_of(1));
}

TEST_P(FacePictureTest, RaysAreSeenFromTheSideThatTheyComeFrom) {
    const auto direction_of = [&](const std::vector<Ray>& rays) {
        return picture_of_rays({}, scene_, rays, std::vector<Hit>(rays.size())).direction;
    };
    for (const vec3 along : {vec3(0, 0, 1), vec3(0, 0, -1), vec3(0, -2, 0), vec3(1, 1, 1)}) {
        const std::optional<vec3> seen = direction_of({{vec3(0), 0, along, INFINITY}, {vec3(1), 0, along, INFINITY}});
        ASSERT_TRUE(seen);
        EXPECT_GT(dot(normalize(*seen), normalize(along)), 0.7f);
        EXPECT_LT(dot(normalize(*seen), normalize(along)), 0.95f) << "strokes are not points";
    }
    EXPECT_FALSE(direction_of({{vec3(0), 0, vec3(0, 0, 1), INFINITY}, {vec3(0), 0, vec3(0, 0, -1), INFINITY}}));
    EXPECT_FALSE(direction_of({}));
}

TEST_P(FacePictureTest, RefusesAnotherScene) {
    expect_error("0 colours for 4 faces", [&] { draw_faces(accel(), scene_, {}, {}); });
    scene_.instances.pop_back();
    expect_error("2 instances, the scene 1", [&] { drawn(); });
}

}  // namespace
}  // namespace twinray::test
