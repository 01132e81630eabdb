// SPDX-License-Identifier: MIT
#include "samples/path_tracer/path_tracer.h"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iomanip>

#include <nlohmann/json.hpp>

#include "renderer/configuration.h"
#include "renderer/reference.h"
#include "samples/support/text.h"

namespace twinray::path_tracer {
using samples::fail;
using samples::text;
namespace {

double mega_rays_per_second(const RenderStats& stats) {
    return static_cast<double>(stats.path_rays + stats.shadow_rays) / stats.seconds * 1e-6;
}

nlohmann::json settings_json(const Options& options, const Session& session) {
    const dvec3& origin = session.scene.origin;
    return {{"schema", "twinray-report/1"},
            {"scene", options.scene.string()},
            {"origin", {origin.x, origin.y, origin.z}},
            {"picture", options.output.string()},
            {"device", session.context->properties().name},
            {"driver", session.context->properties().driver},
            {"width", session.settings.width},
            {"height", session.settings.height},
            {"max_depth", session.settings.max_depth},
            {"seed", session.settings.seed},
            {"triangles", count_triangles(session.scene)},
            {"instances", session.scene.instances.size()}};
}

nlohmann::json render_json(const Options& options, const Session& session, const AbstractAccel& accel,
                           const Rendering& rendering) {
    const RenderStats& stats = rendering.stats;
    const Film& film = rendering.film;
    nlohmann::json record = settings_json(options, session);
    record.update({{"case", "path_tracer"},
                   {"spp", film.mean_samples()},
                   {"configuration", hash_of(film.configuration)},
                   {"backend", session.accel.name()},
                   {"backend_why", session.accel.why},
                   {"path", trace_path(accel)},
                   {"path_rays", stats.path_rays},
                   {"shadow_rays", stats.shadow_rays},
                   {"non_finite", stats.non_finite},
                   {"build_ms", build_ms(accel)},
                   {"seconds", stats.seconds},
                   {"mrays_per_s", mega_rays_per_second(stats)}});
    if (const double error = film.error(); std::isfinite(error)) record["error"] = error;
    return record;
}

void write_line(const std::filesystem::path& file, const std::string& line, std::ios::openmode mode) {
    std::ofstream out(file, mode);
    if (!(out << line << std::flush)) fail("'", file.string(), "': cannot write");
}

nlohmann::json cross_check_json(const Options& options, const Session& session, const CrossCheck& result) {
    nlohmann::json record = settings_json(options, session), classes = nlohmann::json::array();
    for (const auto& [kinds, count] : result.classes)
        classes.push_back({{"sw", name_of(kinds.first)}, {"hw", name_of(kinds.second)}, {"rays", count}});
    record.update({{"case", "path_tracer.cross_check"},
                   {"spp", session.settings.samples},
                   {"path", result.hardware_path},
                   {"path_rays", result.path_rays},
                   {"shadow_rays", result.shadow_rays},
                   {"disagreeing_rays", result.disagreeing},
                   {"classified_rays", result.classified},
                   {"classes", classes},
                   {"faults_of_ours", result.faults_of_ours},
                   {"differing_pixels", result.pictures.differing},
                   {"unexplained_pixels", result.pictures.unexplained},
                   {"pass", result.passed()}});
    return record;
}

void add_frame(const FrameNote& frame, nlohmann::json& record) {
    record.update({{"frame", frame.number}, {"frames", frame.count}, {"build_ms", frame.build_ms}});
    if (frame.times)
        record.update({{"time", frame.seconds},
                       {"pose_ms", frame.times->host},
                       {"vertices_ms", frame.times->vertices},
                       {"refit_ms", frame.times->refit},
                       {"refit_device_ms", frame.times->refit_device}});
}

std::string frame_text(const FrameNote& frame) {
    std::ostringstream out;
    out << std::fixed << std::setprecision(3) << "frame " << frame.number << " of " << frame.count;
    if (frame.times)
        out << ": " << frame.seconds << " s; pose " << frame.times->host << " ms, vertices " << frame.times->vertices
            << " ms, refit " << frame.times->refit << " ms (device " << frame.times->refit_device << " ms, build "
            << frame.build_ms << " ms)";
    return out.str() + '\n';
}

// Returns "640 x 480, 16 spp, error 3.2 %".
std::string film_text(const Film& film) {
    std::ostringstream out;
    out << film.width << " x " << film.height << ", " << std::setprecision(6) << film.mean_samples() << " spp";
    if (const double error = film.error(); std::isfinite(error))
        out << ", error " << std::setprecision(3) << 100 * error << " %";
    return out.str();
}

std::string text_of(const PictureError& error) { return text("MSE ", error.mse, ", relMSE ", error.relative_mse); }

// Returns a line with the picture's difference from the reference, or nothing without one.
std::string reference_text(const std::filesystem::path& file, const HdrImage& picture) {
    if (file.empty()) return {};
    const PictureError error = error_against(picture, load_reference(file, picture.width, picture.height));
    return text("against '", file.string(), "': ", text_of(error), '\n');
}

// Returns the same for a rendering, with that of the noisy picture if there is another. It also goes into the record.
std::string reference_text(const Options& options, const Rendering& rendering, nlohmann::json& record) {
    if (options.reference.empty()) return {};
    const Film& film = rendering.film;
    const HdrImage reference = load_reference(options.reference, film.width, film.height);
    const PictureError error = error_against(rendering.picture, reference);
    record.update({{"mse", error.mse}, {"relative_mse", error.relative_mse}});
    std::string line = text("against '", options.reference.string(), "': ", text_of(error));
    if (options.denoise) {
        const PictureError noisy = error_against(film.mean(), reference);
        record.update({{"noisy_mse", noisy.mse}, {"noisy_relative_mse", noisy.relative_mse}});
        line += "; with its noise: " + text_of(noisy);
    }
    return line + '\n';
}

// Returns "shaded as: plain | glass; left out: alpha, textures, environment".
std::string features_text(const SceneFeatures& features) {
    std::string kinds, absent;
    for (const uint needs : features.kinds.needs) kinds += (kinds.empty() ? "" : " | ") + name_of_needs(needs);
    const auto note = [&](bool is_present, const std::string& name) {
        if (!is_present) absent += (absent.empty() ? "" : ", ") + name;
    };
    for (const uint need : material_needs) note(features.some(need), name_of_needs(1u << need));
    note(features.environment, "environment");
    note(features.local_lights, "local lights");
    note(features.light_tree, "light tree");
    note(features.panes, "panes");
    note(features.deep_textures, "deep textures");
    note(features.kinds.needs.size() > 1, "queues by kind");
    return "shaded as: " + kinds + "; left out: " + (absent.empty() ? "nothing" : absent);
}

void print_stats(const Session& session, const AbstractAccel& accel, const RenderStats& stats) {
    std::printf("rays: %llu of paths, %llu of shadows\n", static_cast<unsigned long long>(stats.path_rays),
                static_cast<unsigned long long>(stats.shadow_rays));
    std::printf("%s\n", features_text(session.device_scene->features()).c_str());
    for (const auto& [pass, ms] : stats.pass_ms) std::printf("device time: %9.1f ms  %s\n", ms, pass.c_str());
    constexpr double mib = 1 << 20;
    std::printf("device memory: %.1f MiB of rays, sums and film, %.1f MiB of the scene, %.1f MiB of the accelerator\n",
                static_cast<double>(session.renderer->device_bytes()) / mib,
                static_cast<double>(session.device_scene->device_bytes()) / mib,
                static_cast<double>(accel.memory_usage().total()) / mib);
}

std::string cross_check_text(const Options& options, const Session& session, const CrossCheck& result) {
    std::ostringstream out;
    out << "cross-check " << options.scene.filename().string() << ", " << session.settings.width << " x "
        << session.settings.height << ", " << session.settings.samples << " spp, on "
        << session.context->properties().name << ": HwTlas by " << result.hardware_path << " against SwTlas\n"
        << "  rays traced by both                  " << result.path_rays + result.shadow_rays << " ("
        << result.path_rays << " path, " << result.shadow_rays << " shadow)\n"
        << "  rays with different hits             " << result.disagreeing << '\n';
    for (const auto& [kinds, count] : result.classes)
        out << "    SW " << name_of(kinds.first) << ", HW " << name_of(kinds.second) << ": " << count << '\n';
    if (result.classified < result.disagreeing)
        out << "    not classified: " << result.disagreeing - result.classified << '\n';
    out << "  faults of twinray (SW_LEAK, SW_FALSE, T_ERR)  " << result.faults_of_ours << '\n'
        << "  differing pixels                     " << result.pictures.differing << " of " << result.pixel_count
        << '\n'
        << "  differing pixels without such a ray  " << result.pictures.unexplained << '\n'
        << (result.passed() ? "PASS\n" : "FAIL\n");
    return out.str();
}

}  // namespace

double build_ms(const AbstractAccel& accel) {
    double ms = 0;
    for (const PassTiming& pass : accel.build_timings()) ms += pass.ms;
    return ms;
}

void report_render(const Options& options, const Session& session, const AbstractAccel& accel,
                   const Rendering& rendering, const FrameNote* frame) {
    const RenderStats& stats = rendering.stats;
    const Film& film = rendering.film;
    if (stats.non_finite)
        std::fprintf(stderr, "path_tracer: %llu contributions were NaN or infinite; the picture leaves them out\n",
                     static_cast<unsigned long long>(stats.non_finite));
    nlohmann::json record = render_json(options, session, accel, rendering);
    const std::string against = reference_text(options, rendering, record);
    if (frame) add_frame(*frame, record);
    if (!options.json.empty()) write_line(options.json, record.dump() + "\n", std::ios::app);
    if (options.stats) print_stats(session, accel, stats);
    if (options.quiet) return;
    const std::string resumed =
        rendering.resumed_samples > 0 ? text(" (", rendering.resumed_samples, " resumed)") : std::string();
    if (frame) std::fputs(frame_text(*frame).c_str(), stdout);
    std::printf("%s: %s%s by %s (%s; %s) in %.1f s, %.2f Mrays/s\n%s", options.output.string().c_str(),
                film_text(film).c_str(), resumed.c_str(), accel.name().c_str(), trace_path(accel).c_str(),
                session.accel.why.c_str(), stats.seconds, mega_rays_per_second(stats), against.c_str());
}

void report_merge(const MergeOptions& options, const Film& film) {
    const std::string against = reference_text(options.reference, film.mean());
    if (options.quiet) return;
    std::printf("%s: %s of %zu films\n%s", options.output.string().c_str(), film_text(film).c_str(),
                options.films.size(), against.c_str());
}

void classify_disagreements(const Scene& scene, const std::vector<Disagreement>& disagreements, CrossCheck& result) {
    if (disagreements.empty()) return;
    const Reference reference(scene);
    const auto class_of = [&](const Disagreement& d, const Hit& hit, TracedBy by) {
        return d.is_any ? reference.classify_any(d.ray, hit.hit != 0, by) : reference.classify(d.ray, hit, by);
    };
    for (const Disagreement& d : disagreements) {
        const HitClass software = class_of(d, d.second, TracedBy::software);
        ++result.classes[{software, class_of(d, d.first, TracedBy::hardware)}];
        result.faults_of_ours += is_fault_of_ours(software);
    }
    result.classified = disagreements.size();
}

void report_cross_check(const Options& options, const Session& session, const CrossCheck& result) {
    const std::string summary = cross_check_text(options, session, result);
    const std::string json = cross_check_json(options, session, result).dump() + "\n";
    std::fputs(summary.c_str(), stdout);
    write_line(options.cross_check, options.cross_check.extension() == ".json" ? json : summary, std::ios::trunc);
    if (!options.json.empty()) write_line(options.json, json, std::ios::app);
}

}  // namespace twinray::path_tracer
