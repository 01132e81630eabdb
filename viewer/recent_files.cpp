// SPDX-License-Identifier: MIT
#include "viewer/recent_files.h"

#include <algorithm>
#include <fstream>
#include <string>

#include "engine/core/platform.h"

namespace twinray::viewer {
namespace {

constexpr std::size_t most_files = 8;

}  // namespace

std::filesystem::path recent_list() {
    const std::filesystem::path folder = platform::state_folder();
    return folder.empty() ? folder : folder / "recent";
}

std::vector<std::filesystem::path> recent_files(const std::filesystem::path& list) {
    std::ifstream in(list);
    std::vector<std::filesystem::path> files;
    std::error_code none;
    for (std::string line; files.size() < most_files && std::getline(in, line);)
        if (const std::filesystem::path file = platform::path_of(line); std::filesystem::is_regular_file(file, none))
            files.push_back(file);
    return files;
}

void keep_recent(const std::filesystem::path& list, const std::filesystem::path& file) {
    if (list.empty()) return;
    std::error_code none;
    const std::filesystem::path shown = std::filesystem::absolute(file, none);
    std::vector<std::filesystem::path> files = recent_files(list);
    std::erase(files, shown);
    files.insert(files.begin(), shown);
    files.resize(std::min(files.size(), most_files));
    std::filesystem::create_directories(list.parent_path(), none);
    std::ofstream out(list);
    for (const std::filesystem::path& each : files) out << each.string() << '\n';
}

}  // namespace twinray::viewer
