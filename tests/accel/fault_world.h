// SPDX-License-Identifier: MIT
// An accelerator of each kind in a scene whose hits are known, for tests that let Vulkan fail under it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <twinray/abstract_accel.h>
#include "tests/accel/accel_fixture.h"
#include "report/faults/fault_injection.h"

namespace twinray {

std::unique_ptr<AbstractAccel> make_accel(Context& context, test::Kind kind);

// Rays down onto World's scene.
extern const std::vector<Ray> world_rays;

// Two floors, a tower that every edit moves, and a guest that every
// edit replaces.
class World {
  public:
    World(faults::FaultInjector& faults, test::Kind kind, const ContextDesc& desc);

    Context& context() { return *context_; }
    AbstractAccel& accel() { return *accel_; }
    void destroy();
    std::vector<std::string> messages() const;  // of the validation layer, those of destroy() too

    void push_base();
    void edit();
    void move();
    void renew_tower();         // another mesh, whose vertices have not moved
    void deform(Memory where);  // the tower's vertices, from the host (upload) or from the device
    void push_aside();          // where no ray comes
    void sync();
    std::uint64_t synced_revision() const { return view_.revision; }
    // Fails the test unless the hits are those of the scene as edited, or as last synced.
    void check_hits();
    void check_view_of_last_sync();

    // What must not change when something fails.
    struct State {
        std::size_t n_instances, n_geometries;
        std::uint64_t revision, structure_bytes;
        bool has_floor, has_tower, has_guest, is_clean;
        std::vector<float> world_bound;
        faults::Counts live;
        std::uint64_t allocated_bytes;

        bool operator==(const State&) const = default;
    };
    State state();

  private:
    std::vector<float> expected() const;
    float tower_height() const { return tower_lift_ + tower_top_; }

    faults::FaultInjector& faults_;
    std::vector<std::string> log_;
    std::unique_ptr<Context> context_;
    std::unique_ptr<AbstractAccel> accel_;
    AccelHandle floor_, tower_, guest_;
    float tower_lift_ = 0, tower_top_ = 1, guest_height_ = 0;
    Buffer vertices_;
    AccelView view_;  // of the last sync, with the hits of then
    std::vector<float> view_expected_;
};

}  // namespace twinray
