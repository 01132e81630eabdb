// SPDX-License-Identifier: MIT
#include "samples/path_tracer/rendering.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "samples/path_tracer/display.h"
#include "renderer/film_file.h"
#include "samples/path_tracer/interrupts.h"
#include "renderer/layers.h"
#include "renderer/rounds.h"
#include "samples/support/progress.h"
#include "samples/support/text.h"

namespace twinray::path_tracer {
using samples::text;
namespace {

// Of the error that is shown; more where estimates take long.
constexpr double seconds_between_estimates = 2, share_of_estimates = 0.05;
constexpr double seconds_between_displays = 1;

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
    samples::Progress bar_;
};

std::filesystem::path film_file(const std::filesystem::path& output) {
    return is_film_file(output) ? output : std::filesystem::path(output.string() + ".film");
}

// Nothing to resume from is no error: an array of jobs may start them all with --resume.
Film first_film(const Options& options, const Session& session, const std::filesystem::path& file) {
    Film film = session.renderer->make_film(session.configuration);
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
    FilmRenderer(const Options& options, const Session& session, AbstractAccel& accel, Ranks& ranks)
        : options_(options),
          session_(session),
          accel_(accel),
          ranks_(ranks),
          file_(checkpoint_file(options.output, ranks)),
          result_{.film = first_film(options, session, file_)},
          error_(result_.film.error()),
          estimate_(options.quiet ? std::nullopt : std::optional(seconds_between_estimates)),
          preview_(options.preview_seconds),
          checkpoint_(options.checkpoint_seconds),
          display_due_(options.display_server.empty() ? std::nullopt : std::optional(seconds_between_displays)),
          progress_("path_tracer " + accel.name(), fraction(), options.quiet) {
        result_.resumed_samples = result_.film.mean_samples();
        if (!options.display_server.empty() && ranks.index() == 0)
            display_.emplace(options.display_server, options.output.filename().string(), result_.film.width,
                             result_.film.height);
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
        result_.stats = session_.renderer->stats();
        show();
        if (result_.signal)
            stop();
        else
            finish();
        return std::move(result_);
    }

  private:
    double fraction() const {
        return fraction_done(result_.film.blocks, result_.film.block_size, session_.rules, session_.shard,
                             time_.elapsed(), error_);
    }

    // A round that would end further beyond the time than it began before is not begun; the first is.
    bool is_out_of_time() const {
        return session_.rules.seconds && last_round_ > 0 &&
               time_.elapsed() + last_round_ / 2 >= *session_.rules.seconds;
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

    // The first one comes at once.
    bool is_preview_due() const { return options_.preview_seconds && (!has_preview_ || preview_.is_due()); }

    void read() {
        const double start = time_.elapsed();
        session_.renderer->read(result_.film);
        error_ = result_.film.error();
        const double cost = time_.elapsed() - start;
        if (!options_.quiet) estimate_ = Timer(std::max(seconds_between_estimates, cost / share_of_estimates));
    }

    void write_what_is_due() {
        if (is_preview_due() && ranks_.index() == 0) {
            read();
            write_output();
            preview_.restart();
            if (!std::exchange(has_preview_, true) && !options_.quiet)
                std::fprintf(stderr, "%s: there after %.1f s, coarse; it is replaced by better ones\n",
                             options_.output.string().c_str(), time_.elapsed());
        }
        if (display_ && display_due_.is_due()) {
            read();
            show();
        }
        if (checkpoint_.is_due()) {
            read();
            save_film(file_, result_.film);
            checkpoint_.restart();
        }
    }

    // Of this rank's part. A viewer that has been closed is no reason to stop.
    void show() {
        if (display_ && !display_->show(result_.film.mean())) {
            if (!options_.quiet) std::fprintf(stderr, "path_tracer: the display server has gone\n");
            display_.reset();
        }
        display_due_.restart();
    }

    std::vector<ImageChannel> layers() const {
        if (!options_.aovs) return {};
        std::vector<ImageChannel> layers =
            layers_of(session_.renderer->first_surfaces(accel_), samples_of_first_surfaces);
        for (ImageChannel& channel : layers_of(result_.film)) layers.push_back(std::move(channel));
        return layers;
    }

    void write_output(std::span<const ImageChannel> layers = {}) const {
        if (!is_film_file(options_.output)) write_picture_of(options_.output, result_.film, options_.exposure, layers);
    }

    // The signal may come from mpirun, because a rank is lost: each saves its own, and none waits for the others.
    void stop() {
        ranks_.abandon();
        if (options_.checkpoint_seconds) save_film(file_, result_.film);
        if (ranks_.index() == 0) write_output(layers());
    }

    // A checkpoint is of no use beside a finished picture.
    void finish() {
        const bool has_checkpoint = options_.checkpoint_seconds &&
                                    (options_.resume || checkpoint_.elapsed() < time_.elapsed() || ranks_.count() > 1);
        if (ranks_.count() > 1) save_film(file_, result_.film);  // a rank may be lost while others wait for it
        ranks_.gather(result_.film, result_.stats);
        const std::filesystem::path whole = film_file(options_.output);
        if (ranks_.index() == 0) {
            write_output(layers());
            if (options_.keep_film || whole == options_.output) save_film(whole, result_.film);
        }
        const bool is_kept = file_ == whole && (options_.keep_film || whole == options_.output);
        if (has_checkpoint && !is_kept) std::filesystem::remove(file_);
    }

    const Options& options_;
    const Session& session_;
    AbstractAccel& accel_;
    Ranks& ranks_;
    std::filesystem::path file_;  // checkpoint
    Interrupts interrupts_;
    Rendering result_;
    double error_, last_round_ = 0;
    bool has_preview_ = false;
    Timer time_{std::nullopt}, estimate_, preview_, checkpoint_, display_due_;
    std::optional<Display> display_;
    RoundProgress progress_;
};

}  // namespace

std::filesystem::path checkpoint_file(const std::filesystem::path& output, const Ranks& ranks) {
    if (ranks.count() > 1) return text(output.string(), ".rank", ranks.index(), "of", ranks.count(), ".film");
    return film_file(output);
}

Rendering render_film(const Options& options, const Session& session, AbstractAccel& accel, Ranks& ranks) {
    return FilmRenderer(options, session, accel, ranks).run();
}

}  // namespace twinray::path_tracer
