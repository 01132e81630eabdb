#include <twinray/queries.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>

#include "engine/collide/exact_class.h"
#include "engine/collide/triangle_set.h"
#include "engine/core/error.h"
#include "engine/core/kernel.h"
#include "engine/points/boundary.h"
#include "points_boundary.spv.h"
#include "points_boxes.spv.h"
#include "points_closest.spv.h"
#include "points_winding.spv.h"
#include "points_within.spv.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/points/point_search.h"
#include "twinray/glsl/cpp_end.h"
static_assert(sizeof(SearchPoint) == 24 && sizeof(ClosestItem) == 56 && sizeof(PointItem) == 16);
static_assert(sizeof(OpenEdge) == 56 && sizeof(AngleSum) == 24);

namespace {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/points/point_boundary.h"
#include "twinray/glsl/cpp_end.h"

constexpr std::size_t batch = 1 << 20;  // points

// Returns a power of two that makes all boxes together about 1 large.
float scale_for(std::span<const MeshView> meshes, std::span<const MeshInstance> instances) {
    std::vector<Bounds> bounds;
    for (const MeshView& mesh : meshes) bounds.push_back(bounds_of(mesh));
    Bounds all;
    for (const MeshInstance& instance : instances) {
        const TreeBox box = box_of_instance(bounds[instance.mesh], instance.transform, 0);
        if (!is_empty(box)) all.include(Bounds{box.min, box.max});
    }
    const vec3 size = all.size();
    const float largest = std::max({size.x, size.y, size.z});
    if (!(largest > 0)) return 1;
    return std::ldexp(1.0f, std::isfinite(largest) ? -std::clamp(std::ilogb(largest), -126, 126) : -126);
}

template <class Body>
void in_batches(std::span<const dvec3> points, const Body& body) {
    for (std::size_t first = 0; first < points.size(); first += batch)
        body(first, points.subspan(first, std::min(batch, points.size() - first)));
}

template <class Args>
void dispatch(Commands& commands, const Kernel<Args>& kernel, Args args, std::uint64_t first, std::uint64_t count) {
    args.first = static_cast<uint>(first);
    args.end = static_cast<uint>(first + count);
    kernel.dispatch(commands, args, count);
}

}  // namespace

struct PointQuery::State {
    explicit State(Context& device)
        : context(with_float64(device, "points: distances")),
          boxes_of_points(device, {.name = "points_boxes", .spirv = points_boxes_spirv}),
          find_closest(device, {.name = "points_closest", .spirv = points_closest_spirv}),
          find_within(device, {.name = "points_within", .spirv = points_within_spirv}),
          find_winding(device, {.name = "points_winding", .spirv = points_winding_spirv}),
          sum_boundary(device, {.name = "points_boundary", .spirv = points_boundary_spirv}),
          order(device),
          triangles(device),
          tree(device),
          found_items(device, "pairs of a point and a triangle", sizeof(PointItem)),
          pace(device) {}

    void set(PlacedMeshes&& given);
    PointSearchArgs upload(std::span<const dvec3> some, std::uint64_t result_bytes);
    std::vector<PointItem> found(const Kernel<PointSearchArgs>& kernel, PointSearchArgs args);
    const std::string& why_not_closed();  // "" where all meshes are
    void wind(std::span<const dvec3> some, std::span<int> windings);
    std::vector<int> wind_all(std::span<const dvec3> all);
    const std::vector<OpenEdge>& open_edges();
    void add_boundary(std::span<const dvec3> some, std::span<double> windings);

    Context& context;
    Kernel<PointSearchArgs> boxes_of_points, find_closest, find_within, find_winding;
    Kernel<BoundaryArgs> sum_boundary;
    HilbertOrder order;
    TriangleSet triangles;
    BoxTree tree;
    PlacedMeshes placed;
    std::optional<std::string> side_fault;  // of the first mesh that is not closed; not set: not looked for yet
    float scale = 1;
    std::optional<std::vector<OpenEdge>> edges;  // of all instances; not set: not looked for yet
    Buffer points, point_boxes, results, edges_on_device;
    DeviceList found_items;
    Pace pace;
    std::uint64_t host_decided = 0;
};

