// SPDX-License-Identifier: MIT
// More memory than a device has, and more than 32 bits can address.
#include <cmath>
#include <cstring>

#include "report/suite/sections.h"
#include "engine/core/vulkan.h"
#include "report/faults/fault_injection.h"
#include "report/suite/scenes.h"
#include "engine/core/context.h"
#include <twinray/geometry.h>

namespace twinray::suite {
namespace {

constexpr std::uint64_t four_gib = std::uint64_t{1} << 32;

// The visible state of a context and an accelerator.
struct Seen {
    std::uint64_t allocated_bytes, revision;
    Hit hit;

    bool operator==(const Seen& other) const {
        return allocated_bytes == other.allocated_bytes && revision == other.revision &&
               std::memcmp(&hit, &other.hit, sizeof(Hit)) == 0;
    }
};

Seen look_at(AbstractAccel& accel) {
    const Ray down{vec3(0.3f, 0.4f, 5), 0, vec3(0, 0, -1), inf};
    const Hit hit = accel.closest_hits(std::span(&down, 1)).front();
    accel.context().wait_for_gpu();
    return {accel.context().allocated_bytes(), accel.revision(), hit};
}

void refuse_what_no_device_has(CaseRun& run, const Configuration& configuration) {
    constexpr std::uint64_t bytes = std::uint64_t{1} << 44;
    AbstractAccel& accel = run.devices().empty_accel(configuration);
    accel.push(make_box(vec3(0), vec3(1)));
    const Seen before = look_at(accel);
    const std::string error =
        faults::what_is_thrown_by([&] { const Buffer buffer(accel.context(), {.name = "huge", .bytes = bytes}); });
    CaseRun::Outcome outcome{.params = {{"asked", "a buffer of 2^44 bytes"}}, .fault_of = "twinray"};
    if (error.find(std::to_string(bytes)) == std::string::npos)
        outcome.what = error.empty() ? "not refused" : "refused without its size: " + error;
    else if (!(look_at(accel) == before))
        outcome.what = "refused, but something has changed";
    outcome.faults = !outcome.what.empty();
    run.expect(configuration, outcome);
}

// Squares of two triangles in the plane z = 0, `side` along x and `side` - 1 along y, at whole numbers, so that
// nothing is rounded.
struct Plane {
    uint side;

