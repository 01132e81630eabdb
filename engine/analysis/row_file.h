// SPDX-License-Identifier: MIT
// Finished rows of view factors on disk, so that work goes on where it was killed.
#pragma once

#include <filesystem>
#include <fstream>

#include "engine/analysis/view_factors.h"

namespace twinray {

// Rows are appended in order and flushed; each ends with a checksum, so that one that was cut short is seen.
class RowFile {
  public:
    // `configuration` tells of what the rows are; it must be the same in all runs that share the file.
    RowFile(std::filesystem::path file, std::string configuration);

    // The rows that are there, the first ones in order without a gap; cuts off what follows them. None where there is
    // no such file. Throws Error where it is of another configuration.
    std::vector<ViewFactorRow> load();
    // Begins anew, without rows.
    void create();
    // After load() or create(). Throws Error naming the file where it cannot be written.
    void append(std::span<const ViewFactorRow> rows);
    void remove();

  private:
    void open_at(std::uint64_t bytes);

    std::filesystem::path file_;
    std::string configuration_;
    std::ofstream out_;
};

}  // namespace twinray
