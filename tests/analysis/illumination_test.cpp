// Grids of rays: the light that they bring, and the centroid of what they meet.
#include <twinray/analysis.h>

#include "engine/analysis/faces.h"
#include "engine/analysis/ray_grid.h"
#include "tests/analysis/scenes.h"

namespace twinray::test {
namespace {

class IlluminationTest : public AnalysisTest {
  protected:
    Illumination lit(const Scene& scene, const IlluminationDesc& desc) {
        fill(scene);
        return illuminate(accel(), Faces(context(), scene), desc);
    }
    // Returns the area of one instance in a scene of several.
    static double area_of(const Illumination& result, uint first, uint count = 2) {
        double area = 0;
        for (uint face = first; face < first + count; ++face) area += result.groups[face].area;
        return area;
    }
};
TWINRAY_OVER_EVERY_ACCEL(IlluminationTest);

// Results that do not depend on the accelerator.
class IlluminationRulesTest : public IlluminationTest {};
TWINRAY_OVER_SOFTWARE(IlluminationRulesTest);

IlluminationDesc lit_along(dvec3 direction, uint side = 200) {
    return {.grid = {.direction = direction, .side = side}};
}

// Makes three squares: the upper one hides half of the lower one, and the one in between them is a unit square as well,
// turned away by 60 degrees.
Scene squares() {
    Mesh tilted = make_quad(vec3(3, 0, 0), vec3(0.5f, 0, 0.8660254f), vec3(0, 1, 0));
    return scene_of({square(0), make_quad(vec3(0.5f, 0, 1), vec3(1, 0, 0), vec3(0, 1, 0)), tilted});
}

TEST_P(IlluminationTest, AreasOfSquaresAreWhatIsSeenOfThem) {
    const Illumination result = lit(squares(), lit_along({0, 0, -3}));
    EXPECT_EQ(result.ray_count, 200u * 200);
    const std::array exact = {0.125, 0.375, 0.5, 0.5, 0.25, 0.25};
    for (uint face = 0; face < 6; ++face) {
        const LitArea& seen = result.groups[face];
        EXPECT_NEAR(seen.area, exact[face], 0.01) << face;
        EXPECT_EQ(seen.area, std::min(static_cast<double>(seen.hits) * result.cell_area, seen.unobstructed));
        EXPECT_LE(seen.interval.low, exact[face] * (1 + 1e-6)) << face;
        EXPECT_GE(seen.interval.high, exact[face] * (1 - 1e-6)) << face;
        EXPECT_LT(seen.interval.high - seen.interval.low, 0.05) << face;
        EXPECT_NEAR(seen.unobstructed, face < 4 ? 0.5 : 0.25, 1e-7);
        EXPECT_NEAR(seen.surface, 0.5, 1e-7);
    }
    EXPECT_NEAR(result.groups[4].irradiance(), 0.5, 0.02);
    EXPECT_NEAR(result.groups[4].fraction(), 1, 0.04);
    EXPECT_NEAR(result.total.area, 2, 0.02);
    EXPECT_LE(result.total.interval.low, 2);
    EXPECT_GE(result.total.interval.high, 2);
    EXPECT_LT(result.total.interval.high - result.total.interval.low, 0.05);
}

TEST_P(IlluminationTest, OfABoxThreeSidesAreSeenWhateverMovesIt) {
    const dvec3 direction(-0.3, -0.5, -1);
    for (const Transform& transform : {skewed(), mirrored()}) {
        const Scene scene = scene_of({make_box(vec3(-1, -2, 0), vec3(1, 0, 1))}, {transform});
        for (const Sides sides : {Sides::both, Sides::front}) {
            IlluminationDesc desc = lit_along(direction);
            desc.sides = sides;
            const Illumination result = lit(scene, desc);
            uint seen = 0;
            for (uint face = 0; face < 12; ++face) {
                const double towards = -dot(area_vector(scene, {0, face}), normalize(direction));
                const double exact = std::max(towards, 0.0);  // a box is convex
                seen += exact > 0;
                EXPECT_NEAR(result.groups[face].area, exact, 0.15) << face;
                EXPECT_LE(result.groups[face].interval.low, exact) << face;
                EXPECT_GE(result.groups[face].interval.high, exact * (1 - 1e-6)) << face;
                EXPECT_EQ(result.groups[face].hits != 0, exact > 0) << face;
                EXPECT_NEAR(result.groups[face].unobstructed, sides == Sides::both ? std::abs(towards) : exact, 1e-6);
            }
            EXPECT_EQ(seen, 6u);
        }
    }
}

TEST_P(IlluminationRulesTest, LightOnASideThatDoesNotCountIsStoppedAllTheSame) {
    const Scene scene = scene_of({square(0), make_quad(vec3(0, 0, 1), vec3(0, 1, 0), vec3(0.5f, 0, 0))});
    IlluminationDesc desc = lit_along({0, 0, -1});
    desc.sides = Sides::front;
    const Illumination front = lit(scene, desc);
    EXPECT_NEAR(area_of(front, 0), 0.5, 0.01);
    EXPECT_EQ(area_of(front, 2), 0);
    EXPECT_NEAR(front.total.area, 0.5, 0.01);
    EXPECT_LT(front.total.interval.high, 0.6);
    desc.sides = Sides::both;
    EXPECT_NEAR(area_of(lit(scene, desc), 2), 0.5, 0.01);
}

TEST_P(IlluminationRulesTest, GroupsAreSumsOfFacesWithIntervalsOfTheirOwn) {
    Scene scene = squares();
    const Illumination faces = lit(scene, lit_along({0, 0, -1}));
    IlluminationDesc desc = lit_along({0, 0, -1});
    desc.by = FaceGrouping::instance;
    const Illumination instances = lit(scene, desc);
    ASSERT_EQ(instances.groups.size(), 3u);
    for (uint i = 0; i < 3; ++i) {
        const LitArea& group = instances.groups[i];
        EXPECT_EQ(group.hits, faces.groups[2 * i].hits + faces.groups[2 * i + 1].hits);
        EXPECT_NEAR(group.area, i == 1 ? 1 : 0.5, 0.01);
        EXPECT_LT(group.interval.high - group.interval.low, 0.05);
    }
    desc.by = FaceGrouping::material;
    EXPECT_EQ(lit(scene, desc).groups.at(0).hits, faces.total.hits);
}

TEST_P(IlluminationTest, EveryAcceleratorCountsTheSameHits) {
    Scene scene = scene_of({make_icosphere(3)}, {{}, Transform::translation({1.5f, 0.25f, -2}), skewed()});
    SwTlas software(context());
    push_scene(software, scene);
    const Illumination expected = illuminate(software, Faces(context(), scene), lit_along({-0.25, -1, -0.5}, 300));
    const Illumination result = lit(scene, lit_along({-0.25, -1, -0.5}, 300));
    ASSERT_EQ(result.groups.size(), expected.groups.size());
    for (std::size_t face = 0; face < result.groups.size(); ++face) {
        EXPECT_EQ(result.groups[face].hits, expected.groups[face].hits) << face;
        EXPECT_EQ(result.groups[face].interval, expected.groups[face].interval) << face;
    }
    EXPECT_GT(expected.total.hits, 10000u);
    const Interval total = expected.total.interval;  // only the outline is uncertain, not the edges between faces
    EXPECT_LT((total.high - total.low) / expected.cell_area, 250);
}

// The scene is a square and a roof. More rays may meet a face than its share, but no more light.
TEST_P(IlluminationRulesTest, WhatIsLitWhollyIsNotLitMore) {
    const Scene scene = scene_of({square(0), make_quad(vec3(3, 0, 0), vec3(1, 0, 1), vec3(0, 1, 0)),
                                  make_quad(vec3(4, 0, 1), vec3(1, 0, -1), vec3(0, 1, 0))});
    fill(scene);
    const Faces faces(context(), scene);
    uint more = 0;  // groups that more rays meet than their share
    for (const uint side : {7u, 30u, 50u})
        for (const GridPoints points : {GridPoints::random, GridPoints::centers})
            for (const FaceGrouping by : {FaceGrouping::face, FaceGrouping::mesh}) {
                IlluminationDesc desc = lit_along({0, 0, -1}, side);
                desc.grid.points = points;
                desc.by = by;
                Illumination result = illuminate(accel(), faces, desc);
                result.groups.push_back(result.total);
                for (const LitArea& lit : result.groups) {
                    more += static_cast<double>(lit.hits) * result.cell_area > lit.unobstructed;
                    EXPECT_LE(lit.fraction(), 1);
                    EXPECT_LE(lit.interval.low, lit.area);
                    EXPECT_GE(lit.interval.high, lit.area);
                    EXPECT_EQ(lit.interval.high, lit.unobstructed);
                }
            }
    EXPECT_GT(more, 10u);
}

// 150 squares at random places behind a plate that hides some of them, small and large against the cells.
TEST_P(IlluminationRulesTest, IntervalsCoverAndEstimatesHaveNoBias) {
    const Scene scene = scene_of({square(0), make_quad(vec3(0.3125f, 0.1875f, 1), vec3(1, 0, 0), vec3(0, 0.45f, 0)),
                                  make_quad(vec3(1.4f, 0.75f, 0), vec3(0.08f, 0, 0), vec3(0, 0.06f, 0))});
    fill(scene);
    const Faces faces(context(), scene);
    const std::array exact = {1 - 0.6875 * 0.45, 0.45, 0.08 * 0.06};
    std::array<double, 3> sum{}, width{};
    std::array<int, 3> missed{};
    constexpr int runs = 100;
    for (int run = 0; run < runs; ++run) {
        IlluminationDesc desc = lit_along({0, 0, -1}, 37);
        desc.grid.seed = 1000 + run;
        desc.by = FaceGrouping::mesh;
        const Illumination result = illuminate(accel(), faces, desc);
        for (int i = 0; i < 3; ++i) {
            const LitArea& seen = result.groups[i];
            sum[i] += static_cast<double>(seen.hits) * result.cell_area;
            width[i] += (seen.interval.high - seen.interval.low) / runs;
            missed[i] += seen.interval.low > exact[i] * (1 + 1e-6) || seen.interval.high < exact[i] * (1 - 1e-6);
        }
    }
    for (int i = 0; i < 3; ++i) {
        EXPECT_LE(missed[i], 5) << i;
        EXPECT_NEAR(sum[i] / runs, exact[i], width[i] / 10) << i;  // a tenth, since it is the mean of 100
    }
    const double cells = 1.5 / (37 * 37);  // the area of one
    EXPECT_LT(width[0], 90 * cells);
    EXPECT_LT(width[2], 12 * cells);
}

TEST_P(IlluminationTest, CountsAreThoseOfTheRaysAsTheHostMakesThem) {
    const Scene scene = scene_of({make_icosphere(1)}, {skewed(), Transform::translation({0, 3, 0})});
    for (const GridPoints points : {GridPoints::random, GridPoints::centers}) {
        IlluminationDesc desc = lit_along({1, -2, 0.5}, 99);
        desc.grid.points = points;
        desc.grid.seed = 0x1'0000'0001;
        const Illumination result = lit(scene, desc);
        const RayGridPlan plan = plan_ray_grid(scene, desc.grid);
        std::vector<Ray> rays;
        for (uint i = 0; i < plan.ray_count; ++i) rays.push_back(grid_ray(plan.grid, i));
        std::vector<std::uint64_t> hits(result.groups.size());
        for (const Hit& hit : accel().closest_hits(rays))
            if (hit.hit) ++hits[hit.instance_index * 80 + hit.primitive_index];
        for (std::size_t face = 0; face < hits.size(); ++face) EXPECT_EQ(result.groups[face].hits, hits[face]) << face;
    }
}

TEST_P(IlluminationRulesTest, SeedsOf64BitsDifferAndRepeat) {
    const auto hits = [&](std::uint64_t seed) {
        IlluminationDesc desc = lit_along({0.25, 0.5, -1}, 31);
        desc.grid.seed = seed;
        return lit(squares(), desc).groups[0].hits + lit(squares(), desc).groups[2].hits * 1000;
    };
    EXPECT_EQ(hits(1), hits(1));
    EXPECT_NE(hits(1), hits(2));
    EXPECT_NE(hits(1), hits(0x1'0000'0001));
}

TEST_P(IlluminationRulesTest, NothingToSeeIsNoLight) {
    for (Scene scene : {Scene(), scene_of({Mesh()}), scene_of({make_quad(vec3(0), vec3(NAN), vec3(1))})}) {
        const Illumination result = lit(scene, lit_along({0, 0, -1}));
        EXPECT_EQ(result.ray_count, 0u);
        EXPECT_EQ(result.total.area, 0);
        EXPECT_EQ(result.total.fraction(), 0);
        EXPECT_EQ(result.groups.size(), count_triangles(scene));
    }
    // The square is seen from its edge, and then lies all at one point.
    EXPECT_EQ(lit(scene_of({square(0)}), lit_along({0, 1, 0})).total.area, 0);
    EXPECT_EQ(lit(scene_of({make_quad(vec3(0), vec3(0), vec3(0))}), lit_along({0, 1, 0})).total.hits, 0u);
}

TEST_P(IlluminationRulesTest, WrongUseSaysWhatIsWrong) {
    const Scene scene = squares(), other = scene_of({make_icosphere(0), square(0), square(1)});
    const Faces faces(context(), scene);
    fill(scene);
    const auto error = [&](const IlluminationDesc& desc) {
        return error_if_any([&] { illuminate(accel(), faces, desc); });
    };
    expect_contains(error(lit_along({0, 0, 0})), "direction (0, 0, 0) must be");
    expect_contains(error(lit_along({0, NAN, 0})), "must be finite");
    expect_contains(error(lit_along({0, 0, 1}, 0)), "0 cells per side");
    expect_contains(error(lit_along({0, 0, 1}, 65536)), "65536 cells per side; must be 1 to 65535");
    EXPECT_EQ(error(lit_along({0, 0, 1e-300}, 1)), "");
    fill(scene_of({square(0)}));
    expect_contains(error(lit_along({0, 0, 1})), "it has 1 instances and the scene 3");
    fill(other);
    expect_contains(error(lit_along({0, 0, 1})), "primitives and the scene's");
    const Scene vast = scene_of({make_quad(vec3(-3.4e38f, 0, 0), vec3(3.4e38f, 0, 0), vec3(0, 3e38f, 0))});
    expect_contains(error_of([&] { Faces(context(), vast); }),
                    "triangle 0 of instance 0 has a coordinate of 3.4e+38 in world space; at most 2^124");
}

class CentroidTest : public AnalysisTest {
  protected:
    Centroid seen(const Scene& scene, const CentroidDesc& desc) {
        fill(scene);
        return centroid(accel(), scene, desc);
    }
};
TWINRAY_OVER_EVERY_ACCEL(CentroidTest);

// Results that do not depend on the accelerator.
class CentroidRulesTest : public CentroidTest {};
TWINRAY_OVER_SOFTWARE(CentroidRulesTest);

CentroidDesc centroids_along(dvec3 direction, uint side) { return {.grid = {.direction = direction, .side = side}}; }

void expect_near(dvec3 a, dvec3 b, dvec3 error) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a[axis], b[axis], error[axis]) << axis;
}

