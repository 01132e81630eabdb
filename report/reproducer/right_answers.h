// SPDX-License-Identifier: MIT
// The answers that a driver may give to a ray, as numbers that a program without twinray can compare with.
#pragma once

#include <optional>
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

}  // namespace twinray::reproducer
