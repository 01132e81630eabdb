#include "report/explain/explain.h"

#include <algorithm>
#include <iomanip>
#include <ostream>
#include <set>

#include <twinray/scene.h>
#include "engine/core/error.h"
#include "engine/scene/local_origin.h"
#include "report/replay/replay.h"
#include "validation/reference/classify.h"

namespace twinray::replay {
namespace {

using exact::Rational, exact::TriangleId;

// An accelerator of this device, its answer and the class of that answer.
struct Answer {
    frame::Configuration configuration;
    Hit hit;
    HitClass kind;
};

// The scene, the ray and the right answer.
struct Stage {
    Replay replay;
    Scene scene;
    ReferenceScene reference;
    exact::Reference exact_reference;

    Stage(const Replay& what, Scene&& where)
        : replay(what), scene(std::move(where)), reference(ReferenceScene::of(scene)), exact_reference(reference) {}
    Stage(const Stage&) = delete;
};

Level level_of(const Replay& replay) {
    for (const Level level : all_levels)
        if (name_of(level) == replay.level) return level;
    fail("there is no level '", replay.level, "'");
}

Answer answer_of(const Stage& stage, frame::Devices& devices, const frame::Configuration& configuration) {
    AbstractAccel& accel = devices.empty_accel(configuration);
    push_scene(accel, stage.scene);
    const Hit hit = accel.closest_hits(std::span(&stage.replay.ray, 1), {.level = configuration.level}).front();
    const auto arbiter = [&](const Ray& ray) { return stage.exact_reference.rounded_hit(ray); };
    const bool is_ours = frame::is_ours(configuration.backend);
    const RayResult ray_result =
        classify(stage.reference, stage.replay.ray, is_ours ? std::optional(hit) : std::nullopt,
                 is_ours ? std::nullopt : std::optional(hit), arbiter);
    return {configuration, hit, is_ours ? *ray_result.software : *ray_result.hardware};
}

void print(std::ostream& out, const char* who, bool is_hit, uint instance, uint primitive, double t) {
    out << "  " << std::left << std::setw(12) << who;
    if (is_hit)
        out << "triangle " << primitive << " of instance " << instance << " at t = " << t;
    else
        out << "miss";
}

std::vector<Answer> print_answers(std::ostream& out, const Stage& stage, frame::Devices& devices) {
    std::vector<Answer> answers;
    out << "Answers of the accelerators on " << devices.context(frame::Backend::software).properties().name
        << " at level " << stage.replay.level << "\n";
    for (const frame::Backend backend : frame::all_backends) {
        const frame::Configuration configuration{backend, level_of(stage.replay)};
        const std::string name(name_of(backend));
        if (const std::string reason = devices.why_not(configuration); !reason.empty()) {
            out << "  " << std::left << std::setw(12) << name << "not here: " << reason << '\n';
            continue;
        }
        answers.push_back(answer_of(stage, devices, configuration));
        const Hit& hit = answers.back().hit;
        print(out, name.c_str(), hit.hit, hit.instance_index, hit.primitive_index, hit.t);
        out << ": " << twinray::name_of(answers.back().kind) << '\n';
    }
    return answers;
}

std::vector<TriangleId> print_truth(std::ostream& out, const Stage& stage) {
    const Ray& ray = stage.replay.ray;
    const ReferenceHit closest = stage.reference.closest_hit(ray);
    out << "Correct answer\n";
    print(out, "float64", closest.hit, closest.instance, closest.primitive, closest.t);
    out << (is_certain(stage.reference, ray, closest) ? ", for certain\n" : "; rounding could decide otherwise\n");
    const auto exact = stage.exact_reference.closest_hit(ray);
    const ReferenceHit rounded = exact::to_float64(exact, stage.reference);
    print(out, "exactly", rounded.hit, rounded.instance, rounded.primitive, rounded.t);
    if (!exact) {
        out << '\n';
        return {};
    }
    const char* where[] = {", inside it", ", on its edge", ", at its vertex"};
    out << where[static_cast<std::size_t>(exact->crossing.incidence)];
    if (exact->triangles.size() > 1) out << "; " << exact->triangles.size() << " triangles meet the ray at this t";
    out << '\n';
    return exact->triangles;
}

// Explains the class of an answer.
const char* meaning(HitClass kind) {
    switch (kind) {
        case HitClass::agree: return "it is the reference's answer";
        case HitClass::tie: return "another triangle at the same distance, within rounding; both are correct";
        case HitClass::boundary:
        case HitClass::boundary_hw_miss:
            return "a silhouette or a rim is nearer to the ray than float32 rounding, which may decide either way";
        case HitClass::unspecified:
            return "Vulkan guarantees nothing here: unshared edges, or t at an end of the interval";
        case HitClass::invalid_input: return "this ray is invalid, so it must miss";
        case HitClass::sw_leak:
        case HitClass::hw_leak:
            return "rounding of the ray does not explain it: triangles that share their edges close the way, and the "
                   "ray slipped between them";
        case HitClass::sw_false:
        case HitClass::hw_false:
            return "the ray misses the reported triangle by more than rounding, or t is out of range";
        case HitClass::t_err:
        case HitClass::hw_t_err: return "the triangle is right, but t, u or v is beyond the error bound";
        case HitClass::hw_range: return "t, u or v is not finite, or beyond the error bound";
    }
    return "";
}

void print_header(std::ostream& out, const Stage& stage) {
    const Replay& replay = stage.replay;
    out << replay.kind << " of " << replay.backend << " at level " << replay.level << " on " << replay.device << ", "
        << replay.driver << ", twinray " << replay.twinray << '\n'
        << "The ray: origin, t_min, direction, t_max\n  " << frame::hexadecimal(replay.ray) << '\n';
    if (const dvec3& origin = stage.scene.origin; origin != dvec3(0))
        out << "  relative to the local origin " << origin_text(origin) << '\n';
    print(out, "answered", replay.answer.hit, replay.answer.instance_index, replay.answer.primitive_index,
          replay.answer.t);
    out << '\n';
}

const char* sign_of(int sign) { return sign > 0 ? "+" : sign < 0 ? "-" : "0"; }

// Finds the boxes from the root to the leaf that is_wanted(leaf index), the root's first. Returns false without such a
// leaf.
template <class IsWanted>
bool find_path(const Bvh& bvh, uint reference, const IsWanted& is_wanted, std::vector<Bounds>& path) {
    if (reference == NOTHING) return false;
    if (reference & LEAF_BIT) return is_wanted(reference & ~LEAF_BIT);
    const BvhNode& node = bvh.nodes[reference];
    for (const auto& [box, child] :
         {std::pair(Bounds{node.lo0, node.hi0}, node.child0), {Bounds{node.lo1, node.hi1}, node.child1}}) {
        path.push_back(box);
        if (find_path(bvh, child, is_wanted, path)) return true;
        path.pop_back();
    }
    return false;
}

// Does the slab test of textbooks, without padding.
bool enters_unpadded(const Bounds& box, const RaySpace& space, float t_min, float t_max) {
    for (int axis = 0; axis < 3; ++axis) {
        const float inverse = 1.0f / space.direction[axis];
        const float a = (box.lo[axis] - space.origin[axis]) * inverse,
                    b = (box.hi[axis] - space.origin[axis]) * inverse;
        t_min = std::max(t_min, std::min(a, b));
        t_max = std::min(t_max, std::max(a, b));
    }
    return t_min <= t_max;
}

void print_path(std::ostream& out, const char* tree, const std::vector<Bounds>& path, const RaySpace& space,
                const Ray& ray) {
    out << "    " << tree << ": " << path.size() << (path.size() == 1 ? " box" : " boxes") << " below the root\n";
    const float t_min = std::max(ray.t_min, 0.0f);
    for (std::size_t depth = 0; depth < path.size(); ++depth) {
        float enter = 0;
        const bool padded = enter_box(path[depth].lo, path[depth].hi, space, t_min, ray.t_max, enter);
        const bool unpadded = enters_unpadded(path[depth], space, t_min, ray.t_max);
        out << "      " << depth + 1 << ": padded " << (padded ? "enters" : "PASSES") << ", unpadded "
            << (unpadded ? "enters" : "PASSES");
        if (padded) out << ", at t = " << enter / space.t_scale;
        out << '\n';
    }
}

// Explains how the float32 tests relate to the level of the replay.
const char* arithmetic_of(Level level) {
    switch (level) {
        case Level::fast: return "as SwTlas computes them at watertight; fast uses Moeller-Trumbore tests instead";
        case Level::certified: return "which only reject distant triangles; certified decides as the exact lines do";
        default: return "as SwTlas computes them";
    }
}

}  // namespace

Explainer::Explainer(const Scene& scene, const ReferenceScene& reference, const Ray& ray, Level level)
    : reference_(reference), ray_(ray), on_cpu_(reference::cpu_reference_of(scene, {.layout = Layout::bvh2})) {
    double advance = 0;
    searched_ = on_cpu_->searched_ray(ray, static_cast<uint>(level), advance);
}

RaySpace Explainer::object_space(uint instance) const {
    const Rows& to_object = on_cpu_->instance(instance).world_to_object;
    const vec3 origin = transform_point(to_object, searched_.origin);
    return make_ray_space(origin, transform_vector(to_object, searched_.direction),
                          vertex_pad(origin, on_cpu_->instance(instance).extent));
}

void Explainer::print_test(std::ostream& out, exact::TriangleId triangle) const {
    out << "  triangle " << triangle.primitive << " of instance " << triangle.instance << '\n';
    const reference::Scene::Tree tree = on_cpu_->geometry_tree(triangle.instance);
    const auto leaf = std::ranges::find(tree.triangles, triangle.primitive, &BvhTriangle::primitive_index);
    const ActiveTriangle* active = reference_.geometry(triangle.instance).find(triangle.primitive);
    if (leaf == tree.triangles.end() || !active) {
        out << "    is not active: not finite, or without area\n";
        return;
    }
    const RaySpace space = object_space(triangle.instance);
    const vec3 vertices[] = {sheared(leaf->v0, space), sheared(leaf->v1, space), sheared(leaf->v2, space)};
    for (int i = 0; i < 3; ++i)
        out << "    vertex " << i << ", sheared so that the ray is (0, 0): " << vertices[i].x << ", " << vertices[i].y
            << "; along the ray " << vertices[i].z << '\n';

    const exact::Line line = exact::object_line(ray_, reference_.placement(triangle.instance));
    const auto values = exact::edge_values(line, active->vertices64());
    const Rational unit = line.direction[static_cast<int>(space.axis)] * Rational(tree.scale) * Rational(tree.scale);
    for (int i = 0; i < 3; ++i) {
        const vec3 a = vertices[(i + 1) % 3], b = vertices[(i + 2) % 3];
        const float area = edge_function(a, b);
        const Rational truth = unit == 0 ? Rational(0) : Rational(values[static_cast<std::size_t>(i)] / unit);
        out << "    edge across from vertex " << i << ": float32 " << area;
        if (area == 0)
            out << ", a tie, with its rounding error " << accurate_edge_function(a, b) << ", decided "
                << sign_of(exact_side(a, b));
        out << "; exactly " << truth.get_d() << " (" << sign_of(sgn(truth)) << ")\n";
    }
    TriangleHit hit{};
    if (intersect_triangle_signed(leaf->v0, leaf->v1, leaf->v2, space, hit))
        out << "    float32: hit at t = " << hit.t << ", u = " << hit.u << ", v = " << hit.v << '\n';
    else
        out << "    float32: the ray misses, or begins in the triangle's plane or behind it\n";
    if (const auto crossing = exact::crossing(line, active->vertices64())) {
        const char* where[] = {"inside", "on an edge", "at a vertex"};
        out << "    exactly: hit at t = " << exact::rounded(crossing->t) << ", "
            << where[static_cast<std::size_t>(crossing->incidence)] << '\n';
    } else {
        out << "    exactly: the ray misses\n";
    }
}

void Explainer::print_boxes(std::ostream& out, exact::TriangleId triangle) const {
    out << "  boxes to triangle " << triangle.primitive << " of instance " << triangle.instance << '\n';
    std::vector<Bounds> path;
    const Bvh& top = on_cpu_->scene_tree().bvh;
    const RaySpace world = make_ray_space(searched_.origin, searched_.direction,
                                          world_pad(searched_.origin, largest_coordinate(top.lo, top.hi)));
    find_path(
        top, top.root, [&](uint leaf) { return leaf == triangle.instance; }, path);
    print_path(out, "tree of instances", path, world, searched_);
    path.clear();
    const reference::Scene::Tree tree = on_cpu_->geometry_tree(triangle.instance);
    find_path(
        tree.bvh, tree.bvh.root, [&](uint leaf) { return tree.triangles[leaf].primitive_index == triangle.primitive; },
        path);
    print_path(out, "tree of triangles", path, object_space(triangle.instance), searched_);
}

bool show(const std::filesystem::path& file, frame::Devices& devices, std::ostream& out) {
    const Replay replay = read(file);
    const Stage stage(replay, load_traced_scene(file, replay));
    const auto precision = out.precision(9);
    print_header(out, stage);
    const std::vector<TriangleId> truth = print_truth(out, stage);
    const std::vector<Answer> answers = print_answers(out, stage, devices);

    std::set<TriangleId> involved(truth.begin(), truth.end());
    for (const Answer& answer : answers)
        if (answer.hit.hit) involved.insert({answer.hit.instance_index, answer.hit.primitive_index});
    const Explainer explainer(stage.scene, stage.reference, replay.ray, level_of(replay));
    out << "Triangle tests in float32, " << arithmetic_of(level_of(replay)) << ", in units of the mesh's size\n";
    for (const TriangleId& triangle : involved) explainer.print_test(out, triangle);
    out << "Boxes of SwTlas's binary trees, which layout compressed4 rounds outwards; the driver's boxes are not "
           "accessible\n";
    for (const TriangleId& triangle : involved) explainer.print_boxes(out, triangle);

    out << "Result\n";
    bool is_fault = false;
    for (const Answer& answer : answers) {
        out << "  " << std::left << std::setw(12) << name_of(answer.configuration.backend)
            << twinray::name_of(answer.kind) << ": " << meaning(answer.kind) << '\n';
        is_fault |=
            is_fault_of_ours(answer.kind) && answer.configuration.level != Level::fast;  // which promises nothing
    }
    out.precision(precision);
    return is_fault;
}

}  // namespace twinray::replay
