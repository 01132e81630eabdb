// SPDX-License-Identifier: MIT
// A ray in float64, 64 bytes.
#ifndef TWINRAY_RAY64_H
#define TWINRAY_RAY64_H

// Like Ray, in float64.
struct Ray64 {
    dvec3 origin;
    double t_min;
    dvec3 direction;
    double t_max;
};
BUFFER_OF(Ray64, 8);
#endif
