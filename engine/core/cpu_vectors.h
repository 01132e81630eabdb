// SPDX-License-Identifier: MIT
// The width of vectors that a driver for CPUs computes with.
#pragma once

#include <filesystem>
#include <optional>

#include <twinray/context.h>

namespace twinray {

// Whether this is a CPU with AVX-512 (F, BW, DQ, VL) that the system lets programs use.
bool prefers_512_bit_vectors();

// The release of Mesa that a device's driver is of, where it is lavapipe: 25, 26; else 0.
int lavapipe_release(const DeviceProperties& device);

// Whether the driver of a CPU computes with vectors of any width (LP_NATIVE_VECTOR_WIDTH): Mesa's did below 26. From 26
// on its own builds of acceleration structures crash at widths other than the one that it chooses.
bool takes_any_vector_width(const DeviceProperties& device);

// Where Mesa is to keep code for 512 bits, which is then there; nothing where the width should stay. `is_set`: by the
// user. `caches`: empty where there are none.
std::optional<std::filesystem::path> folder_of_wide_code(bool is_preferred, bool is_set,
                                                         const std::filesystem::path& caches);

}  // namespace twinray
