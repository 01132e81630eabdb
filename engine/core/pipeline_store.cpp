// SPDX-License-Identifier: MIT
#include "engine/core/pipeline_store.h"

#include <algorithm>
#include <cstring>
#include <iomanip>

#include "engine/core/error.h"
#include "engine/core/platform.h"

namespace twinray {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view prefix = "pipelines-";
constexpr std::string_view suffix = ".bin";

std::string name_for(const VkPhysicalDeviceProperties& driver) {
    std::ostringstream name;
    name << prefix << std::hex << driver.vendorID << '-' << driver.deviceID << '-' << driver.driverVersion << '-'
         << std::setfill('0');
    for (const std::uint8_t byte : driver.pipelineCacheUUID) name << std::setw(2) << uint{byte};
    name << suffix;
    return name.str();
}

bool is_ours(const fs::path& file) {
    const std::string name = file.filename().string();
    return name.starts_with(prefix) && name.ends_with(suffix);
}

// Returns whether data of a pipeline cache begins with the header of this driver (VkPipelineCacheHeaderVersionOne).
bool is_of_driver(std::span<const std::byte> pipelines, const VkPhysicalDeviceProperties& driver) {
    VkPipelineCacheHeaderVersionOne header;
    if (pipelines.size() < sizeof header) return false;
    std::memcpy(&header, pipelines.data(), sizeof header);
    return header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE && header.vendorID == driver.vendorID &&
           header.deviceID == driver.deviceID &&
           std::equal(std::begin(header.pipelineCacheUUID), std::end(header.pipelineCacheUUID),
                      driver.pipelineCacheUUID);
}

void remove_oldest(const fs::path& folder, std::size_t keep) {
    std::vector<std::pair<fs::file_time_type, fs::path>> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
        if (entry.is_regular_file() && is_ours(entry.path())) files.emplace_back(entry.last_write_time(), entry.path());
    std::sort(files.begin(), files.end());
    for (std::size_t i = 0; i + keep < files.size(); ++i) fs::remove(files[i].second);
}

}  // namespace

PipelineStore::PipelineStore(fs::path folder, const VkPhysicalDeviceProperties& driver)
    : file_(folder.empty() ? fs::path() : folder / name_for(driver)), driver_(driver) {}

Bytes PipelineStore::load(const std::function<void(std::string_view)>& log) const {
    std::error_code error;
    if (file_.empty() || !fs::exists(file_, error)) return {};
    try {
        Bytes pipelines = read_file(file_);
        if (is_of_driver(std::as_bytes(std::span(pipelines)), driver_)) return pipelines;
        log(text("'", file_.string(), "': its pipelines are not of this driver; they are compiled again"));
    } catch (const std::exception& failure) {
        log(failure.what());
    }
    return {};
}

void PipelineStore::save(std::span<const std::byte> pipelines,
                         const std::function<void(std::string_view)>& log) const noexcept {
    if (file_.empty()) return;
    try {
        replace(pipelines);
    } catch (const std::exception& failure) {
        log(failure.what());
    }
}

void PipelineStore::replace(std::span<const std::byte> pipelines) const {
    fs::create_directories(file_.parent_path());
    if (pipelines.size() > most_bytes || !is_of_driver(pipelines, driver_)) {
        fs::remove(file_);
        return;
    }
    const std::span<const std::byte> pieces[] = {pipelines};
    write_file(file_, pieces);
    remove_oldest(file_.parent_path(), most_files);
}

fs::path user_pipeline_folder() { return platform::cache_folder(); }

}  // namespace twinray
