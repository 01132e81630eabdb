#include "report/suite/sections.h"

#include <cstdlib>
#include <memory>
#include <set>

#include "report/faults/fault_injection.h"

namespace twinray::suite {
namespace {

// Sets one vertex in the middle of a grid, which six triangles share, to `value` on an axis.
void spoiled_vertex(CaseRun& run, int axis, float value, const char* setting) {
    Mesh grid = make_grid(16, 16, 0.05f, 3);
    grid.positions[8 * 17 + 8][axis] = value;
    const World world = world_of(grid);
    const std::vector<Ray> rays = mixed_rays(world, bounds_of(grid), run.amount(8'192, 1'000'000), run.seed());
    run.devices().take_warnings();
    run.measure(world, rays, {.params = {{"vertex", setting}}, .reps = 1});
    const std::vector<std::string> warnings = run.devices().take_warnings();
    const std::string sentence = text(count_non_finite_triangles(grid), " of ", grid.triangles.size(), " triangles");
    const auto counts = [&](const std::string& warning) { return warning.find(sentence) != std::string::npos; };
    // Each accelerator warns when the mesh is pushed.
    std::set<std::pair<Backend, Level>> accels;
    for (const Configuration& configuration : run.configurations())
        accels.emplace(configuration.backend, Devices::level_to_make(configuration));
    const auto warned = static_cast<std::size_t>(std::count_if(warnings.begin(), warnings.end(), counts));
    for (const Configuration& configuration : run.one_configuration_each())
        run.expect(configuration,
                   {.params = {{"vertex", setting}, {"measured", "warning"}},
                    .faults = warned == accels.size() ? 0u : 1u,
                    .what = text(warned, " warnings say '", sentence, "', ", accels.size(), " were expected"),
                    .fault_of = "twinray"});
}

// An input that must be refused, and a part of the error's text.
struct WrongUse {
    const char* what;
    const char* named;
    std::function<void(AbstractAccel&)> use;
};

std::vector<WrongUse> wrong_uses() {
    const auto box = [] { return make_box(vec3(0), vec3(1)); };
    return {
        {"index out of range", "24",
         [=](AbstractAccel& accel) {
             Mesh mesh = box();
             mesh.triangles[5].y = static_cast<uint>(mesh.positions.size());
             accel.push(mesh);
         }},
        {"options for other than each instance", "1",
         [=](AbstractAccel& accel) {
             const std::array<Transform, 2> transforms;
             const std::array<InstanceOptions, 1> options;
             accel.push(box(), transforms, options);
         }},
        {"transforms for other than each instance", "2",
         [=](AbstractAccel& accel) {
             const std::array<Transform, 2> transforms;
             accel.update_transforms(accel.push(box()), transforms);
         }},
        {"vertices other than the mesh's", "3",
         [=](AbstractAccel& accel) {
             const std::array<vec3, 3> positions{};
             accel.update_vertices(accel.push(box()), positions);
         }},
        {"instance out of range", "7",
         [=](AbstractAccel& accel) { accel.update_transform_at(accel.push(box()), 7, {}); }},
        {"custom index over 24 bits", "16777216",
         [=](AbstractAccel& accel) { accel.push(box(), Transform(), {.custom_index = 1u << 24}); }},
        {"dead handle", "not alive",
         [=](AbstractAccel& accel) {
             const AccelHandle handle = accel.push(box());
             accel.erase(handle);
             accel.update(handle, box());
         }},
        {"view with edits pending", "pending",
         [=](AbstractAccel& accel) {
             accel.push(box());
             static_cast<void>(accel.view());
         }},
        {"stale view", "stale",
         [=](AbstractAccel& accel) {
             accel.sync();
             const AccelView view = accel.view();
             accel.push(box());
             accel.sync();
             Commands commands(accel.context(), "wrong use");
             accel.trace(commands, view, {.count = 1});
         }},
        {"misaligned address of rays", "aligned",
         [=](AbstractAccel& accel) {
             accel.sync();
             Commands commands(accel.context(), "wrong use");
             accel.trace(commands, accel.view(), {.rays = {2}, .hits = {4}, .count = 1});
         }},
    };
}

Hit hit_of_a_box(AbstractAccel& accel) {
    accel.push(make_box(vec3(0), vec3(1)));
    const Ray down{vec3(0.3f, 0.4f, 5), 0, vec3(0, 0, -1), inf};
    return accel.closest_hits(std::span(&down, 1)).front();
}

void expect_refused(CaseRun& run, const std::vector<WrongUse>& uses) {
    for (const Configuration& configuration : run.one_configuration_each()) {
        const Hit before = hit_of_a_box(run.devices().empty_accel(configuration));
        CaseRun::Outcome outcome{.n = uses.size(), .fault_of = "twinray"};
        for (const WrongUse& wrong : uses) {
            AbstractAccel& accel = run.devices().empty_accel(configuration);
            const std::string error = faults::what_is_thrown_by([&] { wrong.use(accel); });
            if (error.find(wrong.named) == std::string::npos && outcome.faults++ == 0)
                outcome.what = text(wrong.what, ": ", error.empty() ? "not refused" : error);
        }
        // Refused use leaves nothing behind: the next scene is answered as before.
        const Hit after = hit_of_a_box(run.devices().empty_accel(configuration));
        if (!same_bits(before, after)) outcome.faults++, outcome.what += " afterwards a box is hit elsewhere";
        run.expect(configuration, outcome);
    }
}

}  // namespace

void vertex_not_a_number_in_x(CaseRun& run) { spoiled_vertex(run, 0, nan, "NaN in x"); }

void vertex_not_a_number_in_y_or_z(CaseRun& run) {
    spoiled_vertex(run, 1, nan, "NaN in y");
    spoiled_vertex(run, 2, nan, "NaN in z");
}

void infinite_vertex(CaseRun& run) {
    spoiled_vertex(run, 0, inf, "infinity in x");
    spoiled_vertex(run, 2, -inf, "-infinity in z");
}

void wrong_use(CaseRun& run) { expect_refused(run, wrong_uses()); }

void empty_and_small(CaseRun& run) {
    const std::size_t count = run.amount(2'048, 100'000);
    const Mesh empty = make_soup(0, 1), box = make_box(vec3(0), vec3(1));
    for (const uint triangles : {0u, 1u, 2u}) {
        const Mesh soup = make_soup(triangles, 5, 0.5f);
        run.measure(world_of(soup), random_rays(bounds_of(soup), count, run.seed()),
                    {.params = {{"triangles", triangles}}, .reps = 1});
    }
    run.measure(
        {[](AbstractAccel&) {}, ReferenceScene(std::span<const MeshView>(), std::span<const ReferenceInstance>())},
        random_rays({}, count, run.seed()), {.params = {{"instances", 0}}, .reps = 1});
    Scene mixed;
    mixed.meshes = {empty, box, empty};
    for (uint i = 0; i < 9; ++i)
        mixed.instances.push_back({"", i / 3, Transform::translation(vec3(1.5f * static_cast<float>(i), 0, 0))});
    run.measure(world_of(mixed), random_rays(bounds_of(mixed), count, run.seed()),
                {.params = {{"instances", "of an empty mesh among others"}}, .reps = 1});
}

// Returns `count` items with all bytes 0, in memory that takes no space until it is read: refused input is not read.
template <class T>
std::span<const T> zeros(std::size_t count, std::unique_ptr<void, decltype(&std::free)>& memory) {
    memory.reset(std::calloc(count, sizeof(T)));
    if (!memory) fail("no memory for ", count, " items");
    return {static_cast<const T*>(memory.get()), count};
}

void too_many(CaseRun& run) {
    constexpr std::size_t limit = Geometry::max_primitives + 1;
    std::unique_ptr<void, decltype(&std::free)> triangle_memory(nullptr, &std::free), box_memory(nullptr, &std::free);
    const auto triangles = zeros<uvec3>(limit, triangle_memory);
    const auto boxes = zeros<Bounds>(limit, box_memory);
    std::vector<WrongUse> uses = {{"2^25 triangles", "33554431",
                                   [&](AbstractAccel& accel) {
                                       const std::array<vec3, 3> vertices{};
                                       accel.push(MeshView("huge", vertices, triangles));
                                   }},
                                  {"2^25 boxes", "33554431", [&](AbstractAccel& accel) {
                                       accel.push(BoxesView{"huge", boxes});
                                   }}};
    if (run.amount(0, 1))  // takes 2 GiB on the host
        uses.push_back({"2^24 instances", "16777215", [](AbstractAccel& accel) {
                            accel.push(make_box(vec3(0), vec3(1)), std::vector<Transform>(max_instances + 1));
                            accel.sync();
                        }});
    expect_refused(run, uses);
}

// Uses 24 unit squares in a row, which face +z before they are mirrored or turned.
void masks_and_culling(CaseRun& run) {
    const Mesh square = make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0));
    constexpr std::array<std::uint8_t, 3> masks = {0x00, 0x01, 0xfe};
    std::vector<Transform> transforms;
    std::vector<InstanceOptions> options;
    std::vector<ReferenceInstance> instances;
    std::vector<Ray> rays;
    for (uint i = 0; i < 24; ++i) {
        const float x = 2 * static_cast<float>(i);
        const bool is_mirrored = i & 1;
        transforms.push_back(Transform::translation({x, 0, 0}) *
                             Transform::scaling({1, 1, is_mirrored ? -1.0f : 1.0f}));
        options.push_back({.mask = masks[i / 8], .disable_culling = (i & 2) != 0, .flip_facing = (i & 4) != 0});
        instances.push_back({0, transforms.back(), options.back()});
        for (const float side : {5.0f, -5.0f}) rays.push_back({vec3(x + 0.3f, 0.4f, side), 0, vec3(0, 0, -side), inf});
    }
    const MeshView view = square;
    const ReferenceScene reference(std::span(&view, 1), instances);
    for (const Configuration& configuration : run.configurations()) {
        AbstractAccel& accel = run.devices().empty_accel(configuration);
        accel.push(square, transforms, options);
        CaseRun::Outcome outcome{.n = 0, .reference = "f64"};
        for (const Cull cull : {Cull::none, Cull::back, Cull::front})
            for (const std::uint8_t mask : std::array<std::uint8_t, 4>{0x01, 0x02, 0xff, 0x00}) {
                const std::vector<Hit> hits =
                    accel.closest_hits(rays, {.mask = mask, .cull = cull, .level = configuration.level});
                for (std::size_t i = 0; i < rays.size(); ++i, ++outcome.n) {
                    const ReferenceHit expected = reference.closest_hit(rays[i], {mask, flags_of(cull)});
                    const bool is_right = (hits[i].hit != 0) == expected.hit &&
                                          (!expected.hit || hits[i].instance_index == expected.instance);
                    if (!is_right && outcome.faults++ == 0)
                        outcome.what = text("instance ", i / 2, " from side ", i % 2, ", mask ", int{mask}, ", cull ",
                                            static_cast<int>(cull), ": ", expected.hit ? "missed" : "hit");
                }
            }
        run.expect(configuration, outcome);
    }
}

}  // namespace twinray::suite
