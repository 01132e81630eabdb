// SPDX-License-Identifier: MIT
#include "engine/points/point_finder.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "engine/collide/exact_sign.h"
#include "engine/core/error.h"
#include "engine/core/float64.h"
#include "engine/points/boundary.h"
#include "points_boxes.spv.h"
#include "points_nearest.spv.h"
#include "points_winding.spv.h"
#include "points_within.spv.h"

namespace twinray {
namespace {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/point_winding.h"
#include "twinray/glsl/cpp_end.h"

constexpr std::size_t batch = 1 << 20;  // points

// A power of two that makes all boxes together about 1 large.
float scale_for(std::span<const MeshView> meshes, std::span<const MeshInstance> instances) {
    std::vector<Bounds> bounds;
    for (const MeshView& mesh : meshes) bounds.push_back(bounds_of(mesh));
    Bounds all;
    for (const MeshInstance& instance : instances) {
        const TreeBox box = box_of_instance(bounds[instance.mesh], instance.transform, 0);
        if (!is_empty(box)) all.include(Bounds{box.lo, box.hi});
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

void dispatch(Commands& commands, const Kernel<PointSearchArgs>& kernel, PointSearchArgs args, std::uint64_t first,
              std::uint64_t count) {
    args.first = static_cast<uint>(first);
    args.end = static_cast<uint>(first + count);
    kernel.dispatch(commands, args, count);
}

}  // namespace

PointFinder::PointFinder(Context& context)
    : context_(with_float64(context, "points: distances")),
      boxes_of_points_(context, {.name = "points_boxes", .spirv = points_boxes_spirv}),
      nearest_(context, {.name = "points_nearest", .spirv = points_nearest_spirv}),
      within_(context, {.name = "points_within", .spirv = points_within_spirv}),
      winding_(context, {.name = "points_winding", .spirv = points_winding_spirv}),
      order_(context),
      triangles_(context),
      tree_(context),
      found_(context, "pairs of a point and a triangle", sizeof(PointItem)),
      pace_(context) {}

std::uint64_t PointFinder::bytes() const {
    return triangles_.bytes() + tree_.bytes() + order_.bytes() + points_.bytes() + point_boxes_.bytes() +
           results_.bytes() + found_.bytes();
}

void PointFinder::set(const Scene& scene) {
    const std::vector<MeshView> meshes(scene.meshes.begin(), scene.meshes.end());
    std::vector<MeshInstance> instances;
    for (const Instance& instance : scene.instances) instances.push_back({instance.mesh, instance.transform});
    set(meshes, instances);
}

void PointFinder::set(std::span<const MeshView> meshes, std::span<const MeshInstance> instances) {
    check_placed(meshes, instances, "points");
    meshes_.assign(meshes.begin(), meshes.end());
    instances_.assign(instances.begin(), instances.end());
    side_fault_.reset();
    scale_ = scale_for(meshes_, instances_);
    std::vector<uint> all(instances.size());
    std::iota(all.begin(), all.end(), 0u);
    triangles_.set(meshes_, instances_, all, Shared::by_index);
    Commands commands(context_, "points tree");
    triangles_.record(commands, tree_.prepare(triangles_.count()));
    tree_.record(commands);
    commands.submit();
}

PointSearchArgs PointFinder::upload(std::span<const dvec3> points, std::uint64_t result_bytes) {
    grow(context_, points_, "points", points.size_bytes());
    grow(context_, point_boxes_, "boxes of points", points.size() * sizeof(TreeBox));
    grow(context_, results_, "points results", result_bytes);
    order_.prepare(points.size());
    const BoxTreeView tree = tree_.view();
    PointSearchArgs args{.nodes = tree.nodes,
                         .corners = triangles_.corners_on_device(),
                         .meshes = triangles_.meshes_on_device(),
                         .points = points_.ref<QueryPoint>(),
                         .boxes = point_boxes_.ref<TreeBox>(),
                         .order = {},
                         .nearest = results_.ref<NearestPoint>(),
                         .windings = results_.ref<uint>(),
                         .found = {},
                         .total = {},
                         .limit = unlimited,
                         .first = 0,
                         .end = static_cast<uint>(points.size()),
                         .leaf_begin = tree.leaf_begin,
                         .leaf_count = tree.count,
                         .capacity = 0,
                         .scale = scale_};
    Commands commands(context_, "points upload");
    {
        const auto pass = commands.pass("points upload");
        commands.upload(points_, points);
    }
    boxes_of_points_.dispatch(commands, args, args.end);
    args.order = order_.record(commands, args.boxes, args.end);
    commands.submit();
    return args;
}

std::vector<PointItem> PointFinder::found(const Kernel<PointSearchArgs>& kernel, PointSearchArgs args) {
    const auto record = [&](Commands& commands, const DeviceList::View& list, std::uint64_t first, std::uint64_t some) {
        args.found = {list.address};
        args.total = list.total;
        args.capacity = list.capacity;
        dispatch(commands, kernel, args, first, some);
    };
    const std::uint64_t points = args.end;
    const std::uint64_t count = found_.fill(record, points, points, "points");
    return download<PointItem>(context_, found_.buffer(), count);
}

std::vector<ClosestPoint> PointFinder::closest(std::span<const dvec3> points, double max_distance) {
    if (!(max_distance >= 0)) fail("points: a largest distance of ", max_distance, "; it must be 0 or more");
    std::vector<ClosestPoint> closest(points.size());
    if (triangles_.count() == 0) return closest;
    in_batches(points, [&](std::size_t first, std::span<const dvec3> some) {
        PointSearchArgs args = upload(some, some.size() * sizeof(NearestPoint));
        args.limit = max_distance;
        Commands commands(context_, "points nearest");
        pace_.record(commands, some.size(), [&](std::uint64_t begin, std::uint64_t count) {
            dispatch(commands, nearest_, args, begin, count);
        });
        pace_.finish(commands);
        const std::vector<NearestPoint> nearest = download<NearestPoint>(context_, results_, some.size());
        for (std::size_t i = 0; i < some.size(); ++i) {
            const NearestPoint& of = nearest[i];
            if (of.item == NO_ITEM) continue;
            closest[first + i] = {
                of.at, of.distance, of.uv, true, triangles_.instance(of.item), triangles_.primitive(of.item)};
        }
    });
    return closest;
}

std::vector<NearTriangle> PointFinder::within(std::span<const dvec3> points, double radius) {
    if (!(radius >= 0) || !std::isfinite(radius))
        fail("points: a radius of ", radius, "; it must be finite, 0 or more");
    std::vector<NearTriangle> near;
    if (triangles_.count() == 0) return near;
    in_batches(points, [&](std::size_t first, std::span<const dvec3> some) {
        PointSearchArgs args = upload(some, 0);
        args.limit = radius;
        std::vector<PointItem> items = found(within_, args);
        std::sort(items.begin(), items.end(), [](const PointItem& a, const PointItem& b) {
            return a.point != b.point ? a.point < b.point : a.item < b.item;
        });
        if (near.size() + items.size() > max_found())
            fail("points: ", near.size() + items.size(), " pairs of a point and a triangle for the first ",
                 first + some.size(), " points; at most ", max_found(), ", see set_max_found()");
        for (const PointItem& item : items)
            near.push_back({static_cast<uint>(first) + item.point, triangles_.instance(item.item),
                            triangles_.primitive(item.item), item.distance});
    });
    return near;
}

void PointFinder::check_closed() {
    if (!side_fault_) {
        side_fault_.emplace();
        std::set<uint> placed;
        for (const MeshInstance& instance : instances_) placed.insert(instance.mesh);
        for (auto mesh = placed.begin(); mesh != placed.end() && side_fault_->empty(); ++mesh)
            side_fault_ = side_fault_of(meshes_[*mesh], *mesh);
    }
    if (!side_fault_->empty()) fail("points: ", *side_fault_);
}

std::vector<int> PointFinder::winding_numbers(std::span<const dvec3> points) {
    check_closed();
    for (std::size_t i = 0; i < points.size(); ++i)
        if (const std::string fault = sign_fault_of(points[i]); !fault.empty())
            fail("points: point ", i, " has ", fault);
    host_decided_ = 0;
    std::vector<int> windings(points.size(), 0);
    if (triangles_.count() == 0) return windings;
    in_batches(points, [&](std::size_t first, std::span<const dvec3> some) {
        wind(some, std::span(windings).subspan(first, some.size()));
    });
    return windings;
}

void PointFinder::wind(std::span<const dvec3> points, std::span<int> windings) {
    const std::vector<PointItem> undecided = found(winding_, upload(points, points.size() * sizeof(uint)));
    const std::vector<uint> counted = download<uint>(context_, results_, points.size());
    std::transform(counted.begin(), counted.end(), windings.begin(), [](uint word) { return static_cast<int>(word); });
    for (const PointItem& each : undecided) {
        const int crossing = crossing_of(points[each.point], triangles_.corners(each.item));
        windings[each.point] += triangles_.is_mirrored(each.item) ? -crossing : crossing;
    }
    host_decided_ += undecided.size();
}

std::vector<double> PointFinder::signed_distances(std::span<const dvec3> points) {
    const std::vector<int> windings = winding_numbers(points);
    const std::vector<ClosestPoint> near = closest(points);
    std::vector<double> distances(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        distances[i] = windings[i] != 0 ? -near[i].distance : near[i].distance;
    return distances;
}

}  // namespace twinray
