// SPDX-License-Identifier: MIT
// The order in which an invocation traces a run of rays: each ray once, alike ones at a time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "engine/accel/trace_args.h"

namespace twinray {
#include "engine/core/bridge_begin.h"
#include "shaders/shared/turns.h"
#include "engine/core/bridge_end.h"

namespace {

constexpr uint lanes = 8;

std::vector<uint> taken_from(Turns turns, uint count) {
    std::vector<uint> taken;
    for (uint k = 0; k < count; ++k) taken.push_back(next_turn(turns, k));
    return taken;
}

TurnKeys keys_of(const std::vector<vec3>& directions) {
    TurnKeys keys;
    for (uint t = 0; t < TURNS; ++t) keys.key[t] = t < directions.size() ? turn_key(directions[t], t) : NO_RAY | t;
    return keys;
}

std::vector<uint> first_numbers(uint count) {
    std::vector<uint> numbers;
    for (uint i = 0; i < count; ++i) numbers.push_back(i);
    return numbers;
}

class Directions {
  public:
    vec3 next() {  // in the hemisphere around z
        const vec3 v(normal_(bits_), normal_(bits_), std::abs(normal_(bits_)));
        return v / std::sqrt(dot(v, v));
    }
    std::vector<vec3> next(uint count) {
        std::vector<vec3> all(count);
        std::generate(all.begin(), all.end(), [this] { return next(); });
        return all;
    }

  private:
    std::mt19937 bits_{5};
    std::normal_distribution<float> normal_;
};

TEST(Turns, AreTakenOnceAndThoseWithoutARayLast) {
    Directions random;
    for (uint count = 0; count <= TURNS; ++count) {
        TurnKeys keys = keys_of(random.next(count));
        sort_turns(keys);
        std::vector<uint> taken = taken_from(turns_in_order(keys), TURNS);
        std::sort(taken.begin(), taken.begin() + count);
        std::sort(taken.begin() + count, taken.end());
        EXPECT_EQ(taken, first_numbers(TURNS)) << count;
    }
}

TEST(Turns, OfRaysThatAreNoneComeBeforeThoseWithoutOne) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    const float all_ones = uintBitsToFloat(0x7fffffffu);
    for (const float worst : {nan, -nan, all_ones, infinity, -infinity, 0.0f, -0.0f})
        for (const uint count : {1u, 7u, 8u, 9u, 31u}) {
            TurnKeys keys = keys_of(std::vector<vec3>(count, vec3(worst)));
            sort_turns(keys);
            std::vector<uint> taken = taken_from(turns_in_order(keys), count);
            std::sort(taken.begin(), taken.end());
            EXPECT_EQ(taken, first_numbers(count)) << worst;
        }
}

void expect_slabs(const std::vector<vec3>& directions) {
    TurnKeys keys = keys_of(directions);
    sort_turns(keys);
    const std::vector<uint> taken = taken_from(turns_in_order(keys), TURNS);
    for (uint k = 1; k < TURNS; ++k) {
        const vec3 here = directions[taken[k]], before = directions[taken[k - 1]];
        if (k % SLAB == 0)
            for (uint i = k; i < TURNS; ++i)
                EXPECT_GE(part_of_key(directions[taken[i]].z), part_of_key(before.z)) << "slabs of z";
        else if (k / SLAB % 2 == 0)
            EXPECT_GE(part_of_key(here.x), part_of_key(before.x)) << "forth";
        else
            EXPECT_LE(part_of_key(here.x), part_of_key(before.x)) << "back";
    }
}

TEST(Turns, GoThroughSlabsOfZBackAndForthInX) {
    Directions random;
    for (uint i = 0; i < 500; ++i) expect_slabs(random.next(TURNS));
}

// What it is for: lanes that sort by themselves come to directions nearer to each other's.
TEST(Turns, OfEqualRankGoMuchTheSameWay) {
    Directions random;
    double given = 0, sorted = 0;
    std::vector<std::vector<vec3>> directions(lanes);
    std::vector<std::vector<uint>> taken(lanes);
    for (uint run = 0; run < 64; ++run) {
        for (uint lane = 0; lane < lanes; ++lane) {
            directions[lane] = random.next(TURNS);
            TurnKeys keys = keys_of(directions[lane]);
            sort_turns(keys);
            taken[lane] = taken_from(turns_in_order(keys), TURNS);
        }
        for (uint lane = 1; lane < lanes; ++lane)
            for (uint k = 0; k < TURNS; ++k) {
                given += dot(directions[0][k], directions[lane][k]);
                sorted += dot(directions[0][taken[0][k]], directions[lane][taken[lane][k]]);
            }
    }
    const double pairs = 64.0 * (lanes - 1) * TURNS;
    EXPECT_NEAR(given / pairs, 0.25, 0.03) << "of a hemisphere";
    EXPECT_GT(sorted / pairs, 0.55);
}

// Lanes 0 to 7 of a group with `count` rays, as trace.comp goes through them.
struct Batch {
    std::vector<Ray> rays;
    std::vector<Hit> hits;
    TraceArgs args{};

