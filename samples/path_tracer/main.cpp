// SPDX-License-Identifier: MIT
// The sample path tracer: a picture of one scene or a sequence of them, by either accelerator or by both against each
// other; or a picture of films that were rendered apart, or the window of `twinray view`.
#include <cmath>
#include <cstdio>
#include <sstream>

#include "engine/core/platform.h"
#include "renderer/configuration.h"
#include "renderer/film_file.h"
#include "samples/path_tracer/path_tracer.h"
#include "samples/support/text.h"

namespace twinray::path_tracer {
using samples::fail;
using samples::text;
namespace {

// Returns 128 + the signal, as shells do, if one came.
int render(const Options& options, Ranks& ranks) {
    const Session session = make_session(options, ranks);
    const auto accel = make_accel(*session.context, session.scene, session.accel);
    const Rendering rendering = render_film(options, session, *accel, ranks);
    if (rendering.signal)
        std::fprintf(
            stderr,
            "path_tracer: interrupted after %g paths per pixel, which '%s' holds; --resume continues from there\n",
            rendering.film.mean_samples(), checkpoint_file(options.output, ranks).string().c_str());
    if (ranks.index() == 0) report_render(options, session, *accel, rendering);
    return rendering.signal ? 128 + rendering.signal : 0;
}

std::filesystem::path with_suffix(const std::filesystem::path& file, const char* suffix) {
    return file.parent_path() / platform::path_of(file.stem().string() + suffix + file.extension().string());
}

// Hardware leads, software traces the same rays; then software renders alone.
int cross_check(const Options& options, const Ranks& ranks) {
    if (!is_image_file(options.output)) fail("--cross-check: '", options.output.string(), "' must be a picture");
    const Session session = make_session(options, ranks);
    Renderer& renderer = *session.renderer;
    const DeviceProperties& properties = session.context->properties();
    const auto hardware = make_accel(*session.context, session.scene, choose_accel(properties, "hw"));
    const auto software = make_accel(*session.context, session.scene, choose_accel(properties, "sw"));
    CrossCheck result;
    result.hardware_path = trace_path(*hardware);
    result.pixel_count = renderer.film_size();

    CrossChecker checker(*session.context, *software, renderer, result.pixel_count);
    const HdrImage by_hardware = render_picture(renderer, session.settings, *hardware, options.quiet, &checker);
    result.path_rays = renderer.stats().path_rays;
    result.shadow_rays = renderer.stats().shadow_rays;
    result.disagreeing = checker.found();
    const HdrImage by_software = render_picture(renderer, session.settings, *software, options.quiet);
    const std::vector<uint> marks = checker.marks();
    result.pictures = compare_pictures(by_hardware, by_software, marks);
    classify_disagreements(session.scene, checker.recorded(), result);

    const float exposure = exposure_of(options.exposure, session.configuration, by_hardware);
    write_image(with_suffix(options.output, "_hw"), by_hardware, exposure);
    write_image(with_suffix(options.output, "_sw"), by_software, exposure);
    write_image(with_suffix(options.output, "_difference"),
                difference_picture(by_hardware, by_software, marks, std::exp2(-exposure)), exposure);
    report_cross_check(options, session, result);
    return result.passed() ? 0 : 1;
}

void check(const Options& options, const Ranks& ranks) {
    if (ranks.count() > 1) fail("--frames does not work under mpirun: start one run for each range of frames");
    if (!is_image_file(options.output))
        fail("--frames: '", options.output.string(), "' must be a picture, .png or .exr");
}

class FrameRenderer {
  public:
    FrameRenderer(const Options& options, Ranks& ranks)
        : options_(options),
          ranks_(ranks),
          session_(make_session(options, ranks)),
          sequence_(make_sequence(options.sequence, session_.scene)),
          accel_(make_accel(*session_.context, session_.scene, session_.accel)),
          build_ms_(build_ms(*accel_)) {
        const Scene whole = swept(session_.scene, sequence_);
        center_ = bounds_of(whole).center();
        if (is_framing(options, session_.scene)) framing_ = camera_of(options, whole, session_.settings);
        options_.checkpoint_seconds.reset();  // a frame is whole or to be rendered anew
        if (sequence_.animation)
            motion_ = std::make_unique<MovingScene>(*session_.context, session_.scene, *session_.device_scene, *accel_);
    }

    // Returns the signal that ended it, or 0.
    int render(uint frame) {
        FrameNote note{frame + 1, sequence_.frames, sequence_.time_of(frame), build_ms_};
        if (motion_) note.times = motion_->move_to(pose_at(*session_.scene.rig, *sequence_.animation, note.seconds));
        set_view(frame);
        describe(note);
        options_.output = frame_file(pattern_, frame);
        const Rendering rendering = render_film(options_, session_, *accel_, ranks_);
        report_render(options_, session_, *accel_, rendering, &note);
        // One exposure serves all frames: otherwise they would flicker.
        if (!options_.exposure) options_.exposure = exposure_of({}, rendering.film.configuration, rendering.picture);
        return rendering.signal;
    }

    uint count() const { return sequence_.frames; }

