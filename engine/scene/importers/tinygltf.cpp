// SPDX-License-Identifier: MIT
// The one file that compiles tinygltf. Debian's shared library is not used: libdraco, which a host may bring
// along, exports another version of the same symbols, and which one is called would depend on the order of linking.
#include <nlohmann/json.hpp>

#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_INCLUDE_JSON
#include <tiny_gltf.h>
