// SPDX-License-Identifier: MIT
// The bound by which level certified leaves triangles out, compared with rational arithmetic: the filter is right
// whenever it is certain.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <random>

#include "validation/exact/exact_reference.h"
#include "swtlas/structures.h"

namespace twinray::exact {
namespace {

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
