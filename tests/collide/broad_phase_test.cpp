// Instances whose boxes overlap, against brute force over boxes that the test knows by itself.
#include <twinray/queries.h>

#include "tests/accel/accel_fixture.h"

namespace twinray {
namespace {

using test::expect_error;

const Mesh unit_cube = make_box(vec3(0), vec3(1));
// Places the cube so that its box is [p, p + size], exactly if both are representable.
Transform placed(vec3 p, float size = 1) { return Transform::translation(p) * Transform::scaling(vec3(size)); }

struct Cube {
    vec3 lo;
    float size;
    Transform transform() const { return placed(lo, size); }
};

// Returns cubes at multiples of 1/64, so that many touch and nothing rounds.
std::vector<Cube> random_cubes(std::size_t count, unsigned seed, int extent) {
    std::mt19937 random(seed);
    const auto coordinate = [&] {
        return static_cast<float>(static_cast<int>(random() % (64u * unsigned(extent)))) / 64;
    };
    std::vector<Cube> cubes;
    for (std::size_t i = 0; i < count; ++i) {
        const float x = coordinate(), y = coordinate();
        cubes.push_back({vec3(x, y, coordinate()), static_cast<float>(1 + random() % 64) / 64});
    }
    return cubes;
}

bool overlap(const Cube& a, const Cube& b) {
    for (int axis = 0; axis < 3; ++axis)
        if (a.lo[axis] + a.size < b.lo[axis] || b.lo[axis] + b.size < a.lo[axis]) return false;
    return true;
}

std::vector<Transform> transforms_of(std::span<const Cube> cubes) {
    std::vector<Transform> transforms;
    for (const Cube& one : cubes) transforms.push_back(one.transform());
    return transforms;
}

// Returns the pairs (first_a + i, first_b + j); within one set, i < j.
std::vector<InstancePair> brute_force(std::span<const Cube> a, std::span<const Cube> b, uint first_a, uint first_b) {
    std::vector<InstancePair> pairs;
    const bool is_within = a.data() == b.data();
    for (uint i = 0; i < a.size(); ++i)
        for (uint j = is_within ? i + 1 : 0; j < b.size(); ++j)
            if (overlap(a[i], b[j])) pairs.push_back({first_a + i, first_b + j});
    return pairs;
}

class BroadPhaseTest : public test::AccelTest {
  protected:
    void prepare() override {
        AccelTest::prepare();
        if (!IsSkipped()) broad_phase_ = &keep<BroadPhase>(context());
    }
    BroadPhase& broad_phase() { return *broad_phase_; }