PointQuery::PointQuery(Context& context) : state_(std::make_unique<State>(context)) {}
PointQuery::~PointQuery() = default;

std::size_t PointQuery::triangle_count() const { return state_->triangles.count(); }
std::uint64_t PointQuery::host_decided() const { return state_->host_decided; }
std::uint64_t PointQuery::max_found() const { return state_->found_items.limit(); }
void PointQuery::set_max_found(std::uint64_t count) { state_->found_items.set_limit(count); }
std::uint64_t PointQuery::bytes() const {
    return state_->triangles.bytes() + state_->tree.bytes() + state_->order.bytes() + state_->points.bytes() +
           state_->point_boxes.bytes() + state_->results.bytes() + state_->found_items.bytes();
}

void PointQuery::set(const Scene& scene) { state_->set(scene); }
void PointQuery::set(AbstractAccel& accel) { state_->set(PlacedMeshes(accel)); }
void PointQuery::set(std::span<const MeshView> meshes, std::span<const MeshInstance> instances) {
    state_->set({meshes, instances});
}

void PointQuery::State::set(PlacedMeshes&& given) {
    check_instances(given.meshes, given.instances, "points");
    placed = std::move(given);
    side_fault.reset();
    edges.reset();
    scale = scale_for(placed.meshes, placed.instances);
    std::vector<uint> all(placed.instances.size());
    std::iota(all.begin(), all.end(), 0u);
    triangles.set(placed, all, SharedVertices::by_index);
    triangles.build(tree);
}

PointSearchArgs PointQuery::State::upload(std::span<const dvec3> some, std::uint64_t result_bytes) {
    grow(context, points, "points", some.size_bytes());
    grow(context, point_boxes, "boxes of points", some.size() * sizeof(TreeBox));
    grow(context, results, "points results", result_bytes);
    order.prepare(some.size());
    const BoxTreeView view = tree.view();
    PointSearchArgs args{.nodes = view.nodes,
                         .triangles = triangles.triangles_on_device(),
                         .runs = triangles.runs_on_device(),
                         .points = points.ref<SearchPoint>(),
                         .boxes = point_boxes.ref<TreeBox>(),
                         .order = {},
                         .closest = results.ref<ClosestItem>(),
                         .windings = results.ref<uint>(),
                         .found = {},
                         .total = {},
                         .limit = unlimited,
                         .first = 0,
                         .end = static_cast<uint>(some.size()),
                         .leaf_begin = view.leaf_begin,
                         .leaf_count = view.count,
                         .capacity = 0,
                         .scale = scale};
    Commands commands(context, "points upload");
    {
        const auto pass = commands.pass("points upload");
        commands.upload(points, some);
    }
    boxes_of_points.dispatch(commands, args, args.end);
    args.order = order.record(commands, args.boxes, args.end);
    commands.submit();
    return args;
}

std::vector<PointItem> PointQuery::State::found(const Kernel<PointSearchArgs>& kernel, PointSearchArgs args) {
    const auto record = [&](Commands& commands, const DeviceList::View& list, std::uint64_t first, std::uint64_t some) {
        args.found = {list.address};
        args.total = list.total;
        args.capacity = list.capacity;
        dispatch(commands, kernel, args, first, some);
    };
    const std::uint64_t count = found_items.fill(record, args.end, args.end, "points");
    return download<PointItem>(context, found_items.buffer(), count);
}

