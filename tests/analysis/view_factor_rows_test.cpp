// Rows of view factors: made reciprocal and closed, kept in a file, and the light between their faces.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>

#include <twinray/analysis.h>

#include "engine/core/error.h"
#include "tests/scene/temp_dir.h"

namespace twinray {
namespace {

constexpr std::uint64_t rays = 10'000;
constexpr double parallel = 0.199824895698387383, perpendicular = 0.200043776075403154;
constexpr float known_parallel = static_cast<float>(parallel);

Estimate fraction(double value) { return {value, {value, value}}; }

// Random symmetric flows, the areas that the flows and the open part add up to, and what rays would count of them.
struct Made {
    std::vector<ViewFactorRow> exact, counted;
    std::vector<double> areas;
};
Made made_matrix(uint n, bool is_closed, std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(0.1, 1);
    std::vector<std::vector<double>> flows(n, std::vector<double>(n));
    for (uint i = 0; i < n; ++i)
        for (uint j = 0; j < i; ++j) flows[i][j] = flows[j][i] = uniform(random);
    Made made;
    for (uint i = 0; i < n; ++i) {
        const double open = is_closed ? 0 : uniform(random);
        double area = open;
        for (uint j = 0; j < n; ++j) area += flows[i][j];
        made.areas.push_back(area);
        ViewFactorRow exact{i, rays, {}, rays, fraction(open / area), fraction(0)}, counted = exact;
        std::vector<double> shares = {open / area};
        for (uint j = 0; j < n; ++j) shares.push_back(flows[i][j] / area);
        std::discrete_distribution<uint> targets(shares.begin(), shares.end());
        std::vector<std::uint64_t> hits(n + 1);
        for (std::uint64_t ray = 0; ray < rays; ++ray) ++hits[targets(random)];
        counted.open = fraction(static_cast<double>(hits[0]) / rays);
        for (uint j = 0; j < n; ++j) {
            const auto found = static_cast<float>(static_cast<double>(hits[j + 1]) / rays);
            if (i != j) exact.factors.push_back({j, static_cast<float>(shares[j + 1]), 0, 1});
            if (i != j) counted.factors.push_back({j, found, found - 0.01f, found + 0.01f});
        }
        made.exact.push_back(exact);
        made.counted.push_back(counted);
    }
    return made;
}

double squared_error(const std::vector<ViewFactorRow>& rows, const std::vector<ViewFactorRow>& exact) {
    double sum = 0;
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (std::size_t k = 0; k < rows[i].factors.size(); ++k)
            sum += std::pow(rows[i].factors[k].value - exact[i].factors[k].value, 2);
    return sum;
}

TEST(Reciprocity, ResidualsOfAnExactMatrixAreRounding) {
    std::mt19937 random(1);
    const Made made = made_matrix(10, false, random);
    const ViewFactorResiduals residuals = residuals_of(made.exact, made.areas);
    EXPECT_LT(residuals.reciprocity, 1e-7);
    EXPECT_LT(residuals.closure, 1e-6);
}

TEST(Reciprocity, ResidualsAreThoseOfTheFormula) {
    std::vector<ViewFactorRow> rows(2);
    rows[0] = {0, rays, {{1, 0.5f, 0, 1}}, rays, fraction(0.25), fraction(0)};
    rows[1] = {1, rays, {{0, 0.2f, 0, 1}}, rays, fraction(0.75), fraction(0)};
    const ViewFactorResiduals residuals = residuals_of(rows, {1, 2});
    EXPECT_NEAR(residuals.reciprocity, 0.1 / 2, 1e-7);  // |1 * 0.5 - 2 * 0.2| over an area of 2
    EXPECT_NEAR(residuals.closure, 0.25, 1e-7);
    EXPECT_GT(residuals.reciprocity_sigma, 5);
}

TEST(Projection, FulfilsBothAndComesNearerToTheTruth) {
    std::mt19937 random(2);
    double before = 0, after = 0;
    for (int trial = 0; trial < 20; ++trial) {
        const Made made = made_matrix(12, trial % 2 == 0, random);
        std::vector<ViewFactorRow> projected = made.counted;
        EXPECT_GT(residuals_of(projected, made.areas).reciprocity, 1e-4);
        project(projected, made.areas);
        const ViewFactorResiduals residuals = residuals_of(projected, made.areas);
        EXPECT_LT(residuals.reciprocity, 1e-6);
        EXPECT_LT(residuals.closure, 1e-6);
        before += squared_error(made.counted, made.exact);
        after += squared_error(projected, made.exact);
        for (const ViewFactorRow& row : projected)
            for (const ViewFactor& factor : row.factors) {
                EXPECT_GE(factor.value, 0);
                EXPECT_LE(factor.low, factor.value);
                EXPECT_GE(factor.high, factor.value);
                EXPECT_LE(factor.high, 1);
            }
    }
    EXPECT_LT(after, 0.6 * before) << "two directions tell more than one, and sums more still";
}

TEST(Projection, LeavesWhatFulfilsBothAlready) {
    std::vector<ViewFactorRow> rows;
    for (uint i = 0; i < 6; ++i) {
        ViewFactorRow row{i, rays, {}, rays, fraction(0), fraction(0)};
        for (uint j = 0; j < 6; ++j)
            if (j != i) row.factors.push_back({j, static_cast<float>(j == (i ^ 1) ? parallel : perpendicular), 0, 1});
        rows.push_back(row);
    }
    const std::vector<ViewFactorRow> exact = rows;
    project(rows, std::vector<double>(6, 1));
    EXPECT_LT(squared_error(rows, exact), 1e-13);
}

// A target that all rays of a row met is certain, however small a part of the other it is.
TEST(Projection, KeepsWhatAllRaysOfARowMet) {
    const std::vector<double> areas = {5, 1, 0x1p-40};
    std::vector<ViewFactorRow> rows(3);
    rows[0] = {0, rays, {{0, 0.8005f, 0, 1}, {1, 0.1995f, 0, 1}}, rays, fraction(0), fraction(0)};
    for (uint i : {1u, 2u}) rows[i] = {i, rays, {{0, 1.0f, 0, 1}}, rays, fraction(0), fraction(0)};
    project(rows, areas);
    EXPECT_LE(residuals_of(rows, areas).closure, 0x1p-24);
    for (uint i : {1u, 2u}) EXPECT_EQ(rows[i].factors[0].value, 1) << i;
    EXPECT_FLOAT_EQ(rows[0].factors[1].value, 0.2f);
    EXPECT_FLOAT_EQ(rows[0].factors[2].value, 0x1p-40f / 5);
}

// A small closed room beside a large one: the solver must not be content when the large one's rows add up.
TEST(Projection, ClosesSmallFacesAsWellAsLargeOnes) {
    std::mt19937 random(3);
    Made made = made_matrix(12, false, random);
    const Made large = made_matrix(3, false, random);
    for (const ViewFactorRow& row : large.counted) {
        made.counted.push_back(row);
        made.counted.back().group += 12;
        for (ViewFactor& factor : made.counted.back().factors) factor.target += 12;
    }
    for (double& area : made.areas) area *= 0x1p-60;
    made.areas.insert(made.areas.end(), large.areas.begin(), large.areas.end());
    project(made.counted, made.areas);
    EXPECT_LE(residuals_of(made.counted, made.areas).closure, 0x1p-21);
}

TEST(Projection, CompletesWhatOneDirectionSawAndKeepsRowsWithoutRays) {
    std::vector<ViewFactorRow> rows(3);
    rows[0] = {0, rays, {{1, 0.001f, 0, 0.01f}}, 10, fraction(0.999), fraction(0)};
    rows[1] = {1, rays, {}, 0, fraction(1), fraction(0)};
    rows[2] = {2, 0, {}, 0, fraction(0), fraction(0)};
    project(rows, {1, 1, 0});
    ASSERT_EQ(rows[1].factors.size(), 1u);
    EXPECT_EQ(rows[1].factors[0].target, 0u);
    EXPECT_FLOAT_EQ(rows[1].factors[0].value, rows[0].factors[0].value);
    EXPECT_NEAR(rows[0].factors[0].value, 0.0005, 0.0001);
    EXPECT_TRUE(rows[2].factors.empty());
}

class RowFileTest : public ::testing::Test {
  protected:
    static std::vector<ViewFactorRow> some_rows(uint count) {
        std::vector<ViewFactorRow> rows;
        for (uint i = 0; i < count; ++i) {
            ViewFactorRow row{i, 100 + i, {}, 7, {0.5, {0.25, 0.75}}, {0.125, {0, 1}}};
            for (uint j = 0; j < i; ++j) row.factors.push_back({j, 0.5f, 0.25f, 1.0f / static_cast<float>(j + 1)});
            rows.push_back(row);
        }
        return rows;
    }
    void write(uint count) {
        RowFile file(file_, "options");
        file.create();
        file.append(some_rows(count));
    }
    std::size_t loaded() { return RowFile(file_, "options").load().size(); }

