// SPDX-License-Identifier: MIT
// Which changes refit a top level and which rebuild it.
#include "engine/accel/scene_update.h"

#include <gtest/gtest.h>

#include <functional>

namespace twinray {
namespace {

constexpr SceneChange moved_again{.is_built = true, .was_moved = true, .built_count = 3, .count = 3};

SceneChange with(const std::function<void(SceneChange&)>& change) {
    SceneChange changed = moved_again;
    change(changed);
    return changed;
}

TEST(SceneUpdate, WhatOnlyMovedAgainIsRefitted) { EXPECT_FALSE(must_build(moved_again)); }

TEST(SceneUpdate, AnotherNumberOfInstancesRebuilds) {
    for (const std::size_t count : {0, 2, 4})
        EXPECT_TRUE(must_build(with([&](SceneChange& change) { change.count = count; }))) << count;
}

TEST(SceneUpdate, SoDoesAllElse) {
    EXPECT_TRUE(must_build({})) << "the first time";
    EXPECT_TRUE(must_build(with([](SceneChange& change) { change.was_moved = false; }))) << "the first move";
    EXPECT_TRUE(must_build(with([](SceneChange& change) { change.has_structure = true; })));
    EXPECT_TRUE(must_build(with([](SceneChange& change) { change.has_new_geometry = true; })));
    EXPECT_TRUE(must_build(with([](SceneChange& change) { change.has_degraded = true; })));
}

}  // namespace
}  // namespace twinray