std::vector<ClosestPoint> PointQuery::closest(std::span<const dvec3> points, double max_distance) {
    if (!(max_distance >= 0)) fail("points: a largest distance of ", max_distance, "; it must be 0 or more");
    std::vector<ClosestPoint> closest(points.size());
    if (state_->triangles.count() == 0) return closest;
    in_batches(points, [&](std::size_t first, std::span<const dvec3> some) {
        PointSearchArgs args = state_->upload(some, some.size() * sizeof(ClosestItem));
        args.limit = max_distance;
        Commands commands(state_->context, "points closest");
        state_->pace.record(commands, some.size(), [&](std::uint64_t begin, std::uint64_t count) {
            dispatch(commands, state_->find_closest, args, begin, count);
        });
        state_->pace.finish(commands);
        const std::vector<ClosestItem> items = download<ClosestItem>(state_->context, state_->results, some.size());
        for (std::size_t i = 0; i < some.size(); ++i) {
            const ClosestItem& of = items[i];
            if (of.item == NO_ITEM) continue;
            closest[first + i] = {.position = of.at,
                                  .distance = of.distance,
                                  .u = of.uv.x,
                                  .v = of.uv.y,
                                  .is_found = true,
                                  .instance = state_->triangles.instance(of.item),
                                  .triangle = state_->triangles.primitive(of.item)};
        }
    });
    return closest;
}

std::vector<NearTriangle> PointQuery::within(std::span<const dvec3> points, double radius) {
    if (!(radius >= 0) || !std::isfinite(radius))
        fail("points: a radius of ", radius, "; it must be finite, 0 or more");
    std::vector<NearTriangle> near;
    if (state_->triangles.count() == 0) return near;
    in_batches(points, [&](std::size_t first, std::span<const dvec3> some) {
        PointSearchArgs args = state_->upload(some, 0);
        args.limit = radius;
        std::vector<PointItem> items = state_->found(state_->find_within, args);
        std::sort(items.begin(), items.end(), [](const PointItem& a, const PointItem& b) {
            return a.point != b.point ? a.point < b.point : a.item < b.item;
        });
        if (near.size() + items.size() > max_found())
            fail("points: ", near.size() + items.size(), " pairs of a point and a triangle for the first ",
                 first + some.size(), " points; at most ", max_found(), ", see set_max_found()");
        for (const PointItem& item : items)
            near.push_back({static_cast<uint>(first) + item.point, state_->triangles.instance(item.item),
                            state_->triangles.primitive(item.item), item.distance});
    });
    return near;
}

const std::string& PointQuery::State::why_not_closed() {
    if (side_fault) return *side_fault;
    side_fault.emplace();
    std::set<uint> used;
    for (const MeshInstance& instance : placed.instances) used.insert(instance.mesh);
    for (auto mesh = used.begin(); mesh != used.end() && side_fault->empty(); ++mesh)
        side_fault = side_fault_of(placed.meshes[*mesh], *mesh);
    return *side_fault;
}

bool PointQuery::is_closed() { return state_->why_not_closed().empty(); }

std::vector<int> PointQuery::winding_numbers(std::span<const dvec3> points) {
    if (const std::string& why = state_->why_not_closed(); !why.empty()) fail("points: ", why);
    return state_->wind_all(points);
}

std::vector<double> PointQuery::generalized_winding_numbers(std::span<const dvec3> points) {
    const std::vector<int> crossings = state_->wind_all(points);
    std::vector<double> windings(crossings.begin(), crossings.end());
    if (state_->open_edges().empty()) return windings;
    in_batches(points, [&](std::size_t first, std::span<const dvec3> some) {
        state_->add_boundary(some, std::span(windings).subspan(first, some.size()));
    });
    return windings;
}

std::vector<int> PointQuery::State::wind_all(std::span<const dvec3> all) {
    for (std::size_t i = 0; i < all.size(); ++i)
        if (const std::string fault = sign_fault_of(all[i]); !fault.empty()) fail("points: point ", i, " has ", fault);
    host_decided = 0;
    std::vector<int> windings(all.size(), 0);
    if (triangles.count() == 0) return windings;
    in_batches(all, [&](std::size_t first, std::span<const dvec3> some) {
        wind(some, std::span(windings).subspan(first, some.size()));
    });
    return windings;
}

