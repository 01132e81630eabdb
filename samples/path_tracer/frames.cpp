// SPDX-License-Identifier: MIT
#include "samples/path_tracer/frames.h"

#include <cstdio>

#include <twinray/scene.h>

#include "renderer/camera.h"
#include "renderer/moving_scene.h"
#include "samples/path_tracer/report.h"
#include "samples/support/text.h"

namespace twinray::path_tracer {
using samples::fail;
using samples::text;
namespace {

void check(const Options& options, const Ranks& ranks) {
    if (ranks.count() > 1) fail("under mpirun there is no --frames: start one run for each part of the frames");
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

    // The signal that ended it, or 0.
    int render(uint frame) {
        FrameNote note{frame + 1, sequence_.frames, sequence_.time_of(frame), build_ms_};
        if (motion_) note.times = motion_->move_to(pose_at(*session_.scene.rig, *sequence_.animation, note.seconds));
        set_view(frame);
        describe(note);
        options_.output = frame_file(pattern_, frame);
        const Rendering rendering = render_film(options_, session_, *accel_, ranks_);
        report_render(options_, session_, *accel_, rendering, &note);
        // One for all: else they would flicker.
        if (!options_.exposure)
            options_.exposure = exposure_of({}, rendering.film.configuration, rendering.film.mean());
        return rendering.signal;
    }

    uint count() const { return sequence_.frames; }

  private:
    // Of the file's cameras, which may move; one that frames the scene shows it at all times.
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

}  // namespace

int render_frames(const Options& options, Ranks& ranks) {
    check(options, ranks);
    FrameRenderer renderer(options, ranks);
    for (uint frame = 0; frame < renderer.count(); ++frame)
        if (const int signal = renderer.render(frame)) {
            std::fprintf(stderr,
                         "path_tracer: interrupted in frame %u of %u, which lacks paths; those before it are whole\n",
                         frame + 1, renderer.count());
            return 128 + signal;
        }
    return 0;
}

}  // namespace twinray::path_tracer
