// `twinray illumination`: what parallel light, the sky or the sun bring to each face.
#include <cmath>

#include "cli/analysis_options.h"
#include "cli/csv_files.h"
#include "cli/shards.h"
#include "engine/analysis/ray_grid.h"

namespace twinray::cli {
namespace {

struct IlluminationOptions : AnalysisOptions {
    ShardOptions shards;
    RayGridOptions grid;
    uint sky = 0;  // rays a face; 0: the sun
    std::vector<double> up = {0, 1, 0};
    std::filesystem::path sun;
    uint samples = 16;
    Sides sides = Sides::both;
    FaceGroupOptions groups;
    std::string measure = "area";
};

// Returns the divisor of areas; 0 if there is nothing to divide.
double unit_of(const LitArea& lit, const std::string& measure) {
    if (measure == "fraction") return lit.unobstructed;
    return measure == "irradiance" ? lit.surface : 1;
}

void write(const IlluminationOptions& options, const Illumination& result) {
    const std::string header = text(name_of(options.groups.by), ",hits,", options.measure, ",ci_low,ci_high");
    write_rows(options.output, header, result.groups.size(), [&](std::size_t group) -> CsvRow {
        const LitArea& lit = result.groups[group];
        const double unit = unit_of(lit, options.measure);
        const auto share = [&](double area) { return unit > 0 ? area / unit : 0; };
        std::optional<double> low, high;
        if (options.grid.points == GridPoints::random) low = share(lit.interval.low), high = share(lit.interval.high);
        return {{group, lit.hits}, {share(lit.area), low, high}};
    });
}

// Shows each face with the value of its group.
ScenePicture picture_of(const IlluminationOptions& options, const Faces& faces, const Illumination& result) {
    const std::string& what = options.measure;
    std::vector<double> values;
    for (const uint group : faces.groups(options.groups.by)) {
        const LitArea& lit = result.groups[group];
        const double unit = unit_of(lit, options.measure);
        values.push_back(unit > 0 ? lit.area / unit : NAN);
    }
    ScenePicture picture = picture_of_values(options.pictures, values, what);
    const std::vector<double>& d = options.grid.direction;
    picture.page.title = options.scene.filename().string() + ": light of one direction";
    picture.page.subtitle = text(what, " by ", name_of(options.groups.by), ", direction ", text_of({d[0], d[1], d[2]}),
                                 ", ", result.ray_count, " rays");
    return picture;
}

void print(const IlluminationOptions& options, const Analysed& analysed, const Illumination& result, double seconds) {
    const LitArea& total = result.total;
    const auto lit = std::ranges::count_if(result.groups, [](const LitArea& g) { return g.hits > 0; });
    std::cout << analysed.head("illumination", options) << "  " << speed_text(result.ray_count, seconds)
              << "\n  lit: " << lit << " of " << result.groups.size() << " by " << name_of(options.groups.by)
              << "; area across the light " << total.area;
    if (options.grid.points == GridPoints::random)
        std::cout << " [" << total.interval.low << ", " << total.interval.high << "]";
    std::cout << ", without shadows " << total.unobstructed << '\n';
}

// Computes rows, which are pairs of rays, and adds up their counts. Returns nothing if another process goes on.
std::optional<Illumination> compute(const Shards& shards, const IlluminationOptions& options, const Analysed& analysed,
                                    const Faces& faces, const RayGridDesc& grid) {
    samples::Progress progress("illumination", std::uint64_t{grid.side} * grid.side, options.common.quiet);
    const IlluminationDesc desc{
        .grid = grid, .sides = options.sides, .by = options.groups.by, .progress = [&](std::uint64_t rays) {
            progress.advance(rays);
        }};
    if (shards.is_whole()) return illuminate(*analysed.accel, faces, desc);
    const std::vector<uint> groups = faces.groups(options.groups.by);
    const Agreement agreement = agreement_of("illumination", analysed.scene, analysed.choice.name(),
                                             {{"groups", checksum_text(std::as_bytes(std::span(groups)))},
                                              {"--sides", std::string(name_of(options.sides))},
                                              {"--seed", std::to_string(grid.seed)},
                                              {"grid", options.grid.record().dump()}});
    const std::uint64_t rays = grid_ray_count(faces, desc);
    const auto parts = shards.parts((rays + 1) / 2, agreement, [&](Rows rows) {
        const std::vector<GroupCount> counts =
            count_light(*analysed.accel, faces, desc, rows.first * 2, std::min(rays, rows.last * 2));
        return joined<GroupCount, std::byte>(counts, {});
    });
    if (!parts) return {};
    std::vector<GroupCount> sums(faces.group_count(options.groups.by) + 1);
    for (const std::vector<std::byte>& part : *parts) {
        std::vector<GroupCount> counts;
        append_bytes(counts, part);
        for (std::size_t i = 0; i < sums.size(); ++i) sums[i].hits += counts[i].hits, sums[i].odd += counts[i].odd;
    }
    return illumination_of(faces, desc, sums);
}

void run(IlluminationOptions options) {
    const Shards shards(options.shards, options.common, options.output);
    const Analysed analysed(options);
    Faces faces(*analysed.context, analysed.scene);
    options.groups.set_groups(faces);
    const RayGridDesc grid = options.grid.desc(options.common);
    const Stopwatch start;
    const std::optional<Illumination> computed = compute(shards, options, analysed, faces, grid);
    if (!computed) return;
    const Illumination& result = *computed;
    const double seconds = start.seconds();
    if (!options.output.empty()) write(options, result);
    if (!options.pictures.files.empty())
        write_pictures(options.pictures, *analysed.accel, analysed.scene, picture_of(options, faces, result));
    if (!options.common.quiet) print(options, analysed, result, seconds);
    nlohmann::json record = {{"sides", name_of(options.sides)},
                             {"by", name_of(options.groups.by)},
                             {"n", result.ray_count},
                             {"hits", result.total.hits},
                             {"cell_area", result.cell_area},
                             {"area", result.total.area},
                             {"unobstructed", result.total.unobstructed},
                             {"surface", result.total.surface},
                             {"seconds", seconds}};
    record.update(options.grid.record());
    record.update(analysed.record("twinray-illumination/1", options));
    if (options.grid.points == GridPoints::random)
        record.update({{"ci_low", result.total.interval.low}, {"ci_high", result.total.interval.high}});
    append_json(options.common.json, record);
}

constexpr uint most_samples = 1u << 20;

void write(const std::filesystem::path& file, const std::string& what, const SkyLight& light) {
    write_rows(file, "face,free_rays," + what + ",ci_low,ci_high", light.faces.size(), [&](std::size_t face) -> CsvRow {
        const Received& received = light.faces[face];
        return {{face, received.free_rays}, {received.value, received.interval.low, received.interval.high}};
    });
}

// Returns the mean by area.
double mean_of(const SkyLight& light, const std::vector<double>& areas) {
    double sum = 0, area = 0;
    for (std::size_t face = 0; face < areas.size(); ++face) {
        sum += areas[face] * light.faces[face].value;
        area += areas[face];
    }
    return area > 0 ? sum / area : 0;
}

ScenePicture picture_of(const IlluminationOptions& options, const SkyLight& light, const std::vector<double>& areas) {
    std::vector<double> values;
    for (std::size_t face = 0; face < areas.size(); ++face)
        values.push_back(areas[face] > 0 ? light.faces[face].value : NAN);
    const bool is_sky = options.sky > 0;
    ScenePicture picture = picture_of_values(options.pictures, values, is_sky ? "sky" : "hours");
    picture.page.title = options.scene.filename().string() + (is_sky ? ": light of the sky" : ": hours of sun");
    picture.page.subtitle = text("mean over the surface ", mean_of(light, areas), ", ", light.ray_count, " rays");
    return picture;
}

// Returns --sky and --sun, and the options that need them.
std::vector<Option> sky_options(IlluminationOptions& options) {
    return {
        {.name = "--sky",
         .value = number(options.sky, {1, most_samples}),
         .help = "compute the light of a uniform sky above the horizon, with N rays per face"},
        {.name = "--sun",
         .value = cli::file(options.sun),
         .help = "compute hours of sun from a CSV file of x,y,z,hours: the direction in which sunlight travels, and "
                 "for how long"},
        {.name = "--up", .value = numbers(options.up, "X Y Z"), .help = "direction of the zenith", .needs = {"--sky"}},
        {.name = "--samples",
         .value = number(options.samples, {1, most_samples}),
         .help = "points per face for each position of the sun",
         .needs = {"--sun"}}};
}

// Computes what the faces in `rows` receive.
std::vector<Received> receive(const Analysed& analysed, const Faces& faces, const IlluminationOptions& options,
                              std::span<const SunPosition> sun, SkyRaysDesc desc, Rows rows) {
    desc.first_face = rows.first, desc.last_face = rows.last;
    const SkyLight light = options.sky
                               ? sky_light(*analysed.accel, faces, {options.up[0], options.up[1], options.up[2]}, desc)
                               : sun_hours(*analysed.accel, faces, sun, desc);
    return {light.faces.begin() + static_cast<std::ptrdiff_t>(rows.first),
            light.faces.begin() + static_cast<std::ptrdiff_t>(rows.last)};
}

Agreement agreement_for(const Analysed& analysed, const IlluminationOptions& options, std::span<const SunPosition> sun,
                        const SkyRaysDesc& desc) {
    return agreement_of("illumination", analysed.scene, analysed.choice.name(),
                        {{"light", options.sky ? "sky" : "sun"},
                         {"up", checksum_text(std::as_bytes(std::span(options.up)))},
                         {"sun", checksum_text(std::as_bytes(sun))},
                         {"samples", std::to_string(desc.samples)},
                         {"--sides", std::string(name_of(desc.sides))},
                         {"--seed", std::to_string(desc.seed)}});
}

void run_sky(IlluminationOptions options) {
    const Shards shards(options.shards, options.common, options.output);
    const std::vector<SunPosition> sun = options.sky ? std::vector<SunPosition>() : read_sun(options.sun);
    const Analysed analysed(options);
    const Faces faces(*analysed.context, analysed.scene);
    const uint samples = options.sky ? options.sky : options.samples;
    const std::string what = options.sky ? "sky" : "hours";
    const Stopwatch start;
    const std::uint64_t rays_of_face = samples * (options.sky ? 1 : sun.size());
    const SkyRaysDesc desc{.samples = samples, .sides = options.sides, .seed = options.common.seed};
    auto computed =
        compute_rows<Received>(shards, faces.count(), agreement_for(analysed, options, sun, desc), [&](Rows rows) {
            samples::Progress progress(what, rows.count() * rays_of_face, options.common.quiet);
            SkyRaysDesc shown = desc;
            shown.progress = [&](std::uint64_t rays) { progress.advance(rays); };
            return receive(analysed, faces, options, sun, shown, rows);
        });
    if (!computed) return;
    const SkyLight light{.faces = std::move(*computed), .ray_count = faces.count() * rays_of_face};
    const double seconds = start.seconds();
    if (!options.output.empty()) write(options.output, what, light);
    if (!options.pictures.files.empty())
        write_pictures(options.pictures, *analysed.accel, analysed.scene, picture_of(options, light, faces.areas()));
    const double mean = mean_of(light, faces.areas());
    if (!options.common.quiet)
        std::cout << analysed.head("illumination", options) << "  " << speed_text(light.ray_count, seconds) << "\n  "
                  << (options.sky ? "light of the sky" : "hours of sun") << ", mean over the surface: " << mean << '\n';
    nlohmann::json record = {{"what", what},         {"sides", name_of(options.sides)},
                             {"samples", samples},   {"positions", sun.size()},
                             {"n", light.ray_count}, {"mean", mean},
                             {"seconds", seconds}};
    record.update(analysed.record("twinray-sky/1", options));
    append_json(options.common.json, record);
}

}  // namespace

Command illumination_command() {
    const auto options = std::make_shared<IlluminationOptions>();
    const Section light = with(with({"Light", ray_grid_options(options->grid)}, sky_options(*options)),
                               {sides_option(options->sides, "receive light")});
    Section output = analysis_output(*options,
                                     "write a CSV file with one line per face: face, hits, area, ci_low, ci_high; with "
                                     "--sky or --sun: face, free_rays, sky or hours, ci_low, ci_high");
    output = with(output, face_group_options(options->groups, "one line of the CSV", {"--direction"}));
    output.options.push_back(
        {.name = "--measure",
         .value = choice(options->measure, {"area", "fraction", "irradiance"}),
         .help = "third column of the CSV: lit area perpendicular to the light, fraction of the area that faces the "
                 "light, or irradiance, which is lit area perpendicular to the light per unit of surface",
         .needs = {"--direction"}});
    const Section pictures = with(picture_options(options->pictures, "the third column of the CSV"),
                                  {color_scale_option(options->pictures)});
    return {.name = "illumination",
            .group = "Analyses",
            .summary = "compute the parallel light, sky light or hours of sun of each face",
            .description =
                "Computes how much of each face parallel light reaches, how much of a uniform sky it sees, or for how "
                "many hours the sun shines on it, with 95 % confidence intervals.",
            .positionals = {scene_argument(options->scene)},
            .sections = {light, output, pictures, shard_options(options->shards, {"--picture"}),
                         common_options(options->common)},
            .alternatives = {{.names = {"--direction", "--sky", "--sun"}, .is_required = true}},
            .examples = {{"twinray illumination house.glb --direction 0.3 -1 0.2 -o lit.csv --picture lit.png",
                          "the faces that the sun reaches, as a table and as a picture"}},
            .run = done_after([options] { options->grid.direction.empty() ? run_sky(*options) : run(*options); })};
}

}  // namespace twinray::cli
