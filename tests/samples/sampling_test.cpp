// Random numbers, and lights that are chosen by them: by tables, environment maps and light trees.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "renderer/environment.h"
#include "renderer/lights.h"

namespace twinray::path_tracer {
namespace {

using std::numbers::pi;

// Every elementary interval of every aligned block of 2^k samples holds one of them.
TEST(SamplePair, IsStratifiedInEveryWayThatTwoDimensionsAllow) {
    for (uint pixel = 0; pixel < 20; ++pixel)
        for (uint k = 1; k <= 8; ++k)
            for (uint block = 0; block < 3; ++block)
                for (uint a = 0; a <= k; ++a) {
                    std::set<std::uint64_t> cells;
                    for (uint i = 0; i < 1u << k; ++i) {
                        const uvec2 pair = sample_pair(pixel, (block << k) + i, 5, 9);
                        cells.insert((std::uint64_t{pair.x} << a >> 32) << 32 | std::uint64_t{pair.y} << (k - a) >> 32);
                    }
                    ASSERT_EQ(cells.size(), 1u << k) << "pixel " << pixel << " block " << block << " a " << a;
                }
}

TEST(SamplePair, PixelsDimensionsAndSeedsAreUncorrelated) {
    const auto correlation = [](auto first, auto second) {
        constexpr uint count = 1 << 14;
        double sum = 0;
        for (uint i = 0; i < count; ++i)
            sum += (double{unit_float(first(i))} - 0.5) * (double{unit_float(second(i))} - 0.5);
        return sum / count * 12;
    };
    const auto base = [](uint i) { return sample_pair(i, 3, 1, 1).x; };
    const double bound = 4 / std::sqrt(1 << 14);
    EXPECT_LT(std::abs(correlation(base, [](uint i) { return sample_pair(i, 3, 1, 1).y; })), bound);
    EXPECT_LT(std::abs(correlation(base, [](uint i) { return sample_pair(i + 1, 3, 1, 1).x; })), bound);
    EXPECT_LT(std::abs(correlation(base, [](uint i) { return sample_pair(i, 3, 2, 1).x; })), bound);
    EXPECT_LT(std::abs(correlation(base, [](uint i) { return sample_pair(i, 3, 1, 2).x; })), bound);
    // The two samples of an aligned pair lie in opposite halves.
    EXPECT_NEAR(correlation(base, [](uint i) { return sample_pair(i, 2, 1, 1).x; }), -0.75, bound);
}

TEST(UnitCircle, IsAccurateToFloatRounding) {
    for (int i = -4096; i <= 4096; ++i) {
        const float turns = static_cast<float>(i) / 2048;
        const vec2 circle = unit_circle(turns);
        const double angle = 2 * pi * static_cast<double>(turns);
        EXPECT_NEAR(circle.x, std::cos(angle), 2e-7) << turns;
        EXPECT_NEAR(circle.y, std::sin(angle), 2e-7) << turns;
    }
}

TEST(FrameAbout, IsOrthonormalEverywhere) {
    for (uint i = 0; i < 1000; ++i) {
        const vec2 u = unit_floats(sample_pair(i, 0, 0, 1));
        const vec2 circle = unit_circle(u.x) * sqrt(1 - (2 * u.y - 1) * (2 * u.y - 1));
        const Frame frame = frame_about(vec3(circle.x, circle.y, 2 * u.y - 1));
        EXPECT_NEAR(length(cross(frame.x, frame.y) - frame.z), 0, 1e-6f);
        EXPECT_NEAR(dot(frame.x, frame.z), 0, 1e-6f);
    }
}

TEST(MisWeight, SumsToOneAndDoesNotOverflow) {
    EXPECT_FLOAT_EQ(mis_weight(2, 3) + mis_weight(3, 2), 1);
    EXPECT_EQ(mis_weight(1, 0), 1);
    EXPECT_EQ(mis_weight(0, 5), 1);
    EXPECT_FLOAT_EQ(mis_weight(1e30f, 1e30f), 0.5f);
    EXPECT_EQ(mis_weight(1e-30f, 1e30f), 0);
}

// Returns the exact probability of each entry, from the columns.
std::vector<double> probabilities(const std::vector<AliasEntry>& table) {
    std::vector<double> result(table.size());
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double probability = table[i].probability * 0x1p-32;
        result[i] += probability / static_cast<double>(table.size());
        result[table[i].alias] += (1 - probability) / static_cast<double>(table.size());
    }
    return result;
}

TEST(AliasTable, GivesEachEntryItsProbability) {
    std::mt19937 random(7);
    for (const std::size_t n : {1u, 2u, 3u, 1000u}) {
        std::vector<double> weights(n);
        for (double& w : weights)
            w = std::uniform_real_distribution<double>(0, 1)(random) < 0.3 ? 0 : static_cast<double>(random()) * 1e-9;
        weights[0] = 5;
        double total = 0;
        for (const double w : weights) total += w;
        const std::vector<double> chosen = probabilities(make_alias_table(weights));
        for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(chosen[i], weights[i] / total, 1e-8) << n << ' ' << i;
    }
}

TEST(AliasTable, OfNothingIsEmpty) {
    EXPECT_TRUE(make_alias_table({}).empty());
    EXPECT_TRUE(make_alias_table(std::vector<double>{0, 0}).empty());
}

TEST(EnvironmentMap, DensityIntegratesToOneOverTheSphere) {
    std::mt19937 random(3);
    HdrImage image{7, 5, std::vector<vec3>(35)};
    for (vec3& pixel : image.rgb) pixel = vec3(static_cast<float>(random() % 100));
    const EnvironmentMap map(image);
    double total = 0;
    for (uint y = 0; y < 5; ++y)
        for (uint x = 0; x < 7; ++x)
            total += static_cast<double>(luminance(image.rgb[y * 7 + x]) * map.density_per_luminance) * 2 * pi / 7 *
                     (std::cos(pi * y / 5) - std::cos(pi * (y + 1) / 5));
    EXPECT_NEAR(total, 1, 1e-6);
}

TEST(EnvironmentMap, OfNothingIsBlack) {
    EXPECT_TRUE(EnvironmentMap(constant_sky(vec3(0))).is_black());
    EXPECT_FALSE(EnvironmentMap(default_sky()).is_black());
}

struct Draws {
    std::mt19937 random{7};
    float unit() { return std::uniform_real_distribution<float>(0, 1)(random); }
    float between(float low, float high) { return low + (high - low) * unit(); }
    vec3 point(float size) { return {between(-size, size), between(-size, size), between(-size, size)}; }
    vec3 direction() {
        while (true)
            if (const vec3 v = point(1); dot(v, v) > 0.01f && dot(v, v) < 1) return normalize(v);
    }
};

// Makes a triangle, a point or a spot, with a power from 10^-3 to 10^3.
PlacedLight any_light(Draws& draws, uint light) {
    const vec3 at = draws.point(10);
    const float power = std::pow(10.0f, draws.between(-3, 3));
    PlacedLight placed{.lo = at, .hi = at, .axis = draws.direction(), .power = power, .light = light};
    const float kind = draws.unit();
    if (kind < 0.4f) {
        const vec3 b = at + draws.point(0.5f), c = at + draws.point(0.5f);
        placed.lo = min(at, min(b, c));
        placed.hi = max(at, max(b, c));
        placed.axis = normalize(cross(b - at, c - at));
        placed.reach_angle = std::numbers::pi / 2;
        placed.is_two_sided = draws.unit() < 0.3f;
    } else if (kind < 0.7f) {
        placed.axes_angle = std::numbers::pi;
        placed.reach_angle = std::numbers::pi / 2;
    } else {
        placed.axes_angle = draws.between(0, 0.5f);
        placed.reach_angle = draws.between(0, 0.5f);
    }
    return placed;
}

std::vector<PlacedLight> any_lights(Draws& draws, uint count) {
    std::vector<PlacedLight> lights;
    for (uint i = 0; i < count; ++i) lights.push_back(any_light(draws, i));
    return lights;
}

LightReceiver any_receiver(Draws& draws) {
    const uint facing = packed_facing(draws.direction(), draws.unit() < 0.3f);
    return receiver_of(draws.point(12), facing);
}

Ref<LightNode> on_host(const LightTree& tree) { return {reinterpret_cast<std::uint64_t>(tree.nodes.data())}; }

// Returns whether any of its light arrives from one of its corners: such a light must not be left out.
bool may_light(const PlacedLight& light, const LightReceiver& at) {
    for (uint corner = 0; corner < 8; ++corner) {
        const vec3 from(corner & 1 ? light.lo.x : light.hi.x, corner & 2 ? light.lo.y : light.hi.y,
                        corner & 4 ? light.lo.z : light.hi.z);
        const vec3 way = normalize(from - at.position);
        const float facing = dot(way, at.normal), along = -dot(way, light.axis);
        if (!at.has_two_sides && facing <= 0) continue;
        const double angle = std::acos(std::min(light.is_two_sided ? std::abs(along) : along, 1.0f));
        if (angle < light.axes_angle + light.reach_angle) return true;
    }
    return false;
}

TEST(LightTree, FewChoicesEndWithoutALight) {
    Draws draws;
    double mean = 0, all = 0;
    for (const uint count : {1u, 2u, 3u, 50u, 1000u}) {
        const LightTree tree = build_light_tree(any_lights(draws, count), count);
        ASSERT_EQ(tree.nodes.size(), 2 * count - 1);
        for (int i = 0; i < 50; ++i) {
            const LightReceiver at = any_receiver(draws);
            double sum = 0;
            for (const uint way : tree.ways) sum += double{chance_of_way(on_host(tree), at, way)};
            // The rest are choices that end at a node with no child that can light the receiver.
            EXPECT_LE(sum, 1 + 1e-5);
            if (count < 50) continue;
            ++all;
            mean += sum;
        }
    }
    EXPECT_GT(mean, 0.7 * all) << "of " << all;
}

TEST(LightTree, EveryLightThatArrivesHasAChance) {
    Draws draws;
    constexpr uint count = 300;
    const std::vector<PlacedLight> lights = any_lights(draws, count);
    const LightTree tree = build_light_tree(lights, count);
    uint arriving = 0;
    for (int i = 0; i < 200; ++i) {
        const LightReceiver at = any_receiver(draws);
        for (const PlacedLight& light : lights)
            if (may_light(light, at)) {
                ++arriving;
                EXPECT_GT(chance_of_way(on_host(tree), at, tree.ways[light.light]), 0) << light.light;
            }
    }
    EXPECT_GT(arriving, 10000u);
}

TEST(LightTree, LightsAreChosenWithTheirChance) {
    Draws draws;
    constexpr uint count = 40, turns = 1 << 16;
    const LightTree tree = build_light_tree(any_lights(draws, count), count);
    for (int i = 0; i < 5; ++i) {
        const LightReceiver at = any_receiver(draws);
        std::vector<double> chosen(count);
        for (uint turn = 0; turn < turns; ++turn) {
            const ChosenLeaf leaf = choose_leaf(on_host(tree), at, (float(turn) + 0.5f) / turns);
            if (!(leaf.chance > 0)) continue;
            chosen[leaf.first] += 1.0 / turns;
            EXPECT_NEAR(leaf.chance, chance_of_way(on_host(tree), at, tree.ways[leaf.first]), 1e-6f * leaf.chance);
            EXPECT_TRUE(leaf.rest >= 0 && leaf.rest < 1 && leaf.count == 1);
        }
        for (uint light = 0; light < count; ++light)
            EXPECT_NEAR(chosen[light], double{chance_of_way(on_host(tree), at, tree.ways[light])}, 1e-3) << light;
    }
}

PlacedLight point(vec3 at, float power, uint light) {
    return {
        .lo = at, .hi = at, .axis = {0, 1, 0}, .power = power, .axes_angle = pi, .reach_angle = pi / 2, .light = light};
}

// Lights beside a receiver are asked more often than a light that is a thousand times as strong but far or hidden.
TEST(LightTree, PlaceCountsMoreThanPower) {
    const LightReceiver floor = receiver_of(vec3(0), packed_facing({0, 1, 0}, false));
    const LightTree far = build_light_tree(std::vector{point({0, 1, 0}, 1, 0), point({0, 100, 0}, 1000, 1)}, 2);
    EXPECT_NEAR(chance_of_way(on_host(far), floor, far.ways[0]), 1 / 1.1f, 1e-3f);
    const LightTree hidden = build_light_tree(std::vector{point({0, 1, 0}, 1, 0), point({0, -1, 0}, 1000, 1)}, 2);
    EXPECT_EQ(chance_of_way(on_host(hidden), floor, hidden.ways[0]), 1);
    const LightReceiver pane = receiver_of(vec3(0), packed_facing({0, 1, 0}, true));
    EXPECT_NEAR(chance_of_way(on_host(hidden), pane, hidden.ways[0]), 0.001f, 1e-4f);
}

// Each light is half as far from the next as from the one before: the best splits part them one by one.
TEST(LightTree, AWayHasAtMost32Levels) {
    std::vector<PlacedLight> lights;
    for (uint i = 0; i < 120; ++i) lights.push_back(point({std::ldexp(1.0f, -static_cast<int>(i)), 0, 0}, 1, i));
    const LightTree tree = build_light_tree(lights, lights.size());
    const LightReceiver at = receiver_of({0.4f, -1, 0}, packed_facing({0, 1, 0}, false));
    double sum = 0;
    for (const uint way : tree.ways) sum += double{chance_of_way(on_host(tree), at, way)};
    EXPECT_NEAR(sum, 1, 1e-5);
}

TEST(LightTree, AFacingIsKeptToItsError) {
    Draws draws;
    for (int i = 0; i < 10000; ++i) {
        const vec3 normal = draws.direction();
        const bool has_two_sides = draws.unit() < 0.5f;
        const LightReceiver at = receiver_of(vec3(1, 2, 3), packed_facing(normal, has_two_sides));
        EXPECT_LT(length(at.normal - normal), FACING_ERROR);
        EXPECT_EQ(at.has_two_sides, has_two_sides);
    }
    for (const vec3& axis :
         {vec3(1, 0, 0), vec3(-1, 0, 0), vec3(0, 1, 0), vec3(0, -1, 0), vec3(0, 0, 1), vec3(0, 0, -1)})
        EXPECT_LT(length(receiver_of(vec3(0), packed_facing(axis, false)).normal - axis), FACING_ERROR);
}

}  // namespace
}  // namespace twinray::path_tracer