    std::uint64_t vertices() const { return std::uint64_t{side + 1} * side; }
    std::uint64_t triangles() const { return std::uint64_t{2} * side * (side - 1); }
    Mesh mesh() const {
        Mesh mesh;
        mesh.name = "plane";
        mesh.positions.reserve(vertices());
        mesh.triangles.reserve(triangles());
        for (uint y = 0; y < side; ++y)
            for (uint x = 0; x <= side; ++x) mesh.positions.emplace_back(x, y, 0);
        for (uint y = 0; y + 1 < side; ++y)
            for (uint x = 0; x < side; ++x) {
                const uint at = y * (side + 1) + x, above = at + side + 1;
                mesh.triangles.emplace_back(at, at + 1, above);
                mesh.triangles.emplace_back(at + 1, above + 1, above);
            }
        return mesh;
    }
    // Returns a ray down from height 8 onto a triangle's inside.
    Ray onto(uint triangle) const {
        const uint square = triangle / 2;
        const float inside = triangle % 2 ? 0.75f : 0.25f;
        return {vec3(static_cast<float>(square % side) + inside, static_cast<float>(square / side) + inside, 8), 0,
                vec3(0, 0, -1), inf};
    }
};

std::uint64_t largest_heap(Context& context) {
    VkPhysicalDeviceMemoryProperties memory{};
    context.state().vk().vkGetPhysicalDeviceMemoryProperties(context.physical_device(), &memory);
    std::uint64_t largest = 0;
    for (uint i = 0; i < memory.memoryHeapCount; ++i)
        if (memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
            largest = std::max<std::uint64_t>(largest, memory.memoryHeaps[i].size);
    return largest;
}

struct Planes {
    Plane plane;
    std::size_t count;
    BuildBytes bytes;
};

// Returns as many as need more than `least` bytes of trees, at least two.
Planes planes_beyond(std::uint64_t least, const Plane& plane, const AbstractAccel& accel) {
    for (std::size_t count = 2;; ++count) {
        const std::vector<GeometrySize> sizes(count, {plane.vertices(), plane.triangles()});
        const BuildBytes bytes = accel.memory_requirements(sizes, count);
        if (bytes.structures > least) return {plane, count, bytes};
    }
}

// The first ray of each plane is aimed at its first triangle, the second at its last.
void expect_every_square(CaseRun& run, const Configuration& configuration, AbstractAccel& accel, const Planes& planes) {
    const Mesh mesh = planes.plane.mesh();
    const auto far = [&](std::size_t i) { return static_cast<float>(i * 2 * planes.plane.side); };
    for (std::size_t i = 0; i < planes.count; ++i) accel.push(mesh, Transform::translation(vec3(far(i), 0, 0)));
    Random random(run.seed());
    const auto triangles = static_cast<uint>(planes.plane.triangles());
    CaseRun::Outcome outcome{.params = {{"asked", "planes"}, {"side", planes.plane.side}},
                             .results = {{"planes", planes.count}, {"triangles", triangles}},
                             .n = 0,
                             .reference = "analytic"};
    for (std::size_t i = 0; i < planes.count; ++i) {
        std::vector<uint> targets = {0, triangles - 1};
        for (std::size_t n = run.is_whole() ? 100'000 : 512; n > 0; --n) targets.push_back(random.below(triangles));
        std::vector<Ray> rays;
        for (const uint target : targets) {
            rays.push_back(planes.plane.onto(target));
            rays.back().origin.x += far(i);
        }
        const std::vector<Hit> hits = accel.closest_hits(rays, {.level = configuration.level});
        for (std::size_t r = 0; r < rays.size(); ++r, ++outcome.n) {
            const bool is_right = hits[r].hit && hits[r].instance_index == i && hits[r].primitive_index == targets[r] &&
                                  std::abs(hits[r].t - 8) <= 0x1p-16f;
            if (!is_right && outcome.faults++ == 0)
                outcome.what = text("plane ", i, ", triangle ", targets[r], ": ", hits[r].hit ? "hit triangle " : "",
                                    hits[r].hit ? std::to_string(hits[r].primitive_index) : "missed");
        }
    }
    outcome.results.emplace("bytes_of_trees", accel.memory_usage().structures());
    run.expect(configuration, outcome);
}

}  // namespace

// In the full suite, a geometry has as many triangles as Plane can have below 2^25, and all trees take more than 4 GiB;
// half of the heap is left to other users.
void large_buffers(CaseRun& run) {
    const std::uint64_t least = run.is_whole() ? four_gib : 0;
    const Plane plane{run.is_whole() ? 4'096u : 16u};
    for (const Configuration& configuration : run.one_configuration_each()) {
        refuse_what_no_device_has(run, configuration);
        const std::unique_ptr<AbstractAccel> accel = run.devices().make_accel(configuration);
        const Planes planes = planes_beyond(least, plane, *accel);
        const std::uint64_t needed =
            planes.bytes.structures + planes.bytes.scratch +
            planes.count * (sizeof(vec3) * plane.vertices() + sizeof(uvec3) * plane.triangles());
        const std::uint64_t heap = largest_heap(run.devices().context(configuration.backend));
        if (needed <= heap / 2) {
            expect_every_square(run, configuration, *accel, planes);
            continue;
        }
        run.expect(configuration,
                   {.params = {{"asked", "planes"}, {"side", plane.side}},
                    .results = {{"planes", planes.count}, {"bytes_needed", needed}, {"heap_bytes", heap}},
                    .n = 0,
                    .only_measured =
                        text("nothing was traced: ", needed, " bytes do not fit half of the device's heap of ", heap)});
    }
}

}  // namespace twinray::suite