TEST_P(CentroidTest, OfASquareIsItsMiddleInWorldSpace) {
    for (const Transform& transform : {Transform(), skewed(), mirrored()}) {
        const Scene scene = scene_of({square(2)}, {transform});
        const Centroid result = seen(scene, centroids_along({0.5, 0.25, -1}, 100));
        ASSERT_TRUE(result.mean && result.standard_error);
        EXPECT_EQ(result.ray_count, 10000u);
        EXPECT_GT(result.point_count, 2000u);
        expect_near(*result.mean, in_world(transform, vec3(0.5f, 0.5f, 2)), *result.standard_error * 4.0 + 1e-6);
        expect_near(*result.standard_error, dvec3(0), dvec3(0.01));
    }
}

TEST_P(CentroidRulesTest, OfASphereIsTwoThirdsOfTheRadiusInFront) {
    const Scene scene = scene_of({make_icosphere(5, 3)}, {Transform::translation({100, -200, 300})});
    const Centroid result = seen(scene, centroids_along({0, 1e-3, 0}, 300));
    ASSERT_TRUE(result.mean);
    expect_near(*result.mean, {100, -202, 300}, *result.standard_error * 4.0 + 0.004);  // facets
}

TEST_P(CentroidRulesTest, OnlyTheClosestPointsCount) {
    const Scene scene = scene_of({square(0), square(1), make_quad(vec3(0, 0, -1), vec3(0.5f, 0, 0), vec3(0, 1, 0))});
    EXPECT_NEAR(seen(scene, centroids_along({0, 0, -1}, 50)).mean->z, 1, 1e-6);
    EXPECT_NEAR(seen(scene, centroids_along({0, 0, 1}, 50)).mean->z, -0.5, 0.02);
}

