// The only file that compiles tinygltf. Debian's shared library is not used: libdraco, which an application may link,
// exports another version of the same symbols, and the order of linking would decide which one is called.
#include <nlohmann/json.hpp>

#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_INCLUDE_JSON
#include <tiny_gltf.h>
