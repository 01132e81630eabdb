// SPDX-License-Identifier: MIT
// Perceived differences of pictures.
#pragma once

#include <twinray/scene.h>

namespace twinray::suite {

// Return how far two pictures differ to the eye when they alternate, from 0 to 1, for each pixel or in the mean:
// LDR-FLIP (Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", 2020), of linear radiance cut to
// [0, 1]. Both are equally large. pixels_per_degree: 67 is a screen of 0.7 m and 3840 pixels, seen from 0.7 m.
std::vector<double> flip(const HdrImage& test, const HdrImage& reference, double pixels_per_degree = 67);
double mean_flip(const HdrImage& test, const HdrImage& reference);

}  // namespace twinray::suite
