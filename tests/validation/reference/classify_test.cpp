// Classes of hits: their names and counts, and which of them an answer has.
#include "validation/reference/classify.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include <twinray/validation.h>
#include "engine/core/error.h"
#include "tests/validation/reference/meshes.h"

namespace twinray {
namespace {

TEST(HitClassCounts, NamesAreThoseOfTheReports) {
    using enum HitClass;
    const std::pair<HitClass, const char*> names[] = {{agree, "AGREE"},       {tie, "TIE"},
                                                      {boundary, "BOUNDARY"}, {boundary_hw_miss, "BOUNDARY_HW_MISS"},
                                                      {sw_leak, "SW_LEAK"},   {unspecified, "UNSPECIFIED"},
                                                      {sw_false, "SW_FALSE"}, {invalid_input, "INVALID_INPUT"},
                                                      {t_err, "T_ERR"},       {hw_leak, "HW_LEAK"},
                                                      {hw_false, "HW_FALSE"}, {hw_t_err, "HW_T_ERR"},
                                                      {hw_range, "HW_RANGE"}};
    for (const auto& [kind, name] : names) EXPECT_EQ(name_of(kind), name);
}

TEST(HitClassCounts, OnlySoftwareLeaksFalseHitsAndTErrorsAreFaultsOfOurs) {
    std::set<std::string> faults;
    for (std::size_t i = 0; i < hit_class_count; ++i)
        if (is_fault_of_ours(static_cast<HitClass>(i))) faults.emplace(name_of(static_cast<HitClass>(i)));
    EXPECT_EQ(faults, (std::set<std::string>{"SW_LEAK", "SW_FALSE", "T_ERR"}));
}

TEST(HitClassCounts, CountsAddUp) {
    HitClassCounts a, b;
    a.add(HitClass::agree);
    a.add(HitClass::sw_leak);
    b.add(HitClass::sw_leak);
    b.add(HitClass::t_err);
    b.add(HitClass::hw_leak);
    a += b;
    EXPECT_EQ(a[HitClass::sw_leak], 2u);
    EXPECT_EQ(a[HitClass::agree], 1u);
    EXPECT_EQ(a.total(), 5u);
    EXPECT_EQ(a.faults_of_ours(), 3u);
}

using namespace test;  // NOLINT

constexpr std::uint32_t inside_seed = 77;

RayResult both(HitClass software, HitClass hardware) { return {software, hardware}; }

// Classifies the same answer from both accelerators.
RayResult check(const ReferenceScene& reference, const Ray& ray, const Hit& hit) {
    return classify(reference, ray, hit, hit);
}

Hit hit_of(const ReferenceHit& hit) {
    return {1, float(hit.t), hit.primitive, 0, float(hit.u), float(hit.v), hit.instance, 0};
}

// Unit squares in z = 4 and z = 6: triangles 0, 1 and 2, 3, split along x = y.
Soup two_sheets() {
    Soup soup;
    for (const float z : {4.0f, 6.0f}) {
        soup.add({0, 0, z}, {1, 0, z}, {1, 1, z});
        soup.add({0, 0, z}, {1, 1, z}, {0, 1, z});
    }
    return soup;
}

const Ray inner_ray = make_ray({0.7f, 0.2f, 0}, {0, 0, 1});
const Hit near_hit = {1, 4, 0, 0, 0.5f, 0.2f, 0, 0};
const Hit far_hit = {1, 6, 2, 0, 0.5f, 0.2f, 0, 0};

Ray upward(float x, float y, float t_min = 0) { return make_ray({x, y, 0}, {0, 0, 1}, t_min); }

TEST(Classify, AnswersBeforeTwoSheets) {
    const ReferenceScene reference = reference_of(two_sheets());
    ASSERT_EQ(reference.closest_hit(upward(0.5f, 0.5f)).primitive, 0u);
    const RayResult agrees = both(HitClass::agree, HitClass::agree), leaks = both(HitClass::sw_leak, HitClass::hw_leak),
                    is_false = both(HitClass::sw_false, HitClass::hw_false);
    const struct {
        const char* what;
        Ray ray;
        Hit hit;
        RayResult expected;
    } rows[] = {{"the right hit", inner_ray, near_hit, agrees},
                {"a right miss", upward(2, 2), miss(), agrees},
                {"an interior hit reported as a miss", inner_ray, miss(), leaks},
                {"a far hit in place of a near one", inner_ray, far_hit, leaks},
                {"a far hit through a shared edge", upward(0.5f, 0.5f), {1, 6, 2, 0, 0, 0.5f, 0, 0}, leaks},
                {"a triangle that the ray clearly misses", inner_ray, {1, 4, 1, 0, 0.2f, 0, 0, 0}, is_false},
                {"a hit where all is missed", upward(2, 2), near_hit, is_false},
                {"a hit outside the interval", upward(0.7f, 0.2f, 4.5f), near_hit, is_false},
                {"the neighbour across a shared edge",
                 upward(0.5f, 0.5f),
                 {1, 4, 1, 0, 0.5f, 0, 0, 0},
                 both(HitClass::tie, HitClass::tie)}};
    for (const auto& row : rows) EXPECT_EQ(check(reference, row.ray, row.hit), row.expected) << row.what;
}

TEST(Classify, AnAcceleratorWithoutAnAnswerHasNoClass) {
    EXPECT_EQ(classify(reference_of(two_sheets()), inner_ray, near_hit, std::nullopt),
              (RayResult{HitClass::agree, std::nullopt}));
}

TEST(Classify, PrimitiveOrInstanceThatCannotBeHitIsFalse) {
    Soup soup = two_sheets();
    soup.add(vec3(NAN), vec3(0), vec3(1));
    const ReferenceScene reference = reference_of(soup);
    for (const auto& [primitive, instance] : {std::pair{4u, 0u}, std::pair{5u, 0u}, std::pair{0u, 1u}}) {
        Hit hit = near_hit;
        hit.primitive_index = primitive;
        hit.instance_index = instance;
        EXPECT_EQ(check(reference, inner_ray, hit), both(HitClass::sw_false, HitClass::hw_false));
    }
}

TEST(Classify, SilhouetteIsBoundary) {
    const ReferenceScene reference = reference_of(two_sheets());
    const Ray on_rim = upward(1, 0.5f);
    ASSERT_TRUE(reference.closest_hit(on_rim).hit);
    EXPECT_EQ(check(reference, on_rim, {1, 6, 2, 0, 0.5f, 0.5f, 0, 0}), both(HitClass::boundary, HitClass::boundary));
    EXPECT_EQ(check(reference, on_rim, miss()), both(HitClass::boundary, HitClass::boundary_hw_miss));
    const Ray past_rim = upward(std::nextafter(1.0f, 2.0f), 0.5f);
    ASSERT_FALSE(reference.closest_hit(past_rim).hit);
    EXPECT_EQ(check(reference, past_rim, {1, 4, 0, 0, 0.5f, 0.5f, 0, 0}), both(HitClass::boundary, HitClass::boundary));
}

TEST(Classify, RayDownTheWallOfACubeMayHitTopOrFloor) {
    Soup soup = cube();
    soup.add({-9, -9, 0}, {9, -9, 0}, {0, 9, 0});
    const ReferenceScene reference = reference_of(soup);
    const Ray ray = make_ray({1, 0.3f, 3}, {0, 0, -1});
    const ReferenceHit top = reference.closest_hit(ray);
    ASSERT_EQ(top.t, 2);
    EXPECT_EQ(check(reference, ray, hit_of(top)), both(HitClass::agree, HitClass::agree));
    const ReferenceHit floor = reference.closest_hit(make_ray({1 + 1e-6f, 0.3f, 3}, {0, 0, -1}));
    ASSERT_EQ(floor.primitive, 12u);
    EXPECT_EQ(check(reference, ray, hit_of(floor)), both(HitClass::boundary, HitClass::boundary));
    EXPECT_EQ(check(reference, ray, miss()), both(HitClass::sw_leak, HitClass::hw_leak));
}

TEST(Classify, WrongTIsTErr) {
    const ReferenceScene reference = reference_of(two_sheets());
    Hit hit = near_hit;
    hit.t = 4 + 1e-4f;
    EXPECT_EQ(check(reference, inner_ray, hit), both(HitClass::t_err, HitClass::hw_t_err));
    hit.t = std::nextafter(4.0f, 5.0f);
    EXPECT_EQ(check(reference, inner_ray, hit), both(HitClass::agree, HitClass::agree));
}

TEST(Classify, HardwareIsAllowedTheErrorOfItsOwnInverse) {
    const Transform nearly_singular = {{vec4(1, 1, 0, 0), vec4(1, 1 + 0x1p-10f, 0, 0), vec4(0, 0, 1, 0)}};
    const ReferenceScene reference = reference_of(two_sheets(), nearly_singular);
    const Ray ray = make_ray(transform_point(nearly_singular, {0.7f, 0.2f, 0}), {0, 0, 1});
    Hit hit = near_hit;
    ASSERT_EQ(check(reference, ray, hit), both(HitClass::agree, HitClass::agree));
    hit.t = 4.02f;
    EXPECT_EQ(check(reference, ray, hit), both(HitClass::t_err, HitClass::agree));
}

TEST(Classify, WrongBarycentricsAreOutOfRange) {
    const ReferenceScene reference = reference_of(two_sheets());
    Hit swapped = near_hit;
    std::swap(swapped.u, swapped.v);
    EXPECT_EQ(check(reference, inner_ray, swapped), both(HitClass::t_err, HitClass::hw_range));
    for (float Hit::*field : {&Hit::t, &Hit::u, &Hit::v}) {
        Hit hit = near_hit;
        hit.*field = NAN;
        EXPECT_EQ(check(reference, inner_ray, hit), both(HitClass::t_err, HitClass::hw_range));
    }
}

TEST(Classify, RaysThatNobodyMayTraceMustMiss) {
    const ReferenceScene reference = reference_of(two_sheets());
    const Ray ray = make_ray(vec3(NAN), {0, 0, 1});
    EXPECT_EQ(check(reference, ray, miss()), both(HitClass::agree, HitClass::agree));
    EXPECT_EQ(check(reference, ray, near_hit), both(HitClass::invalid_input, HitClass::invalid_input));
    EXPECT_EQ(classify_any(reference, ray, true, false), both(HitClass::invalid_input, HitClass::agree));
}

TEST(Classify, HitAtAnEndOfTheIntervalIsUnspecified) {
    const ReferenceScene reference = reference_of(two_sheets());
    Ray ray = inner_ray;
    ray.t_max = std::nextafter(4.0f, 5.0f);
    ASSERT_TRUE(reference.closest_hit(ray).hit);
    EXPECT_EQ(check(reference, ray, miss()), both(HitClass::unspecified, HitClass::unspecified));
    ray.t_max = INFINITY;
    ray.t_min = 4;
    Hit hit = near_hit;
    hit.t = std::nextafter(4.0f, 5.0f);
    EXPECT_EQ(check(reference, ray, hit), both(HitClass::unspecified, HitClass::unspecified));
}

TEST(Classify, DistanceBeyondFloat32IsUnspecified) {
    Ray ray = inner_ray;
    ray.direction.z = 1e-39f;
    ASSERT_TRUE(reference_of(two_sheets()).closest_hit(ray).hit);
    EXPECT_EQ(check(reference_of(two_sheets()), ray, miss()), both(HitClass::unspecified, HitClass::unspecified));
}

// No rounding excuses a miss of a closed mesh from inside.
void expect_misses_leak(const Soup& soup, const Transform& transform = {}) {
    const ReferenceScene reference = reference_of(soup, transform);
    std::vector<Ray> rays = rays_from_inside(soup, transform, 1000, inside_seed);
    for (std::size_t i = 0; i < 100; ++i)  // exactly through vertices, where nothing moves them
        rays.push_back(make_ray(transform_point(transform, vec3(0)),
                                transform_vector(transform, soup.positions[i % soup.positions.size()])));
    for (const Ray& ray : rays) {
        ASSERT_TRUE(reference.closest_hit(ray).hit);
        ASSERT_EQ(check(reference, ray, miss()), both(HitClass::sw_leak, HitClass::hw_leak))
            << "seed " << inside_seed << ", direction " << ray.direction.x << " " << ray.direction.y << " "
            << ray.direction.z;
        ASSERT_EQ(classify_any(reference, ray, false, true), both(HitClass::sw_leak, HitClass::agree))
            << "seed " << inside_seed;
    }
}

// Also at vertices and edges, whatever the winding, in doubled surfaces, without shared indices, and in moved and
// stretched instances.
TEST(Classify, MissFromInsideAClosedSphereIsALeak) {
    const Soup indexed = sphere(3);
    expect_misses_leak(indexed);
    Soup mixed = indexed, doubled;
    for (std::size_t i = 0; i < mixed.triangles.size(); i += 3) std::swap(mixed.triangles[i].x, mixed.triangles[i].y);
    expect_misses_leak(mixed);
    for (const uvec3& t : indexed.triangles) {
        doubled.add(indexed.positions[t.x], indexed.positions[t.y], indexed.positions[t.z]);
        doubled.add(indexed.positions[t.y], indexed.positions[t.x], indexed.positions[t.z]);
    }
    expect_misses_leak(doubled);
    expect_misses_leak(indexed,
                       Transform::translation({1, 2, 3}) * (rotation(0.5f, 0.3f) * Transform::scaling({1, 2, 3})));
}

// The square's right half is split at (1, 0.3), which is no vertex of the left half.
TEST(Classify, TJunctionIsUnspecified) {
    Soup soup;
    soup.add({0, 0, 4}, {1, 0, 4}, {1, 1, 4});
    soup.add({1, 0, 4}, {2, 0, 4}, {1, 0.3f, 4});
    soup.add({1, 0.3f, 4}, {2, 0, 4}, {1, 1, 4});
    const ReferenceScene reference = reference_of(soup);
    EXPECT_EQ(check(reference, upward(1, 0.3f), miss()), both(HitClass::unspecified, HitClass::unspecified));
}

TEST(Classify, SilhouetteOfAClosedMeshIsBoundary) {
    const ReferenceScene reference = reference_of(cube());
    for (const float x : {0.0f, 1.0f}) {
        const Ray down_a_wall = make_ray({x, 0.3f, 3}, {0, 0, -1});
        EXPECT_EQ(check(reference, down_a_wall, miss()), both(HitClass::boundary, HitClass::boundary_hw_miss));
        EXPECT_EQ(classify_any(reference, down_a_wall, false, false),
                  both(HitClass::boundary, HitClass::boundary_hw_miss));
    }
}

TEST(Classify, AnyHitIsClassifiedByHitAndMiss) {
    const ReferenceScene reference = reference_of(two_sheets());
    EXPECT_EQ(classify_any(reference, inner_ray, true, false), both(HitClass::agree, HitClass::hw_leak));
    EXPECT_EQ(classify_any(reference, upward(2, 2), true, false), both(HitClass::sw_false, HitClass::agree));
    EXPECT_EQ(classify_any(reference, upward(std::nextafter(1.0f, 2.0f), 0.5f), true, false),
              both(HitClass::boundary, HitClass::agree));
}

TEST(ClassifyAll, ClassifiesEachRayAndRejectsListsOfAnotherLength) {
    const ReferenceScene reference = reference_of(two_sheets());
    const std::vector<Ray> rays(3, inner_ray);
    const std::vector<Hit> hits = {near_hit, far_hit, miss()};
    const std::vector<RayResult> ray_results = classify_all(reference, rays, hits, {});
    ASSERT_EQ(ray_results.size(), 3u);
    EXPECT_EQ(ray_results[0], (RayResult{HitClass::agree, {}}));
    EXPECT_EQ(ray_results[1], (RayResult{HitClass::sw_leak, {}}));
    EXPECT_EQ(ray_results[2], (RayResult{HitClass::sw_leak, {}}));
    EXPECT_THROW(classify_all(reference, rays, {hits.data(), 2}, {}), Error);
}

}  // namespace
}  // namespace twinray
