// `twinray viewfactors`: the view factors of a scene with their errors, as a matrix and as pictures.
#include <cmath>

#include "cli/analysis_options.h"
#include "cli/shards.h"
#include "engine/analysis/row_run.h"
#include "engine/core/files.h"
#include "twinray_version.h"
#include "viewer/picture/page.h"

namespace twinray::cli {
namespace {

struct Options : AnalysisOptions {
    FaceGroupOptions groups;
    ViewFactorOptions factors;  // its grouping is groups.by
    PairEstimator estimator = PairEstimator::automatic;
    ShardOptions shards;
    bool projects = false;
    std::filesystem::path matrix;
    std::optional<uint> from;  // the row to draw; none: open fractions of all
};

// Returns none if hits estimate all entries, as for too many faces unless another estimator is asked for.
PairExchanges compute_pairs(const Options& options, AbstractAccel& accel, const Faces& faces) {
    const auto count = static_cast<std::size_t>(
        std::count_if(faces.areas().begin(), faces.areas().end(), [](double area) { return area > 0; }));
    if (options.estimator == PairEstimator::automatic && count > most_paired_faces) {
        if (!options.common.quiet)
            std::cout << count << " faces are more than " << most_paired_faces
                      << ", the limit for exact pairs, so hits of rays estimate all entries\n";
        return {};
    }
    samples::Progress progress("pairs", faces.group_count(options.factors.grouping), options.common.quiet);
    return exchanges_of_pairs(accel, faces, options.factors, options.estimator,
                              [&](std::uint64_t groups) { progress.advance(groups); });
}

std::filesystem::path rows_file(const std::filesystem::path& output) {
    return std::filesystem::path(output) += ".rows";
}

ComputedRows compute_to(const Options& options, ViewFactors& factors, Rows rows, RowFile* file) {
    ComputedRows computed = begin_rows(file, options.shards.resumes);
    if (computed.resumed > 0 && !options.common.quiet)
        std::cout << "resumed after " << computed.resumed << " of " << rows.count() << " rows\n";
    samples::Progress progress("view factors", rows.count(), options.common.quiet);
    complete_rows(computed, factors, rows.first, rows.last, file,
                  [&](std::uint64_t count) { progress.advance(count); });
    return computed;
}

// Returns nothing if another process goes on.
std::optional<ComputedRows> compute(const Shards& shards, const Options& options, ViewFactors& factors,
                                    const std::string& configuration) {
    const std::size_t count = factors.row_count();
    if (shards.is_whole()) {
        std::optional<RowFile> file;
        if (!options.output.empty()) file.emplace(rows_file(options.output), configuration);
        return compute_to(options, factors, {0, count}, file ? &*file : nullptr);
    }
    const auto file_of = [&](Rows rows, const std::filesystem::path& file) {
        return RowFile(file,
                       text("twinray ", twinray_version, ", ", configuration, ", rows ", rows.first, " to ", rows.last),
                       rows.first);
    };
    ComputedRows computed;
    const bool goes_on = shards.for_parts(
        count,
        [&](Rows rows, const std::filesystem::path& name) {
            RowFile file = file_of(rows, name);
            compute_to(options, factors, rows, &file);
        },
        [&](Rows rows, const std::filesystem::path& name) {
            const std::vector<ViewFactorRow> part = file_of(rows, name).load();
            if (part.size() != rows.count())
                fail("'", name.string(), "': ", part.size(), " of ", rows.count(),
                     " rows are finished; --resume goes on");
            computed.rows.insert(computed.rows.end(), part.begin(), part.end());
        });
    if (!goes_on) return {};
    return computed;
}

void print_residuals(const char* when, const ViewFactorResiduals& residuals) {
    std::cout << when << ": reciprocity " << residuals.reciprocity << " of the largest area, "
              << residuals.reciprocity_scaled << " of the smaller of two (" << residuals.reciprocity_sigma
              << " standard errors at most), closure " << residuals.closure << '\n';
}

nlohmann::json json_of(const ViewFactorResiduals& residuals) {
    return {{"reciprocity", residuals.reciprocity},
            {"reciprocity_scaled", residuals.reciprocity_scaled},
            {"reciprocity_sigma", residuals.reciprocity_sigma},
            {"closure", residuals.closure}};
}

// The results of a run, for printing and for records.
struct Summary {
    AccelChoice choice;
    MatrixTotals totals;
    std::size_t rows = 0;
    std::uint64_t rays = 0, rays_between_faces = 0;  // of this run, and of pairs
    double seconds = 0, seconds_of_pairs = 0;
    ViewFactorResiduals counted;
    std::optional<ViewFactorResiduals> projected;
};

void print(const Summary& run, const Options& options) {
    const MatrixTotals& totals = run.totals;
    std::cout << run.rows << ' ' << name_of(options.factors.grouping) << " rows, " << totals.entries << " entries, "
              << totals.rays << " rays in " << run.seconds << " s ("
              << static_cast<double>(run.rays) / run.seconds / 1e6 << " million per second) " << text_of(run.choice)
              << ", " << totals.hits << " met a face\nentries by estimator: " << totals.entries_by.at("contour")
              << " contour, " << totals.entries_by.at("area") << " area, " << totals.entries_by.at("hits") << " hits; "
              << run.rays_between_faces << " rays between points of faces, " << run.seconds_of_pairs
              << " s\nwidest 95 % interval: +- " << totals.widest << '\n';
    if (totals.hits == 0 && totals.rays > 0 && options.factors.sides == Sides::front)
        std::cout << "no ray met the front of a face: either no faces see each other, or their fronts point away; "
                     "--sides both radiates from both sides\n";
    print_residuals("as counted", run.counted);
    if (run.projected) print_residuals("projected", *run.projected);
}

nlohmann::json fields_of(const Summary& run, const Options& options) {
    return {{"by", name_of(options.factors.grouping)},
            {"sequence", name_of(options.factors.sequence)},
            {"sides", name_of(options.factors.sides)},
            {"estimator", name_of(options.estimator)},
            {"entries_by_estimator", run.totals.entries_by},
            {"rays_between_faces", run.rays_between_faces},
            {"seconds_of_pairs", run.seconds_of_pairs},
            {"seed", options.factors.seed},
            {"rows", run.rows},
            {"entries", run.totals.entries},
            {"rays", run.totals.rays},
            {"hits", run.totals.hits},
            {"seconds", run.seconds},
            {"widest_half_interval", run.totals.widest},
            {"as_counted", json_of(run.counted)},
            {"projected", run.projected ? json_of(*run.projected) : nlohmann::json()}};
}

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

// `groups`: the group of each face. `rows` are all, in order.
ScenePicture picture_of_view_factors(const Options& options, const std::vector<uint>& groups,
                                     const std::vector<ViewFactorRow>& rows) {
    const std::string scene = options.scene.filename().string();
    if (!options.from) {
        ScenePicture picture = picture_of_values(options.pictures, by_face(groups, open_fractions(rows)), "open");
        picture.page.title = scene + ": open fraction";
        picture.page.subtitle = "part of the diffuse radiation of a face that leaves the scene";
        return picture;
    }
    const std::vector<double> values = by_face(groups, factors_of(rows[*options.from], rows.size()));
    ScenePicture picture = picture_of_values(options.pictures, values, "F", ColorScale::log);
    for (std::size_t face = 0; face < groups.size(); ++face)
        if (groups[face] == *options.from) picture.colors[face] = categorical::vermilion;
    picture.page.legend.entries.push_back({categorical::vermilion, text("row ", *options.from)});
    picture.page.title = text(scene, ": view factors of row ", *options.from);
    picture.page.subtitle = "part of its diffuse radiation that reaches each group of faces";
    return picture;
}

void write_matrix(const Options& options, const std::vector<ViewFactorRow>& rows) {
    std::vector<MatrixEntry> entries;
    for (const ViewFactorRow& row : rows)
        for (const ViewFactor& factor : row.factors) entries.push_back({row.group, factor.target, factor.value});
    const Raster raster =
        draw_matrix(rows.size(), entries,
                    {.title = options.scene.filename().string() + ": view factors",
                     .subtitle = text("row: emitting ", name_of(options.factors.grouping), ", column: receiving"),
                     .legend = {.title = "F", .scale = {}, .entries = {}}});
    write_png(options.matrix, raster.width, raster.height, raster.pixels);
}

void write_matrices(const Options& options, const std::vector<double>& areas, const std::vector<ViewFactorRow>& rows) {
    const std::string suffix = lower_suffix(options.output);
    if (suffix == ".csv") write_matrix_csv(options.output, rows);
    if (suffix == ".npz") write_matrix_npz(options.output, rows, areas);
    if (!options.matrix.empty()) write_matrix(options, rows);
}

void run(Options options) {
    const Shards shards(options.shards, options.common, options.output);
    check_writable(options.matrix);
    const Analysed analysed(options);
    const auto& [scene, context, choice, accel] = analysed;
    Faces faces(*context, scene);
    options.groups.set_groups(faces);
    const std::size_t row_count = faces.group_count(options.factors.grouping);
    if (options.from && *options.from >= row_count)
        fail("--from ", *options.from, ": there are ", row_count, " rows, numbered from 0");

    Summary summary;
    summary.choice = choice;
    const Stopwatch start;
    const PairExchanges pairs = options.shards.merged ? PairExchanges{} : compute_pairs(options, *accel, faces);
    summary.rays_between_faces = pairs.rays;
    summary.seconds_of_pairs = start.seconds();
    ViewFactors factors(*accel, faces, options.factors, pairs.known);
    std::optional<ComputedRows> computed = compute(
        shards, options, factors, configuration_of(options.factors, options.estimator, choice.name(), scene, faces));
    if (!computed) return;
    summary.seconds = start.seconds();
    summary.rays = computed->rays();
    std::vector<ViewFactorRow>& rows = computed->rows;
    summary.rows = rows.size();
    summary.totals = totals_of(rows);
    summary.counted = residuals_of(rows, factors.areas());
    if (options.projects) {
        project(rows, factors.areas());
        summary.projected = residuals_of(rows, factors.areas());
    }
    write_matrices(options, factors.areas(), rows);
    if (!options.pictures.files.empty())
        write_pictures(options.pictures, *accel, scene,
                       picture_of_view_factors(options, faces.groups(options.factors.grouping), rows));
    if (!options.output.empty() && shards.is_whole()) RowFile(rows_file(options.output), {}).remove();
    if (!options.common.quiet) print(summary, options);
    nlohmann::json record = base_record("twinray-viewfactors/1", *context, options.scene, scene);
    record.update(describe(choice));
    record.update(fields_of(summary, options));
    append_json(options.common.json, record);
}

}  // namespace

Command viewfactors_command() {
    const auto options = std::make_shared<Options>();
    ViewFactorOptions& factors = options->factors;
    const Names<Sequence> sequences = {{"sobol", Sequence::sobol}, {"random", Sequence::random}};
    Section sampling = {
        "Sampling",
        {{.name = "--rays-per-row",
          .value = number(factors.rays, {.least = 1}),
          .help = "number of rays from each row; with --target-error, the largest number",
          .former_name = "--rays"},
         {.name = "--target-error",
          .value = number(factors.target_error, {.least = 0, .is_above = true}),
          .help = "stop a row when the 95 % confidence interval of each of its entries is within +- this"},
         sides_option(factors.sides, "radiate"),
         {.name = "--sequence", .value = choice(factors.sequence, sequences), .help = "sequence of the samples"},
         {.name = "--estimator",
          .value = choice(options->estimator, names_of(all_pair_estimators)),
          .help = "auto: contour integrals for pairs that nothing can come between, rays between points of both for "
                  "distant pairs, and hits of rays for all others; or hits, area or contour for all pairs"},
         accel_option(options->accel)}};
    Section output = {
        "Matrix",
        {output_option(
            file(options->output, {".npz", ".csv"}),
            "write the matrix: a SciPy CSR matrix with confidence intervals, or lines i,j,F,ci_low,ci_high")}};
    output = with(output, face_group_options(options->groups, "one row"));
    output.options.push_back(
        {.name = "--project",
         .value = flag(options->projects),
         .help = "write the nearest matrix that satisfies reciprocity and closure, instead of the counted one"});
    const Section pictures =
        with(picture_options(options->pictures, "the open fraction, or the view factors of one row with --from"),
             {color_scale_option(options->pictures),
              {.name = "--from",
               .value = number(options->from),
               .help = "row whose view factors --picture shows, numbered from 0",
               .needs = {"--picture"}},
              {.name = "--matrix",
               .value = file(options->matrix, {".png"}),
               .help = "write a picture of the matrix on a logarithmic scale"}});
    return {.name = "viewfactors",
            .group = "Analyses",
            .summary = "compute view factors between faces or groups of faces, with confidence intervals",
            .description =
                "Computes the view-factor matrix: the part of the diffuse radiation that leaves each face, or group of "
                "faces, and reaches each other one, with 95 % confidence intervals. Prints how far the matrix is from "
                "reciprocity and closure.",
            .positionals = {scene_argument(options->scene)},
            .sections = {output, sampling, pictures, shard_options(options->shards, {"--picture", "--matrix"}),
                         common_options(options->common)},
            .examples = {{"twinray viewfactors room.obj --by instance -o room.npz",
                          "view factors between the objects of a room, as a matrix for SciPy"}},
            .run = done_after([options] {
                if (options->common.seed > UINT32_MAX)
                    throw UsageError(text("--seed is ", options->common.seed, ", but must be at most ", UINT32_MAX));
                options->factors.seed = static_cast<uint>(options->common.seed);
                options->factors.grouping = options->groups.by;
                run(*options);
            })};
}

}  // namespace twinray::cli
