// Classifies triangles without error: the signs of volumes and areas that float64 leaves open are computed by
// expansions of doubles. Coordinates must be 0 or of a magnitude from 2^-245 to 2^259, as those of world_vertex.h are:
// then no operation over- or underflows.
#pragma once

#include <array>
#include <cstddef>

#include "engine/collide/pair_class.h"

namespace twinray {

// Returns the class.
PairClass exact_class(const WorldTriangle& a, const WorldTriangle& b);

// The same for triangles of meshes: two of one run that share vertices are separate unless they have more in common
// than these and the edge between two of them.
PairClass exact_class(const WorldTriangle& a, const TriangleName& a_name, const WorldTriangle& b,
                      const TriangleName& b_name);

// Needs two triangles of class crossing.
ContactSegment crossing_segment(const WorldTriangle& a, const WorldTriangle& b);

#include "twinray/glsl/cpp_begin.h"
#include "shaders/collide/orient.h"
#include "twinray/glsl/cpp_end.h"

// A sum of doubles without rounding, as doubles that do not overlap, the largest last (Shewchuk 1997, GROW-EXPANSION
// with zeros left out). Exact as long as nothing over- or underflows.
class Expansion {
  public:
    // Adds a term; at most 192 times.
    void add(double term);
    // Adds x y z without rounding: four terms.
    void add_product(double x, double y, double z);
    int sign() const { return size_ == 0 ? 0 : terms_[size_ - 1] > 0 ? 1 : -1; }
    // Returns the sum with a relative error of 2^-51.
    double value() const;

  private:
    std::array<double, 192> terms_;
    std::size_t size_ = 0;
};

// Return det(a - d, b - d, c - d), and its sign: 1 if d sees a, b, c turn clockwise.
Expansion volume_of(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d);
int volume_sign(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d);
// Returns the sign of det(a - c, b - c) as seen along an axis: 1 if a, b, c turn anticlockwise.
int area_sign(const dvec3& a, const dvec3& b, const dvec3& c, uint axis);

// Says why signs of these coordinates may be wrong, "" if they are right.
std::string sign_fault_of(const dvec3& point);

}  // namespace twinray
