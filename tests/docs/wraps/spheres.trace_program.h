// SPDX-License-Identifier: MIT
// As twinray_add_trace_program() makes it of the page's spheres.glsl.
#pragma once
#include <twinray/trace.h>

extern const twinray::TraceProgramCode spheres;
