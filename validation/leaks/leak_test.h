// The findings of a leak test, as a file from which a later run goes on; and the count of crossings on the device, of
// which it is made.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include <twinray/abstract_accel.h>
#include <twinray/validation.h>

#include "engine/accel/trace_desc.h"
#include "engine/core/kernel.h"

namespace twinray {

struct LeakState {
    LeakCounts counts;
    double seconds = 0;  // spent on tracing
};

// Traces until `rays` are traced in all; after(count) is called when a batch of so many rays is done.
void trace_until(const LeakTest& test, std::uint64_t rays, LeakState& state,
                 const std::function<void(const LeakFault&)>& on_fault, const std::function<void(std::size_t)>& after);

// Returns FNV-1a (Fowler, Noll, Vo) of all vertices, by which a state knows its mesh.
std::uint64_t hash_of(const Mesh& mesh);

// `identity`: what a run must have in common with the one that it continues. Throws Error naming the file if that
// differs, or if the file holds no state.
LeakState read_state(const std::filesystem::path& file, const nlohmann::json& identity);
// Writes the whole file or nothing: whenever the process ends, it is that of some earlier call. Throws Error naming it.
void write_state(const std::filesystem::path& file, nlohmann::json identity, const LeakState& state);

// Counts how often rays cross the triangles of a scene, which closest hits do not show: an edge that is hit twice, or a
// far wall that is lost behind a near one.
class CrossingCounter {
  public:
    // Compiles the kernel. Hardware needs ray queries (Feature::kernel_queries).
    CrossingCounter(Context& context, bool is_software, Level level);

    // Returns the number of hits of each ray in (t_min, t_max). `accel` is of the requested kind, synced, and all its
    // instances are non-opaque (InstanceOptions): opaque ones count as nothing, and hide what lies behind them. A
    // triangle that a driver offers more than once, as it may, counts once among the first 16.
    std::vector<uint> count(const AbstractAccel& accel, std::span<const Ray> rays) const;

  private:
    struct Args {  // as shaders/suite/crossings.comp declares them
        std::uint64_t scene;
        Ref<Ray> rays;
        Uints counts;
        uint count;
        uint padding = 0;
    };
    Kernel<Args> kernel_;
};

}  // namespace twinray
