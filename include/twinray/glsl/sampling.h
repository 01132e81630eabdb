// SPDX-License-Identifier: MIT
// Warps from the unit square, and local frames.
#ifndef TWINRAY_SAMPLING_H
#define TWINRAY_SAMPLING_H

const float PI = 3.14159265358979f;

// Returns (cos, sin) of `turns` whole turns, for |turns| below 2^20. Vulkan promises only 11 bits of its own sin and
// cos; these Taylor polynomials on an eighth of a turn are good to 23.
FUNC vec2 unit_circle(float turns) {
    float quarters = floor(turns * 4.0f + 0.5f);
    float x = (turns - quarters * 0.25f) * (2.0f * PI);
    float x2 = x * x;
    float s = 1.0f + x2 * (-1.0f / 6.0f + x2 * (1.0f / 120.0f + x2 * (-1.0f / 5040.0f + x2 * (1.0f / 362880.0f))));
    s = s * x;
    float c = 1.0f + x2 * (-0.5f + x2 * (1.0f / 24.0f + x2 * (-1.0f / 720.0f + x2 * (1.0f / 40320.0f))));
    int quadrant = int(quarters) & 3;
    vec2 even = (quadrant & 1) == 0 ? vec2(c, s) : vec2(-s, c);
    return quadrant < 2 ? even : -even;
}

// Samples with the density cos / pi.
FUNC vec3 sample_cosine_hemisphere(vec2 u) {
    vec2 circle = unit_circle(u.y) * sqrt(u.x);
    return vec3(circle.x, circle.y, sqrt(1.0f - u.x));
}

// Returns barycentric u and v, uniform by area.
FUNC vec2 sample_triangle(vec2 u) {
    float root = sqrt(u.x);
    return vec2(1.0f - root, u.y * root);
}

// Three perpendicular unit axes, right-handed.
struct Frame {
    vec3 x;
    vec3 y;
    vec3 z;
};

// Makes a frame about z: Duff et al., "Building an Orthonormal Basis, Revisited", 2017.
FUNC Frame frame_about(vec3 z) {
    float s = z.z < 0.0f ? -1.0f : 1.0f;
    float a = -1.0f / (s + z.z);
    float b = z.x * z.y * a;
    Frame frame;
    frame.x = vec3(1.0f + s * z.x * z.x * a, s * b, -s * z.x);
    frame.y = vec3(b, s + z.y * z.y * a, -z.y);
    frame.z = z;
    return frame;
}

// Returns the components of v along the axes of the frame.
FUNC vec3 to_local(Frame frame, vec3 v) { return vec3(dot(frame.x, v), dot(frame.y, v), dot(frame.z, v)); }
// Returns the vector with these components.
FUNC vec3 to_world(Frame frame, vec3 v) { return frame.x * v.x + frame.y * v.y + frame.z * v.z; }

#endif
