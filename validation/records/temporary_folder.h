// SPDX-License-Identifier: MIT
// A folder for files that nobody keeps.
#pragma once

#include <filesystem>
#include <system_error>

#include "engine/core/platform.h"

namespace twinray {

// A folder that exists while this object lives. Throws Error if there is no place for one.
class TemporaryFolder {
  public:
    TemporaryFolder() = default;
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_ = platform::make_temporary_folder();
};

}  // namespace twinray
