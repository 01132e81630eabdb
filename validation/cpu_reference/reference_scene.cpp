#include "validation/cpu_reference/reference_scene.h"

#include "engine/accel/trace_desc.h"
#include "swtlas/plan.h"
#include "swtlas/triangle_pairs.h"

namespace twinray::reference {

std::size_t Scene::add_geometry(const MeshView& mesh) {
    Geometry geometry(mesh, software_unit(mesh.positions));
    if (has_records(layout_)) choose_leaves(geometry, false);
    const SharedArray<vec3> positions = geometry.built_positions();
    const std::vector<LeafBox> boxes = leaves_triangles(positions, geometry.triangles, geometry.leaves);
    const Codes codes = morton(boxes, centroids(boxes));
    const std::vector<uint> order = sort(codes);
    Hierarchy tree = hierarchy(boxes, codes, order, !has_records(layout_), quality_);
    std::vector<BvhTriangle> triangles;
    std::vector<CompressedRecord> records;
    if (has_records(layout_))
        records = records_of_triangles(tree, positions, geometry.triangles, width_of(layout_), geometry.leaves);
    else {
        tree = linked(std::move(tree));
        triangles = encode_triangles(positions, geometry.triangles, order);
    }
    geometries_.push_back({std::move(geometry), positions, std::move(tree), std::move(triangles), std::move(records)});
    return geometries_.size() - 1;
}

void Scene::add_instance(std::size_t geometry, const InstanceRecord& record) { placed_.push_back({geometry, record}); }

uint Scene::root_of(const Hierarchy& tree) const {
    return has_records(layout_) && tree.root != NOTHING ? 0 : tree.root;
}

// Returns the records as kernels see them, each with the address of its geometry's block.
std::vector<InstanceRecord> Scene::records_in_built_units() {
    for (BuiltGeometry& built : geometries_) {
        built.block.geometry = {{built.tree.box.lo, built.tree.box.hi, Ref<BvhNode>::to(built.tree.nodes.data()),
                                 root_of(built.tree), built.leaf_count()},
                                Ref<BvhTriangle>::to(built.triangles.data()),
                                Ref<CompressedRecord>::to(built.records.data()),
                                Floats::to(&built.positions.data()->x),
                                GEOMETRY_TRIANGLES,
                                0};
        built.block.source = {Floats::to(&built.positions.data()->x), Uints::to(&built.mesh.triangles.data()->x),
                              built.mesh.scale, 0};
    }
    std::vector<InstanceRecord> records;
    for (auto [geometry, record] : placed_) {
        record.geometry = Ref<Block>::to(&geometries_[geometry].block).address;
        records.push_back(in_built_units(record));
    }
    return records;
}

void Scene::build() {
    const std::vector<InstanceRecord> records = records_in_built_units();
    instance_boxes_ = leaves_instances(records, instances_);
    const Codes codes = morton(instance_boxes_, centroids(instance_boxes_));
    top_ = hierarchy(instance_boxes_, codes, sort(codes), false, quality_);
    const auto count = static_cast<uint>(instance_boxes_.size());
    if (has_records(layout_))
        top_records_ = records_of_instances(top_, count, width_of(layout_));
    else
        top_ = linked(std::move(top_));
    header_ = {{},
               {top_.box.lo, top_.box.hi, Ref<BvhNode>::to(top_.nodes.data()), root_of(top_), count},
               Ref<CompressedRecord>::to(top_records_.data()),
               Ref<SwInstance>::to(instances_.data()),
               instances_.size()};
    build_refinement(records);
}

// The references of engine/world_bound.comp and engine/refine.comp.
void Scene::build_refinement(std::span<const InstanceRecord> records) {
    bound_ = {empty_box().lo, empty_box().hi};
    refined_.clear();
    for (std::size_t i = 0; i < records.size(); ++i) {
        const BuiltGeometry& built = geometries_[placed_[i].first];
        refined_.push_back(refine_instance(records[i], NULL_ADDRESS));
        if (instances_[i].root == NOTHING || !is_active(built.tree.box)) continue;
        const GeometryBox world = box_in_world({built.tree.box.lo, built.tree.box.hi}, to_world_of(records[i]));
        bound_ = {min(bound_.lo, world.lo), max(bound_.hi, world.hi)};
    }
}

TraceOptions Scene::trace_options(const Ray& ray, uint query, uint mask, uint level) const {
    const uint features = features_of({.layout = layout_}, {.instances = instances_.size(), .has_transforms = true},
                                      TraceTraits::of_every_kind());
    return {mask, 0, query, level, features, 0, ray, 0, Ref<RefineInstance>::to(refined_.data())};
}

Ray Scene::searched_ray(const Ray& ray, uint level, double& advance) const {
    TraceOptions options = trace_options(ray, QUERY_CLOSEST, 0xff, level);
    const Ray searched = level < LEVEL_REFINED ? ray : twinray::searched_ray(bound_.lo, bound_.hi, options);
    advance = options.advance;
    return searched;
}

Hit Scene::trace(const Ray& ray, uint query, uint mask, uint level) const {
    TraceOptions options = trace_options(ray, query, mask, level);
    Ray searched = searched_ray(ray, level, options.advance);
    float step = REFINING_STEP;
    for (;;) {
        Hit hit = traverse(header_, searched, options);
        if (level < LEVEL_REFINED || !hit.hit || refine(hit, searched, step, options)) return hit;
    }
}

TraversalSteps Scene::take_steps() { return std::exchange(traversal_steps(), {}); }

SwGeometry Scene::scene_nodes() const { return {header_.bvh, {}, header_.records, {}, GEOMETRY_TRIANGLES, 0}; }

Scene::Tree Scene::geometry_tree(std::size_t instance) const {
    const BuiltGeometry& built = geometries_[placed_[instance].first];
    return {built.block.geometry.bvh, built.triangles, built.mesh.scale};
}

std::unique_ptr<Scene> cpu_reference_of(const twinray::Scene& scene, const AccelOptions& trees) {
    auto on_cpu = std::make_unique<Scene>(trees.layout, trees.build_quality);
    for (const Mesh& mesh : scene.meshes) on_cpu->add_geometry(mesh);
    for (const Instance& instance : scene.instances)
        on_cpu->add_instance(instance.mesh, make_instance_record(instance.transform));
    on_cpu->build();
    return on_cpu;
}

}  // namespace twinray::reference
