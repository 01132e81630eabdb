// SPDX-License-Identifier: MIT
// The common beginning of kernels of analyses. A face: they are numbered by instance, then by triangle.
#include "twinray/glsl/common.glsl"

struct Face {
    uint instance;
    uint primitive;
};
