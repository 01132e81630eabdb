// SPDX-License-Identifier: MIT
// Scenes from files that a test writes.
#pragma once

#include <twinray/scene.h>

#include "tests/scene/temp_dir.h"

namespace twinray::test {

// Loads a scene from a file of that name; the files that it refers to do not exist.
inline Scene load_text(const std::string& content, const std::string& name, const std::optional<dvec3>& origin = {}) {
    const TempDir dir;
    return load_scene(dir.write(name, content), origin);
}

// Expects an Error that names the file and says `part`.
inline void expect_load_error(const std::string& content, const std::string& name, const std::string& part) {
    const std::string message = error_of([&] { load_text(content, name); });
    expect_contains(message, name);
    expect_contains(message, part);
}

// Expects as many warnings as parts, in that order.
inline void expect_warnings(const Scene& scene, const std::vector<std::string>& parts) {
    ASSERT_EQ(scene.warnings.size(), parts.size()) << joined(scene.warnings);
    for (std::size_t i = 0; i < parts.size(); ++i) expect_contains(scene.warnings[i], parts[i]);
}

}  // namespace twinray::test
