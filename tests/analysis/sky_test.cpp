// The sky and the sun, seen from faces and over rasters of heights.
#include <twinray/analysis.h>

#include "tests/analysis/scenes.h"
#include "tests/support/device.h"
#include "tests/support/errors.h"

namespace twinray::test {
namespace {

constexpr dvec3 zenith(0, 0, 2);

class SkyTest : public AnalysisTest {
  protected:
    SkyLight sky(const Scene& scene, const SkyRaysDesc& desc) {
        fill(scene);
        return sky_light(accel(), Faces(context(), scene), zenith, desc);
    }
    SkyLight hours(const Scene& scene, const std::vector<SunPosition>& positions, const SkyRaysDesc& desc) {
        fill(scene);
        return sun_hours(accel(), Faces(context(), scene), positions, desc);
    }
};
TWINRAY_OVER_EVERY_ACCEL(SkyTest);

// Results that do not depend on the accelerator.
class SkyRulesTest : public SkyTest {};
TWINRAY_OVER_SOFTWARE(SkyRulesTest);

void expect_covers(const Received& received, double exact, double width) {
    EXPECT_LE(received.interval.low, exact * (1 + 1e-6));
    EXPECT_GE(received.interval.high, exact * (1 - 1e-6));
    EXPECT_LT(received.interval.high - received.interval.low, width);
    EXPECT_LE(received.interval.low, received.value);
    EXPECT_GE(received.interval.high, received.value);
}

TEST_P(SkyRulesTest, UnobstructedFacesSeeWhatTheirTiltLets) {
    for (const double cosine : {1.0, 0.5, 0.0, -0.6}) {
        const auto sine = static_cast<float>(std::sqrt(1 - cosine * cosine));
        const vec3 u(static_cast<float>(cosine), 0, sine);
        const Scene scene = scene_of({make_quad(vec3(5, 6, 7), u * 0.01f, vec3(0, 3, 0))});
        const SkyLight front = sky(scene, {.samples = 1500, .sides = Sides::front});
        EXPECT_EQ(front.ray_count, 3000u);
        const SkyLight both = sky(scene, {.samples = 1500, .sides = Sides::both});
        for (uint face = 0; face < 2; ++face) {
            const double open = (1 + normalize(area_vector(scene, {0, face})).z) / 2;
            expect_covers(front.faces[face], open, 0.05);
            EXPECT_EQ(front.faces[face].interval.high, open) << cosine;
        }
        for (const Received& face : both.faces) EXPECT_EQ(face.value, 1);
    }
}

// Between long walls as high as the street is wide, the floor sees sqrt(2) - 1 of the sky (crossed strings: Hottel
// 1954).
TEST_P(SkyRulesTest, AStreetSeesWhatItsWallsLeave) {
    const Scene scene = scene_of({make_quad(vec3(0, -1, 0), vec3(1, 0, 0), vec3(0, 2, 0)),
                                  make_quad(vec3(0, -1000, 0), vec3(0, 2000, 0), vec3(0, 0, 1)),
                                  make_quad(vec3(1, -1000, 0), vec3(0, 0, 1), vec3(0, 2000, 0))});
    const SkyLight light = sky(scene, {.samples = 20000, .sides = Sides::front});
    // In the mean of both, the floor's triangles have points at all distances from the walls alike.
    const double floor = (light.faces[0].value + light.faces[1].value) / 2;
    EXPECT_NEAR(floor, std::sqrt(2.0) - 1, 0.01);
    EXPECT_LT(light.faces[0].interval.high - light.faces[0].interval.low, 0.04);
}

TEST_P(SkyTest, NothingGetsOutOfABoxAndNothingIsLostOutsideOfIt) {
    for (const Transform& transform : {skewed(), mirrored()}) {
        const Scene scene = scene_of({make_box(vec3(-1), vec3(1))}, {transform});
        const SkyLight front = sky(scene, {.samples = 500, .sides = Sides::front});
        const SkyLight both = sky(scene, {.samples = 500, .sides = Sides::both});
        for (uint face = 0; face < 12; ++face) {
            const double cosine = normalize(area_vector(scene, {0, face})).z;
            expect_covers(front.faces[face], (1 + cosine) / 2, 0.12);
            EXPECT_EQ(both.faces[face].free_rays, front.faces[face].free_rays) << "by the inside";
        }
    }
}

// A square, and another that hides half of it from the sun above.
Scene half_hidden() { return scene_of({square(0), make_quad(vec3(0.5f, 0, 1), vec3(1, 0, 0), vec3(0, 1, 0))}); }

// Half of the lower square lies in the shadow of the upper one, for the sun from above and from the side.
TEST_P(SkyTest, HoursOfSunAreThoseOfTheShadows) {
    const Scene scene = half_hidden();
    const std::vector<SunPosition> positions = {{{0, 0, -1}, 2}, {{-7, 0, -7}, 3}, {{0, 0, 0.1}, 0.5}};
    const std::array front = {0.25 * 2 + 0.75 * 3, 0.75 * 2 + 0.25 * 3, 5.0, 5.0};
    const std::array back = {0.5, 0.5, 0.375, 0.125};
    const SkyLight of_front = hours(scene, positions, {.samples = 400, .sides = Sides::front});
    const SkyLight of_both = hours(scene, positions, {.samples = 400, .sides = Sides::both});
    EXPECT_EQ(of_both.ray_count, 4u * 3 * 400);
    for (uint face = 0; face < 4; ++face) {
        expect_covers(of_front.faces[face], front[face], 0.4);
        expect_covers(of_both.faces[face], front[face] + back[face], 0.4);
    }
    EXPECT_EQ(of_front.faces[2].interval.high, 5);
}

TEST_P(SkyTest, EveryAcceleratorCountsTheSame) {
    const Scene scene = scene_of({make_icosphere(2)}, {skewed(), Transform::translation({3, 0, 6})});
    SwTlas software(context());
    push_scene(software, scene);
    const SkyRaysDesc desc{.samples = 33, .sides = Sides::front};
    const SkyLight expected = sky_light(software, Faces(context(), scene), zenith, desc), result = sky(scene, desc);
    ASSERT_EQ(result.faces.size(), 640u);
    for (std::size_t face = 0; face < 640; ++face)
        EXPECT_EQ(result.faces[face].free_rays, expected.faces[face].free_rays) << face;
}

TEST_P(SkyRulesTest, IntervalsCoverAndEstimatesHaveNoBias) {
    const Scene scene = half_hidden();
    fill(scene);
    const Faces faces(context(), scene);
    const double exact = sky_light(accel(), faces, zenith, {.samples = 1u << 18, .seed = 9}).faces[0].value;
    const std::vector<SunPosition> positions = {{{0, 0, -1}, 2}, {{-1, 0, -1}, 3}};
    double sky_sum = 0, hours_sum = 0;
    int missed = 0;
    constexpr int runs = 100;
    for (int run = 0; run < runs; ++run) {
        const SkyRaysDesc desc{.samples = 101, .sides = Sides::front, .seed = 100u + run};
        const Received of_sky = sky_light(accel(), faces, zenith, desc).faces[0];
        const Received of_sun = sun_hours(accel(), faces, positions, desc).faces[0];
        sky_sum += of_sky.value, hours_sum += of_sun.value;
        missed += of_sky.interval.low > exact || of_sky.interval.high < exact;
        missed += of_sun.interval.low > 2.75 || of_sun.interval.high < 2.75;
    }
    EXPECT_LE(missed, 10);
    EXPECT_NEAR(sky_sum / runs, exact, 0.012);
    EXPECT_NEAR(hours_sum / runs, 2.75, 0.03);
}

// 11 times 0.1 / 11 is more than 0.1, as rounded.
TEST_P(SkyRulesTest, NoFaceHasMoreHoursThanThereAre) {
    const std::vector<SunPosition> positions = {{{0, 0, -1}, 0.1}};
    for (const Received& face : hours(scene_of({square(0)}), positions, {.samples = 11}).faces) {
        EXPECT_EQ(face.value, 0.1);
        EXPECT_EQ(face.interval.high, 0.1);
    }
}

TEST_P(SkyRulesTest, PositionsOfTheSunHavePointsOfTheirOwn) {
    const Scene scene = half_hidden();
    bool differs = false;  // else the hits of two alike are even
    for (uint seed = 0; seed < 10; ++seed)
        differs |=
            hours(scene, {{{0, 0, -1}, 1}, {{0, 0, -1}, 1}}, {.samples = 51, .seed = seed}).faces[0].free_rays % 2;
    EXPECT_TRUE(differs);
}

TEST_P(SkyRulesTest, BatchesAreOfWholeFaces) {
    const Scene scene = scene_of({make_icosphere(0)});
    int missed = 0;
    for (const uint samples : {1u, 3u, 120'000u}) {
        const SkyLight light = sky(scene, {.samples = samples, .sides = Sides::front, .seed = 0x3'0000'0001});
        for (std::size_t face = 0; face < 20; ++face) {
            const double cosine = normalize(area_vector(scene, {0, static_cast<uint>(face)})).z;
            const Interval interval = light.faces[face].interval;
            missed += interval.low > (1 + cosine) / 2 + 1e-6 || interval.high < (1 + cosine) / 2 - 1e-6;
            EXPECT_NEAR(light.faces[face].value, (1 + cosine) / 2, 3 / std::sqrt(samples)) << samples;
            EXPECT_LE(light.faces[face].free_rays, samples);
        }
    }
    EXPECT_LE(missed, 3) << "of 60 intervals of 95 %";
}

TEST_P(SkyRulesTest, FacesWithoutAreaReceiveNothing) {
    Mesh mesh = make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0));
    mesh.normals.clear();
    mesh.uvs.clear();
    mesh.positions.push_back(vec3(NAN));
    mesh.triangles = {{0, 1, 2}, {0, 1, 4}, {0, 1, 1}};
    const SkyLight light = sky(scene_of({mesh}), {.samples = 10});
    EXPECT_EQ(light.faces[0].value, 1);
    for (const uint face : {1u, 2u}) EXPECT_EQ(light.faces[face].interval, (Interval{0, 0}));
    EXPECT_EQ(hours(scene_of({mesh}), {{{0, 0, -1}, 2}}, {.samples = 10}).faces[2].value, 0);
    EXPECT_TRUE(sky(Scene(), {}).faces.empty());
    EXPECT_TRUE(hours(Scene(), {{{0, 0, -1}, 2}}, {}).faces.empty());
}

TEST_P(SkyRulesTest, WrongUseSaysWhatIsWrong) {
    const Scene scene = scene_of({square(0)});
    const auto error = [&](const SunPosition& position, uint samples) {
        return error_if_any([&] { hours(scene, {position}, {.samples = samples}); });
    };
    expect_contains(error({{0, 0, 0}, 1}, 5), "direction (0, 0, 0) must be");
    expect_contains(error({{0, 0, 1}, -1}, 5), "-1 hours");
    expect_contains(error({{0, 0, 1}, NAN}, 5), "nan hours");
    expect_contains(error({{0, 0, 1}, 1}, 0), "0 per face; must be 1 to 1048576");
    expect_contains(error({{0, 0, 1}, 1}, 1048577), "1048577 per face");
    EXPECT_EQ(error({{0, 0, 1e-200}, 0}, 1), "");
    const Faces faces(context(), scene);
    expect_contains(error_of([&] { sky_light(accel(), faces, dvec3(0), {}); }), "must be finite");
    fill(scene_of({square(0), square(1)}));
    expect_contains(error_of([&] { sky_light(accel(), faces, zenith, {}); }), "it has 2 instances");
}

constexpr float hole = NAN;

class HorizonTest : public VulkanTest {
  protected:
    // Returns the slope eastward from the cell in column 0 of the middle row.
    float slope_east(const std::vector<float>& heights, uint columns, HorizonDesc desc = {}) {
        const vec2 east(1, 0);
        const uint rows = static_cast<uint>(heights.size()) / columns;
        desc.corner = {0, rows / 2}, desc.size = {1, 1}, desc.ways = {&east, 1};
        return horizon(context(), {.heights = heights, .columns = columns, .rows = rows}, desc).at(0);
    }
};

TEST_F(HorizonTest, TheSteepestPointCounts) {
    const std::vector<float> heights = {0, 0, 0, 0, 0,  //
                                        0, 1, 3, 2, 4,  //
                                        0, 0, 0, 0, 0};
    EXPECT_EQ(slope_east(heights, 5), 1.5f);
    EXPECT_EQ(slope_east(heights, 5, {.lift = 1}), 1.0f);
    EXPECT_EQ(slope_east(heights, 5, {.lift = 9}), 0.0f);
    EXPECT_EQ(slope_east(heights, 5, {.reach = 1}), 1.0f);
    EXPECT_EQ(slope_east(heights, 5, {.curvature = 0.5f}), 1.0f);
    EXPECT_FLOAT_EQ(slope_east(heights, 5, {.measure = HorizonMeasure::light}), 1 / 3.25f);
    EXPECT_FLOAT_EQ(slope_east(heights, 5, {.measure = HorizonMeasure::solid_angle}), 1 - 1.5f / std::sqrt(3.25f));
}

// An edge without a triangle is no surface.
TEST_F(HorizonTest, HolesHideNothing) {
    EXPECT_EQ(slope_east({hole, hole, hole, hole,  //
                          0, 0, 9, hole,           //
                          hole, hole, hole, hole},
                         4),
              0.0f);
    for (const bool is_above : {false, true}) {
        std::vector<float> heights = {hole, hole, hole, hole,  //
                                      0,    0,    8,    hole,  //
                                      hole, hole, 8,    hole};
        if (is_above) heights = {hole, 0, 8, hole, 0, 0, 8, hole, hole, hole, hole, hole};
        EXPECT_EQ(slope_east(heights, 4), 4.0f) << is_above;
    }
    EXPECT_TRUE(std::isnan(slope_east({0, 0, hole, 0}, 2)));
    EXPECT_TRUE(std::isnan(slope_east({0, 0, hole, 0}, 2, {.measure = HorizonMeasure::light})));
}

// Ways lead along a row, a column and a diagonal, from cells in a corner, at the border and inside.
TEST_F(HorizonTest, AnswersAreByCellThenByWay) {
    const std::vector<float> heights = {5, 0, 0, 0,  //
                                        0, 0, 0, 0,  //
                                        0, 0, 0, 3};
    const vec2 ways[] = {vec2(1, 0), vec2(0, -1), vec2(-1, -1)};
    const std::vector<float> found = horizon(context(), {.heights = heights, .columns = 4, .rows = 3},
                                             {.corner = {0, 1}, .size = {3, 2}, .ways = ways});
    const std::vector<float> wanted = {0,    5,    0, 0,    0, 5, 0, 0, 0,  //
                                       1.0f, 2.5f, 0, 1.5f, 0, 0, 3, 0, 2.5f};
    ASSERT_EQ(found.size(), wanted.size());
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], wanted[i], 1e-12) << i;
}

