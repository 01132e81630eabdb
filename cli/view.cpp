// `twinray view`: a window, or its pictures without one.
#include <cmath>
#include <fstream>
#include <numbers>

#include "cli/common.h"
#include "engine/core/stopwatch.h"
#include "twinray_version.h"
#include "viewer/files.h"
#include "viewer/viewer.h"

namespace twinray::cli {
namespace {

using viewer::Layer;
using viewer::Shown;

struct ViewOptions {
    CommonOptions common;
    std::filesystem::path scene, screenshot, exported, reference, play, record, folder;
    viewer::State state;
    std::vector<double> camera, up = {0, 1, 0};
    std::vector<uint> size = {1280, 720}, pick;
    double fov = 40;
    bool is_orthographic = false;
    int tree_depth = -1;
    uint headless = 0, samples = 0;
    double threshold = 2;
};

viewer::UpAxis up_of(const std::vector<double>& up) {
    if (up == std::vector<double>{0, 1, 0}) return viewer::UpAxis::y;
    if (up == std::vector<double>{0, 0, 1}) return viewer::UpAxis::z;
    throw UsageError("--up must be 0 1 0 or 0 0 1");
}

viewer::State state_of(const ViewOptions& options) {
    viewer::State state = options.state;
    state.width = options.size[0], state.height = options.size[1];
    state.orbit.up = up_of(options.up);
    state.orbit.vertical_fov = options.fov * std::numbers::pi / 180;
    state.orbit.is_orthographic = options.is_orthographic;
    if (options.tree_depth >= 0) state.tree_depth = options.tree_depth;
    if (state.layer == Layer::path && state.shown == Shown::difference)
        throw UsageError("--show difference compares hits and excludes --layer path");
    if (!options.pick.empty()) {
        if (options.pick[0] >= state.width || options.pick[1] >= state.height)
            throw UsageError(text("--pick ", options.pick[0], ' ', options.pick[1], ": the picture has ", state.width,
                                  " x ", state.height, " pixels"));
        state.picked = uvec2(options.pick[0], options.pick[1]);
    }
    return state;
}

std::optional<std::array<dvec3, 2>> camera_of(const std::vector<double>& c) {
    if (c.empty()) return {};
    return std::array{dvec3(c[0], c[1], c[2]), dvec3(c[3], c[4], c[5])};
}

// Returns the root mean square of the differences of all channels, of 255. Throws Error for a picture of another size.
double difference_of(const Raster& raster, const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) fail("'", file.string(), "': cannot be read");
    const std::string bytes((std::istreambuf_iterator<char>(in)), {});
    const Image image =
        decode_image(std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()), file.string());
    if (image.width != raster.width || image.height != raster.height)
        fail("'", file.string(), "' has ", image.width, " x ", image.height, " pixels, but the picture has ",
             raster.width, " x ", raster.height);
    double sum = 0;
    for (std::size_t i = 0; i < raster.pixels.size(); ++i) {
        const Rgb pixel = raster.pixels[i];
        const double d[] = {double(pixel.r) - image.rgba[4 * i], double(pixel.g) - image.rgba[4 * i + 1],
                            double(pixel.b) - image.rgba[4 * i + 2]};
        sum += d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    }
    return std::sqrt(sum / (3.0 * static_cast<double>(raster.pixels.size())));
}

void write(const Raster& raster, const std::filesystem::path& file) {
    write_png(file, raster.width, raster.height, raster.pixels);
}

// Renders frames until nothing gets better, or there are as many samples as asked for.
const Raster& finished(viewer::Viewer& view, uint samples) {
    const Raster* raster = &view.frame(false);
    while (view.traces_paths() && view.samples() < samples) raster = &view.frame(false);
    return *raster;
}

// Plays events as fast as it can. Returns the seconds of each frame between them.
std::vector<double> play(viewer::Viewer& view, const std::vector<viewer::Event>& events, const ViewOptions& options) {
    std::vector<double> seconds;
    for (const viewer::Event& event : events) {
        if (view.is_closed()) break;
        if (const auto* frames = std::get_if<viewer::Frames>(&event))
            for (unsigned i = 0; i < frames->count; ++i) {
                const Stopwatch start;
                view.frame(true);
                seconds.push_back(start.seconds());
            }
        else if (const auto* shot = std::get_if<viewer::Shot>(&event))
            write(finished(view, options.samples), options.folder / shot->file);
        else
            view.handle(event);
    }
    return seconds;
}