    test::TempDir folder_;
    std::filesystem::path file_ = folder_ / "rows";
};

TEST_F(RowFileTest, GivesBackWhatWasAppended) {
    write(5);
    const std::vector<ViewFactorRow> rows = RowFile(file_, "options").load(), expected = some_rows(5);
    ASSERT_EQ(rows.size(), 5u);
    for (uint i = 0; i < 5; ++i) {
        EXPECT_EQ(rows[i].group, i);
        EXPECT_EQ(rows[i].rays, expected[i].rays);
        EXPECT_EQ(rows[i].open.interval_95, expected[i].open.interval_95);
        EXPECT_EQ(rows[i].back.value, expected[i].back.value);
        ASSERT_EQ(rows[i].factors.size(), i);
        for (uint j = 0; j < i; ++j) EXPECT_EQ(rows[i].factors[j].high, expected[i].factors[j].high);
    }
}

TEST_F(RowFileTest, ARowThatWasCutShortIsLeftOutAndWrittenOver) {
    write(5);
    const std::uint64_t whole = std::filesystem::file_size(file_);
    for (const std::uint64_t missing : {1, 30, 80}) {
        write(5);
        std::filesystem::resize_file(file_, whole - missing);
        RowFile file(file_, "options");
        ASSERT_EQ(file.load().size(), 4u) << missing << " bytes are missing";
        const std::vector<ViewFactorRow> all = some_rows(5);
        file.append(std::span(all).last(1));
        EXPECT_EQ(std::filesystem::file_size(file_), whole);
        EXPECT_EQ(loaded(), 5u);
    }
}

TEST_F(RowFileTest, DamageEndsWhatIsRead) {
    write(5);
    std::fstream stream(file_, std::ios::binary | std::ios::in | std::ios::out);
    stream.seekp(-60, std::ios::end);
    stream.put('?');
    stream.close();
    EXPECT_EQ(loaded(), 4u);
}

TEST_F(RowFileTest, APartBeginsWithItsFirstRow) {
    const std::vector<ViewFactorRow> rows = some_rows(5);
    RowFile part(file_, "options", 2);
    part.create();
    part.append(std::span(rows).subspan(2));
    const std::vector<ViewFactorRow> found = RowFile(file_, "options", 2).load();
    ASSERT_EQ(found.size(), 3u);
    EXPECT_EQ(found.front().group, 2u);
    EXPECT_EQ(loaded(), 0u);
}

TEST_F(RowFileTest, OtherOptionsAreRefused) {
    write(2);
    EXPECT_THROW(RowFile(file_, "other options").load(), Error);
    EXPECT_EQ(loaded(), 2u) << "and nothing is lost";
}

TEST_F(RowFileTest, WithoutAFileItBegins) {
    EXPECT_EQ(loaded(), 0u);
    EXPECT_TRUE(std::filesystem::exists(file_));
}

// Returns the factors of a cube, with the flow of row 0 known exactly, in float32; `half` is half of every interval.
std::vector<ViewFactorRow> cube_factors(float half = 0) {
    std::vector<ViewFactorRow> rows;
    for (uint i = 0; i < 6; ++i) {
        ViewFactorRow row{i, 1000, {}, 1000, {}, {}};
        for (uint j = 0; j < 6; ++j) {
            const float value = j == (i ^ 1) ? known_parallel : (1 - known_parallel) / 4;
            if (j != i) row.factors.push_back({j, value, value - half, value + half});
        }
        rows.push_back(row);
    }
    return rows;
}

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
        const Radiosity found = solve_radiosity(cube_factors(), emission, std::vector<double>(6, rho));
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
    const CubeLight half = cube_light(0.5, parallel), most = cube_light(0.999, parallel);
    EXPECT_NEAR(half.emitter, 1.090909098107695, 1e-12);
    EXPECT_NEAR(half.opposite, 0.1817458261077885, 1e-12);
    EXPECT_NEAR(half.side, 0.181836268946129, 1e-12);
    EXPECT_NEAR(most.emitter, 167.3612268932902, 1e-9);
}

TEST(Radiosity, ForwardErrorIsTheAmplifiedResidual) {
    const std::vector<double> emission = {1, 0, 0.5, 0, 0, 0.25}, rho(6, 0.999);
    const Radiosity exact = solve_radiosity(cube_factors(), emission, rho);
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
    const Radiosity found = solve_radiosity(cube_factors(half), emission, rho);
    int inside = 0, count = 0;
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<ViewFactorRow> rows = cube_factors(half);
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
    const Radiosity one = solve_radiosity(cube_factors(), emission, rho);
    for (const double unit : {0x1p-100, 0x1p-30, 0x1p30, 0x1p100}) {
        std::vector<double> scaled = emission;
        for (double& value : scaled) value *= unit;
        const Radiosity found = solve_radiosity(cube_factors(), scaled, rho);
        for (std::size_t i = 0; i < 6; ++i)
            EXPECT_NEAR(found.values[i] / unit, one.values[i], 1e-13 * one.values[i]) << unit;
        EXPECT_LT(found.relative_residual, 1e-14) << unit;
    }
}

TEST(Radiosity, WhatHasNoSolutionIsAnError) {
    const auto solve = [](std::size_t n, double emission, double rho) {
        return solve_radiosity(cube_factors(), std::vector<double>(n, emission), std::vector<double>(6, rho));
    };
    EXPECT_THROW(solve(6, 1, 1), Error);
    EXPECT_THROW(solve(5, 1, 0.5), Error);
    EXPECT_THROW(solve(6, 1, 1.5), Error);
    EXPECT_THROW(solve(6, NAN, 0.5), Error);
}

TEST(Radiosity, NothingEmittedAndNothingAtAll) {
    const Radiosity dark = solve_radiosity(cube_factors(), std::vector<double>(6), std::vector<double>(6, 1.0));
    EXPECT_EQ(dark.values, std::vector<double>(6));
    EXPECT_TRUE(solve_radiosity({}, {}, {}).values.empty());
}

}  // namespace
}  // namespace twinray