TEST_P(CentroidRulesTest, StandardErrorsAreThoseOfManySeeds) {
    const Scene scene = scene_of({make_icosphere(2)}, {skewed()});
    fill(scene);
    constexpr int runs = 100;
    dvec3 sum(0), squares(0), told(0);
    const dvec3 about = *centroid(accel(), scene, centroids_along({1, 2, -3}, 400)).mean;
    for (int run = 0; run < runs; ++run) {
        CentroidDesc desc = centroids_along({1, 2, -3}, 40);
        desc.grid.seed = 77 + run;
        const Centroid result = centroid(accel(), scene, desc);
        const dvec3 off = *result.mean - about;
        sum += off, squares += off * off, told += *result.standard_error / double{runs};
    }
    for (int axis = 0; axis < 3; ++axis) {
        const double spread = std::sqrt(squares[axis] / runs);
        EXPECT_GT(told[axis], spread * 0.8) << axis;
        EXPECT_LT(told[axis], spread * 2) << axis;
        EXPECT_LT(std::abs(sum[axis] / runs), spread * 0.4) << axis;
    }
}

TEST_P(CentroidRulesTest, PointsAreKeptWhereAskedAndMeanWhatTheySay) {
    CentroidDesc desc = centroids_along({0, -1, 0}, 1025);  // more than one batch
    desc.keeps_points = true;
    const Scene scene = scene_of({make_icosphere(1)}, {Transform::translation({0, 7, 0})});
    const Centroid result = seen(scene, desc);
    ASSERT_EQ(result.points.size(), result.point_count);
    dvec3 sum(0);
    for (const dvec3& point : result.points) {
        EXPECT_GT(point.y, 6.999);
        EXPECT_LT(length(point - dvec3(0, 7, 0)), 1.000001);
        sum += point;
    }
    expect_near(sum / double(result.points.size()), *result.mean, dvec3(1e-9));
    const Centroid again = seen(scene, centroids_along({0, -1, 0}, 1025));
    EXPECT_TRUE(again.points.empty());
    EXPECT_EQ(*again.mean, *result.mean);
    EXPECT_EQ(*again.standard_error, *result.standard_error);
}

