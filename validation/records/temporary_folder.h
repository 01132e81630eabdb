// SPDX-License-Identifier: MIT
// A folder for files that nobody keeps.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

#include "engine/core/error.h"

namespace twinray {

// There while this lives. Throws Error where there is no place for one.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "twinray-XXXXXX").string();
        if (!mkdtemp(name.data())) fail(name, ": cannot create temporary files; set TMPDIR to a writable folder");
        path_ = name;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

}  // namespace twinray
