#include <twinray/geometry.h>

#include <gtest/gtest.h>

#include "engine/core/error.h"
#include "swtlas/structures.h"
#include "tests/validation/reference/meshes.h"

namespace twinray {
namespace {

Transform random_transform(std::mt19937& random, float scale) {
    std::uniform_real_distribution<float> unit(-scale, scale);
    Transform transform;
    for (vec4& row : transform.rows) row = vec4(unit(random), unit(random), unit(random), unit(random));
    return transform;
}

TEST(Transform, OfAGlmMatrixHasItsRows) {
    glm::mat4 matrix(1);
    matrix[3] = vec4(5, 6, 7, 1);  // GLM is column-major: the translation
    EXPECT_EQ(Transform::of(matrix), Transform::translation({5, 6, 7}));
    matrix[0][3] = 1;
    EXPECT_THROW(Transform::of(matrix), Error);
}

TEST(Transform, ProductsApplyTheRightOneFirst) {
    const Transform t = Transform::translation({1, 0, 0}) * Transform::scaling({2, 3, 4});
    EXPECT_EQ(transform_point(t, {1, 1, 1}), vec3(3, 3, 4));
    EXPECT_EQ(transform_vector(t, {1, 1, 1}), vec3(2, 3, 4));
}

TEST(Transform, InverseRefusesSingularAndNonFiniteOnes) {
    EXPECT_THROW(inverse(Transform::scaling({1, 0, 1}), "x"), Error);
    EXPECT_THROW(inverse(Transform::translation({INFINITY, 0, 0}), "x"), Error);
}

// The GPU's float32 inverse must be as good as float64 rounded, but for a few roundings.
TEST(Transform, TheShadersInverseIsAccurateToARoundingForWellConditionedMaps) {
    std::mt19937 random(4);
    for (int i = 0; i < 2000; ++i) {
        const float scale = std::ldexp(1.0f, static_cast<int>(random() % 60) - 30);
        const Transform m = random_transform(random, scale);
        const Transform exact = inverse(m, "test");
        const Rows rows = inverse_of({m.rows[0], m.rows[1], m.rows[2]});
        const vec4 computed[] = {rows.r0, rows.r1, rows.r2};
        double norm_m = 0, norm_w = 0;
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) {
                norm_m = std::max(norm_m, std::abs(double{m.rows[static_cast<std::size_t>(r)][c]}));
                norm_w = std::max(norm_w, std::abs(double{exact.rows[static_cast<std::size_t>(r)][c]}));
            }
        if (norm_m * norm_w > 1000) continue;  // nearly singular: the residual is checked where it matters
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(computed[r][c], exact.rows[static_cast<std::size_t>(r)][c], norm_w * 0x1p-22)
                    << "transform " << i;
    }
}

// Scales along axes, beside a rotation, have condition numbers up to 10^72, which say nothing of the maps. If the
// scales come after the rotation, an entry of it that is 0 leaves them apart, and low parts of products vanish.
TEST(Transform, TheShadersInverseHoldsForScalesFarApart) {
    std::mt19937 random(5);
    int refused = 0;
    for (const double most : {14.0, 20.0, 36.0})
        for (int i = 0; i < 1000; ++i) {
            const auto [scaling, both] = test::scaled_and_turned(random, most);
            for (const bool scaled_first : {true, false}) {
                const Transform& m = both[scaled_first ? 0 : 1];
                if (!fault_of(m).empty()) {
                    EXPECT_FALSE(scaled_first && most <= 20) << "scaled by 10^" << most;
                    ++refused;
                    continue;
                }
                const Transform exact = inverse(m, "test");
                const Rows rows = inverse_of({m.rows[0], m.rows[1], m.rows[2]});
                const vec4 computed[] = {rows.r0, rows.r1, rows.r2};
                for (int r = 0; r < 3; ++r)
                    for (int c = 0; c < 3; ++c) {
                        const float size =
                            1 / scaling.rows[static_cast<std::size_t>(scaled_first ? r : c)][scaled_first ? r : c];
                        EXPECT_NEAR(computed[r][c], exact.rows[static_cast<std::size_t>(r)][c],
                                    size * (scaled_first ? 0x1p-20f : 0x1p-15f))
                            << "scaled by 10^" << most << (scaled_first ? " before" : " after") << " the rotation";
                    }
            }
        }
    EXPECT_LT(refused, 600) << "of 6000";
}

TEST(Transform, DenormalColumnsAndRowsAreRefused) {
    EXPECT_EQ(fault_of(Transform::scaling(vec3(1.2e-38f))), "");
    for (const vec3 factors : {vec3(1e-38f), vec3(1, 1e-38f, 1)})
        EXPECT_NE(fault_of(Transform::scaling(factors)).find("denormal"), std::string::npos)
            << fault_of(Transform::scaling(factors));
}

TEST(Transform, TheFloat32InverseHoldsWhereProductsCannotBeSplit) {
    for (const float place : {1e34f, 1e35f, 1e37f}) {
        const Rows rows = inverse_of({vec4(0, -1, 0, place), vec4(1, 0, 0, 0), vec4(0, 0, 1, 0)});
        EXPECT_TRUE(is_finite_map(rows)) << place;
        EXPECT_EQ(rows.r1, vec4(-1, 0, 0, place));
    }
}

TEST(WorldBound, IsNotAboveWhereOffsetsCancel) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (int i = 0; i < 100'000; ++i) {
        const vec3 a(unit(random), unit(random), unit(random));
        const vec3 b = vec3(1e6f) + 1e5f * vec3(unit(random), unit(random), unit(random));
        const double exact = dot(dvec3(a), dvec3(b));
        const auto c = static_cast<float>(unit(random) - exact);
        // Products of float32 are exact in float64, and their sum to 2^-52 of 3e6.
        ASSERT_LE(double{dot_below(a, b, c)}, exact + c + 3e6 * 0x1p-51) << i;
        ASSERT_NEAR(dot_below(a, b, c), exact + c, 1e-6);
    }
}

// Scales of 1 : 1e6 between two rotations: each entry is right to a few of its own roundings.
TEST(Transform, TheFloat32InverseHoldsForIllConditionedMaps) {
    std::mt19937 random(8);
    std::uniform_real_distribution<float> angle(-3, 3);
    const auto turned = [&](int axis) {
        const float a = angle(random);
        Transform t;
        const int i = (axis + 1) % 3, j = (axis + 2) % 3;
        t.rows[static_cast<std::size_t>(i)][i] = t.rows[static_cast<std::size_t>(j)][j] = std::cos(a);
        t.rows[static_cast<std::size_t>(i)][j] = -std::sin(a);
        t.rows[static_cast<std::size_t>(j)][i] = std::sin(a);
        return t;
    };
    for (const float scale : {1.0f, 1e-2f, 1e-4f, 1e-6f})
        for (int i = 0; i < 200; ++i) {
            const Transform m = turned(0) * turned(1) * Transform::scaling({1, scale, 1}) * turned(2) * turned(0);
            const Transform exact = inverse(m, "test");
            const Rows rows = inverse_of({m.rows[0], m.rows[1], m.rows[2]});
            const vec4 found[] = {rows.r0, rows.r1, rows.r2};
            for (std::size_t row = 0; row < 3; ++row)
                for (int column = 0; column < 3; ++column)
                    ASSERT_NEAR(found[row][column], exact.rows[row][column],
                                std::abs(exact.rows[row][column]) * 4 * std::ldexp(1.0, -24))
                        << "scale " << scale;
        }
}

}  // namespace
}  // namespace twinray