nlohmann::json record_of(const viewer::Viewer& view, const nlohmann::json& base, double seconds, uint frames) {
    nlohmann::json record = base;
    record.update({{"layer", viewer::name_of(view.state().layer)},
                   {"show", viewer::name_of(view.state().shown)},
                   {"width", view.state().width},
                   {"height", view.state().height},
                   {"frames", frames},
                   {"seconds", seconds},
                   {"samples", view.samples()}});
    if (view.state().shown == Shown::difference) record["disagreements"] = view.disagreements();
    return record;
}

int run_without_window(viewer::Viewer& view, const ViewOptions& options, const nlohmann::json& base) {
    const Stopwatch start;
    std::vector<double> frames;
    if (!options.play.empty()) frames = play(view, viewer::read_events(options.play), options);
    for (uint i = 0; i < options.headless; ++i) {
        const Raster& raster = view.frame(false);
        if (!options.folder.empty()) write(raster, options.folder / text("frame", i, ".png"));
    }
    if (options.headless == 0) finished(view, std::max(1u, options.samples));
    const Raster& raster = view.last();
    if (view.picked() && !options.common.quiet)
        std::cout << text_of(*view.picked()) << explanation_of(view.stage(), *view.picked());
    nlohmann::json record = record_of(view, base, start.seconds(), options.headless);
    if (!options.play.empty()) record["frame_seconds"] = frames;
    append_json(options.common.json, record);
    if (!options.exported.empty()) viewer::write_values(options.exported, view.stage().scene(), view.values());
    if (!options.reference.empty()) {
        const double difference = difference_of(raster, options.reference);
        const bool is_alike = difference <= options.threshold;
        std::cout << "differs from " << options.reference.string() << " by " << difference << " of 255, at most "
                  << options.threshold << '\n';
        if (is_alike) return 0;
        if (!options.screenshot.empty()) write(raster, options.screenshot);
        return 1;
    }
    if (!options.screenshot.empty()) write(raster, options.screenshot);
    return 0;
}

int run(const ViewOptions& options) {
    const bool has_window = options.screenshot.empty() && options.headless == 0 && options.folder.empty() &&
                            options.reference.empty() && options.exported.empty();
    if (has_window && (!options.common.json.empty() || options.samples > 0))
        throw UsageError("--json and --spp require a picture without a window, as with --screenshot or --headless");
    for (const auto& file : {options.screenshot, options.record, options.exported}) check_writable(file);
    if (!options.folder.empty()) std::filesystem::create_directories(options.folder);
    const auto say = [](const std::string& line) { std::cout << line << std::endl; };
    viewer::ViewerDesc desc{.file = options.scene,
                            .state = state_of(options),
                            .camera = camera_of(options.camera),
                            .say = say,
                            .version = twinray_version};
    if (has_window)
        return viewer::run_window(
            {.context = context_desc(options.common), .viewer = desc, .play = options.play, .record = options.record});
    const std::unique_ptr<Context> context = make_context(options.common);
    viewer::Viewer view(*context, desc);
    return run_without_window(view, options,
                              base_record("twinray-view/1", *context, options.scene, view.stage().scene()));
}

}  // namespace

