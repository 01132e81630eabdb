// SPDX-License-Identifier: MIT
// The addresses among the arguments of a kernel. Some drivers read through an address before they know that the branch
// around the read is not taken (lavapipe from Mesa 26.1 on), so a kernel never gets an unreadable one: it gets
// Context::absent if the host gives 0 for absent data.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/core/pipeline_table.h"

namespace twinray {

// Returns all members of type REF(T), by the names that glslang leaves in a module, but not those in arrays. Members of
// type Address cannot be told from other pairs of words; hosts never leave those 0.
std::vector<KernelAddress> kernel_addresses(std::span<const std::uint32_t> spirv);

// Returns the arguments with Context::absent in place of 0. With ContextDesc::validation, and on a CPU, whose addresses
// are those of the host, an unreadable address becomes a validation message that names kernel and argument. Throws
// Error for arguments that are shorter than the module's.
std::vector<std::byte> readable_args(Context& context, const std::string& kernel,
                                     std::span<const KernelAddress> addresses, std::span<const std::byte> args);

}  // namespace twinray
