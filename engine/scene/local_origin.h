// SPDX-License-Identifier: MIT
#pragma once

namespace twinray {

// Whether float32 rounds a coordinate of this magnitude by more than a millionth of the extent, a micrometre a metre.
// It rounds by up to 2^-24 of the magnitude: more than 2^-20 of the extent beyond 16 extents. About its own middle the
// same model is rounded by up to 2^-25 of its extent.
bool is_far(double distance, double extent);

}  // namespace twinray
