// SPDX-License-Identifier: MIT
// What `twinray illumination` and `twinray centroid` share: a scene, an accelerator and a grid of parallel rays.
#pragma once

#include <fstream>
#include <functional>
#include <optional>
#include <vector>

#include "cli/picture_options.h"
#include "engine/analysis/ray_grid.h"

namespace twinray::cli {

struct AnalysisOptions {
    CommonOptions common;
    std::filesystem::path scene, output;
    std::string accel = "hw";
    PictureOptions pictures;
};
// `output` and `shows`: what -o writes, and what colours of pictures tell.
void add_analysis_options(CLI::App& command, AnalysisOptions& options, const std::string& output,
                          const std::string& shows);

struct RayGridOptions {
    std::vector<double> direction;
    uint side = 1000;
    GridPoints points = GridPoints::random;

    RayGridDesc desc(const CommonOptions& common) const;
    nlohmann::json record() const;
};
// Returns --direction, which goes into `source`: the command or a group of its options. The others need it.
CLI::Option* add_ray_grid_options(CLI::App& command, CLI::App& source, RayGridOptions& options);

// A scene in an accelerator.
struct Analysed {
    Scene scene;
    std::unique_ptr<Context> context;
    std::unique_ptr<AbstractAccel> accel;

    explicit Analysed(const AnalysisOptions& options);
    nlohmann::json record(const AnalysisOptions& options) const;
};

double seconds_of(const std::function<void()>& work);
// "1000000 rays in 0.5 s with copies, 2 million a second".
std::string speed_text(std::uint64_t rays, double seconds);
// "(1, 0, 0)".
std::string text_of(const glm::dvec3& v);

// A table of numbers. Throws Error if it cannot be written.
class CsvFile {
  public:
    CsvFile(const std::filesystem::path& file, const std::string& header);
    // Numbers in as few digits as give the same float64; those that are missing are empty.
    void row(std::initializer_list<std::uint64_t> first, std::initializer_list<std::optional<double>> rest);
    void close();

  private:
    std::filesystem::path file_;
    std::ofstream out_;
};

}  // namespace twinray::cli
