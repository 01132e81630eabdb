// SPDX-License-Identifier: MIT
// What a driver may answer to a ray, as numbers that a program without twinray can compare with.
#pragma once

#include <string>
#include <vector>

#include "validation/reference/classify.h"

namespace twinray::reproducer {

struct Interval {
    double low, high;
    bool holds(double value) const { return low <= value && value <= high; }  // no NaN
};

// A hit of this triangle is right where t, u and v lie within.
struct RightHit {
    uint instance, primitive;
    Interval t, u, v;
};

struct RightAnswers {
    bool is_miss_right = false;
    std::vector<RightHit> hits;  // ascending
    std::string exact;           // the one exact answer in words: "triangle 1 of instance 0 at t = 3/2 (1.5), ..."

    bool allow(const Hit& hit) const;
};

// All that classify() finds no fault of hardware in: the exact answer to some ray within float32 rounding of this one.
// u and v may be off by as much as the point that they name may, in the worst direction.
RightAnswers right_answers(const ReferenceScene& reference, const Ray& ray);

}  // namespace twinray::reproducer