  private:
    BroadPhase* broad_phase_ = nullptr;
};
TWINRAY_OVER_EVERY_ACCEL_AND_THE_REFERENCE(BroadPhaseTest);

TEST_P(BroadPhaseTest, FindsWhatBruteForceFindsAmongTenThousand) {
    const std::vector<Cube> cubes = random_cubes(10'000, 1, 12);
    accel().push(unit_cube, transforms_of(std::span(cubes).first(6'000)));
    accel().push(unit_cube, transforms_of(std::span(cubes).subspan(6'000)));
    const std::vector<InstancePair> expected = brute_force(cubes, cubes, 0, 0);
    ASSERT_GT(expected.size(), 10'000u);
    EXPECT_EQ(broad_phase().instance_pairs(accel()), expected);
    EXPECT_EQ(broad_phase().count(accel()), expected.size());
    EXPECT_TRUE(broad_phase().any(accel()));
    const DevicePairs pairs = broad_phase().instance_pairs_on_device(accel());
    ASSERT_EQ(pairs.count, expected.size());
    const std::uint64_t offset = pairs.second - pairs.buffer->address();
    EXPECT_EQ(download<uint>(context(), *pairs.buffer, pairs.count, offset).back(), expected.back().b);
}

TEST_P(BroadPhaseTest, FindsThemForEverySmallNumber) {
    for (std::size_t count = 0; count <= 20; ++count) {
        const std::vector<Cube> cubes = random_cubes(count, static_cast<unsigned>(count), 2);
        const AccelHandle handle = accel().push(unit_cube, transforms_of(cubes));
        EXPECT_EQ(broad_phase().instance_pairs(accel()), brute_force(cubes, cubes, 0, 0)) << count;
        EXPECT_EQ(broad_phase().any(accel()), !brute_force(cubes, cubes, 0, 0).empty()) << count;
        accel().erase(handle);
    }
}

TEST_P(BroadPhaseTest, BetweenHandlesAndWithinOne) {
    const std::vector<Cube> a = random_cubes(300, 2, 5), b = random_cubes(200, 3, 5), c = random_cubes(100, 4, 5);
    const AccelHandle ha = accel().push(unit_cube, transforms_of(a)), hb = accel().push(unit_cube, transforms_of(b)),
                      hc = accel().push(unit_cube, transforms_of(c));
    EXPECT_EQ(broad_phase().instance_pairs(accel(), ha, hc), brute_force(a, c, 0, 500));
    EXPECT_EQ(broad_phase().instance_pairs(accel(), hc, ha), brute_force(c, a, 500, 0));
    EXPECT_EQ(broad_phase().instance_pairs(accel(), hb, hb), brute_force(b, b, 300, 300));
    EXPECT_EQ(broad_phase().count(accel(), hc, hb), brute_force(c, b, 500, 300).size());
    const auto second = make_accel();
    second->push(unit_cube, transforms_of(c));
    second->push(unit_cube, transforms_of(b));
    std::vector<Cube> cb = c;
    cb.insert(cb.end(), b.begin(), b.end());
    accel().erase(hb);
    accel().erase(hc);
    EXPECT_EQ(broad_phase().instance_pairs(accel(), *second), brute_force(a, cb, 0, 0));
    EXPECT_EQ(broad_phase().count(accel(), *second), brute_force(a, cb, 0, 0).size());
    EXPECT_TRUE(broad_phase().any(accel(), *second));
}

// Instances sorted by place, not by number: x = 10, 0, 10.5.
TEST_P(BroadPhaseTest, AnyAnswersForTheHandlesThatItWasAskedAbout) {
    const AccelHandle a = accel().push(unit_cube, placed(vec3(10, 0, 0))), b = accel().push(unit_cube, placed(vec3(0))),
                      c = accel().push(unit_cube, placed(vec3(10.5f, 0, 0)));
    EXPECT_TRUE(broad_phase().any(accel(), a, c));
    EXPECT_FALSE(broad_phase().any(accel(), b, c));
    EXPECT_FALSE(broad_phase().any(accel(), a, b));
    EXPECT_FALSE(broad_phase().any(accel(), a, a));
    accel().update_transform(b, placed(vec3(11.5f, 0, 0)));  // touches c
    EXPECT_TRUE(broad_phase().any(accel(), b, c));
    EXPECT_FALSE(broad_phase().any(accel(), a, b));
}

TEST_P(BroadPhaseTest, BoxesAreClosed) {
    const float one_up = std::nextafter(1.0f, 2.0f);
    accel().push(unit_cube, std::vector{placed(vec3(0)), placed(vec3(1, 0, 0)), placed(vec3(0, one_up, 0)),
                                        placed(vec3(-1, -1, -1))});
    EXPECT_EQ(broad_phase().instance_pairs(accel()), (std::vector<InstancePair>{{0, 1}, {0, 3}}));
}

TEST_P(BroadPhaseTest, WhatCannotBeHitCollidesWithNothing) {
    accel().push(unit_cube);
    accel().push(Mesh{});
    Mesh flat = make_quad(vec3(0), vec3(1, 0, 0), vec3(2, 0, 0));
    accel().push(flat);
    EXPECT_TRUE(broad_phase().instance_pairs(accel()).empty());
    EXPECT_EQ(broad_phase().count(accel()), 0u);
    accel().push(unit_cube);
    EXPECT_EQ(broad_phase().instance_pairs(accel()), (std::vector<InstancePair>{{0, 3}}));
}

TEST_P(BroadPhaseTest, IdenticalBoxesAreAllFound) {
    constexpr std::uint64_t n = 10'000, expected = n * (n - 1) / 2;
    accel().push(unit_cube, std::vector<Transform>(n));
    EXPECT_EQ(broad_phase().count(accel()), expected);
    if (GetParam() != test::Kind::software) return;  // one kernel for all
    broad_phase().set_max_pairs(expected - 1);
    for (const char* part : {"49995000 pairs", "at most 49994999"})
        expect_error(part, [&] { broad_phase().instance_pairs(accel()); });
    broad_phase().set_max_pairs(expected);
    const std::vector<InstancePair> pairs = broad_phase().instance_pairs(accel());
    ASSERT_EQ(pairs.size(), expected);
    std::size_t i = 0, wrong = 0;
    for (uint a = 0; a < n; ++a)
        for (uint b = a + 1; b < n; ++b, ++i) wrong += pairs[i] != InstancePair{a, b};
    EXPECT_EQ(wrong, 0u);
}

// 2^32 and more do not fit into a counter of 32 bits.
TEST_P(BroadPhaseTest, CountsBeyondThirtyTwoBits) {
    constexpr std::uint64_t n = 70'000;
    accel().push(unit_cube, std::vector<Transform>(n));
    const auto second = make_accel();
    second->push(unit_cube, std::vector<Transform>(n));
    EXPECT_EQ(broad_phase().count(accel(), *second), n * n);
}

TEST_P(BroadPhaseTest, WrongUseIsAnError) {
    const AccelHandle a = accel().push(unit_cube), b = accel().push(unit_cube);
    accel().erase(b);
    EXPECT_EQ(test::error_of([&] { broad_phase().instance_pairs(accel(), a, b); }),
              accel().name() + ": instance_pairs: handle " + std::to_string(b.id) + " is not alive");
    expect_error("any: handle", [&] { broad_phase().any(accel(), b, a); });
    expect_error("are one", [&] { broad_phase().any(accel(), accel()); });
    expect_error("4294967295", [&] { broad_phase().set_max_pairs(1ull << 32); });
    EXPECT_TRUE(broad_phase().instance_pairs(accel()).empty());
    const auto other = test::make_context(context_desc());
    ASSERT_TRUE(other);
    BroadPhase stranger(*other);
    expect_error("another context", [&] { stranger.count(accel()); });
}

}  // namespace
}  // namespace twinray
