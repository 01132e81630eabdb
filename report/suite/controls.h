// SPDX-License-Identifier: MIT
// Negative controls: kernels that leave out something that a promise rests on. A case that counts 0 faults says little
// until it has shown faults of these.
#pragma once

#include <optional>

#include "engine/accel/trace_desc.h"
#include "engine/accel/trace_program.h"

namespace twinray::suite {

// SwTlas's own trace kernel, compiled otherwise.
struct Control {
    TraceProgramCode code;  // its name becomes Record::variant
    // False: whether it shows faults is up to the driver, so that it is only measured.
    bool must_show = true;
    double least_rate = 0;              // of faults, which it must exceed
    std::optional<Layout> layout = {};  // the only one that shows anything
};

// To add one: a macro in shaders/shared that leaves the thing out, and a twinray_compile_shader() of
// shaders/engine/trace.comp with it in this folder's CMakeLists.txt.

// Without `precise`: no operation is NoContraction. Leaks where the driver contracts or reassociates.
Control without_precise();
// What a driver that contracts makes of that, on any driver with float64: edge functions by one rounding instead of
// two, so that two triangles may disagree about the edge between them.
Control contracted();
// Boxes as they are: planes that a ray reaches at the same t are told apart by rounding. Those of compressed4 are
// rounded outwards by more, so that it takes bvh2 to see what the padding is for.
Control without_padding();

}  // namespace twinray::suite
