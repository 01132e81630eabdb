// Structure: meshes from which trees are built, and rays that must find everything in them. Refits are in
// builds_refit.cpp.
#include "report/suite/sections.h"

#include <bit>

#include <twinray/tlas.h>
#include "engine/accel/geometry.h"
#include "engine/core/context.h"
#include "swtlas/tree.h"
#include "swtlas/plan.h"
#include "validation/cpu_reference/reference.h"

namespace twinray::suite {
namespace {

// Returns the depth that the traversal's stack allows: 60 bits of Morton codes, then the position among equal codes.
uint depth_limit(std::size_t leaves) { return 60 + static_cast<uint>(std::bit_width(leaves)); }

TreeCheck check_tree(AbstractAccel& accel, const Mesh& mesh) {
    const AccelHandle handle = accel.push(mesh);
    accel.sync();
    const BuiltTree tree = download_geometry(dynamic_cast<SwTlas&>(accel), handle);
    const std::vector<LeafBox> by_primitive =
        reference::leaves_triangles(Geometry(mesh, software_unit(mesh.positions)).built_positions(), mesh.triangles);
    if (!tree.records.empty()) return check_tree(tree.bvh, tree.records, by_primitive);
    std::vector<LeafBox> boxes;
    for (const BvhTriangle& triangle : tree.triangles) boxes.push_back(by_primitive.at(triangle.primitive_index));
    return check_tree(tree.bvh, tree.nodes, boxes);
}

void measure_and_check(CaseRun& run, const Mesh& mesh, std::span<const Ray> rays, const Values& params) {
    run.measure(world_of(mesh), rays, {.params = params});
    expect_sound_tree(run, mesh, params);
}

// Builds triangles of different sizes around one centroid, and copies of one triangle.
void equal_centroids(CaseRun& run) {
    const std::size_t count = run.amount(500, 100'000);
    const std::size_t rays = run.amount(1'024, 16'384);
    Mesh nested, copies = make_soup(1, 2);
    for (std::size_t i = 0; i < count; ++i) {
        const float size = 1 + static_cast<float>(i) / static_cast<float>(count);
        add_triangle(nested, vec3(-size, -size, 0), vec3(size, -size, 0), vec3(0, size, 0));
        if (i) copies.triangles.push_back(copies.triangles.front());
    }
    measure_and_check(run, nested, random_rays(bounds_of(nested), rays, run.seed()), {{"triangles", "nested"}});
    measure_and_check(run, copies, random_rays(bounds_of(copies), rays, run.seed()), {{"triangles", "copies"}});
}

// Triangle k has size and position 2^k: each is alone in its half of the rest. One ray aims at each, from above.
void geometric_series(CaseRun& run) {
    Mesh chain;
    std::vector<Ray> rays;
    for (int k = -60; k < 60; ++k) {
        const float size = std::ldexp(1.0f, k);
        add_triangle(chain, vec3(size, 0, 0), vec3(1.5f * size, 0, 0), vec3(size, 0.5f * size, 0));
        rays.push_back({vec3(1.125f * size, 0.125f * size, size), 0, vec3(0, 0, -1), inf});
    }
    measure_and_check(run, chain, rays, {});
}

void lines_and_planes(CaseRun& run) {
    const std::size_t rays = run.amount(2'048, 200'000);
    Mesh line;
    const std::size_t count = run.amount(2'000, 100'000);
    for (std::size_t i = 0; i < count; ++i) {
        const float x = static_cast<float>(i);
        add_triangle(line, vec3(x, -1, -1), vec3(x, 1, -1), vec3(x, 0, 1));
    }
    const Mesh plane = make_grid(64, 64);
    measure_and_check(run, line, random_rays(bounds_of(line), rays, run.seed()), {{"centroids", "on a line"}});
    measure_and_check(run, plane, edge_aimed_rays(world_of(plane).reference, rays, run.seed()),
                      {{"centroids", "in a plane"}});
}

// Puts all triangles but one far away into one cell of the Morton grid.
void morton_cluster(CaseRun& run) {
    const auto count = static_cast<uint>(run.amount(5'000, 1'000'000));
    Mesh cluster = make_soup(count, 9, 0.01f);
    Bounds middle = bounds_of(cluster);
    const std::vector<Ray> rays = random_rays(middle, run.amount(512, 16'384), run.seed());
    run.measure(world_of(cluster), rays, {.params = {{"outlier", "none"}}});
    add_triangle(cluster, vec3(1e6f), vec3(1e6f + 1, 1e6f, 1e6f), vec3(1e6f, 1e6f + 1, 1e6f));
    measure_and_check(run, cluster, rays, {{"outlier", "at 1e6"}});
}

// Uses vertices at +-1e18 and at the end of float32.
void huge_extents(CaseRun& run) {
    for (const float extent : {1e18f, 3e38f}) {
        Mesh mesh;
        Random random(4);
        const auto coordinate = [&] { return extent * random.between(-1, 1); };
        for (int i = 0; i < 64; ++i) {
            vec3 vertices[3];
            for (vec3& vertex : vertices) vertex = extent * random.in_box(1);
            add_triangle(mesh, vertices[0], vertices[1], vertices[2]);
        }
        std::vector<Ray> rays;
        for (std::size_t i = 0; i < run.amount(1'024, 100'000); ++i) {
            vec3 target(coordinate(), coordinate(), coordinate()), origin(coordinate(), coordinate(), coordinate());
            rays.push_back({origin * 0.5f, 0, target * (1 / extent) - origin * (0.5f / extent), inf});
        }
        measure_and_check(run, mesh, rays, {{"extent", extent}});
    }
}

// Each halving of the distance to the origin costs a bit of the Morton code, and copies at the origin share them all.
void deep_tree(CaseRun& run) {
    Mesh mesh;
    std::vector<Ray> rays;
    const auto add = [&](float at, float size) {
        add_triangle(mesh, vec3(at), vec3(at + size, at, at), vec3(at, at + size, at));
    };
    for (int bit = 0; bit <= 10; ++bit)
        for (int axis = 0; axis < 3; ++axis) {
            const float at = std::ldexp(1.0f, -bit);
            add(at, at * (0.1f + 0.1f * static_cast<float>(axis)));
            rays.push_back({vec3(at * 1.02f, at * 1.02f, 2), 0, vec3(0, 0, -1), inf});
        }
    for (std::size_t copies = run.amount(4'096, 1 << 20); copies > 0; --copies) add(0, 1e-5f);
    rays.push_back({vec3(1e-6f, 1e-6f, 2), 0, vec3(0, 0, -1), inf});
    measure_and_check(run, mesh, rays, {{"copies", run.amount(4'096, 1 << 20)}});
}

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

// Compares nodes and hits of our builds, and only hits of the driver's, because its nodes are hidden.
void repeated_builds(CaseRun& run) {
    constexpr std::size_t builds = 10;
    const Mesh mesh = make_soup(static_cast<uint>(run.amount(5'000, 500'000)), 21);
    const std::vector<Ray> rays = random_rays(bounds_of(mesh), run.amount(1'024, 100'000), run.seed());
    for (const Configuration& configuration : run.one_configuration_each()) {
        BuiltTree first{};
        std::vector<Hit> hits;
        CaseRun::Outcome outcome{.params = {{"compared", is_ours(configuration.backend) ? "nodes and hits" : "hits"}},
                                 .n = builds,
                                 .what = "a build differs from the first",
                                 .reference = "invariance"};
        for (std::size_t i = 0; i < builds; ++i) {
            AbstractAccel& accel = run.devices().empty_accel(configuration);
            const AccelHandle handle = accel.push(mesh);
            const std::vector<Hit> now = accel.closest_hits(rays, {.level = configuration.level});
            const auto* software = dynamic_cast<SwTlas*>(&accel);
            const BuiltTree tree = software ? download_geometry(*software, handle) : BuiltTree{};
            if (i == 0) first = tree, hits = now;
            if (!same_bytes(first.nodes, tree.nodes) || !same_bytes(first.records, tree.records) ||
                !same_bytes(hits, now))
                ++outcome.faults;
        }
        run.expect(configuration, outcome);
    }
}

void sound_trees(CaseRun& run) {
    Mesh holes = make_soup(static_cast<uint>(run.amount(3'000, 100'000)), 31);
    for (std::size_t i = 0; i < holes.positions.size(); i += 7) holes.positions[i].x = NAN;
    expect_sound_tree(run, holes, {{"mesh", "soup with NaN"}});
    expect_sound_tree(run, make_icosphere(static_cast<uint>(run.amount(5, 8))), {{"mesh", "icosphere"}});
    expect_sound_tree(run, make_grid(100, 100, 0.2f, 3), {{"mesh", "height field"}});
}

// Uses meshes with boxes that are far from the origin for their size, flat, or of very different sizes in one node.
void quantised_nodes(CaseRun& run) {
    std::vector<std::pair<std::string, Mesh>> meshes = {{"height field", make_grid(60, 60, 0.2f, 3)}};
    for (const int exponent : {0, 8, 16, 22}) {
        const Mesh soup = make_soup(static_cast<uint>(run.amount(1'000, 100'000)), 17, 0.1f);
        meshes.push_back(
            {text("soup of size 2 near 2^", exponent), moved(soup, std::ldexp(1.0f, exponent) * vec3(1, -0.7f, 0.3f))});
    }
    Mesh sizes = make_soup(static_cast<uint>(run.amount(1'000, 100'000)), 18);
    for (std::size_t i = 0; i < sizes.positions.size(); ++i)
        sizes.positions[i] *= std::ldexp(1.0f, -static_cast<int>(i / 3 % 60));
    meshes.push_back({"sizes from 1 to 2^-59", std::move(sizes)});
    for (const Configuration& configuration : run.one_configuration_each()) {
        if (!is_ours(configuration.backend)) continue;
        for (const auto& [name, mesh] : meshes) {
            const TreeCheck tree = check_tree(run.devices().empty_accel(configuration, Layout::compressed4), mesh);
            run.expect(configuration, {.params = {{"mesh", name}},
                                       .results = {{"depth", tree.depth}, {"sah", tree.sah}},
                                       .n = mesh.triangles.size(),
                                       .faults = tree.violations.size(),
                                       .what = tree.violations.empty() ? "sound" : tree.violations.front()});
        }
    }
}

// Each of these sizes gives another shape of tree.
void small_sizes(CaseRun& run) {
    std::map<std::pair<Backend, Level>, CheckResult> sums;
    std::vector<Configuration> configurations = run.configurations();
    const uint step = static_cast<uint>(run.amount(7, 1));
    for (uint n = 1; n <= 300; n += n < 16 ? 1 : step) {
        const Mesh soup = make_soup(n, n, 0.4f);
        const World world = world_of(soup);
        const std::vector<Ray> rays = random_rays(bounds_of(soup), 64, run.seed() + n);
        for (const Traced& traced : trace(run.devices(), configurations, world, {.rays = rays, .reps = 0})) {
            const auto& [backend, level] = traced.configuration;
            sums[{backend, level}] += check(world.reference, rays, traced.hits, backend);
        }
    }
    for (const Configuration& configuration : configurations)
        run.add_checked(configuration, sums[{configuration.backend, configuration.level}]);
}

// Hits do not depend on the tree.
void layouts_and_qualities(CaseRun& run) {
    Mesh mesh = make_grid(48, 48, 0.2f, 5);
    append(mesh, make_soup(500, 7));
    const World world = world_of(mesh);
    const std::vector<Ray> rays = mixed_rays(world, bounds_of(mesh), run.amount(2'048, 500'000), run.seed());
    for (const Configuration& configuration : run.one_configuration_each()) {
        if (!is_ours(configuration.backend)) continue;
        AbstractAccel& usual = run.devices().empty_accel(configuration, Layout::compressed4);
        usual.push(mesh);
        const std::vector<Hit> expected = usual.closest_hits(rays, {.level = configuration.level});
        for (const Layout layout : all_layouts)
            for (const BuildQuality quality : all_build_qualities) {
                if (layout != Layout::compressed4 && quality != BuildQuality::fast) continue;
                AccelOptions options = run.devices().options(configuration, layout);
                options.build_quality = quality;
                const auto accel =
                    Devices::make_accel(run.devices().context(configuration.backend), configuration.backend, options);
                accel->push(mesh);
                const std::vector<Hit> hits = accel->closest_hits(rays, {.level = configuration.level});
                std::uint64_t differ = 0;
                for (std::size_t i = 0; i < rays.size(); ++i) differ += !same_bits(hits[i], expected[i]);
                run.expect(configuration, {.params = {{"layout", std::string(name_of(layout))},
                                                      {"quality", std::string(name_of(quality))}},
                                           .n = rays.size(),
                                           .faults = differ,
                                           .what = "hits differ from those of the usual tree",
                                           .reference = "invariance"});
            }
    }
}

// ---- Kernels in their shapes for GPUs and for CPU drivers (engine/core/kernel_tuning.h), both on this device.

std::vector<Hit> hits_of(AbstractAccel& accel, const World& world, std::span<const Ray> rays, Query query,
                         Level level) {
    for (const AccelHandle handle : accel.handles()) accel.erase(handle);
    world.fill(accel);
    const TraceDesc desc{.level = level};
    return query == Query::any ? accel.any_hits(rays, desc) : accel.closest_hits(rays, desc);
}

// Returns a context with the row that the suite's own context does not use.
ContextDesc of_other_shape(Devices& devices) {
    ContextDesc desc = devices.desc(Backend::software);
    const bool is_for_gpu = devices.context(Backend::software).state().tuning().row == TuningRow::gpu;
    desc.tuning = is_for_gpu ? TuningRow::cpu_driver : TuningRow::gpu;
    return desc;
}

// Makes triangles that share edges, some that overlap and need a long stack, and mirrored and flat instances.
std::vector<std::pair<std::string, World>> shaped_worlds(CaseRun& run) {
    Scene many;
    many.meshes = {make_icosphere(2), make_soup(400, 3, 0.3f)};
    Random random(run.seed());
    for (uint i = 0; i < 60; ++i) {
        const vec3 size(random.between(-1, 1), 0.7f, i % 5 ? 1 : -1e-3f);
        many.instances.push_back({"", i % 2, Transform::translation(random.in_box(2)) * Transform::scaling(size)});
    }
    std::ranges::stable_sort(many.instances, {}, &Instance::mesh);
    return {{"sphere", world_of(make_icosphere(static_cast<uint>(run.amount(4, 7))))},
            {"soup", world_of(make_soup(static_cast<uint>(run.amount(3'000, 300'000)), 7, 0.8f))},
            {"instances", world_of(many)}};
}

void expect_same_hits(CaseRun& run, Context& other_context, const Configuration& configuration, Layout layout) {
    Devices& devices = run.devices();
    AbstractAccel& own = devices.empty_accel(configuration, layout);
    const auto other = Devices::make_accel(other_context, Backend::software, devices.options(configuration, layout));
    for (const auto& [name, world] : shaped_worlds(run)) {
        // These are more than a group has, so that invocations have several if a shape gives them more than one.
        const std::vector<Ray> rays = random_rays({vec3(-2), vec3(2)}, run.amount(8'192, 1'000'000), run.seed());
        CaseRun::Outcome outcome{
            .params = {{"scene", name}, {"layout", std::string(name_of(layout))}}, .n = 0, .reference = "invariance"};
        std::size_t hits = 0;
        for (const Query query : {Query::closest, Query::any}) {
            const std::vector<Hit> by_own = hits_of(own, world, rays, query, configuration.level);
            const std::vector<Hit> by_other = hits_of(*other, world, rays, query, configuration.level);
            for (std::size_t i = 0; i < rays.size(); ++i, ++outcome.n) {
                hits += by_own[i].hit;
                if (!same_bits(by_own[i], by_other[i]) && outcome.faults++ == 0)
                    outcome.what = "hits differ of " + hexadecimal(rays[i]);
            }
        }
        outcome.results = {{"hits", hits}};
        run.expect(configuration, outcome);
    }
}

void both_shapes_of_kernels(CaseRun& run) {
    Context other(of_other_shape(run.devices()));
    for (const Configuration& configuration : run.is_whole() ? run.configurations() : run.one_configuration_each()) {
        if (!is_ours(configuration.backend)) continue;
        expect_same_hits(run, other, configuration, run.devices().trees().layout);
        if (!run.is_whole()) continue;
        for (const Layout layout : all_layouts)
            if (layout != run.devices().trees().layout) expect_same_hits(run, other, configuration, layout);
    }
}

}  // namespace

void expect_sound_tree(CaseRun& run, const Mesh& mesh, Values params) {
    for (const Configuration& configuration : run.one_configuration_each()) {
        if (!is_ours(configuration.backend)) continue;  // the driver shows no tree
        const TreeCheck tree = check_tree(run.devices().empty_accel(configuration), mesh);
        const bool is_deep = tree.depth > depth_limit(mesh.triangles.size());
        params.insert_or_assign("measured", "tree");
        run.expect(configuration,
                   {.params = params,
                    .results = {{"depth", tree.depth}, {"sah", tree.sah}},
                    .n = mesh.triangles.size(),
                    .faults = tree.violations.size() + (is_deep ? 1u : 0u),
                    .what = tree.violations.empty() ? text("depth ", tree.depth) : tree.violations.front()});
    }
}

std::vector<SuiteCase> build_cases() {
    return {
        {"B01", "all centroids equal: nested triangles, and copies of one", "hits, tree",
         "0 faults; depth at most 30 + ceil(log2 n) + 1", equal_centroids},
        {"B02", "a geometric series of triangles, 2^-60 to 2^59, as one chain", "hits, tree",
         "each of the 120 is found", geometric_series},
        {"B03", "centroids on a line and in a plane", "hits, tree", "0 faults", lines_and_planes},
        {"B04", "all triangles in one cell of the Morton grid, beside an outlier at 1e6", "hits, tree, time",
         "0 faults; the time beside that without the outlier is measured", morton_cluster},
        {"B05", "extents of 1e18 and 3e38", "hits, tree", "0 faults: no overflow in centroid or extent", huge_extents},
        {"B06", "refits after many random moves of vertices and of instances", "hits beside those of a rebuild, SAH",
         "the same hits; the growth of the SAH is measured", refit_many_times},
        {"B07", "all vertices moved to one point by refit, and back", "hits beside those of a rebuild",
         "no hit in between, the same hits after", refit_collapse},
        {"B08", "the deepest tree that Morton codes and copies give", "hits, depth", "0 faults; no push is lost",
         deep_tree},
        {"B09", "ten builds of one mesh", "nodes, hits", "equal to the last bit", repeated_builds},
        {"B10", "every child inside its parent, every triangle once, no cycles", "violations", "0", sound_trees},
        {"B11", "quantised nodes contain the exact boxes", "violations", "0", quantised_nodes},
        {"B12", "1 to 300 triangles", "hits", "0 faults", small_sizes},
        {"B13", "the same rays by kernels shaped for GPUs and for CPU drivers: groups, stacks, loads and builds",
         "hits that differ in a bit", "0", both_shapes_of_kernels},
        {"B14", "one mesh in every layout, and by every build quality",
         "hits that differ in a bit from the usual tree's", "0", layouts_and_qualities},
        {"B15", "skins and morph targets on the device: weights of 0 for what is not finite, an axis scaled by 0",
         "vertices, hits", "vertices as in float64 within 32 roundings; 0 SW_LEAK, SW_FALSE, T_ERR",
         deformed_meshes_on_device},
        {"B16", "a thousand meshes and more, pushed, moved, bent, erased, saved and loaded", "hits",
         "0 SW_LEAK, SW_FALSE, T_ERR", long_histories},
    };
}

}  // namespace twinray::suite
