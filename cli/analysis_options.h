// Shared by commands that compute over a scene: pictures, groups of faces, the scene in an accelerator, a grid of
// parallel rays and tables.
#pragma once

#include <twinray/analysis.h>

#include <fstream>

#include "cli/common.h"
#include "engine/core/stopwatch.h"
#include "samples/support/progress.h"
#include "viewer/picture/face_picture.h"
#include "viewer/picture/page.h"
#include "viewer/picture/scene_picture.h"

namespace twinray::cli {

// Returns --picture and what needs it: the scene in colours, as .png, .html or .glb. `shows`: what colours tell.
Section picture_options(PictureOptions& options, const std::string& shows);
// Returns the option of commands whose colours show values.
Option color_scale_option(PictureOptions& options);
// Throws Error if a file has no folder. Call it before the work, not after it.
void check_pictures(const PictureOptions& options);

// The way in which commands group faces: --by, or --groups with a file.
struct FaceGroupOptions {
    FaceGrouping by = FaceGrouping::face;
    std::filesystem::path file;  // of custom groups

    // Reads the file. Throws Error naming it, also if it does not give the group of each face exactly once.
    void set_groups(Faces& faces) const;
};

// `of_what`: "one row". Both options need the options `needs`.
std::vector<Option> face_group_options(FaceGroupOptions& options, const std::string& of_what,
                                       const std::vector<std::string>& needs = {});

// Returns --sides: which sides of faces do something, such as "receive light".
Option sides_option(Sides& sides, const std::string& do_what);

struct AnalysisOptions {
    CommonOptions common;
    std::filesystem::path scene, output;
    std::string accel = "auto";
    PictureOptions pictures;
};
// `output`: what -o writes.
Section analysis_output(AnalysisOptions& options, const std::string& output);

struct RayGridOptions {
    std::vector<double> direction;
    uint side = 1000;
    GridPoints points = GridPoints::random;

    RayGridDesc desc(const CommonOptions& common) const;
    nlohmann::json record() const;
};
// Returns --direction, then the other options, which need it.
std::vector<Option> ray_grid_options(RayGridOptions& options);

// A scene in an accelerator.
struct Analysed {
    Scene scene;
    std::unique_ptr<Context> context;
    AccelChoice choice;
    std::unique_ptr<AbstractAccel> accel;

    explicit Analysed(const AnalysisOptions& options);
    nlohmann::json record(const char* schema, const AnalysisOptions& options) const;
    // Returns "illumination house.glb: 12 faces, by SwTlas (...), on llvmpipe".
    std::string head(const char* command, const AnalysisOptions& options) const;
};

// Returns "1000000 rays in 0.5 s with copies, 2 million a second".
std::string speed_text(std::uint64_t rays, double seconds);
// Returns "(1, 0, 0)".
std::string text_of(const dvec3& v);

struct CsvRow {
    std::vector<std::uint64_t> first;
    std::vector<std::optional<double>> rest;
};
// Writes a table of numbers in as few digits as give the same float64; missing ones are empty. Throws Error if it
// cannot be written.
void write_rows(const std::filesystem::path& file, const std::string& header, std::size_t count,
                const std::function<CsvRow(std::size_t)>& row_of);

}  // namespace twinray::cli