  private:
    // The file's cameras may move; one that frames the scene shows it at all times.
    void set_view(uint frame) {
        const Camera camera = framing_ ? *framing_ : camera_of(options_, session_.scene, session_.settings);
        RenderSettings& settings = session_.settings;
        settings.camera = rays_of(options_, turned_about(camera, center_, sequence_.angle_of(frame)), settings);
        settings.seed = options_.seed + frame;
        session_.renderer->set_frame(settings.camera, settings.seed);
    }

    void describe(const FrameNote& note) {
        if (!base_) base_ = session_.configuration;
        session_.configuration = *base_;
        session_.configuration.emplace_back("frame", text(note.number, " of ", note.count));
        session_.configuration.emplace_back("time", text(note.seconds));
    }

    Options options_;
    Ranks& ranks_;
    std::filesystem::path pattern_ = options_.output;
    Session session_;
    Sequence sequence_;
    std::unique_ptr<AbstractAccel> accel_;
    vec3 center_ = vec3(0);
    std::optional<Camera> framing_;
    double build_ms_;
    std::unique_ptr<MovingScene> motion_;  // null: nothing moves but the camera
    std::optional<Configuration> base_;
};

// Renders --frames: picture after picture of a scene that moves, or that the camera circles. Returns the exit status:
// 128 + the signal that ended it early, else 0.
int render_frames(const Options& options, Ranks& ranks) {
    check(options, ranks);
    FrameRenderer renderer(options, ranks);
    for (uint frame = 0; frame < renderer.count(); ++frame)
        if (const int signal = renderer.render(frame)) {
            std::fprintf(
                stderr,
                "path_tracer: interrupted in frame %u of %u, which is incomplete; the frames before it are complete\n",
                frame + 1, renderer.count());
            return 128 + signal;
        }
    return 0;
}

Film merged(const std::vector<std::filesystem::path>& files) {
    Film film = load_film(files[0]);
    for (std::size_t i = 1; i < files.size(); ++i)
        film.merge(load_film(files[i]), files[0].string() + (i > 1 ? " and others" : ""), files[i].string());
    return film;
}

// Merges films of one picture into one film or picture, the same in any order. Returns the exit status. Throws Error
// naming the files that do not belong together.
int merge_films(const MergeOptions& options) {
    check_folder(options.output);
    const Film film = merged(options.films);
    if (is_film_file(options.output))
        save_film(options.output, film);
    else
        write_picture_of(options.output, film.configuration, film.mean(), options.exposure);
    report_merge(options, film);
    return 0;
}

void add(std::vector<std::string>& words, const std::string& option, const std::vector<double>& numbers) {
    words.push_back(option);
    for (const double number : numbers) {
        std::ostringstream out;
        out.precision(17);
        out << number;
        words.push_back(out.str());
    }
}

std::vector<std::string> command_line(const Options& options) {
    std::vector<std::string> words = {"view", options.scene.string(), "--layer", "path"};
    if (options.accel != "auto") words.insert(words.end(), {"--show", options.accel});
    if (!options.device.empty()) words.insert(words.end(), {"--device", options.device});
    if (!options.look_from.empty()) {
        std::vector<double> camera = options.look_from;
        camera.insert(camera.end(), options.look_at.begin(), options.look_at.end());
        add(words, "--camera", camera);
        add(words, "--up", {options.up.begin(), options.up.end()});
        add(words, "--fov", {options.fov});
    }
    if (options.width && options.height) add(words, "--size", {double(options.width), double(options.height)});
    if (options.exposure) add(words, "--exposure", {*options.exposure});
    return words;
}

// Becomes `twinray view` with this scene, camera and device: the command beside this program, else the one in PATH.
// Throws Error if there is none.
[[noreturn]] void view(const Options& options) {
    if (options.scene.string().starts_with("builtin:")) fail("--view: '", options.scene.string(), "' is not a file");
    if ((options.width == 0) != (options.height == 0)) fail("--view requires both --width and --height, or neither");
    const std::filesystem::path self = platform::this_program();
    const std::filesystem::path beside = self.parent_path() / ("twinray" + self.extension().string());
    for (const std::filesystem::path& command : {beside, std::filesystem::path("twinray")})
        platform::become_program({command, command_line(options)});
    fail("--view: the command twinray is neither in '", beside.parent_path().string(), "' nor in PATH");
}

}  // namespace
}  // namespace twinray::path_tracer

int main(int argc, char** argv) {
    using namespace twinray::path_tracer;
    return twinray::samples::run_program("path_tracer", [&]() -> int {
        Ranks ranks;
        ParsedOptions parsed = parse_options(argc, argv);
        if (parsed.exit_status) return *parsed.exit_status;
        if (parsed.options.view) view(parsed.options);
        if (parsed.merge) return merge_films(*parsed.merge);
        parsed.options.quiet |= ranks.index() > 0;
        if (parsed.options.sequence.is_wanted()) return render_frames(parsed.options, ranks);
        return parsed.options.cross_check.empty() ? render(parsed.options, ranks) : cross_check(parsed.options, ranks);
    });
}