TEST_F(HorizonTest, WrongArgumentsAreNamed) {
    const std::vector<float> heights(6);
    const vec2 ways[] = {vec2(1, 0)};
    const auto error = [&](const HeightRaster& raster, const HorizonDesc& desc) {
        return error_of([&] { horizon(context(), raster, desc); });
    };
    const HeightRaster raster{.heights = heights, .columns = 3, .rows = 2};
    expect_contains(error({.heights = heights, .columns = 6, .rows = 1}, {}), "6 heights for 6 x 1 cells");
    expect_contains(error({.heights = heights, .columns = 3, .rows = 3}, {}), "6 heights for 3 x 3 cells");
    expect_contains(error(raster, {.corner = {2, 0}, .size = {2, 1}}),
                    "2 x 1 cells from column 2, row 0 are not all within a raster of 3 x 2");
    const vec2 wrong_ways[] = {vec2(1, 0), vec2(INFINITY, 0), vec2(0, 0)};
    expect_contains(error(raster, {.size = {1, 1}, .ways = {wrong_ways, 2}}), "way 1 is (inf, 0)");
    expect_contains(error(raster, {.size = {1, 1}, .ways = {wrong_ways + 2, 1}}), "way 0 is (0, 0)");
    for (const vec2 way : {vec2(1, NAN), vec2(NAN, 1)})
        expect_contains(error(raster, {.size = {1, 1}, .ways = {&way, 1}}), "way 0 is (");
    expect_contains(error(raster, {.size = {1, 1}, .ways = ways, .lift = -1}), "lift is -1; wanted is at least 0");
    expect_contains(error(raster, {.size = {1, 1}, .ways = ways, .reach = NAN}), "reach is nan");
    EXPECT_TRUE(horizon(context(), raster, {.ways = ways}).empty());
}

}  // namespace
}  // namespace twinray::test
