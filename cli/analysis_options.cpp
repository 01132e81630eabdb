#include "cli/analysis_options.h"

#include <array>
#include <utility>

#include "cli/csv_files.h"

namespace twinray::cli {

Section picture_options(PictureOptions& options, const std::string& shows) {
    return {
        "Pictures",
        {{.name = "--picture",
          .value = files(options.files, {".png", ".html", ".glb"}),
          .help = "write a picture of the scene (.png), a page that explains its marks (.html), or the scene itself "
                  "(.glb); colours show " +
                  shows},
         {.name = "--view",
          .value = numbers(options.view, "X Y Z"),
          .help = "viewing direction; without it, that of the scene's first camera, or from the front right and above",
          .needs = {"--picture"}},
         {.name = "--camera",
          .value = numbers(options.camera, "X Y Z X Y Z"),
          .help = "position of the camera, then the point that it looks at; replaces --view",
          .needs = {"--picture"},
          .excludes = {"--view"}},
         {.name = "--picture-size",
          .value = numbers(options.size, "WIDTH HEIGHT", {16, 16384}),
          .help = "size of the image of the scene, in pixels",
          .needs = {"--picture"}},
         {.name = "--cutaway",
          .value = flag(options.is_cutaway),
          .help = "leave out faces seen from their back in the .png, to see into rooms from outside",
          .needs = {"--picture"}}}};
}

Option color_scale_option(PictureOptions& options) {
    const Names<ColorScale> scales = {{"linear", ColorScale::linear}, {"log", ColorScale::log}};
    return {.name = "--color-scale",
            .value = choice(options.color_scale, scales),
            .help = "scale of the colours; without it, the one that fits the values",
            .needs = {"--picture"}};
}

void check_pictures(const PictureOptions& options) {
    for (const std::filesystem::path& file : options.files) check_writable(file);
    if (!options.view.empty())
        frame_scene({}, 1, vec3(options.view[0], options.view[1], options.view[2]));  // throws for no direction
}

void FaceGroupOptions::set_groups(Faces& faces) const {
    if (by == FaceGrouping::custom) faces.set_custom_groups(read_face_groups(file, faces.count()));
}

std::vector<Option> face_group_options(FaceGroupOptions& options, const std::string& of_what,
                                       const std::vector<std::string>& needs) {
    const Names<FaceGrouping> groupings =
        names_of(std::array{FaceGrouping::face, FaceGrouping::mesh, FaceGrouping::instance, FaceGrouping::material});
    Value groups = cli::file(options.file);
    groups.store = [store = groups.store, &options](std::span<const std::string> words) {
        options.by = FaceGrouping::custom;
        return store(words);
    };
    return {{.name = "--by",
             .value = choice(options.by, groupings),
             .help = of_what + " per face, mesh, instance or material",
             .needs = needs},
            {.name = "--groups",
             .value = groups,
             .help = of_what +
                     " per group in a CSV file of face,group, which lists each face once; groups are numbered from 0",
             .needs = needs,
             .excludes = {"--by"}}};
}

Option sides_option(Sides& sides, const std::string& do_what) {
    return {
        .name = "--sides",
        .value = choice(sides, names_of(std::array{Sides::front, Sides::both})),
        .help = "sides of faces that " + do_what + ": the front, from which vertices run counter-clockwise, or both"};
}

Section analysis_output(AnalysisOptions& options, const std::string& output) {
    return {"Output and accelerator", {output_option(file(options.output), output), accel_option(options.accel)}};
}

std::vector<Option> ray_grid_options(RayGridOptions& options) {
    const Names<GridPoints> points = {{"random", GridPoints::random}, {"centers", GridPoints::centers}};
    return {
        {.name = "--direction",
         .value = numbers(options.direction, "X Y Z"),
         .help = "direction of the rays in world space; its length may be anything but 0"},
        {.name = "--grid",
         .value = number(options.side, {1, 65535}),
         .help = "number of cells per side: one ray goes through each of N x N cells perpendicular to the direction",
         .needs = {"--direction"}},
        {.name = "--grid-points",
         .value = choice(options.points, points),
         .help = "position of a ray in its cell; only random positions give confidence intervals",
         .needs = {"--direction"},
         .former_name = "--points"}};
}

RayGridDesc RayGridOptions::desc(const CommonOptions& common) const {
    return {
        .direction = {direction[0], direction[1], direction[2]}, .side = side, .points = points, .seed = common.seed};
}

nlohmann::json RayGridOptions::record() const {
    return {{"direction", direction}, {"grid", side}, {"points", points == GridPoints::random ? "random" : "centers"}};
}

Analysed::Analysed(const AnalysisOptions& options) {
    if (!options.output.empty()) check_writable(options.output);
    check_pictures(options.pictures);
    scene = load_scene(options.scene, options.common);
    context = make_context(options.common);
    choice = choose_accel(context->properties(), options.accel);
    accel = make_accel(*context, choice, scene);
}

nlohmann::json Analysed::record(const char* schema, const AnalysisOptions& options) const {
    nlohmann::json record = base_record(schema, *context, options.scene, scene);
    record.update(describe(choice));
    record.update({{"faces", count_triangles(scene)}, {"seed", options.common.seed}});
    return record;
}

std::string Analysed::head(const char* command, const AnalysisOptions& options) const {
    return text(command, ' ', options.scene.filename().string(), ": ", count_triangles(scene), " faces, ",
                text_of(choice), ", on ", context->properties().name, '\n');
}

std::string speed_text(std::uint64_t rays, double seconds) {
    return text(rays, " rays in ", seconds, " s with copies, ", static_cast<double>(rays) / seconds / 1e6,
                " million per second");
}

std::string text_of(const dvec3& v) { return text("(", v.x, ", ", v.y, ", ", v.z, ")"); }

void write_rows(const std::filesystem::path& file, const std::string& header, std::size_t count,
                const std::function<CsvRow(std::size_t)>& row_of) {
    std::ofstream out(file);
    out << header << '\n';
    for (std::size_t i = 0; i < count; ++i) {
        const CsvRow row = row_of(i);
        const char* separator = "";
        for (const std::uint64_t value : row.first) out << std::exchange(separator, ",") << value;
        for (const std::optional<double>& value : row.rest)
            out << std::exchange(separator, ",") << (value ? digits_of(*value) : "");
        out << '\n';
    }
    if (!out.flush()) fail("'", file.string(), "' cannot be written");
}

}  // namespace twinray::cli
