// SPDX-License-Identifier: MIT
#include <algorithm>
#include <string_view>

#include "tests/fuzz/scene_contract.h"

namespace twinray::fuzz {

// What follows the first line "#mtl" is the library of materials, "input.mtl".
void obj(Input input) {
    constexpr std::string_view border = "\n#mtl\n";
    const auto found = std::search(input.begin(), input.end(), border.begin(), border.end());
    const auto size = static_cast<std::size_t>(found - input.begin());
    file_of(input.subspan(found == input.end() ? size : size + border.size()), "input.mtl");
    load_whole_scene(file_of(input.first(size), "input.obj"));
}

}  // namespace twinray::fuzz
