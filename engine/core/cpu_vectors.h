// SPDX-License-Identifier: MIT
// Facts about Mesa's CPU driver, and about the CPU that it runs on.
#pragma once

#include <twinray/context.h>

namespace twinray {

// Returns the number of threads on which a CPU driver runs groups: LP_NUM_THREADS (of Mesa) if that is a number above
// 0, else one per core.
unsigned count_cpu_threads();

// Returns whether this is a CPU with AVX-512 (F, BW, DQ, VL) that the system lets programs use.
bool has_512_bit_vectors();

// Returns the release of Mesa if the device's driver is lavapipe: 25, 26; else 0.
int lavapipe_release(const DeviceProperties& device);

// Returns whether the driver of a CPU computes with vectors of any width (LP_NATIVE_VECTOR_WIDTH): Mesa's did below 26.
// In 26 and later, its own builds of acceleration structures crash at widths other than the one that it chooses.
bool takes_any_vector_width(const DeviceProperties& device);

}  // namespace twinray
