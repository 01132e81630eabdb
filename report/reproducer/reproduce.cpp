#include "report/reproducer/reproduce.h"

#include <fstream>
#include <iomanip>
#include <set>
#include <sstream>

#include <twinray/tlas.h>
#include "engine/core/error.h"
#include "engine/core/stopwatch.h"
#include "report/frame/cases.h"
#include "report/reproducer/simplify.h"

namespace twinray::reproducer {
namespace {

bool is_leak_at_edges(const Reproduction& found) { return found.kind == HitClass::hw_leak && !found.answer.hit; }

const char* summary(const Reproduction& found) {
    switch (found.kind) {
        case HitClass::hw_leak:
            return found.answer.hit ? "a closest hit is not the closest: the ray meets nearer triangles"
                                    : "a ray misses although it meets triangles that close its way";
        case HitClass::hw_false: return "a hit names a triangle that the ray misses, or a t outside its interval";
        case HitClass::hw_t_err: return "the t of a hit is wrong by more than rounding in float32";
        default: return "t or the barycentric coordinates of a hit are not finite, or wrong by more than rounding";
    }
}

// Returns the rule of the Vulkan specification, and how firm it is.
const char* specification(const Reproduction& found) {
    if (is_leak_at_edges(found))
        return "Chapter *Ray Traversal*, section *Ray Intersection Candidate Determination*, *Watertightness*, for "
               "triangles of one instance with equal positions of shared vertices and equal winding: \"Implementations "
               "**should** not double-hit or miss when a ray intersects a shared edge, or a shared vertex of a closed "
               "fan.\" This is a *should*, not a *must*; a note adds that it is \"expected and tested that "
               "implementations will perform watertight intersection tests\". Where the ray meets a triangle well "
               "inside, it is a candidate without any such condition.";
    if (found.kind == HitClass::hw_leak)
        return "Chapter *Ray Traversal*: the committed intersection of a traversal that runs to its end is the closest "
               "one of the candidates that were confirmed, opaque ones all of them.";
    if (found.kind == HitClass::hw_false)
        return "Chapter *Ray Traversal*, section *Ray Intersection Candidate Determination*: a triangle is a candidate "
               "where the ray intersects it at a t with t_min < t < t_max. No precision is stated for this test; the "
               "ray passes the triangle by more than the rounding of its operands in float32 explains.";
    return "Chapter *Ray Traversal*, section *Ray Intersection Candidate Determination*: t and the barycentric "
           "coordinates are those of the intersection. The specification states no precision for them, so this is a "
           "matter of quality unless they are not finite; what is taken as right here allows for rounding of every "
           "operation in float32.";
}

// Returns whether two triangles of an instance list an edge in the same direction: to Vulkan, it is then no shared
// edge.
bool has_unequal_winding(const Scene& scene) {
    for (const Mesh& mesh : scene.meshes) {
        std::set<std::pair<uint, uint>> directed;
        for (const uvec3& t : mesh.triangles)
            for (int k = 0; k < 3; ++k)
                if (!directed.emplace(t[k], t[(k + 1) % 3]).second) return true;
    }
    return false;
}

void put_triangles(std::ostream& out, const Scene& scene) {
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const Mesh& mesh = scene.meshes[instance.mesh];
        out << "| instance | triangle | vertices |\n|---|---|---|\n";
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            out << "| " << i << " | " << t << " |";
            for (int k = 0; k < 3; ++k) {
                const vec3& p = mesh.positions[mesh.triangles[t][k]];
                out << " (" << p.x << ", " << p.y << ", " << p.z << ')';
            }
            out << " |\n";
        }
        if (instance.transform == Transform{}) continue;
        out << "\nInstance " << i << " has the transform, row by row";
        for (const vec4& row : instance.transform.rows)
            out << " (" << row.x << ", " << row.y << ", " << row.z << ", " << row.w << ')';
        out << ".\n\n";
    }
}

// Compares by the intervals that a program without twinray uses. The answer is a fault, so a miss is not allowed.
bool is_allowed(const ReferenceScene& reference, const Ray& ray, const Hit& answer) {
    if (!answer.hit || answer.instance_index >= reference.instance_count()) return false;
    if (!reference.geometry(answer.instance_index).find(answer.primitive_index)) return false;
    const auto right = right_hit(reference, ray, answer.instance_index, answer.primitive_index);
    return right && right->allows(answer);
}

namespace fs = std::filesystem;

