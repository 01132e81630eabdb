// SPDX-License-Identifier: MIT
#include "cli/view_factor_picture.h"

#include <cmath>

#include <twinray/scene.h>

#include "cli/command/values.h"
#include "engine/core/error.h"
#include "viewer/picture/matrix_picture.h"

namespace twinray::cli {
namespace {

std::vector<double> open_fractions(const std::vector<ViewFactorRow>& rows) {
    std::vector<double> values;
    for (const ViewFactorRow& row : rows) values.push_back(row.rays > 0 ? row.open.value : NAN);
    return values;
}

std::vector<double> factors_of(const ViewFactorRow& row, std::size_t count) {
    std::vector<double> values(count, NAN);
    for (const ViewFactor& factor : row.factors) values[factor.target] = static_cast<double>(factor.value);
    return values;
}

std::vector<double> by_face(const std::vector<uint>& groups, const std::vector<double>& values) {
    std::vector<double> of_faces;
    for (const uint group : groups) of_faces.push_back(values[group]);
    return of_faces;
}

}  // namespace

std::vector<Option> view_factor_picture_options(ViewFactorPictureOptions& options) {
    return {{.name = "--from",
             .value = number(options.from),
             .help = "the row whose view factors --picture shows, from 0",
             .needs = {"--picture"}},
            {.name = "--matrix",
             .value = file(options.matrix, {".png"}),
             .help = "a picture of the matrix, on a logarithmic scale"}};
}

void check_shown(const ViewFactorPictureOptions& options, std::size_t row_count) {
    if (options.from && *options.from >= row_count)
        fail("--from ", *options.from, ": there are ", row_count, " rows, the first is 0");
}

ScenePicture picture_of_view_factors(const PictureOptions& options, const ViewFactorPictureOptions& shown,
                                     const std::string& scene, const std::vector<uint>& groups,
                                     const std::vector<ViewFactorRow>& rows) {
    if (!shown.from) {
        ScenePicture picture = picture_of_values(options, by_face(groups, open_fractions(rows)), "open");
        picture.page.title = scene + ": open fraction";
        picture.page.subtitle = "part of the diffuse radiation of a face that meets nothing";
        return picture;
    }
    const std::vector<double> values = by_face(groups, factors_of(rows[*shown.from], rows.size()));
    ScenePicture picture = picture_of_values(options, values, "F", ColorScale::log);
    for (std::size_t face = 0; face < groups.size(); ++face)
        if (groups[face] == *shown.from) picture.colors[face] = categorical::vermilion;
    picture.page.legend.entries.push_back({categorical::vermilion, text("row ", *shown.from)});
    picture.page.title = text(scene, ": view factors of row ", *shown.from);
    picture.page.subtitle = "part of its diffuse radiation that meets each group of faces";
    return picture;
}

void write_matrix(const std::filesystem::path& file, const std::string& scene, FaceGrouping grouping,
                  const std::vector<ViewFactorRow>& rows) {
    std::vector<MatrixEntry> entries;
    for (const ViewFactorRow& row : rows)
        for (const ViewFactor& factor : row.factors) entries.push_back({row.group, factor.target, factor.value});
    const Raster raster = draw_matrix(rows.size(), entries,
                                      {.title = scene + ": view factors",
                                       .subtitle = text("row: from which ", name_of(grouping), ", column: to which"),
                                       .legend = {.title = "F", .scale = {}, .entries = {}}});
    write_png(file, raster.width, raster.height, raster.pixels);
}

}  // namespace twinray::cli
