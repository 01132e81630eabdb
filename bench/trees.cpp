// Measures trees of each layout and build quality for `twinray bench`, by counts that are the same on every device.
#include "bench/command.h"

#include <algorithm>
#include <mutex>

#include "bench/report.h"
#include "engine/core/error.h"
#include "engine/core/parallel.h"
#include "swtlas/plan.h"
#include "swtlas/tree.h"
#include "validation/cpu_reference/reference.h"
#include "validation/cpu_reference/reference_scene.h"

namespace twinray::bench {
namespace {

// Steps of a ray, on average.
struct RaySteps {
    double nodes = 0;       // fetched
    double boxes = 0;       // tested
    double leaves = 0;      // fetched
    double primitives = 0;  // tested in full
};

// The tree of a scene whose instances are joined to one mesh.
struct TreeFigures {
    Layout layout;
    BuildQuality quality;
    double bytes = 0;       // per triangle, of what is kept of the tree and its triangles
    double used_bytes = 0;  // the same for what a traversal can reach
    double sah = 0;         // surface-area cost of its boxes as rays meet them, over that of the root
    double overlap = 0;     // end-point overlap
    std::map<RayKind, RaySteps> steps;
};

std::size_t bytes_kept(const BuiltTree& tree) {
    return tree.nodes.size() * sizeof(BvhNode) + tree.triangles.size() * sizeof(BvhTriangle) +
           tree.records.size() * sizeof(CompressedRecord) + tree.vertices.size() * sizeof(vec3);
}

std::size_t bytes_used(const BuiltTree& tree) {
    const auto used = static_cast<std::size_t>(
        std::ranges::count_if(tree.records, [](const CompressedRecord& record) { return !is_none(record); }));
    return bytes_kept(tree) - (tree.records.size() - used) * sizeof(CompressedRecord);
}

// Boxes count as rays meet them.
double sah_of(const BuiltTree& tree, const Mesh& mesh) {
    std::vector<LeafBox> boxes;
    if (tree.records.empty()) {
        for (const BvhTriangle& triangle : tree.triangles) boxes.push_back(box_of_triangle(triangle));
        return check_tree(tree.bvh, tree.nodes, boxes).sah;
    }
    const Geometry built(mesh, software_unit(mesh.positions));
    boxes = reference::leaves_triangles(built.built_positions(), built.triangles);
    return check_tree(tree.bvh, tree.records, boxes).sah;
}

TreeFigures figures_of_tree(Context& context, const Mesh& mesh, Layout layout, BuildQuality quality) {
    SwTlas accel(context, {.layout = layout, .build_quality = quality, .can_move = false});
    const AccelHandle handle = accel.push(mesh);
    accel.sync();
    const BuiltTree tree = download_geometry(accel, handle);
    const auto triangles = static_cast<double>(std::max<std::size_t>(mesh.triangles.size(), 1));
    return {layout,
            quality,
            static_cast<double>(bytes_kept(tree)) / triangles,
            static_cast<double>(bytes_used(tree)) / triangles,
            sah_of(tree, mesh),
            reference::end_point_overlap(tree),
            {}};
}

struct Followed {
    RaySteps steps;
    std::size_t hits = 0;
};

Followed follow(const reference::Scene& scene, std::span<const Ray> rays, Query query) {
    TraversalSteps all;
    std::size_t hits = 0;
    std::mutex mutex;
    parallel_for(rays.size(), [&](std::size_t begin, std::size_t end) {
        std::size_t found = 0;
        reference::Scene::take_steps();
        for (std::size_t i = begin; i < end; ++i)
            found += scene.trace(rays[i], query == Query::any ? QUERY_ANY : QUERY_CLOSEST).hit;
        const std::lock_guard lock(mutex);
        hits += found;
        const TraversalSteps steps = reference::Scene::take_steps();
        all.nodes += steps.nodes;
        all.boxes += steps.boxes;
        all.leaves += steps.leaves;
        all.primitives += steps.primitives;
    });
    const auto a_ray = [&](std::uint64_t count) {
        return static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(rays.size(), 1));
    };
    return {{a_ray(all.nodes), a_ray(all.boxes), a_ray(all.leaves), a_ray(all.primitives)}, hits};
}

// Measures trees of every layout and quality. SwTlas builds and measures them; its CPU reference follows rays, at level
// watertight. Throws Error if trees differ in how many rays hit.
std::vector<TreeFigures> measure_trees(Context& context, const BenchScene& scene, std::span<const RayKind> kinds,
                                       uint width, std::uint64_t seed) {
    const Mesh mesh = joined(scene.scene, scene.name);
    const auto rays = make_rays(context, scene, width, seed);
    std::vector<TreeFigures> trees;
    std::map<RayKind, std::size_t> hits;
    for (const Layout layout : all_layouts)
        for (const BuildQuality quality : all_build_qualities) {
            TreeFigures figures = figures_of_tree(context, mesh, layout, quality);
            reference::Scene on_host(layout, quality);
            on_host.add_instance(on_host.add_geometry(mesh), make_instance_record(Transform{}, {}));
            on_host.build();
            for (const RayKind kind : kinds) {
                const Followed followed = follow(on_host, rays[static_cast<std::size_t>(kind)], query_of(kind));
                figures.steps[kind] = followed.steps;
                if (hits.emplace(kind, followed.hits).first->second != followed.hits)
                    fail("bench: layout ", name_of(layout), ", build quality ", name_of(quality), ": ", followed.hits,
                         " of the ", name_of(kind), " rays hit, of other trees ", hits[kind]);
            }
            trees.push_back(std::move(figures));
        }
    return trees;
}

void print_trees(std::ostream& out, std::span<const TreeFigures> trees) {
    std::vector<std::string> heading = {"tree", "bytes/triangle", "used", "SAH", "overlap"};
    if (!trees.empty())
        for (const auto& [kind, steps] : trees.front().steps)
            for (const char* what : {"nodes", "boxes", "leaves", "triangles"})
                heading.push_back(text(name_of(kind), ' ', what));
    std::vector<std::vector<std::string>> rows = {heading};
    for (const TreeFigures& tree : trees) {
        std::vector<std::string> row = {text(name_of(tree.layout), ' ', name_of(tree.quality)),
                                        fixed_text(tree.bytes, 1), fixed_text(tree.used_bytes, 1),
                                        number_text(tree.sah, 3), number_text(tree.overlap, 3)};
        for (const auto& [kind, steps] : tree.steps)
            for (const double count : {steps.nodes, steps.boxes, steps.leaves, steps.primitives})
                row.push_back(number_text(count, 3));
        rows.push_back(std::move(row));
    }
    print_table(out, rows);
}

void record_trees(const Session& session, const nlohmann::json& base, std::span<const TreeFigures> trees) {
    for (const TreeFigures& tree : trees) {
        nlohmann::json record = base;
        record.update({{"schema", record_schema},
                       {"kind", "tree"},
                       {"layout", name_of(tree.layout)},
                       {"build_quality", name_of(tree.quality)},
                       {"bytes_per_triangle", tree.bytes},
                       {"used_bytes_per_triangle", tree.used_bytes},
                       {"sah", tree.sah},
                       {"end_point_overlap", tree.overlap}});
        for (const auto& [kind, steps] : tree.steps)
            record["steps_per_ray"][std::string(name_of(kind))] = {{"nodes", steps.nodes},
                                                                   {"boxes", steps.boxes},
                                                                   {"leaves", steps.leaves},
                                                                   {"triangles", steps.primitives}};
        session.record(record);
    }
}

}  // namespace

void bench_trees(const Session& session, const BenchScene& scene) {
    const RunOptions& run = session.run;
    Context context(session.device);
    session.out << "bench " << scene.name << ": trees over " << count_triangles(scene.scene)
                << " triangles as one mesh, " << run.width * run.width
                << " rays per set at level watertight, averages per ray\n";
    const std::vector<TreeFigures> trees = measure_trees(context, scene, run.kinds, run.width, run.seed);
    print_trees(session.out, trees);
    nlohmann::json base = base_record(session);
    base.update({{"scene", scene.name}, {"triangles", count_triangles(scene.scene)}});
    record_trees(session, base, trees);
}

}  // namespace twinray::bench