void write_bytes(const fs::path& file, const void* bytes, std::size_t size) {
    std::ofstream out(file, std::ios::binary);
    out.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
    if (!out.flush()) fail("'", file.string(), "' cannot be written");
}

void write_text(const fs::path& file, const std::string& words) { write_bytes(file, words.data(), words.size()); }

frame::Backend backend_of(const replay::Replay& replay) {
    for (const frame::Backend backend : frame::all_backends)
        if (frame::name_of(backend) == replay.backend && !frame::is_ours(backend)) return backend;
    fail("a fault of '", replay.backend, "' is not a fault of the driver; reproducers only show faults of drivers");
}

// Returns the replay of the reduced fault on the current device.
replay::Replay replay_of(const Reproduction& found, const replay::Replay& original, const DeviceProperties& device) {
    const ReferenceScene reference = ReferenceScene::of(found.scene);
    replay::Replay replay = original;
    replay.scene = "scene.glb";
    replay.scene_hash = replay::hash_of(found.scene);
    replay.level = name_of(Level::watertight);
    replay.kind = name_of(found.kind);
    replay.ray = found.ray;
    replay.answer = found.answer;
    replay.reference = reference.closest_hit(found.ray);
    replay.device = device.name;
    replay.driver = device.driver;
    return replay;
}

}  // namespace

std::string words_of(const Hit& answer) {
    if (!answer.hit) return "a miss";
    return text(std::setprecision(9), "triangle ", answer.primitive_index, " of instance ", answer.instance_index,
                " at t = ", answer.t, ", u = ", answer.u, ", v = ", answer.v);
}

std::string page_text(const Reproduction& found, const replay::Replay& replay) {
    const bool is_pipeline = found.backend == frame::Backend::pipeline;
    std::ostringstream out;
    out << std::setprecision(9) << "# " << replay.device << ": " << summary(found) << "\n\n"
        << "- device: " << replay.device << "\n- driver: " << replay.driver << "\n- traced by: "
        << (is_pipeline ? "a ray tracing pipeline (`VK_KHR_ray_tracing_pipeline`)" : "a ray query (`VK_KHR_ray_query`)")
        << "\n- class of the fault: `" << replay.kind << "`, found by twinray " << replay.twinray << "\n\n"
        << "## The ray\n\n"
        << "- origin (" << found.ray.origin.x << ", " << found.ray.origin.y << ", " << found.ray.origin.z
        << "), direction (" << found.ray.direction.x << ", " << found.ray.direction.y << ", " << found.ray.direction.z
        << "), t_min " << found.ray.t_min << ", t_max " << found.ray.t_max << "\n- to the last bit: `"
        << frame::hexadecimal(found.ray) << "`\n- expected: " << found.right.exact
        << " (in rational arithmetic)\n- answered: " << words_of(found.answer) << "\n\n## The scene\n\n";
    put_triangles(out, found.scene);
    out << "\nDecimals are rounded; `reproducer.c` and `scene.glb` hold every bit. The scene was reduced from "
        << found.triangles_before << " triangles"
        << (found.was_cut_short ? " until the time limit, so it may not be the smallest.\n" : ".\n")
        << "\n## What the specification says\n\n"
        << specification(found)
        << (is_leak_at_edges(found) && has_unequal_winding(found.scene)
                ? " Two of these triangles list their common edge in the same direction: their winding is not equal, "
                  "so "
                  "the sentence does not speak of them."
                : "")
        << "\n\n## To see it\n\n"
        << "    cc -std=c99 reproducer.c -lvulkan -o reproducer && ./reproducer\n\n"
        << "prints the answer, and WRONG with exit status 1, or RIGHT with 0 (2: it cannot run here). The program "
           "needs "
           "nothing but the Vulkan loader and headers 1.2.162 or newer; `./reproducer DEVICE "
        << (is_pipeline ? "query" : "pipeline") << "` traces the same ray by a "
        << (is_pipeline ? "ray query" : "ray tracing pipeline")
        << ". Its shaders are beside it as `*.spv`. `twinray verify --replay replay.json` explains the ray step by "
           "step.\n";
    return out.str();
}