Command view_command() {
    const auto options = std::make_shared<ViewOptions>();
    Value layer = choice(options->state.layer, names_of(viewer::all_layers));
    layer.metavar = "NAME";
    const Section picture = {
        "Display",
        {{.name = "--layer",
          .value = layer,
          .help = "quantity that the colours show. path: the path-traced picture; eyelight: base colours lit from the "
                  "camera; "
                  "occlusion, uv, normal, geometry, primitive, depth: properties of hits; steps: traversal steps of "
                  "each ray in the software tree; light, factors (view factors from the picked face), collisions: "
                  "analyses of faces"},
         {.name = "--show",
          .value = choice(options->state.shown, names_of(viewer::all_shown)),
          .help = "hits of the software accelerator, of the driver, of both with a movable divider, or where they "
                  "disagree"},
         level_option(options->state.level),
         {.name = "--wipe",
          .value = number(options->state.wipe, {.least = 0, .most = 1}),
          .help = "position of the divider, as a fraction of the width"},
         {.name = "--tree-depth",
          .value = number(options->tree_depth, {.least = -1, .most = 64}),
          .help = "draw the boxes of the software tree this many levels below its root; -1 draws none"},
         {.name = "--tree-areas",
          .value = flag(options->state.has_area_colors),
          .help = "colour these boxes by their share of the root's surface area, which estimates the rays that hit "
                  "them (SAH)",
          .needs = {"--tree-depth"}},
         {.name = "--pick", .value = numbers(options->pick, "X Y"), .help = "explain the ray of this pixel"},
         {.name = "--time",
          .value = number(options->state.seconds, {.least = 0}),
          .help = "time of the animation in seconds"},
         {.name = "--hour",
          .value = number(options->state.hour, {.least = 6, .most = 18}),
          .help = "hour of the day for --layer light"},
         {.name = "--all-features",
          .value = flag(options->state.has_all_features),
          .help = "for --layer path, use kernels with all features that any scene may need, to measure what leaving "
                  "them out saves"},
         {.name = "--exposure",
          .value = number(options->state.exposure, {.least = -32, .most = 32}),
          .help = "exposure of --layer path in stops"}}};
    const Section camera = {
        "Camera",
        {{.name = "--camera",
          .value = numbers(options->camera, "X Y Z X Y Z"),
          .help = "position of the camera, then the point that it looks at; without it, the scene's first camera, or "
                  "one that shows the whole scene"},
         {.name = "--fov",
          .value = number(options->fov, {.least = 1, .most = 170}),
          .help = "vertical field of view of --camera in degrees"},
         {.name = "--orthographic", .value = flag(options->is_orthographic), .help = "use an orthographic camera"},
         {.name = "--up", .value = numbers(options->up, "X Y Z"), .help = "axis that points up: 0 1 0 or 0 0 1"},
         {.name = "--size",
          .value = numbers(options->size, "WIDTH HEIGHT", {1, 16384}),
          .help = "size of the picture in pixels"}}};
    const Section without = {
        "Without a window",
        {{.name = "--screenshot",
          .value = file(options->screenshot, {".png"}),
          .help = "write the picture to this file and exit"},
         {.name = "--spp",
          .value = number(options->samples, {.least = 0, .most = 1u << 20u}),
          .help = "samples per pixel of --layer path"},
         {.name = "--export",
          .value = file(options->exported, {".csv", ".glb"}),
          .help = "write the layer's values of faces to this file, as numbers or as a coloured scene, and exit"},
         {.name = "--headless",
          .value = number(options->headless, {.least = 1, .most = 1000000}),
          .help = "render N frames and exit"},
         output_option(folder(options->folder), "folder for the frames, or for the pictures of --play"),
         {.name = "--reference",
          .value = file(options->reference, {".png"}),
          .help = "compare with this picture; only if they differ, write --screenshot and end with exit status 1"},
         {.name = "--threshold",
          .value = number(options->threshold, {.least = 0, .most = 255}),
          .help = "largest accepted root mean square difference, out of 255",
          .needs = {"--reference"}}}};
    const Section input = {
        "Input",
        {{.name = "--play",
          .value = file(options->play),
          .help = "play events from this file, as --record writes them"},
         {.name = "--record", .value = file(options->record), .help = "write the events of the window to this file"}}};
    return {.name = "view",
            .group = "Tracing",
            .summary = "show a scene in a window, or write a picture of it",
            .description =
                "Shows a scene in a window: its picture, its trees, where accelerators disagree, analyses. With "
                "--screenshot it writes a picture and opens none; path_tracer renders pictures of a given error. Drag "
                "with the left button to orbit, with the middle button, or with shift and the left button, to pan. The "
                "wheel zooms, a double-click sets the orbit centre, and a click explains the ray of a pixel. H shows "
                "all keys.",
            .positionals = {scene_argument(options->scene)},
            .sections = {picture, camera, without, input, common_options(options->common)},
            .examples = {{"twinray view scene.glb", "open a window"},
                         {"twinray view scene.glb --layer path --spp 64 --screenshot picture.png",
                          "write a path-traced picture"},
                         {"twinray view scene.glb --layer steps --tree-depth 4 --screenshot steps.png",
                          "show the work of each ray, and boxes of the tree"},
                         {"twinray view scene.glb --show difference --screenshot difference.png",
                          "show the pixels where the hits of twinray and the driver differ"}},
            .fault = "the picture differs from --reference",
            .run = [options] { return run(*options); }};
}

}  // namespace twinray::cli
