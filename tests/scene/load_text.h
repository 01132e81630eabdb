// SPDX-License-Identifier: MIT
// Scenes of files that a test writes.
#pragma once

#include <twinray/scene.h>

#include "tests/scene/temp_dir.h"

namespace twinray::test {

// From a file of that name; what it refers to is not there.
inline Scene load_text(const std::string& content, const std::string& name, const std::optional<dvec3>& origin = {}) {
    const TempDir dir;
    return load_scene(dir.write(name, content), origin);
}

// The Error names the file and says `part`.
inline void expect_load_error(const std::string& content, const std::string& name, const std::string& part) {
    const std::string message = error_of([&] { load_text(content, name); });
    expect_contains(message, name);
    expect_contains(message, part);
}

// The scene has as many warnings as parts, in that order.
inline void expect_warnings(const Scene& scene, const std::vector<std::string>& parts) {
    ASSERT_EQ(scene.warnings.size(), parts.size()) << joined(scene.warnings);
    for (std::size_t i = 0; i < parts.size(); ++i) expect_contains(scene.warnings[i], parts[i]);
}

}  // namespace twinray::test
