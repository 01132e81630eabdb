// Pairs of triangles for the tests of collisions.
#pragma once

#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "engine/collide/pair_classifier.h"

namespace twinray::test {

inline WorldTriangle triangle_of(dvec3 a, dvec3 b, dvec3 c) { return {a, b, c}; }

// Returns TWINRAY_LATTICE_PAIRS, or as many as are decided within seconds.
inline std::size_t lattice_count() {
    const char* asked = std::getenv("TWINRAY_LATTICE_PAIRS");
    return asked ? std::stoul(asked) : 100'000;
}

// Returns pairs with corners among {-2..2}^3, every fourth pair in one plane: half of them touch or overlap, in every
// possible way.
inline std::vector<TrianglePair> lattice_pairs(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    const auto one = [&] { return static_cast<double>(random() % 5) - 2; };
    const auto point = [&] {
        const double x = one(), y = one();
        return dvec3(x, y, one());
    };
    const auto triangle = [&] {
        const dvec3 a = point(), b = point();
        return WorldTriangle{a, b, point()};
    };
    std::vector<TrianglePair> pairs;
    for (std::size_t i = 0; i < count; ++i) {
        const WorldTriangle a = triangle();
        pairs.push_back({a, triangle()});
        if (i % 4 == 0)
            for (WorldTriangle* t : {&pairs.back().a, &pairs.back().b}) t->a.z = t->b.z = t->c.z = 0;
    }
    return pairs;
}

// Returns the triangle with its vertices in all six orders.
inline std::vector<WorldTriangle> permutations(const WorldTriangle& t) {
    return {{t.a, t.b, t.c}, {t.a, t.c, t.b}, {t.b, t.a, t.c}, {t.b, t.c, t.a}, {t.c, t.a, t.b}, {t.c, t.b, t.a}};
}

}  // namespace twinray::test
