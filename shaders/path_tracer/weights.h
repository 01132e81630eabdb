// SPDX-License-Identifier: MIT
// Weights of samples, sizes of colours.
#ifndef TWINRAY_PATH_TRACER_WEIGHTS_H
#define TWINRAY_PATH_TRACER_WEIGHTS_H

// Returns Veach's power heuristic with exponent 2, without overflow. Density 0 of `own` means that it needs no partner.
FUNC float mis_weight(float own, float other) {
    if (own <= 0.0f) return 1.0f;
    float ratio = other / own;
    return 1.0f / (1.0f + ratio * ratio);
}

FUNC float luminance(vec3 color) { return dot(color, vec3(0.2126f, 0.7152f, 0.0722f)); }
FUNC float largest(vec3 color) { return max(color.x, max(color.y, color.z)); }
#endif
