// The rational reference; the float64 one checked against it where arithmetic is hardest; and the bound by which level
// certified leaves triangles out, which is right whenever it is certain.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <glm/gtc/quaternion.hpp>
#include <random>

#include <twinray/geometry.h>

#include "report/suite/case_run.h"
#include "swtlas/structures.h"
#include "tests/validation/reference/meshes.h"
#include "validation/exact/exact_reference.h"
#include "validation/reference/aimed_rays.h"
#include "validation/reference/classify.h"

namespace twinray::exact {
namespace {

using namespace test;  // NOLINT

const Triangle64 vertex_triangle = {dvec3(0, 0, 3), dvec3(4, 0, 3), dvec3(0, 4, 3)};

Line line(vec3 origin, vec3 direction) { return {vector_of(origin), vector_of(direction)}; }

TEST(Rounded, IsTheNearestDouble) {
    for (const double value : {0.0, 1.0, -0.1, 1e300, -0x1p-1060, 0x1.fffffffffffffp1023})
        EXPECT_EQ(rounded(Rational(value)), value);
    const Rational third = Rational(1, 3);
    EXPECT_EQ(rounded(third), 1.0 / 3.0);
    EXPECT_EQ(rounded(-third), -1.0 / 3.0);
    EXPECT_EQ(rounded(Rational(2, 3)), 2.0 / 3.0);  // rounds away from zero
    const Rational half_ulp = Rational(0x1p-53);
    EXPECT_EQ(rounded(1 + half_ulp), 1.0);                    // tie to even
    EXPECT_EQ(rounded(1 + 3 * half_ulp), 1.0 + 2 * 0x1p-52);  // tie to even, away from zero
    EXPECT_EQ(rounded(1 + half_ulp + Rational(0x1p-500)), std::nextafter(1.0, 2.0));
}

TEST(Crossing, TellsInsideEdgeAndVertexApart) {
    const auto inside = crossing(line({1, 1, 0}, {0, 0, 2}), vertex_triangle);
    ASSERT_TRUE(inside);
    EXPECT_EQ(inside->t, Rational(3, 2));
    EXPECT_EQ(inside->u, Rational(1, 4));
    EXPECT_EQ(inside->v, Rational(1, 4));
    EXPECT_EQ(inside->incidence, Incidence::interior);
    EXPECT_EQ(crossing(line({2, 2, 0}, {0, 0, -1}), vertex_triangle)->incidence, Incidence::edge);
    EXPECT_EQ(crossing(line({2, 2, 0}, {0, 0, -1}), vertex_triangle)->t, -3);
    EXPECT_EQ(crossing(line({1, 1, 0}, {-1, -1, 3}), vertex_triangle)->incidence, Incidence::vertex);
    EXPECT_FALSE(crossing(line({std::nextafter(2.0f, 3.0f), 2, 0}, {0, 0, 1}), vertex_triangle));
    EXPECT_TRUE(crossing(line({std::nextafter(2.0f, 1.0f), 2, 0}, {0, 0, 1}), vertex_triangle));
    EXPECT_FALSE(crossing(line({-1, 1, 3}, {1, 0, 0}), vertex_triangle));  // in its plane
    EXPECT_FALSE(crossing(line({-1, 1, 2}, {1, 0, 0}), vertex_triangle));
}

TEST(Reference, NamesAllTrianglesAtTheClosestT) {
    const Soup soup = grid(4, 0, 0, 1);
    const ReferenceScene reference = reference_of(soup);
    const Reference exact_reference(reference);
    const auto vertex = exact_reference.closest_hit(make_ray({2, 2, 5}, {0, 0, -1}));
    ASSERT_TRUE(vertex);
    EXPECT_EQ(vertex->triangles.size(), 6u);  // one diagonal
    EXPECT_EQ(vertex->crossing.incidence, Incidence::vertex);
    EXPECT_TRUE(std::ranges::is_sorted(vertex->triangles));
    EXPECT_EQ(exact_reference.closest_hit(make_ray({2.5f, 2, 5}, {0, 0, -1}))->triangles.size(), 2u);
    EXPECT_EQ(exact_reference.closest_hit(make_ray({2.5f, 2.25f, 5}, {0, 0, -1}))->triangles.size(), 1u);
    EXPECT_FALSE(exact_reference.closest_hit(make_ray({2.5f, 2.25f, 5}, {0, 0, -1}, 5)));     // exclusive
    EXPECT_FALSE(exact_reference.closest_hit(make_ray({2.5f, 2.25f, 5}, {0, 0, -1}, 0, 5)));  // at both ends
    EXPECT_FALSE(exact_reference.closest_hit(make_ray({2.5f, 2.25f, 5}, {0, 0, 0})));
}

TEST(Reference, InvertsTheMatrixAsGiven) {
    // 1/3 is no float: the plane z = 1 of the instance lies at t = 0x1.555556p-2, exactly.
    const float third = 1.0f / 3.0f;
    Soup soup;
    soup.add({-1, -1, 1}, {1, -1, 1}, {0, 1, 1});
    const ReferenceScene reference =
        reference_of(soup, Transform::translation({0, 0, 7}) * Transform::scaling({3, 5, third}));
    const auto hit = Reference(reference).closest_hit(make_ray({0, 0, 7}, {0, 0, 1}));
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->crossing.t, Rational(third));
    EXPECT_EQ(to_float64(hit, reference).t, double{third});
}

struct Comparison {
    std::size_t rays = 0, hits = 0, uncertain = 0;
    std::size_t wrong = 0;  // float64 misses, hits or names a triangle where exact arithmetic does not
    std::size_t wrong_and_certain = 0;
    double worst_t = 0;  // relative error of float64's t, where both name the same
};

void compare(const ReferenceScene& reference, std::span<const Ray> rays, Comparison& sum) {
    const Reference exact_reference(reference);
    for (const Ray& ray : rays) {
        const ReferenceHit hit = reference.closest_hit(ray);
        const auto exact = exact_reference.closest_hit(ray);
        const bool names_it = hit.hit == exact.has_value() &&
                              (!hit.hit || exact->triangles.front() == TriangleId{hit.instance, hit.primitive});
        const bool certain = is_certain(reference, ray, hit);
        ++sum.rays;
        sum.hits += exact.has_value();
        sum.uncertain += !certain;
        sum.wrong += !names_it;
        sum.wrong_and_certain += !names_it && certain;
        if (certain && exact) {
            EXPECT_EQ(exact->triangles.size(), 1u);
        }
        if (names_it && exact) {
            const Rational error = abs(Rational(hit.t) - exact->crossing.t) / exact->crossing.t;
            sum.worst_t = std::max(sum.worst_t, error.get_d());
        }
    }
}

void report(const char* what, const Comparison& sum) {
    std::printf(
        "%s: %zu rays, %zu hits; float64 is certain of %zu, wrong on %zu, wrong though certain on %zu; relative "
        "error of t up to %.2g\n",
        what, sum.rays, sum.hits, sum.rays - sum.uncertain, sum.wrong, sum.wrong_and_certain, sum.worst_t);
    EXPECT_GT(sum.hits, sum.rays / 100) << what;
    EXPECT_EQ(sum.wrong_and_certain, 0u) << what;
}

vec3 lattice_point(std::mt19937& random, int extent = 2) {
    const auto one = [&] { return static_cast<float>(static_cast<int>(random() % (2 * extent + 1)) - extent); };
    const float x = one(), y = one();
    return {x, y, one()};
}

Soup lattice_soup(std::mt19937& random, int count, int extent = 2) {
    Soup soup;
    for (int i = 0; i < count; ++i)
        soup.add(lattice_point(random, extent), lattice_point(random, extent), lattice_point(random, extent));
    return soup;
}

TEST(Float64Reference, IsRightWhereItIsCertainOnALatticeFullOfTies) {
    std::mt19937 random(11);
    Comparison sum;
    for (int round = 0; round < 60; ++round) {
        const ReferenceScene reference = reference_of(lattice_soup(random, 12));
        std::vector<Ray> rays;
        for (int i = 0; i < 200; ++i)
            rays.push_back(make_ray(lattice_point(random), lattice_point(random), static_cast<float>(random() % 2),
                                    random() % 3 ? INFINITY : 2.0f));
        compare(reference, rays, sum);
    }
    report("lattice", sum);
    EXPECT_GT(sum.uncertain, sum.rays / 10);  // the ties
}

TEST(Float64Reference, IsRightWhereItIsCertainOnSliversAndMixedMagnitudes) {
    std::mt19937 random(12);
    const auto scaled = [&] {
        return uniform3(random, -1, 1) * std::ldexp(1.0f, static_cast<int>(random() % 60) - 30);
    };
    Comparison slivers, mixed;
    for (int round = 0; round < 40; ++round) {
        Soup thin, sizes;
        for (int i = 0; i < 12; ++i) {
            const vec3 a = uniform3(random, -1, 1), b = uniform3(random, -1, 1);
            const float w = uniform(random, 0, 1);
            thin.add(a, b, a * (1 - w) + b * w + uniform3(random, -1, 1) * std::ldexp(1.0f, -10 - int(random() % 16)));
            sizes.add(scaled(), scaled(), scaled());
        }
        const ReferenceScene thin_reference = reference_of(thin), sizes_reference = reference_of(sizes);
        compare(thin_reference, vertex_aimed_rays(thin_reference, 60, static_cast<unsigned>(round)), slivers);
        compare(thin_reference, edge_aimed_rays(thin_reference, 60, static_cast<unsigned>(round)), slivers);
        compare(sizes_reference, edge_aimed_rays(sizes_reference, 60, static_cast<unsigned>(round)), mixed);
        compare(sizes_reference, vertex_aimed_rays(sizes_reference, 60, static_cast<unsigned>(round)), mixed);
    }
    report("slivers", slivers);
    report("mixed magnitudes", mixed);
}

TEST(Float64Reference, IsRightWhereItIsCertainUnderIllConditionedTransforms) {
    std::mt19937 random(13);
    Comparison sum;
    const Soup soup = sphere(2);
    for (int round = 0; round < 30; ++round) {
        std::vector<ReferenceInstance> instances;
        for (int i = 0; i < 4; ++i) {
            const auto squeeze = [&] { return std::ldexp(1.0f, static_cast<int>(random() % 20) - 10); };
            const float x = squeeze(), y = squeeze();
            instances.push_back({0, Transform::translation(uniform3(random, -1, 1)) *
                                        rotation(uniform(random, 0, 6), uniform(random, 0, 6)) *
                                        Transform::scaling({x, y, squeeze()}) *
                                        rotation(uniform(random, 0, 6), uniform(random, 0, 6))});
        }
        const ReferenceScene reference = reference_of({soup}, instances);
        compare(reference, vertex_aimed_rays(reference, 50, static_cast<unsigned>(round)), sum);
        compare(reference, edge_aimed_rays(reference, 50, static_cast<unsigned>(round)), sum);
    }
    report("squeezed instances", sum);
}

// The edge at x = 1 of an instance n times as large, hit by a ray at x = n: in float64 n times 1 / n is less than 1 for
// some n, so that the ray would pass the triangle's box.
TEST(Reference, FindsWhatRoundingPutsOutsideOfItsBox) {
    Soup soup;
    soup.add({1, 0, 1}, {2, 0, 1}, {1, 1, 1});
    int outside = 0;
    for (int n = 1; n < 200; ++n) {
        const float scale = static_cast<float>(n);
        const ReferenceScene reference = reference_of(soup, Transform::scaling({scale, scale, 1}));
        outside += reference.placement(0).vector_to_object(dvec3(scale, 0, 0)).x < 1;
        const auto hit = Reference(reference).closest_hit(make_ray({scale, scale / 2, 0}, {0, 0, 1}));
        ASSERT_TRUE(hit) << n;
        EXPECT_EQ(hit->crossing.incidence, Incidence::edge);
    }
    EXPECT_GT(outside, 0);
}

TEST(Reference, TheHierarchyLosesNothing) {
    using Clock = std::chrono::steady_clock;
    std::mt19937 random(14);
    std::size_t tests = 0;
    Clock::duration spent{};
    for (int round = 0; round < 8; ++round) {
        const Soup soup = lattice_soup(random, 30, 3);
        const Transform squeezed = rotation(0.3f, 1) * Transform::scaling({1, 0.01f, 3});
        const ReferenceScene reference = reference_of({soup}, {{0, Transform{}}, {0, squeezed}});
        const Reference exact_reference(reference);
        for (int i = 0; i < 100; ++i) {
            const Ray ray = make_ray(lattice_point(random, 3), lattice_point(random, 3));
            const auto fast = exact_reference.closest_hit(ray);
            const Clock::time_point start = Clock::now();
            const auto slow = exact_reference.closest_hit_brute_force(ray);
            spent += Clock::now() - start;
            tests += reference.geometry(0).active().size() + reference.geometry(1).active().size();
            ASSERT_EQ(fast.has_value(), slow.has_value());
            if (!fast) continue;
            EXPECT_EQ(fast->crossing.t, slow->crossing.t);
            EXPECT_EQ(fast->triangles, slow->triangles);
            const auto [instance, primitive] = fast->triangles.front();
            const auto first = crossing(object_line(ray, reference.placement(instance)),
                                        reference.geometry(instance).find(primitive)->vertices64());
            EXPECT_EQ(fast->crossing.u, first->u);
            EXPECT_EQ(fast->crossing.v, first->v);
        }
    }
    std::printf("%.0f ns for a ray and a triangle, half of them under a rotation\n",
                std::chrono::duration<double, std::nano>(spent).count() / static_cast<double>(tests));
}

TEST(ReferenceOf, TheArbiterDecidesWhatFloat64Cannot) {
    std::mt19937 random(15);
    std::size_t corrected = 0, asked = 0;
    for (int round = 0; round < 20; ++round) {
        const ReferenceScene reference = reference_of(lattice_soup(random, 12));
        const Reference exact_reference(reference);
        const Arbiter arbiter = [&](const Ray& ray) {
            ++asked;
            return to_float64(exact_reference.closest_hit(ray), reference);
        };
        for (int i = 0; i < 200; ++i) {
            const Ray ray = make_ray(lattice_point(random), lattice_point(random));
            const ReferenceHit exact = to_float64(exact_reference.closest_hit(ray), reference);
            const ReferenceHit found = reference_hit(reference, ray, arbiter);
            ASSERT_EQ(found.hit, exact.hit);
            ASSERT_EQ(found.primitive, exact.primitive);
            corrected += reference.closest_hit(ray).primitive != exact.primitive;
        }
    }
    EXPECT_GT(corrected, 0u);
    EXPECT_LT(asked, 20u * 200);  // not where float64 is certain
}

using glm::dmat3;

struct Draws {
    std::mt19937 engine;

