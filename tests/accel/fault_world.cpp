// SPDX-License-Identifier: MIT
#include "tests/accel/fault_world.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/vma.h"
#include <twinray/geometry.h>
#include <twinray/tlas.h>

namespace twinray {
namespace {

Ray down(float x) { return {vec3(x + 0.25f, 0.5f, 10), 0, vec3(0, 0, -1), INFINITY}; }

std::vector<float> distances(const std::vector<Hit>& hits) {
    std::vector<float> t;
    for (const Hit& hit : hits) t.push_back(hit.t);
    return t;
}

}  // namespace

std::unique_ptr<AbstractAccel> make_accel(Context& context, test::Kind kind) {
    if (kind == test::Kind::software)
        return std::make_unique<SwTlas>(context, AccelOptions{.compiles_in_background = false});
    return std::make_unique<HwTlas>(context);
}

const std::vector<Ray> world_rays = {down(0), down(2), down(4), down(6), down(8)};

World::World(faults::FaultInjector& faults, test::Kind kind, const ContextDesc& desc) : faults_(faults) {
    ContextDesc logged = desc;
    logged.log = [this](std::string_view message) { log_.emplace_back(message); };
    context_ = std::make_unique<Context>(logged);
    accel_ = make_accel(*context_, kind);
}

void World::destroy() {
    accel_.reset();
    vertices_ = {};
    context_.reset();
}

std::vector<std::string> World::messages() const {
    std::vector<std::string> messages;
    for (const std::string& message : log_)
        if (message.starts_with("Validation")) messages.push_back(message);
    return messages;
}

void World::push_base() {
    const Mesh floor = make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0));
    floor_ = accel().push(floor, std::vector{Transform{}, Transform::translation({2, 0, 0})});
    tower_ = accel().push(make_box(vec3(0), vec3(1)), Transform::translation({4, 0, 0}));
}

void World::edit() {
    move();
    accel().erase(guest_);
    guest_height_ = tower_height();
    guest_ = accel().push(make_box(vec3(6, 0, 0), vec3(7, 1, guest_height_)));
}

void World::move() {
    tower_lift_ = std::fmod(tower_lift_ + 1, 5.0f);
    accel().update_transform(tower_, Transform::translation({4, 0, tower_lift_}));
}

void World::renew_tower() {
    tower_top_ = 1;
    accel().update(tower_, make_box(vec3(0), vec3(1)));
}

void World::deform(Memory where) {
    tower_top_ = 1 + std::fmod(tower_top_, 4.0f);
    const std::vector<vec3> positions = make_box(vec3(0), vec3(1, 1, tower_top_)).positions;
    if (where == Memory::upload) return accel().update_vertices(tower_, positions);
    vertices_ = Buffer(context(), {.name = "vertices", .bytes = std::span(positions).size_bytes()});
    Commands commands(context(), "vertices");
    {
        const auto pass = commands.pass("vertices");
        commands.upload(vertices_, std::span(positions));
    }
    commands.submit();
    accel().update_vertices(tower_, vertices_.ref<float>(), positions.size());
}

void World::push_aside() { accel().push(make_box(vec3(20, 0, 0), vec3(21, 1, 1))); }

std::vector<float> World::expected() const {
    return {10, 10, 10 - tower_height(), guest_height_ > 0 ? 10 - guest_height_ : -1, -1};
}

void World::sync() {
    accel().sync();
    view_ = accel().view();
    view_expected_ = expected();
}

void World::check_hits() {
    EXPECT_EQ(distances(accel().closest_hits(world_rays)), expected());
    const std::vector<Hit> any = accel().any_hits(world_rays);
    for (std::size_t i = 0; i < world_rays.size(); ++i)
        EXPECT_EQ(any[i].hit, expected()[i] < 0 ? 0u : 1u) << "ray " << i;
    sync();
}

void World::check_view_of_last_sync() {
    if (!view_.accel) return;
    const Buffer ray_buffer(context(), {.name = "rays", .bytes = std::span(world_rays).size_bytes()});
    const Buffer hits(context(), {.name = "hits", .bytes = world_rays.size() * sizeof(Hit)});
    Commands commands(context(), "view of the last sync");
    {
        const auto pass = commands.pass("rays");
        commands.upload(ray_buffer, std::span(world_rays));
    }
    accel().trace(commands, view_,
                  {.rays = ray_buffer.ref<Ray>(), .hits = hits.ref<Hit>(), .count = world_rays.size()});
    commands.submit();
    EXPECT_EQ(distances(download<Hit>(context(), hits, world_rays.size())), view_expected_);
}

World::State World::state() {
    const Bounds bound = accel().revision() ? accel().world_bound() : Bounds{};  // there is none before the first sync
    context().wait_for_gpu();
    State state{};
    state.n_instances = accel().n_instances();
    state.n_geometries = accel().n_geometries();
    state.revision = accel().revision();
    state.structure_bytes = accel().memory_usage().structures();
    state.has_floor = accel().is_valid(floor_);
    state.has_tower = accel().is_valid(tower_);
    state.has_guest = accel().is_valid(guest_);
    state.is_clean = faults::outcome_of([&] { accel().view(); }) == faults::Outcome::done;
    for (const vec3& corner : {bound.lo, bound.hi})
        state.world_bound.insert(state.world_bound.end(), {corner.x, corner.y, corner.z});
    state.live = faults_.live_objects();
    for (const char* compiled : {"VkPipeline", "VkPipelineLayout"})
        state.live.erase(compiled);  // when first used; kept
    state.allocated_bytes = context().allocated_bytes();
    return state;
}

}  // namespace twinray
