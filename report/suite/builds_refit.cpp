// Refits: an accelerator that has moved many times answers like a new one.
#include "report/suite/sections.h"

#include <filesystem>
#include <unordered_map>

#include <twinray/tlas.h>
#include "engine/scene/rig.h"
#include "engine/core/files.h"

namespace twinray::suite {
namespace {

// Ties may be decided differently by a refit and a rebuild of a driver's tree, but t may not differ.
bool is_same(const Hit& a, const Hit& b, bool exactly) {
    if (exactly) return same_bits(a, b);
    return a.hit == b.hit && a.t == b.t;
}

struct Refitted {
    std::vector<Hit> refit = {}, rebuilt = {};
    std::optional<double> sah_ratio = {};  // of the refitted tree to that of a new one
    std::vector<double> refit_ms = {};
    double build_ms = 0;
};

void expect_same(CaseRun& run, const Configuration& configuration, const Refitted& refitted, const Values& params) {
    CaseRun::Outcome outcome{.params = params, .n = refitted.refit.size(), .reference = "invariance"};
    if (refitted.sah_ratio) outcome.results.emplace("sah_ratio", *refitted.sah_ratio);
    if (!refitted.refit_ms.empty()) {
        outcome.time = time_figures("ms_per_refit", refitted.refit_ms);
        outcome.time->phases_ms["build"] = refitted.build_ms;
    }
    for (std::size_t i = 0; i < refitted.refit.size(); ++i)
        if (!is_same(refitted.refit[i], refitted.rebuilt[i], is_ours(configuration.backend)) && outcome.faults++ == 0)
            outcome.what = text("ray ", i, " hits at t = ", refitted.refit[i].t, " after refits, at ",
                                refitted.rebuilt[i].t, " after a rebuild");
    run.expect(configuration, outcome);
}

std::optional<double> ratio(std::optional<double> refitted, std::optional<double> rebuilt) {
    if (!refitted || !rebuilt || !(*rebuilt > 0)) return std::nullopt;
    return *refitted / *rebuilt;
}

Refitted refit_vertices(CaseRun& run, const Configuration& configuration, Mesh mesh, std::size_t steps,
                        std::span<const Ray> rays) {
    Random random(run.seed());
    AbstractAccel& accel = run.devices().empty_accel(configuration);
    accel.set_rebuild_ratio(INFINITY);
    const AccelHandle handle = accel.push(mesh);
    accel.sync();
    Refitted result;
    for (std::size_t i = 0; i < steps; ++i) {
        for (vec3& position : mesh.positions) position += 0.01f * random.in_box(1);
        accel.update_vertices(handle, mesh.positions);
        accel.sync();
        result.refit_ms.push_back(total_ms(accel.build_timings()));
    }
    result.refit = accel.closest_hits(rays, {.level = configuration.level});
    const std::optional<double> refitted = accel.sah(handle);
    const std::unique_ptr<AbstractAccel> fresh = run.devices().make_accel(configuration);
    const AccelHandle again = fresh->push(mesh);
    result.rebuilt = fresh->closest_hits(rays, {.level = configuration.level});
    result.build_ms = total_ms(fresh->build_timings());
    fresh->update_vertices(again, mesh.positions);  // in place: its SAH is then measured
    fresh->sync();
    result.sah_ratio = ratio(refitted, fresh->sah(again));
    return result;
}

Refitted refit_instances(CaseRun& run, const Configuration& configuration, std::size_t steps,
                         std::span<const Ray> rays) {
    const Mesh mesh = make_icosphere(1, 0.05f);
    Random random(run.seed());
    std::vector<vec3> centers(200);
    for (vec3& center : centers) center = random.in_box(1);
    const auto transforms = [&] {
        std::vector<Transform> all;
        for (const vec3& center : centers) all.push_back(Transform::translation(center));
        return all;
    };
    AbstractAccel& accel = run.devices().empty_accel(configuration);
    accel.set_rebuild_ratio(INFINITY);
    const AccelHandle handle = accel.push(mesh, transforms());
    accel.sync();
    Refitted result;
    for (std::size_t i = 0; i < steps; ++i) {
        for (vec3& center : centers) center += 0.05f * random.in_box(1);
        accel.update_transforms(handle, transforms());
        accel.sync();
        result.refit_ms.push_back(total_ms(accel.build_timings()));
    }
    result.refit = accel.closest_hits(rays, {.level = configuration.level});
    const std::unique_ptr<AbstractAccel> fresh = run.devices().make_accel(configuration);
    fresh->push(mesh, transforms());
    result.rebuilt = fresh->closest_hits(rays, {.level = configuration.level});
    result.build_ms = total_ms(fresh->build_timings());
    result.sah_ratio = ratio(accel.sah(), fresh->sah());
    return result;
}

}  // namespace

void refit_many_times(CaseRun& run) {
    const std::size_t steps = run.amount(25, 10'000);
    const std::vector<Ray> rays = random_rays({vec3(-1), vec3(1)}, run.amount(2'048, 100'000), run.seed());
    for (const Configuration& configuration : run.one_configuration_each()) {
        for (const uint level : {1u, 2u, 3u, 4u}) {
            const Mesh mesh = make_icosphere(level);
            expect_same(run, configuration, refit_vertices(run, configuration, mesh, steps, rays),
                        {{"moved", "vertices"}, {"triangles", mesh.triangles.size()}});
        }
        expect_same(run, configuration, refit_instances(run, configuration, steps, rays), {{"moved", "instances"}});
        run.devices().drop_accels();  // their rebuild ratio was changed
    }
}

void refit_collapse(CaseRun& run) {
    const Mesh mesh = make_icosphere(4);
    const std::vector<vec3> one_point(mesh.positions.size(), vec3(0.25f));
    const std::vector<Ray> rays = vertex_aimed_rays(world_of(mesh).reference, run.amount(2'048, 100'000), run.seed());
    for (const Configuration& configuration : run.one_configuration_each()) {
        AbstractAccel& accel = run.devices().empty_accel(configuration);
        accel.set_rebuild_ratio(INFINITY);
        const AccelHandle handle = accel.push(mesh);
        Refitted result{.rebuilt = accel.closest_hits(rays, {.level = configuration.level})};
        accel.update_vertices(handle, one_point);
        CaseRun::Outcome collapsed{.params = {{"moved", "to a point"}}, .n = rays.size(), .what = "a point was hit"};
        for (const Hit& hit : accel.closest_hits(rays, {.level = configuration.level}))
            collapsed.faults += hit.hit != 0;
        run.expect(configuration, collapsed);
        accel.update_vertices(handle, mesh.positions);
        result.refit = accel.closest_hits(rays, {.level = configuration.level});
        expect_same(run, configuration, result, {{"moved", "back"}});
        run.devices().drop_accels();
    }
}

namespace {

// ---- Vertices that skins and morph targets move on the device, and refits to them.

// Errors are in 2^-24 of the mesh's size. A vertex is a dozen sums of numbers up to four times as large.
constexpr double most_error = 32;

// Returns joints of a sphere: one turns, one flattens it, one is at infinity and has no weight.
std::vector<Rig::Node> joints(float size, Random& random) {
    std::vector<Rig::Node> nodes(3);
    const auto part = [&] { return double{random.between(-0.5f, 0.5f)}; };
    nodes[0].rest.rotation = {part(), part(), part(), 1};
    nodes[0].rest.translation = dvec3(random.in_box(0.5f * size));
    nodes[1].rest.scale = {1, 0, 1};
    nodes[2].rest.translation = dvec3(INFINITY);
    return nodes;
}

// Returns displacements of two targets. The second ones are NaN; the pose takes half of the first and none of the
// second.
VertexMotion motion(std::size_t vertices, float size, Random& random) {
    VertexMotion motion;
    motion.targets.resize(2);
    motion.influences = 3;
    for (std::size_t i = 0; i < vertices; ++i) {
        motion.targets[0].positions.push_back(random.in_box(0.1f * size));
        motion.targets[1].positions.push_back(vec3(nan));
        const float turned = 0.25f * static_cast<float>(random.below(5));
        motion.joints.insert(motion.joints.end(), {0, 1, 2});
        motion.weights.insert(motion.weights.end(), {turned, 1 - turned, 0});
    }
    return motion;
}

std::shared_ptr<const Rig> rig_of(const Mesh& mesh, float size, std::uint64_t seed) {
    Random random(seed);
    auto rig = std::make_shared<Rig>();
    rig->nodes = joints(size, random);
    rig->nodes.emplace_back().weights = {0.5, 0};
    rig->skins.push_back({"skin", {0, 1, 2}, std::vector(3, glm::dmat4(1))});
    rig->meshes.push_back({.mesh = 0,
                           .node = 3,
                           .skin = 0,
                           .base = {mesh.positions, {}, {}},
                           .motion = motion(mesh.positions.size(), size, random)});
    return rig;
}

// Poses the mesh and moves the accelerator's to it. Keeps its buffers in `deformers`.
const Buffer& pose(AbstractAccel& accel, AccelHandle handle, const std::shared_ptr<const Rig>& rig,
                   std::vector<std::unique_ptr<Deformer>>& deformers) {
    Context& context = accel.context();
    Deformer& deformer = *deformers.emplace_back(std::make_unique<Deformer>(context, rig));
    Commands commands(context, "suite pose");
    deformer.record(commands, rest_pose(*rig));
    commands.submit();
    const Deformer::Output output = deformer.output(0);
    accel.update_vertices(handle, output.positions.ref<float>(), output.vertex_count);
    return output.positions;
}

CaseRun::Outcome outcome_of(std::span<const vec3> found, std::span<const vec3> right, float size) {
    CaseRun::Outcome outcome{.params = {{"size", size}}, .n = found.size(), .reference = "f64"};
    double largest = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const double error = length(dvec3(found[i]) - dvec3(right[i])) / (double{size} * 0x1p-24);
        largest = std::max(largest, error);
        if (!(error <= most_error) && outcome.faults++ == 0)
            outcome.what = text("vertex ", i, " is off by ", error, " of 2^-24 of the size");
    }
    outcome.results = {{"largest_error", largest}};
    return outcome;
}

}  // namespace

void deformed_meshes_on_device(CaseRun& run) {
    for (const float size : {1e-15f, 1.0f, 1e15f}) {
        Mesh mesh = scaled(make_icosphere(3), size);
        const Mesh bound = mesh;
        const std::shared_ptr<const Rig> rig = rig_of(mesh, size, run.seed());
        std::vector<std::unique_ptr<Deformer>> deformers;  // until all have traced
        const Configuration one = run.one_configuration_each().front();
        AbstractAccel& accel = run.devices().empty_accel(one);
        const Buffer& moved = pose(accel, accel.push(mesh), rig, deformers);
        mesh.positions = download<vec3>(accel.context(), moved, mesh.positions.size());
        accel.sync();
        run.expect(one, outcome_of(mesh.positions, deformed(*rig, 0, rest_pose(*rig)).positions, size));
        CaseRun::Outcome control = outcome_of(bound.positions, mesh.positions, size);
        control.control = "vertices that stay";
        run.expect(one, control);
        const World world{[&](AbstractAccel& to) { pose(to, to.push(bound), rig, deformers); },
                          world_of(mesh).reference};
        run.measure(world, mixed_rays(world, bounds_of(mesh), run.amount(1'024, 200'000), run.seed()),
                    {.params = {{"size", size}}, .reps = 1});
    }
}

namespace {

// ---- Many geometries that are pushed, moved and erased, and saved and loaded in between.

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