    double between(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(engine); }
    dvec3 in_box() {
        const double x = between(-1, 1), y = between(-1, 1);
        return {x, y, between(-1, 1)};
    }
    dmat3 rotation() {
        std::normal_distribution<double> normal;
        const double w = normal(engine), x = normal(engine), y = normal(engine);
        return glm::mat3_cast(normalize(glm::dquat(w, x, y, normal(engine))));
    }
};

// One instance of a geometry within [-1, 1]^3, a ray that passes close to one of its edges, and that edge.
struct Sample {
    Transform transform;
    Ray ray;
    vec3 a, b;
};

// Makes a sample that is stretched by 2^-stretch to 2^stretch along axes of its own, moved by `place` and seen from
// `distance`.
Sample sample(Draws& draws, double stretch, double place, double distance) {
    const auto scale = [&] { return std::exp2(draws.between(-stretch, stretch)); };
    dmat3 stretched(scale());
    stretched[1][1] = scale();
    stretched[2][2] = scale();
    const dmat3 linear = transpose(draws.rotation() * stretched * draws.rotation());
    const dvec3 offset = place * draws.in_box();
    Sample made;
    for (int row = 0; row < 3; ++row)
        made.transform.rows[static_cast<std::size_t>(row)] = vec4(dvec4(linear[row], offset[row]));
    made.a = vec3(draws.in_box());
    made.b = vec3(draws.in_box());
    const double along = draws.between(0, 1), aside = std::exp2(draws.between(-30, -6));
    const dvec3 point = dvec3(made.a) * along + dvec3(made.b) * (1 - along) + aside * draws.in_box();
    const dvec3 target = point * linear + offset;
    const vec3 origin(target + distance * draws.in_box());
    made.ray = {origin, 0, vec3(target - dvec3(origin)), INFINITY};
    return made;
}

RefineInstance instance_of(const Transform& transform) {
    const Rows rows{transform.rows[0], transform.rows[1], transform.rows[2]};
    RefineInstance instance{};
    instance.placed.object_to_world = rows;
    instance.world_to_object = inverse_double(rows);
    instance.residual = static_cast<float>(residual_of(instance.world_to_object, rows) * (1 + 0x1p-20));
    instance.extent = 1;
    return instance;
}

// Returns the exact sign that certain_side() is certain of, for rays with the dominant axis of `direction`.
int exact_side_of(const Sample& sample, vec3 direction) {
    const Line line = object_line(sample.ray, Placement64(sample.transform, "sample"));
    const Vector normal = cross(vector_of(sample.a) - line.origin, vector_of(sample.b) - line.origin);
    const int axis = static_cast<int>(dominant_axis(direction));
    return sgn(dot(normal, line.direction)) * sgn(line.direction[axis]);
}

struct FilterResults {
    std::size_t n = 0, wrong = 0, open = 0;
};

// Returns the results for samples at each stretch and place, with the bound times `factor`.
FilterResults filter_results(float factor) {
    Draws draws{std::mt19937(3)};
    FilterResults found;
    for (const double stretch : {0.0, 3.0, 8.0, 14.0})
        for (const double place : {0.0, 10.0, 1e4, 1e8})
            for (const double distance : {3.0, 1e4})
                for (int i = 0; i < 400; ++i) {
                    const Sample drawn = sample(draws, stretch, place, distance);
                    const CertifiedRay mapped = certified_ray(instance_of(drawn.transform), drawn.ray, false);
                    const RaySpace space = make_ray_space(mapped.origin, mapped.direction, 0);
                    const int side =
                        certain_side(sheared(drawn.a, space), sheared(drawn.b, space), factor * mapped.error);
                    ++found.n;
                    if (side == 0)
                        ++found.open;
                    else if (side != exact_side_of(drawn, mapped.direction))
                        ++found.wrong;
                }
    return found;
}

TEST(CertifiedFilter, IsCertainOfWhatIsSo) {
    const FilterResults as_it_is = filter_results(1), too_small = filter_results(0x1p-5f);
    EXPECT_EQ(as_it_is.wrong, 0u);
    EXPECT_GT(too_small.wrong, 0u) << "or the samples would not notice a bound that is too small";
    std::printf("%zu points near edges: %zu left open, with the bound / 32 %zu and %zu wrong\n", as_it_is.n,
                as_it_is.open, too_small.open, too_small.wrong);
    EXPECT_LT(as_it_is.open, as_it_is.n * 7 / 10) << "what is left open costs float64";
}

}  // namespace
}  // namespace twinray::exact