    Batch(uint count, const std::vector<vec3>& directions) : rays(count), hits(count) {
        for (Hit& hit : hits) hit.hit = 7;
        for (uint i = 0; i < count; ++i) rays[i].direction = directions[i % directions.size()];
        args.rays = Ref<Ray>::to(rays.data());
        args.hits = Ref<Hit>::to(hits.data());
    }
    Turns turns(uint lane, uint turns) const {
        return turns_of(args, lane, lanes, turns, static_cast<uint>(rays.size()));
    }
    uint begun() const {
        return static_cast<uint>(std::count_if(hits.begin(), hits.end(), [](const Hit& hit) { return hit.hit == 0; }));
    }
};

TEST(Turns, OfABatchAreOfItsRaysAndBeginTheirHits) {
    Directions random;
    for (const uint count : {64u, 65u, 71u, 100u, 255u, 256u}) {
        const Batch batch(count, random.next(count));
        std::vector<uint> traced;
        for (uint lane = 0; lane < lanes; ++lane) {
            const uint turns = (count + lanes - 1) / lanes;
            Turns order = batch.turns(lane, turns);
            for (uint k = 0; lane + k * lanes < count; ++k) traced.push_back(lane + next_turn(order, k) * lanes);
        }
        EXPECT_FALSE(std::is_sorted(traced.begin(), traced.begin() + count / lanes));
        std::sort(traced.begin(), traced.end());
        EXPECT_EQ(traced, first_numbers(count));
        EXPECT_EQ(batch.begun(), count);
    }
}

TEST(Turns, StayAsGivenWhereSortingDoesNotPay) {
    Directions random;
    const std::vector<vec3> any = random.next(256);
    EXPECT_NE(taken_from(Batch(256, any).turns(0, TURNS), TURNS), first_numbers(TURNS));

    const vec3 ahead(0.3f, -0.2f, 1);
    const Batch camera(256, {ahead, ahead + vec3(0.5f, 0, 0), ahead, ahead + vec3(0, 0.5f, 0)});
    const Batch few(256, any);
    Batch ordered(256, any);
    ordered.args.order = Uints{1};  // not read
    for (const auto& [batch, turns] : {std::pair(&camera, TURNS), {&few, FEWEST_TURNS - 1}, {&ordered, TURNS}}) {
        EXPECT_EQ(taken_from(batch->turns(0, turns), TURNS), first_numbers(TURNS));
        EXPECT_EQ(batch->begun(), 0u);
    }
}

TEST(Turns, AreAlikeWithinTheAngleWhateverTheirLengths) {
    const float inside = std::cos(0.6f), outside = std::cos(0.7f);  // 37 degrees are 0.644
    const auto alike = [](vec3 other) {
        const Batch batch(4 * lanes, {vec3(0, 0, 3)});
        std::vector<Ray> rays = batch.rays;
        rays[2 * lanes].direction = other;
        return are_alike(Ref<Ray>::to(rays.data()), 0, lanes, 4 * lanes);
    };
    EXPECT_TRUE(alike(vec3(std::sin(0.6f), 0, inside) * 100.0f));
    EXPECT_FALSE(alike(vec3(0, std::sin(0.7f), outside)));
    EXPECT_FALSE(alike(vec3(0, 0, -1)));
    EXPECT_FALSE(alike(vec3(0)));
    EXPECT_FALSE(alike(vec3(NAN)));
}

}  // namespace
}  // namespace twinray
