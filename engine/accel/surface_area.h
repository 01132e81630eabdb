// Measures how the boxes of a tree have changed since its build.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "engine/core/kernel.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/surface_area.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(AreaItem) == 28 && sizeof(TreeCost) == 8);

// The destination of a measurement.
struct CostTarget {
    Ref<TreeCost> kept;
    Ref<TreeCost> result;   // null: nothing is measured
    bool is_first = false;  // the tree was never measured: before a refit, its cost as built comes first
};

// The last measurements of one tree, for a host that does not wait.
class CostLog {
  public:
    CostLog() = default;
    explicit CostLog(Context& context);

    // Returns the destination of the next measurement.
    CostTarget target() const;
    void commit(bool is_build, SyncPoint done);
    void forget() { points_ = {}; }  // the tree was built and not measured
    // Returns the latest measurement since the last build that the GPU has finished; nullopt without one.
    std::optional<TreeCost> newest(const Context& context) const;
    SyncPoint last_point() const { return last_; }
    std::uint64_t bytes() const { return costs_.bytes(); }

  private:
    static constexpr std::size_t places_ = 8;  // enough for a host that runs some frames ahead of the GPU
    Buffer costs_;                             // one kept on the device, then places_
    std::array<SyncPoint, places_> points_{};  // null: nothing there
    std::size_t next_ = 0;
    SyncPoint last_;
};

// One tree to be measured.
struct AreaWork {
    std::uint64_t item_count;
    Ref<GeometryBox> root;
    CostTarget target;
    bool is_build;
    Ref<AreaItem> items = {}, joined = {};  // written by the caller's kernels; see SurfaceArea::place()

    std::uint64_t bytes() const;  // of both
};

class SurfaceArea {
  public:
    explicit SurfaceArea(Context& context);

    // Places the items of all trees in memory from `address` on, AreaWork::bytes() each.
    static void place(std::uint64_t address, std::span<AreaWork> work);
    // The same in memory of its own.
    static void place(Commands& commands, std::span<AreaWork> work);
    void record(Commands& commands, std::vector<AreaWork> work) const;

  private:
    Kernel<JoinAreasArgs> join_;
};

}  // namespace twinray