void PointQuery::State::wind(std::span<const dvec3> some, std::span<int> windings) {
    const std::vector<PointItem> undecided = found(find_winding, upload(some, some.size() * sizeof(uint)));
    const std::vector<uint> counted = download<uint>(context, results, some.size());
    std::transform(counted.begin(), counted.end(), windings.begin(), [](uint word) { return static_cast<int>(word); });
    for (const PointItem& each : undecided) {
        const int crossing = crossing_of(some[each.point], triangles.triangle(each.item));
        windings[each.point] += triangles.is_mirrored(each.item) ? -crossing : crossing;
    }
    host_decided += undecided.size();
}

const std::vector<OpenEdge>& PointQuery::State::open_edges() {
    if (edges) return *edges;
    std::vector<std::optional<std::vector<BoundaryEdge>>> of_mesh(placed.meshes.size());
    std::vector<OpenEdge> all;
    if (triangles.count() == 0) return edges.emplace();
    uint first_item = 0;
    for (const MeshInstance& instance : placed.instances) {
        auto& boundary = of_mesh[instance.mesh];
        if (!boundary) boundary = boundary_edges(placed.meshes[instance.mesh]);
        for (const BoundaryEdge& edge : *boundary) {
            const uint item = first_item + edge.triangle;
            const WorldTriangle at = triangles.triangle(item);
            const dvec3 vertices[] = {at.a, at.b, at.c, at.a};
            if (!is_finite_point(at.a) || !is_finite_point(at.b) || !is_finite_point(at.c)) continue;
            all.push_back({.a = vertices[edge.vertex],
                           .b = vertices[edge.vertex + 1],
                           .passes = triangles.is_mirrored(item) ? -edge.passes : edge.passes,
                           .reserved = 0});
        }
        first_item += static_cast<uint>(placed.meshes[instance.mesh].triangles.size());
    }
    grow(context, edges_on_device, "boundary edges", all.size() * sizeof(OpenEdge));
    Commands commands(context, "points boundary");
    {
        const auto pass = commands.pass("boundary upload");
        commands.upload(edges_on_device, std::span<const OpenEdge>(all));
    }
    commands.submit();
    return edges.emplace(std::move(all));
}

void PointQuery::State::add_boundary(std::span<const dvec3> some, std::span<double> windings) {
    upload(some, some.size() * sizeof(AngleSum));
    const BoundaryArgs args{.points = points.ref<SearchPoint>(),
                            .edges = edges_on_device.ref<OpenEdge>(),
                            .angles = results.ref<AngleSum>(),
                            .first = 0,
                            .end = 0,
                            .edge_count = static_cast<uint>(edges->size())};
    Commands commands(context, "points boundary");
    pace.record(commands, some.size(), [&](std::uint64_t begin, std::uint64_t count) {
        dispatch(commands, sum_boundary, args, begin, count);
    });
    pace.finish(commands);
    std::vector<AngleSum> sums = download<AngleSum>(context, results, some.size());
    for (std::size_t i = 0; i < some.size(); ++i) {
        AngleSum& sum = sums[i];
        if (sum.is_undecided != 0) {
            sum = no_angle();
            for (const OpenEdge& edge : *edges) sum = with_edge(sum, some[i], edge);
            ++host_decided;
        }
        windings[i] += std::atan2(sum.y == 0 ? 0.0 : sum.y, sum.x) / (2 * std::numbers::pi) + sum.revolutions;
    }
}

std::vector<double> PointQuery::signed_distances(std::span<const dvec3> points) {
    const std::vector<int> windings = winding_numbers(points);
    const std::vector<ClosestPoint> near = closest(points);
    std::vector<double> distances(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        distances[i] = windings[i] != 0 ? -near[i].distance : near[i].distance;
    return distances;
}

}  // namespace twinray
