// SPDX-License-Identifier: MIT
// Signs of volumes and areas in float64, if they are certain. The bounds are those of the first stage of Shewchuk,
// "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997: (7 + 56 u) u and (3 + 16
// u) u of the magnitudes added up, u = 2^-53, here rounded up to 8 u and 4 u. They hold while nothing over- or
// underflows, as among vertices of world_vertex(): see world_vertex.h.
#ifndef TWINRAY_COLLIDE_ORIENT_H
#define TWINRAY_COLLIDE_ORIENT_H

const int UNKNOWN_SIGN = 2;

FUNC int certain_sign(double value, double bound) {
    if (value > bound) return 1;
    if (-value > bound) return -1;
    return bound == double(0.0f) ? 0 : UNKNOWN_SIGN;  // 0: each product has a factor of exactly 0
}

// Returns the sign of det(a - d, b - d, c - d): positive if d sees a, b, c turn clockwise. 0 if two points are one.
FUNC int filtered_volume_sign(dvec3 a, dvec3 b, dvec3 c, dvec3 d) {
    const double BOUND = double(8.8817841970012523e-16f);
    if (a == b || a == c || a == d || b == c || b == d || c == d) return 0;
    PRECISE dvec3 ad = a - d;
    PRECISE dvec3 bd = b - d;
    PRECISE dvec3 cd = c - d;
    PRECISE double bc = bd.x * cd.y;
    PRECISE double cb = cd.x * bd.y;
    PRECISE double ca = cd.x * ad.y;
    PRECISE double ac = ad.x * cd.y;
    PRECISE double ab = ad.x * bd.y;
    PRECISE double ba = bd.x * ad.y;
    PRECISE double volume = ad.z * (bc - cb) + bd.z * (ca - ac) + cd.z * (ab - ba);
    PRECISE double size =
        (abs(bc) + abs(cb)) * abs(ad.z) + (abs(ca) + abs(ac)) * abs(bd.z) + (abs(ab) + abs(ba)) * abs(cd.z);
    PRECISE double bound = BOUND * size;
    return certain_sign(volume, bound);
}

// Returns the coordinates across `axis`, in cyclic order of x, y, z.
FUNC dvec2 without_axis(dvec3 p, uint axis) {
    if (axis == 0u) return dvec2(p.y, p.z);
    if (axis == 1u) return dvec2(p.z, p.x);
    return dvec2(p.x, p.y);
}

// Returns the sign of det(a - c, b - c) as seen along an axis: positive if a, b, c turn anticlockwise, 0 if two are
// equal.
FUNC int filtered_area_sign(dvec3 a, dvec3 b, dvec3 c, uint axis) {
    const double BOUND = double(4.4408920985006262e-16f);
    if (a == b || a == c || b == c) return 0;
    dvec2 a2 = without_axis(a, axis);
    dvec2 b2 = without_axis(b, axis);
    dvec2 c2 = without_axis(c, axis);
    PRECISE dvec2 ac = a2 - c2;
    PRECISE dvec2 bc = b2 - c2;
    PRECISE double left = ac.x * bc.y;
    PRECISE double right = ac.y * bc.x;
    PRECISE double area = left - right;
    PRECISE double bound = BOUND * (abs(left) + abs(right));
    return certain_sign(area, bound);
}
#endif