Reproduction reproduce(frame::Devices& devices, frame::Backend backend, const Scene& scene, const Ray& ray,
                       double seconds) {
    const Stopwatch begin;
    // The driver's own answers: nothing is refined, and triangles and instances are built in the given order.
    HwTlas accel(devices.context(backend), BuildOrder::input, {.level = Level::watertight});
    const auto answer_to = [&](const Ray& asked, const Scene& where) {
        for (const AccelHandle handle : accel.handles()) accel.erase(handle);
        push_scene(accel, where);
        return accel.closest_hits(std::span(&asked, 1), {.level = Level::watertight}).front();
    };
    Reproduction found;
    found.backend = backend;
    // An accelerator as users have it tells whether the driver reorders this scene's triangles.
    FaultCase fault = case_of(scene, ray, HwTlas(devices.context(backend)).reorders());
    found.triangles_before = fault.triangles.size();
    const Scene whole = scene_of(fault);
    found.answer = answer_to(ray, whole);
    found.kind = class_of(ReferenceScene::of(whole), ray, found.answer);
    if (!is_fault_of_hardware(found.kind))
        fail("the driver's own answer is ", name_of(found.kind),
             ", which is no fault, so there is nothing to reproduce");

    const auto is_late = [&] { return begin.seconds() > seconds; };
    const CaseTest shows_fault = [&](const FaultCase& smaller) {
        if (smaller.triangles.empty() || is_late()) {
            found.was_cut_short |= !smaller.triangles.empty();
            return false;
        }
        const Scene small = scene_of(smaller);
        const Hit answer = answer_to(smaller.ray, small);
        const ReferenceScene reference = ReferenceScene::of(small);
        return class_of(reference, smaller.ray, answer) == found.kind && !is_allowed(reference, smaller.ray, answer);
    };
    if (FaultCase near = near_the_ray(fault, found.answer.instance_index, found.answer.primitive_index);
        shows_fault(near))
        fault = std::move(near);
    fault = simplified(std::move(fault), shows_fault);
    if (FaultCase built = as_built(fault); shows_fault(built)) fault = std::move(built);

    found.scene = scene_of(fault);
    found.ray = fault.ray;
    found.answer = answer_to(found.ray, found.scene);
    found.right = right_answers(ReferenceScene::of(found.scene), found.ray);
    return found;
}

std::string write_reproducer(const fs::path& folder, const Scene& scene, const replay::Replay& replay,
                             frame::Devices& devices, double seconds) {
    const frame::Backend backend = backend_of(replay);
    if (const std::string reason = devices.why_not({backend, Level::watertight}); !reason.empty()) fail(reason);
    const Reproduction found = reproduce(devices, backend, scene, replay.ray, seconds);
    const replay::Replay reduced = replay_of(found, replay, devices.context(backend).properties());
    fs::create_directories(folder);
    replay::write_glb(folder / "scene.glb", found.scene);
    replay::write(folder / "replay.json", reduced);
    write_text(folder / "report.md", page_text(found, reduced));
    const std::string found_on =
        text(reduced.device, ", ", reduced.driver, ", which answered ", words_of(found.answer));
    write_text(folder / "reproducer.c",
               program_text({found.scene, found.ray, found.right, backend == frame::Backend::pipeline, found_on}));
    for (const ProgramShader& shader : program_shaders())
        write_bytes(folder / text(shader.name, ".spv"), shader.spirv.data(), shader.spirv.size_bytes());
    const std::size_t triangles = count_triangles(found.scene);
    return text(name_of(found.kind), " in ", triangles, triangles == 1 ? " triangle" : " triangles", ", of ",
                found.triangles_before, ": ", (folder / "reproducer.c").string());
}

std::string write_reproducer(const fs::path& folder, const fs::path& replay_file, frame::Devices& devices,
                             double seconds) {
    const replay::Replay replay = replay::read(replay_file);
    const Scene scene = replay::load_traced_scene(replay_file, replay);
    try {
        return write_reproducer(folder, scene, replay, devices, seconds);
    } catch (const std::exception& error) {
        fail("replay '", replay_file.string(), "': ", error.what());
    }
}

std::size_t write_reproducers(const fs::path& folder, std::span<const fs::path> replay_files, frame::Devices& devices,
                              std::ostream& out, double seconds) {
    const Stopwatch begin;
    std::set<std::string> done;
    for (const fs::path& file : replay_files) {
        const double left = seconds - begin.seconds();
        if (left <= 0) break;
        try {
            const replay::Replay replay = replay::read(file);
            if (replay.backend == frame::name_of(frame::Backend::software) || done.contains(replay.kind)) continue;
            out << "  " << write_reproducer(folder / replay.kind, file, devices, left) << '\n';
            done.insert(replay.kind);
        } catch (const Error& error) {
            out << "  no reproducer: " << error.what() << '\n';
        }
    }
    return done.size();
}

}  // namespace twinray::reproducer
