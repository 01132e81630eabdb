// SPDX-License-Identifier: MIT
#include <twinray/analysis.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "engine/core/error.h"

namespace twinray {
namespace {

// Returns the factors of a cube, with the flow of row 0 known exactly, in float32; `half` is half of every interval.
std::vector<ViewFactorRow> cube_factors(float parallel, float half = 0) {
    std::vector<ViewFactorRow> rows;
    const float perpendicular = (1 - parallel) / 4;
    for (uint i = 0; i < 6; ++i) {
        ViewFactorRow row{i, 1000, {}, 1000, {}, {}};
        for (uint j = 0; j < 6; ++j) {
            const float value = j == (i ^ 1) ? parallel : perpendicular;
            if (j != i) row.factors.push_back({j, value, value - half, value + half});
        }
        rows.push_back(row);
    }
    return rows;
}
constexpr float known_parallel = 0.199824895698387383f;

// The light of the face that radiates 1, of the one opposite and of those beside it, with factors p and s = (1 - p) /
// 4, by symmetry: the modes (1, 1, 1), (1, 1, -1/2) and (1, -1, 0) are eigenvectors of F with 1, p - 2 s and -p.
struct CubeLight {
    double emitter, opposite, side;
};
CubeLight cube_light(double rho, double p) {
    const double s = (1 - p) / 4, all = 1 / (1 - rho) / 6, axis = 1 / (1 - rho * (p - 2 * s)) / 3,
                 odd = 1 / (1 + rho * p) / 2;
    return {all + axis + odd, all + axis - odd, all - axis / 2};
}

TEST(Radiosity, OfACubeIsTheClosedForm) {
    const std::vector<double> emission = {1, 0, 0, 0, 0, 0};
    for (const double rho : {0.0, 0.5, 0.9, 0.99, 0.999, 0.9999, 0.999999}) {
        const Radiosity found = solve_radiosity(cube_factors(known_parallel), emission, std::vector<double>(6, rho));
        const double slack = 1e-6;
        const CubeLight known = cube_light(rho, static_cast<double>(known_parallel));
        const double of = known.emitter;
        EXPECT_NEAR(found.values[0], known.emitter, slack * of) << rho;
        EXPECT_NEAR(found.values[1], known.opposite, slack * of) << rho;
        for (int side = 2; side < 6; ++side) EXPECT_NEAR(found.values[side], known.side, slack * of) << rho;
        EXPECT_LT(found.relative_residual, 1e-13) << rho;
        EXPECT_LT(found.forward_error, 1e-7) << rho;
        EXPECT_NEAR(found.amplification * (1 - rho), 1, 0.2) << rho;
    }
}

TEST(Radiosity, ReferenceValues) {
    const CubeLight half = cube_light(0.5, 0.199824895698387383), most = cube_light(0.999, 0.199824895698387383);
    EXPECT_NEAR(half.emitter, 1.090909098107695, 1e-12);
    EXPECT_NEAR(half.opposite, 0.1817458261077885, 1e-12);
    EXPECT_NEAR(half.side, 0.181836268946129, 1e-12);
    EXPECT_NEAR(most.emitter, 167.3612268932902, 1e-9);
}

TEST(Radiosity, ForwardErrorIsTheAmplifiedResidual) {
    const std::vector<double> emission = {1, 0, 0.5, 0, 0, 0.25}, rho(6, 0.999);
    const Radiosity exact = solve_radiosity(cube_factors(known_parallel), emission, rho);
    double residual = 0;
    for (std::size_t i = 0; i < 6; ++i)
        residual = std::max(residual, std::abs(emission[i] + rho[i] * exact.incident[i] - exact.values[i]));
    EXPECT_LE(residual, 1e-13 * exact.values[0]) << "B and F B fit together";
    EXPECT_NEAR(exact.amplification, 1000, 1e-6);
    EXPECT_EQ(exact.forward_error, exact.amplification * exact.relative_residual);
}

TEST(Radiosity, SamplingBoundsWhatTheErrorOfFactorsDoes) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    constexpr float half = 0.002f;
    const std::vector<double> emission = {1, 0, 0, 0, 0, 0}, rho(6, 0.9);
    const Radiosity found = solve_radiosity(cube_factors(known_parallel, half), emission, rho);
    int inside = 0, count = 0;
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<ViewFactorRow> rows = cube_factors(known_parallel, half);
        for (ViewFactorRow& row : rows)
            for (ViewFactor& factor : row.factors) factor.value += static_cast<float>(normal(random) * half / 1.96);
        for (ViewFactorRow& row : rows) {
            double sum = 0;
            for (const ViewFactor& factor : row.factors) sum += static_cast<double>(factor.value);
            row.open.value = 1 - sum;
        }
        const Radiosity moved = solve_radiosity(rows, emission, rho);
        for (std::size_t i = 0; i < 6; ++i, ++count)
            inside += std::abs(moved.values[i] - found.values[i]) <= found.sampling[i];
    }
    EXPECT_GE(inside, 0.95 * count);
    EXPECT_LT(found.sampling[0], 0.2 * found.values[0]) << "and is not much too wide";
}

TEST(Radiosity, EmissionInAnyUnitGivesTheSameLight) {
    const std::vector<double> emission = {1, 0, 0.5, 0, 0, 0.25}, rho(6, 0.9);
    const Radiosity one = solve_radiosity(cube_factors(known_parallel), emission, rho);
    for (const double unit : {0x1p-100, 0x1p-30, 0x1p30, 0x1p100}) {
        std::vector<double> scaled = emission;
        for (double& value : scaled) value *= unit;
        const Radiosity found = solve_radiosity(cube_factors(known_parallel), scaled, rho);
        for (std::size_t i = 0; i < 6; ++i)
            EXPECT_NEAR(found.values[i] / unit, one.values[i], 1e-13 * one.values[i]) << unit;
        EXPECT_LT(found.relative_residual, 1e-14) << unit;
    }
}

TEST(Radiosity, WhatHasNoSolutionIsAnError) {
    EXPECT_THROW(
        solve_radiosity(cube_factors(known_parallel), std::vector<double>(6, 1.0), std::vector<double>(6, 1.0)), Error);
    EXPECT_THROW(
        solve_radiosity(cube_factors(known_parallel), std::vector<double>(5, 1.0), std::vector<double>(6, 0.5)), Error);
    EXPECT_THROW(
        solve_radiosity(cube_factors(known_parallel), std::vector<double>(6, 1.0), std::vector<double>(6, 1.5)), Error);
    EXPECT_THROW(
        solve_radiosity(cube_factors(known_parallel), std::vector<double>(6, NAN), std::vector<double>(6, 0.5)), Error);
}

TEST(Radiosity, NothingEmittedAndNothingAtAll) {
    const Radiosity dark =
        solve_radiosity(cube_factors(known_parallel), std::vector<double>(6), std::vector<double>(6, 1.0));
    EXPECT_EQ(dark.values, std::vector<double>(6));
    EXPECT_TRUE(solve_radiosity({}, {}, {}).values.empty());
}

}  // namespace
}  // namespace twinray