TEST_P(CentroidRulesTest, CentersGiveAMeanForEverySeedAndNoError) {
    CentroidDesc desc = centroids_along({0, 0, -1}, 32);
    desc.grid.points = GridPoints::centers;
    const Centroid result = seen(scene_of({square(0)}), desc);
    expect_near(*result.mean, {0.5, 0.5, 0}, dvec3(1e-6));
    EXPECT_FALSE(result.standard_error);
    desc.grid.seed = 5;
    EXPECT_EQ(*seen(scene_of({square(0)}), desc).mean, *result.mean);
}

TEST_P(CentroidRulesTest, NothingHitIsNoMean) {
    for (const Scene& scene : {Scene(), scene_of({Mesh()}), scene_of({make_quad(vec3(1), vec3(0), vec3(0))})}) {
        const Centroid result = seen(scene, centroids_along({0, 0, -1}, 10));
        EXPECT_FALSE(result.mean || result.standard_error);
        EXPECT_EQ(result.point_count, 0u);
    }
}

TEST_P(CentroidRulesTest, WrongUseSaysWhatIsWrong) {
    fill(scene_of({make_icosphere(0)}));
    const auto expect_refused = [&](const Scene& scene, const CentroidDesc& desc, const char* why) {
        expect_contains(error_of([&] { centroid(accel(), scene, desc); }), why);
    };
    expect_refused(scene_of({square(0)}), centroids_along({0, 0, -1}, 9),
                   "its instance 0 has 20 primitives and the scene's 2 triangles");
    expect_refused(Scene(), centroids_along({0, 0, -1}, 9), "has 1 instances");
    expect_refused(scene_of({make_icosphere(0)}), centroids_along({0, INFINITY, -1}, 9), "finite");
    const Scene vast = scene_of({make_quad(vec3(-3.4e38f, 0, 0), vec3(3.4e38f, 0, 0), vec3(0, 3e38f, 0))});
    fill(vast);
    expect_refused(vast, centroids_along({1, 0, 0.1}, 9), "float32 ends");
}

}  // namespace
}  // namespace twinray::test
