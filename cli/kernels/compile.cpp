#include "cli/kernels/kernels.h"

#include <cmath>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

#include <twinray/geometry.h>
#include <twinray/tlas.h>
#include "engine/accel/trace_desc.h"
#include "engine/core/context.h"
#include "engine/core/parallel.h"
#include "swtlas/structures.h"

namespace twinray::kernels {
namespace {

// Bytes per triangle that a build of SwTlas reads and writes: each array counts as often as a pass goes through it, and
// each corner counts as a vertex. Savings by caches and costs of lines fetched in vain are not included. As many
// records count as a tree may need; the second sort, by 60-bit codes, which few meshes need, does not count.
struct BuildTraffic {
    double read = 0, written = 0;
};

constexpr double word = sizeof(uint), box = sizeof(LeafBox), node = sizeof(BvhNode), record = sizeof(CompressedRecord);
constexpr double mesh_triangle = sizeof(uvec3) + 3 * sizeof(vec3);
constexpr double morton_bits = 30;

void add(BuildTraffic& sum, double read, double written) {
    sum.read += read;
    sum.written += written;
}

// A pass reads keys to count digits, and keys and places to scatter both.
void add_sort(BuildTraffic& sum) {
    const double passes = std::ceil(morton_bits / SORT_GPU_DIGIT_BITS);
    add(sum, passes * 3 * word, passes * 2 * word);
}

// Returns a triangle's share of the nodes of a layout of records, in records.
double node_records(Layout layout) {
    constexpr uint many = 3'000'000;
    return record_count(many, width_of(layout)) / double{many} - 1;
}

// At best two triangles share a leaf.
BuildTraffic of_triangle(Layout layout, const BuildTraffic& of_leaf, double mesh_reads) {
    const double leaves = has_records(layout) ? 0.5 : 1;
    return {leaves * of_leaf.read + mesh_reads * mesh_triangle, leaves * of_leaf.written};
}

BuildTraffic build_traffic_of_leaf(Layout layout, BuildQuality quality) {
    BuildTraffic sum;
    add(sum, has_records(layout) ? word : 0, box);  // leaves
    add(sum, box, word);                            // Morton codes
    add_sort(sum);
    add(sum, 2 * word + box, node + word);  // hierarchy: each node by its two halves, each box from below
    add(sum, node, 0);
    if (quality == BuildQuality::high) add(sum, 2 * node, node);                // rotations look two levels down
    if (quality == BuildQuality::ploc) add(sum, 3 * box + 2 * word, 2 * word);  // clusters, some three rounds
    if (layout == Layout::bvh2) {
        add(sum, node, word);  // edges
        add(sum, word, sizeof(BvhTriangle));
        return sum;
    }
    add(sum, node, node_records(layout) * record + word);  // collapse
    add(sum, 3 * word, record);                            // records of leaves
    return sum;
}

BuildTraffic refit_traffic_of_leaf(Layout layout) {
    BuildTraffic sum;
    if (layout == Layout::bvh2) {
        add(sum, sizeof(BvhTriangle), box + sizeof(BvhTriangle));
        add(sum, node, word);              // edges of leaves
        add(sum, box + word, box + word);  // each node's boxes, by its two children
        return sum;
    }
    const double slots = 1 + node_records(layout);
    add(sum, slots * record, slots * 2 * word);  // parents
    add(sum, slots * (record + box + word), slots * (record + box + word));
    return sum;
}

BuildTraffic build_traffic(Layout layout, BuildQuality quality) {
    return of_triangle(layout, build_traffic_of_leaf(layout, quality), 2);
}

BuildTraffic refit_traffic(Layout layout) { return of_triangle(layout, refit_traffic_of_leaf(layout), 1); }

BuildRow row_of(const char* what, const AccelOptions& options, const BuildTraffic& traffic) {
    const RecordedWork work = take_recorded_work();
    return {what,
            std::string(name_of(options.layout)),
            std::string(name_of(options.build_quality)),
            work.dispatches,
            work.barriers,
            work.copies,
            traffic.read,
            traffic.written};
}

bool fits(const ListedKernel& kernel, const std::string& filter) {
    return (kernel.name + ' ' + kernel.variant).find(filter) != std::string::npos;
}

// Frees each pipeline before its thread compiles the next one.
std::vector<KernelRow> compile_all(const KernelList& list, const std::string& device, const std::string& filter) {
    std::vector<KernelRow> rows(list.kernels.size());
    parallel_for(rows.size(), [&](std::size_t i) {
        const ListedKernel& kernel = list.kernels[i];
        if (!fits(kernel, filter)) return;
        const KernelStatistics statistics = compile_for_statistics(*list.context, kernel.desc, kernel.args_bytes);
        rows[i] = {device,         list.context->properties().driver, kernel.name,
                   kernel.variant, figures_of(statistics.told),       statistics.subgroup_size};
    });
    std::erase_if(rows, [](const KernelRow& row) { return row.kernel.empty(); });
    return rows;
}

}  // namespace

std::vector<BuildRow> list_builds(Context& context) {
    Mesh mesh = make_icosphere(6);
    std::vector<BuildRow> rows;
    for (const Layout layout : all_layouts)
        for (const BuildQuality quality : all_build_qualities) {
            const AccelOptions options{.layout = layout, .build_quality = quality};
            SwTlas accel(context, options);
            const AccelHandle handle = accel.push(mesh);
            take_recorded_work();
            accel.sync();
            rows.push_back(row_of("build", options, build_traffic(layout, quality)));
            if (quality != BuildQuality::fast) continue;
            // The first move also measures the tree as it was built.
            for (int move = 0; move < 2; ++move) {
                take_recorded_work();
                accel.update_vertices(handle, mesh.positions);
                accel.sync();
            }
            rows.push_back(row_of("refit", options, refit_traffic(layout)));
        }
    return rows;
}

std::string table_of(std::span<const BuildRow> rows) {
    std::ostringstream out;
    out << std::left << std::setw(7) << "what" << std::setw(13) << "layout" << std::setw(9) << "quality" << std::right
        << std::setw(11) << "dispatches" << std::setw(10) << "barriers" << std::setw(8) << "copies" << std::setw(15)
        << "read/triangle" << std::setw(10) << "written" << '\n';
    for (const BuildRow& row : rows)
        out << std::left << std::setw(7) << row.what << std::setw(13) << row.layout << std::setw(9) << row.quality
            << std::right << std::setw(11) << row.dispatches << std::setw(10) << row.barriers << std::setw(8)
            << row.copies << std::setw(15) << static_cast<long>(row.read + 0.5) << std::setw(10)
            << static_cast<long>(row.written + 0.5) << '\n';
    return out.str();
}

nlohmann::json to_json(const BuildRow& row, const std::string& device) {
    return {{"device", device},
            {row.what, row.layout + ' ' + row.quality},
            {"dispatches", row.dispatches},
            {"barriers", row.barriers},
            {"copies", row.copies},
            {"read_bytes_per_triangle", row.read},
            {"written_bytes_per_triangle", row.written}};
}

CompiledKernels compile_kernels(ContextDesc desc, const std::string& family, const std::string& filter) {
    if (!family.empty()) desc.device = find_device(find_family(family));
    const KernelList list = list_kernels(desc);
    const DeviceProperties& properties = list.context->properties();
    const std::string device = family.empty() ? properties.name : family;
    return {device, properties.name, properties.driver, compile_all(list, device, filter),
            filter.empty() ? list_builds(*list.context) : std::vector<BuildRow>()};
}

}  // namespace twinray::kernels
