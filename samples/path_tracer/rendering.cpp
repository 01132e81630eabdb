// SPDX-License-Identifier: MIT
#include "samples/path_tracer/rendering.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>

#include "engine/core/error.h"
#include "samples/path_tracer/film_file.h"
#include "samples/path_tracer/interrupts.h"
#include "samples/path_tracer/layers.h"
#include "samples/path_tracer/rounds.h"

namespace twinray::path_tracer {
namespace {

constexpr double seconds_between_estimates = 2;

// Says when something that is done every so often is due.
class Timer {
  public:
    explicit Timer(std::optional<double> interval) : interval_(interval) {}
    bool is_due() const { return interval_ && elapsed() >= *interval_; }
    double elapsed() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
    void restart() { start_ = Clock::now(); }

  private:
    using Clock = std::chrono::steady_clock;
    std::optional<double> interval_;
    Clock::time_point start_ = Clock::now();
};

// In thousandths of the work that is left for this run.
class RoundProgress {
  public:
    RoundProgress(const std::string& name, double fraction, bool quiet)
        : name_(name), start_(fraction), bar_(name, steps, quiet) {}
    void show(double fraction, double error) {
        if (std::isfinite(error)) bar_.rename(text(name_, ", error ", std::round(1000 * error) / 10, " %"));
        const double left = start_ < 1 ? (fraction - start_) / (1 - start_) : 1;
        const auto reached = static_cast<std::uint64_t>(std::max(0.0, left) * steps);
        bar_.advance(reached > shown_ ? reached - shown_ : 0);
        shown_ = std::max(shown_, reached);
    }

  private:
    static constexpr std::uint64_t steps = 1000;
    std::string name_;
    double start_;
    std::uint64_t shown_ = 0;
    Progress bar_;
};

// Nothing to resume from is no error: an array of jobs may start them all with --resume.
Film first_film(const Options& options, const Session& session) {
    Film film = session.renderer->make_film(session.configuration);
    const std::filesystem::path file = checkpoint_file(options.output);
    if (!options.resume) return film;
    if (!std::filesystem::exists(file)) {
        if (!options.quiet)
            std::fprintf(stderr, "path_tracer: there is no '%s' to resume; begins anew\n", file.string().c_str());
        return film;
    }
    film.merge(load_film(file), "what is to be rendered", file.string());
    return film;
}

class FilmRenderer {
  public:
    FilmRenderer(const Options& options, const Session& session, AbstractAccel& accel)
        : options_(options),
          session_(session),
          accel_(accel),
          result_{.film = first_film(options, session)},
          error_(result_.film.error()),
          preview_(options.preview_seconds),
          checkpoint_(options.checkpoint_seconds),
          progress_("path_tracer " + accel.name(), fraction(), options.quiet) {
        result_.resumed_samples = result_.film.mean_samples();
    }

    Rendering run() {
        session_.renderer->start(result_.film);
        while (const std::optional<Round> round = next_round(result_.film, session_.rules, session_.shard)) {
            if (is_out_of_time()) break;
            render(*round);
            write_what_is_due();
            progress_.show(fraction(), error_);
            if ((result_.signal = interrupts_.signal()) != 0) break;
        }
        session_.renderer->read(result_.film);
        write_output(layers());
        finish();
        return std::move(result_);
    }

  private:
    double fraction() const {
        return fraction_done(result_.film.blocks, result_.film.block_size, session_.rules, session_.shard,
                             time_.elapsed(), error_);
    }

    // A round that would end further beyond the time than it began before is not begun.
    bool is_out_of_time() const {
        return session_.rules.seconds && time_.elapsed() + last_round_ / 2 >= *session_.rules.seconds;
    }

    void render(const Round& round) {
        const double start = time_.elapsed();
        Renderer& renderer = *session_.renderer;
        if (!round.pixels.empty()) renderer.set_pixels(round.pixels);
        for (uint block = round.first; block < round.first + round.count; ++block) {
            renderer.add_block(accel_, block);
            result_.film.blocks.insert(block);
        }
        if (session_.rules.error || estimate_.is_due()) read();
        last_round_ = time_.elapsed() - start;
    }

    void read() {
        session_.renderer->read(result_.film);
        error_ = result_.film.error();
        estimate_.restart();
    }

    void write_what_is_due() {
        if (preview_.is_due()) {
            read();
            write_output();
            preview_.restart();
        }
        if (checkpoint_.is_due()) {
            read();
            save_film(checkpoint_file(options_.output), result_.film);
            checkpoint_.restart();
        }
    }

    std::vector<Channel> layers() const {
        if (!options_.aovs) return {};
        std::vector<Channel> layers = layers_of(session_.renderer->first_surfaces(accel_), samples_of_first_surfaces);
        for (Channel& channel : layers_of(result_.film)) layers.push_back(std::move(channel));
        return layers;
    }

    void write_output(std::span<const Channel> layers = {}) const {
        if (!is_film_file(options_.output)) write_picture_of(options_.output, result_.film, options_.exposure, layers);
    }

    // A checkpoint is of no use beside a finished picture.
    void finish() const {
        const std::filesystem::path file = checkpoint_file(options_.output);
        if (file == options_.output || options_.keep_film || result_.signal)
            save_film(file, result_.film);
        else if (options_.resume || checkpoint_.elapsed() < time_.elapsed())
            std::filesystem::remove(file);
    }

    const Options& options_;
    const Session& session_;
    AbstractAccel& accel_;
    Interrupts interrupts_;
    Rendering result_;
    double error_, last_round_ = 0;
    Timer time_{std::nullopt}, estimate_{seconds_between_estimates}, preview_, checkpoint_;
    RoundProgress progress_;
};

}  // namespace

std::filesystem::path checkpoint_file(const std::filesystem::path& output) {
    return is_film_file(output) ? output : std::filesystem::path(output.string() + ".film");
}

Rendering render_film(const Options& options, const Session& session, AbstractAccel& accel) {
    return FilmRenderer(options, session, accel).run();
}

}  // namespace twinray::path_tracer
