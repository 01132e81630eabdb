// SPDX-License-Identifier: MIT
// The sample path tracer: one scene, one picture, by either accelerator or by both against each other.
#include <cmath>
#include <cstdio>

#include <twinray/context.h>
#include "samples/path_tracer/frames.h"
#include "samples/path_tracer/merge.h"
#include "samples/path_tracer/report.h"
#include "samples/path_tracer/view.h"
#include "samples/support/text.h"

namespace twinray::path_tracer {
using samples::fail;
namespace {

// 128 + the signal, as shells have it, where one came.
int render(const Options& options, Ranks& ranks) {
    const Session session = make_session(options, ranks);
    const auto accel = make_accel(*session.context, session.scene, session.accel);
    const Rendering rendering = render_film(options, session, *accel, ranks);
    if (rendering.signal) say_interrupted(rendering, checkpoint_file(options.output, ranks));
    if (ranks.index() == 0) report_render(options, session, *accel, rendering);
    return rendering.signal ? 128 + rendering.signal : 0;
}

std::filesystem::path with_suffix(const std::filesystem::path& file, const char* suffix) {
    return file.parent_path() / (file.stem().string() + suffix + file.extension().string());
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

}  // namespace
}  // namespace twinray::path_tracer

int main(int argc, char** argv) {
    using namespace twinray::path_tracer;
    return twinray::samples::run_program("path_tracer", [&]() -> int {
        Ranks ranks(argc, argv);
        ParsedOptions parsed = parse_options(argc, argv);
        if (parsed.exit_status) return *parsed.exit_status;
        if (parsed.options.view) view(parsed.options);
        if (parsed.merge) return merge_films(*parsed.merge);
        parsed.options.quiet |= ranks.index() > 0;
        if (parsed.options.sequence.is_wanted()) return render_frames(parsed.options, ranks);
        return parsed.options.cross_check.empty() ? render(parsed.options, ranks) : cross_check(parsed.options, ranks);
    });
}
