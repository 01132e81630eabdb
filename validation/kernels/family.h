// SPDX-License-Identifier: MIT
// GPUs that are not there: Mesa's driver RADV compiles for any family of AMD's when it is told to.
#pragma once

#include <string>

namespace twinray::kernels {

// The Vulkan instances of this process that are made from now on see RADV alone, which takes the GPU for one of this
// family. Throws Error where RADV is not installed or knows no such family.
void pretend_family(const std::string& family);

// The file by which the Vulkan loader finds RADV; empty: there is none in the usual folders.
std::string find_radv();

}  // namespace twinray::kernels
