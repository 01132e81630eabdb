// SPDX-License-Identifier: MIT
#include "validation/replay/show.h"

#include <algorithm>
#include <iomanip>
#include <ostream>
#include <set>

#include <twinray/scene.h>

#include "validation/replay/explain.h"
#include "validation/replay/replay.h"
#include "validation/replay/scene_file.h"
#include "validation/suite/judging.h"
#include "engine/core/error.h"
#include "engine/verify/certainty.h"

namespace twinray::replay {
namespace {

using exact::TriangleId;

// An accelerator of this device, what it answers and what that is worth.
struct Answer {
    suite::Subject subject;
    Hit hit;
    Class kind;
};

// The scene, the ray and who judges.
struct Stage {
    Replay replay;
    Scene scene;
    Oracle oracle;
    exact::Referee referee;

    Stage(const Replay& what, Scene&& where)
        : replay(what), scene(std::move(where)), oracle(Oracle::of(scene)), referee(oracle) {}
    Stage(const Stage&) = delete;
};

// A file of a user's was loaded as it is here; one that write_glb() made has the floats that were traced.
Scene load_checked(const std::filesystem::path& file, const Replay& replay) {
    const std::filesystem::path path = file.parent_path() / replay.scene;
    Scene scene = load_scene(path);
    const std::string hash = hash_of(scene);
    if (hash == replay.scene_hash) return scene;
    Scene as_written = load_scene(path, dvec3(0));
    if (hash_of(as_written) == replay.scene_hash) return as_written;
    fail("replay '", file.string(), "': scene '", path.string(), "' is not the one that was traced: its hash is ", hash,
         ", not ", replay.scene_hash);
}

Level level_of(const Replay& replay) {
    for (const Level level : suite::all_levels)
        if (suite::name(level) == replay.level) return level;
    fail("there is no level '", replay.level, "'");
}

Answer answer_of(const Stage& stage, suite::Devices& devices, const suite::Subject& subject) {
    AbstractAccel& accel = devices.empty_accel(subject);
    push_scene(accel, stage.scene);
    const Hit hit = accel.closest_hits(std::span(&stage.replay.ray, 1), {.level = subject.level}).front();
    const auto arbiter = [&](const Ray& ray) {
        return exact::to_float64(stage.referee.closest_hit(ray), stage.oracle);
    };
    const bool is_ours = suite::is_ours(subject.backend);
    const Verdict verdict = classify(stage.oracle, stage.replay.ray, is_ours ? std::optional(hit) : std::nullopt,
                                     is_ours ? std::nullopt : std::optional(hit), arbiter);
    return {subject, hit, is_ours ? *verdict.software : *verdict.hardware};
}

void print(std::ostream& out, const char* who, bool is_hit, uint instance, uint primitive, double t) {
    out << "  " << std::left << std::setw(12) << who;
    if (is_hit)
        out << "triangle " << primitive << " of instance " << instance << " at t = " << t;
    else
        out << "miss";
}

std::vector<Answer> print_answers(std::ostream& out, const Stage& stage, suite::Devices& devices) {
    std::vector<Answer> answers;
    out << "What the accelerators of " << devices.context(suite::Backend::software).facts().name << " answer at level "
        << stage.replay.level << "\n";
    for (const suite::Backend backend : suite::all_backends) {
        const suite::Subject subject{backend, level_of(stage.replay)};
        const std::string name(suite::name(backend));
        if (const std::string reason = devices.why_not(subject); !reason.empty()) {
            out << "  " << std::left << std::setw(12) << name << "not here: " << reason << '\n';
            continue;
        }
        answers.push_back(answer_of(stage, devices, subject));
        const Hit& hit = answers.back().hit;
        print(out, name.c_str(), hit.hit, hit.instance_index, hit.primitive_index, hit.t);
        out << ": " << twinray::name(answers.back().kind) << '\n';
    }
    return answers;
}

std::vector<TriangleId> print_truth(std::ostream& out, const Stage& stage) {
    const Ray& ray = stage.replay.ray;
    const OracleHit reference = stage.oracle.closest_hit(ray);
    out << "What is true\n";
    print(out, "float64", reference.hit, reference.instance, reference.primitive, reference.t);
    out << (is_certain(stage.oracle, ray, reference) ? ", for certain\n" : "; rounding could decide otherwise\n");
    const auto exact = stage.referee.closest_hit(ray);
    const OracleHit rounded = exact::to_float64(exact, stage.oracle);
    print(out, "exactly", rounded.hit, rounded.instance, rounded.primitive, rounded.t);
    if (!exact) {
        out << '\n';
        return {};
    }
    const char* where[] = {", inside it", ", on its edge", ", at its corner"};
    out << where[static_cast<std::size_t>(exact->crossing.incidence)];
    if (exact->triangles.size() > 1) out << "; " << exact->triangles.size() << " triangles meet the ray at this t";
    out << '\n';
    return exact->triangles;
}

// What the class of an answer means.
const char* meaning(Class kind) {
    switch (kind) {
        case Class::agree: return "it is the referee's answer";
        case Class::tie: return "another triangle at the same distance, within rounding: either is right";
        case Class::boundary:
        case Class::boundary_hw_miss:
            return "a silhouette or a rim is nearer to the ray than float32 rounding, which may decide either way";
        case Class::unspecified: return "Vulkan promises nothing here: unshared edges, or t at an end of the interval";
        case Class::invalid_input: return "nobody may trace this ray, so that it must miss";
        case Class::sw_leak:
        case Class::hw_leak:
            return "no rounding of the ray excuses it: triangles that share their edges close the way, and the ray "
                   "slipped between them";
        case Class::sw_false:
        case Class::hw_false: return "the ray misses the reported triangle by more than rounding, or t is out of range";
        case Class::t_err:
        case Class::hw_t_err: return "the triangle is right, but t, u or v is beyond the error bound";
        case Class::hw_range: return "t, u or v is not finite, or beyond the error bound";
    }
    return "";
}

void print_header(std::ostream& out, const Stage& stage) {
    const Replay& replay = stage.replay;
    out << replay.kind << " of " << replay.backend << " at level " << replay.level << " on " << replay.device << ", "
        << replay.driver << ", twinray " << replay.twinray << '\n'
        << "The ray: origin, t_min, direction, t_max\n  " << suite::hexadecimal(replay.ray) << '\n';
    if (const dvec3& origin = stage.scene.origin; origin != dvec3(0))
        out << "  relative to the local origin " << origin_text(origin) << '\n';
    print(out, "answered", replay.answer.hit, replay.answer.instance_index, replay.answer.primitive_index,
          replay.answer.t);
    out << '\n';
}

}  // namespace

// What the tests in float32 are to the level that was asked.
const char* arithmetic_of(Level level) {
    switch (level) {
        case Level::fast: return "as SwTlas computes them at watertight; fast has others (Moeller-Trumbore)";
        case Level::certified: return "which only leave out what is far; certified decides as the exact lines do";
        default: return "as SwTlas computes them";
    }
}

bool show(const std::filesystem::path& file, suite::Devices& devices, std::ostream& out) {
    const Replay replay = read(file);
    const Stage stage(replay, load_checked(file, replay));
    const auto precision = out.precision(9);
    print_header(out, stage);
    const std::vector<TriangleId> truth = print_truth(out, stage);
    const std::vector<Answer> answers = print_answers(out, stage, devices);

    std::set<TriangleId> involved(truth.begin(), truth.end());
    for (const Answer& answer : answers)
        if (answer.hit.hit) involved.insert({answer.hit.instance_index, answer.hit.primitive_index});
    const Explainer explainer(stage.scene, stage.oracle, replay.ray, level_of(replay));
    out << "Triangle tests in float32, " << arithmetic_of(level_of(replay)) << ", in units of the mesh's size\n";
    for (const TriangleId& triangle : involved) explainer.print_test(out, triangle);
    out << "Boxes, of SwTlas's binary trees, which layout compressed4 rounds outwards; those of the driver cannot be "
           "seen\n";
    for (const TriangleId& triangle : involved) explainer.print_boxes(out, triangle);

    out << "Verdict\n";
    bool is_fault = false;
    for (const Answer& answer : answers) {
        out << "  " << std::left << std::setw(12) << suite::name(answer.subject.backend) << twinray::name(answer.kind)
            << ": " << meaning(answer.kind) << '\n';
        is_fault |= is_fault_of_ours(answer.kind) && answer.subject.level != Level::fast;  // which promises nothing
    }
    out.precision(precision);
    return is_fault;
}

}  // namespace twinray::replay
