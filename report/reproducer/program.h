// A C program of plain Vulkan that traces one ray and says whether the answer is right, and the numbers with which it
// compares the answer.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "validation/reference/classify.h"

namespace twinray::reproducer {

struct Interval {
    double low, high;
    bool holds(double value) const { return low <= value && value <= high; }  // no NaN
};

// A hit of this triangle is right if t, u and v lie within these intervals.
struct RightHit {
    uint instance, primitive;
    Interval t, u, v;
    bool allows(const Hit& hit) const;
};

struct RightAnswers {
    bool is_miss_right = false;
    std::vector<RightHit> hits;  // ascending
    std::string exact;           // the one exact answer in words: "triangle 1 of instance 0 at t = 3/2 (1.5), ..."

    bool allow(const Hit& hit) const;
};

// Judges an answer of the driver by the exact reference, if float64 cannot decide.
HitClass class_of(const ReferenceScene& reference, const Ray& ray, const Hit& hit);

// Returns all answers in which class_of() finds no fault of hardware: the exact answer to some ray within float32
// rounding of this one. u and v may be off by as much as the point that they name, in the worst direction.
RightAnswers right_answers(const ReferenceScene& reference, const Ray& ray);

// Returns the part of one triangle, which is active; nothing if no hit of it is right.
std::optional<RightHit> right_hit(const ReferenceScene& reference, const Ray& ray, uint instance, uint primitive);

struct ProgramData {
    const Scene& scene;
    Ray ray;
    RightAnswers right;
    bool by_pipeline;      // else by a ray query
    std::string found_on;  // device and driver
};

// Returns the template reproducer.c with this data in place of its example. Floats are hexadecimal, so that nothing
// rounds.
std::string program_text(const ProgramData& data);

// The shaders of the program, as SPIR-V.
struct ProgramShader {
    const char* name;  // "query"
    std::span<const std::uint32_t> spirv;
};
std::span<const ProgramShader> program_shaders();

}  // namespace twinray::reproducer
