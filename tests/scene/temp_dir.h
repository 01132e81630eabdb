// A folder that is gone after the test.
#pragma once

#include <filesystem>
#include <fstream>

#include "engine/core/platform.h"
#include "tests/support/errors.h"

namespace twinray::test {

// A fresh folder that disappears with its test.
class TempDir {
  public:
    TempDir() = default;
    ~TempDir() { std::filesystem::remove_all(path_); }
    TempDir(const TempDir&) = delete;
    TempDir& operator=(const TempDir&) = delete;

    std::filesystem::path operator/(const std::string& name) const { return path_ / platform::path_of(name); }

    // Writes the file and returns its path.
    std::filesystem::path write(const std::string& name, std::string_view content) const {
        const std::filesystem::path file = *this / name;
        std::ofstream(file, std::ios::binary).write(content.data(), static_cast<std::streamsize>(content.size()));
        return file;
    }

  private:
    std::filesystem::path path_ = platform::make_temporary_folder();
};

inline std::string replaced(std::string all, const std::string& from, const std::string& to) {
    for (std::size_t at = all.find(from); at != all.npos; at = all.find(from, at + to.size()))
        all.replace(at, from.size(), to);
    return all;
}

}  // namespace twinray::test
