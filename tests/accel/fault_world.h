// An accelerator of each kind in a scene whose hits are known, for tests that let Vulkan fail under it.
#pragma once

#include "engine/core/context.h"
#include "report/faults/fault_injection.h"
#include "tests/accel/accel_fixture.h"

namespace twinray {

inline std::unique_ptr<AbstractAccel> make_accel(Context& context, test::Kind kind) {
    return test::make_accel(context, kind, {.compiles_in_background = kind != test::Kind::software});
}

// Rays down onto World's scene.
inline const std::vector<Ray> world_rays = {test::down(0.25f, 0.5f), test::down(2.25f, 0.5f), test::down(4.25f, 0.5f),
                                            test::down(6.25f, 0.5f), test::down(8.25f, 0.5f)};

// Two floors, a tower that every edit moves, and a guest that every edit replaces.
class World {
  public:
    World(faults::FaultInjector& faults, test::Kind kind, const ContextDesc& desc) : faults_(faults) {
        ContextDesc logged = desc;
        logged.log = [this](std::string_view message) { log_.emplace_back(message); };
        context_ = std::make_unique<Context>(logged);
        accel_ = make_accel(*context_, kind);
    }

    Context& context() { return *context_; }
    AbstractAccel& accel() { return *accel_; }
    void destroy() {
        accel_.reset();
        vertices_ = {};
        context_.reset();
    }
    // Returns the messages of the validation layer, including those of destroy().
    std::vector<std::string> messages() const {
        std::vector<std::string> messages;
        for (const std::string& message : log_)
            if (message.starts_with("Validation")) messages.push_back(message);
        return messages;
    }

    void push_base() {
        const Mesh floor = test::square(0);
        floor_ = accel().push(floor, std::vector{Transform{}, Transform::translation({2, 0, 0})});
        tower_ = accel().push(make_box(vec3(0), vec3(1)), Transform::translation({4, 0, 0}));
    }
    void edit() {
        move();
        accel().erase(guest_);
        guest_height_ = tower_height();
        guest_ = accel().push(make_box(vec3(6, 0, 0), vec3(7, 1, guest_height_)));
    }
    void move() {
        tower_lift_ = std::fmod(tower_lift_ + 1, 5.0f);
        accel().update_transform(tower_, Transform::translation({4, 0, tower_lift_}));
    }
    // Replaces the tower by another mesh, whose vertices have not moved.
    void renew_tower() {
        tower_top_ = 1;
        accel().update(tower_, make_box(vec3(0), vec3(1)));
    }
    // Moves the tower's vertices, from the host (upload) or from the device.
    void deform(Memory where) {
        tower_top_ = 1 + std::fmod(tower_top_, 4.0f);
        const std::vector<vec3> positions = make_box(vec3(0), vec3(1, 1, tower_top_)).positions;
        if (where == Memory::upload) return accel().update_vertices(tower_, positions);
        vertices_ = test::device_copy(context(), positions);
        accel().update_vertices(tower_, vertices_.ref<float>(), positions.size());
    }
    // Pushes a box that no ray reaches.
    void push_aside() { accel().push(make_box(vec3(20, 0, 0), vec3(21, 1, 1))); }
    void sync() {
        accel().sync();
        view_ = accel().view();
        view_expected_ = expected();
    }
    std::uint64_t synced_revision() const { return view_.revision; }

    // Fails the test unless the hits are those of the scene as edited.
    void check_hits() {
        EXPECT_EQ(distances(accel().closest_hits(world_rays)), expected());
        const std::vector<Hit> any = accel().any_hits(world_rays);
        for (std::size_t i = 0; i < world_rays.size(); ++i)
            EXPECT_EQ(any[i].hit, expected()[i] < 0 ? 0u : 1u) << "ray " << i;
        sync();
    }
    // Fails the test unless the view of the last sync still has the hits that it had then.
    void check_view_of_last_sync() {
        if (!view_.accel) return;
        EXPECT_EQ(distances(test::traced(accel(), view_, world_rays)), view_expected_);
    }

    // The state that must not change when something fails.
    struct State {
        std::size_t n_instances, n_geometries;
        std::uint64_t revision, structure_bytes;
        bool has_floor, has_tower, has_guest, is_clean;
        std::vector<float> world_bound;
        faults::Counts live;
        std::uint64_t allocated_bytes;

        bool operator==(const State&) const = default;
    };
    State state() {
        const Bounds bound = accel().revision() ? accel().world_bound() : Bounds{};  // none before the first sync
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

  private:
    static std::vector<float> distances(const std::vector<Hit>& hits) {
        std::vector<float> t;
        for (const Hit& hit : hits) t.push_back(hit.t);
        return t;
    }
    std::vector<float> expected() const {
        return {10, 10, 10 - tower_height(), guest_height_ > 0 ? 10 - guest_height_ : -1, -1};
    }
    float tower_height() const { return tower_lift_ + tower_top_; }

    faults::FaultInjector& faults_;
    std::vector<std::string> log_;
    std::unique_ptr<Context> context_;
    std::unique_ptr<AbstractAccel> accel_;
    AccelHandle floor_, tower_, guest_;
    float tower_lift_ = 0, tower_top_ = 1, guest_height_ = 0;
    Buffer vertices_;
    AccelView view_;  // of the last sync, with its hits
    std::vector<float> view_expected_;
};

}  // namespace twinray
