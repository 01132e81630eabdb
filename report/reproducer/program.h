// SPDX-License-Identifier: MIT
// A C program of plain Vulkan that traces one ray and says whether the answer is right.
#pragma once

#include <span>
#include <string>

#include "report/reproducer/right_answers.h"

namespace twinray::reproducer {

struct ProgramData {
    const Scene& scene;
    Ray ray;
    RightAnswers right;
    bool by_pipeline;      // else by a ray query
    std::string found_on;  // device and driver
};

// Returns the template reproducer.c with this data in place of its example. Floats are hexadecimal, so that nothing
// rounds.
std::string program_text(const ProgramData& data);

// The shaders of the program, as SPIR-V.
struct ProgramShader {
    const char* name;  // "query"
    std::span<const std::uint32_t> spirv;
};
std::span<const ProgramShader> program_shaders();

}  // namespace twinray::reproducer
