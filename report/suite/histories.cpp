// SPDX-License-Identifier: MIT
// Many geometries that are pushed, moved and erased, and saved and loaded in between.
#include <twinray/geometry.h>
#include <twinray/tlas.h>

#include <algorithm>
#include <filesystem>
#include <unordered_map>

#include "validation/records/temporary_folder.h"
#include "report/suite/sections.h"
#include "report/suite/scenes.h"

namespace twinray::suite {
namespace {

// A small mesh of its own, its place and its handle.
struct Placed {
    Mesh mesh;
    Transform place;
    AccelHandle handle = {};
};

class History {
  public:
    explicit History(std::uint64_t seed) : random_(seed) {}

    void push(AbstractAccel& accel, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            Placed made{make_icosphere(0, random_.between(0.05f, 0.2f)), somewhere()};
            made.handle = accel.push(made.mesh, made.place);
            all_.push_back(std::move(made));
        }
    }
    // Moves a few, bends a few, erases a few, and adds as many.
    void edit(AbstractAccel& accel) {
        for (int i = 0; i < 8; ++i) {
            Placed& moved = any();
            moved.place = somewhere();
            accel.update_transform(moved.handle, moved.place);
            Placed& bent = any();
            for (vec3& position : bent.mesh.positions) position += random_.in_box(0.02f);
            accel.update_vertices(bent.handle, bent.mesh.positions);
            Placed& gone = any();
            accel.erase(gone.handle);
            std::swap(gone, all_.back());
            all_.pop_back();
        }
        push(accel, 8);
        accel.sync();
    }
    // Takes the handles of another accelerator, which has the same order.
    void rename(const std::vector<AccelHandle>& handles, const std::vector<AccelHandle>& before) {
        std::unordered_map<AccelHandle, AccelHandle> names;
        for (std::size_t i = 0; i < handles.size(); ++i) names[before[i]] = handles[i];
        for (Placed& placed : all_) placed.handle = names.at(placed.handle);
    }
    // Returns the scene in the order of handles, which is that of pushes.
    Scene scene() const {
        std::vector<Placed> ordered = all_;
        std::ranges::sort(ordered, {}, [](const Placed& placed) { return placed.handle.id; });
        Scene scene;
        for (Placed& placed : ordered) {
            scene.instances.push_back({"", static_cast<uint>(scene.meshes.size()), placed.place, {}});
            scene.meshes.push_back(std::move(placed.mesh));
        }
        return scene;
    }

  private:
    Placed& any() { return all_[random_.below(all_.size())]; }
    Transform somewhere() { return Transform::translation(random_.in_box(5)) * random_.rotation(); }

    Random random_;
    std::vector<Placed> all_;
};

// Saves the accelerator and loads it again, with other handles.
std::unique_ptr<AbstractAccel> saved_and_loaded(AbstractAccel& accel, History& history) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "accel";
    dynamic_cast<SwTlas&>(accel).save(file);
    SwTlas::Loaded loaded = SwTlas::load(accel.context(), file);
    history.rename(loaded.handles, accel.handles());
    return std::move(loaded.accel);
}

// Returns the accelerator after the edits; `history` has the scene that is left.
std::unique_ptr<AbstractAccel> edited(CaseRun& run, const Configuration& configuration, History& history,
                                      std::size_t count, std::size_t edits) {
    std::unique_ptr<AbstractAccel> accel = run.devices().make_accel(configuration);
    history.push(*accel, count);
    accel->sync();
    for (std::size_t i = 0; i < edits; ++i) {
        history.edit(*accel);
        if (is_ours(configuration.backend) && i == edits / 2) accel = saved_and_loaded(*accel, history);
    }
    return accel;
}

}  // namespace

void long_histories(CaseRun& run) {
    const std::size_t count = run.amount(1'000, 100'000), edits = run.amount(16, 1'000);
    for (const Configuration& configuration : run.one_configuration_each()) {
        if (configuration.level > Level::watertight) continue;  // a saved accelerator has none above
        History history(run.seed());
        const std::unique_ptr<AbstractAccel> accel = edited(run, configuration, history, count, edits);
        const Scene scene = history.scene();
        const World world = world_of(scene);
        const std::vector<Ray> rays = mixed_rays(world, bounds_of(scene), run.amount(2'048, 200'000), run.seed());
        const std::vector<Hit> hits = accel->closest_hits(rays, {.level = configuration.level});
        run.add_checked(configuration, check(world.reference, rays, hits, configuration.backend),
                        {.params = {{"geometries", count}, {"edits", edits}}});
    }
}

}  // namespace twinray::suite
