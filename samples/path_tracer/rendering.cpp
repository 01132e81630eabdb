// SPDX-License-Identifier: MIT
#include "samples/path_tracer/path_tracer.h"

#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <utility>

#include "engine/core/platform.h"
#include "renderer/configuration.h"
#include "renderer/film_file.h"
#include "samples/support/progress.h"
#include "samples/support/text.h"

namespace twinray::path_tracer {
using samples::fail;
using samples::text;
namespace {

// The shown error is estimated at these intervals, and less often if estimates take long.
constexpr double seconds_between_estimates = 2, share_of_estimates = 0.05;
constexpr double seconds_between_displays = 1;

// Tells when a repeated action is due.
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

// Shows thousandths of the remaining work of this run.
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

volatile std::sig_atomic_t noted = 0;

void note(int number) {
    noted = number;
    std::signal(number, SIG_DFL);
}

// While it lives, the first SIGINT or SIGTERM is only noted, so that work can end in good order; a second one ends the
// program at once. One at a time.
class Interrupts {
  public:
    Interrupts() {
        noted = 0;
        std::signal(SIGINT, note);
        std::signal(SIGTERM, note);
    }
    ~Interrupts() {
        std::signal(SIGINT, SIG_DFL);
        std::signal(SIGTERM, SIG_DFL);
    }
    Interrupts(const Interrupts&) = delete;
    Interrupts& operator=(const Interrupts&) = delete;

    // Returns the number of the signal; 0: none came.
    int signal() const { return noted; }
};

constexpr char default_port[] = "14158";
constexpr int patience_seconds = 2;  // a viewer that does not read for so long counts as gone
constexpr char update_image = 3, create_image = 4;
constexpr std::array channels = {"R", "G", "B"};

// server: HOST:PORT, or only HOST for port 14158. Throws Error if nobody listens there.
platform::Connection connect_to(const std::string& server) {
    const std::size_t colon = server.rfind(':');
    const std::string port = colon == std::string::npos ? default_port : server.substr(colon + 1);
    auto connection = platform::Connection::open(server.substr(0, colon), port, patience_seconds);
    if (!connection) fail("--display-server ", server, ": no server listens there; it must be HOST or HOST:PORT");
    return std::move(*connection);
}

// Values are little-endian, like the protocol and the machines that this runs on.
template <class T>
void put(std::string& payload, const T& value) {
    payload.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void put_text(std::string& payload, const std::string& value) { payload.append(value.c_str(), value.size() + 1); }

std::string header(char kind, const std::string& name) {
    std::string payload(1, kind);
    payload += '\0';  // the viewer need not come to the front
    put_text(payload, name);
    return payload;
}

// Shows a picture in a viewer that takes it over a TCP connection, such as tev: its protocol's packets CreateImage and,
// for each channel, UpdateImage (github.com/Tom94/tev), as pbrt-v4 sends them.
class Display {
  public:
    // Connects as connect_to() does.
    Display(const std::string& server, const std::string& name, uint width, uint height)
        : name_(name), connection_(connect_to(server)) {
        std::string payload = header(create_image, name_);
        put(payload, width);
        put(payload, height);
        put(payload, static_cast<uint>(channels.size()));
        for (const char* channel : channels) put_text(payload, channel);
        send_packet(payload);
    }

    // Returns false once the viewer is gone.
    bool show(const HdrImage& picture) {
        for (std::size_t channel = 0; channel < channels.size(); ++channel) {
            std::string payload = header(update_image, name_);
            put_text(payload, channels[channel]);
            for (const uint value : {0u, 0u, picture.width, picture.height}) put(payload, value);
            for (const vec3& rgb : picture.rgb) put(payload, rgb[static_cast<int>(channel)]);
            if (!send_packet(payload)) return false;
        }
        return true;
    }

  private:
    bool send_packet(const std::string& payload) {
        std::string packet;
        put(packet, static_cast<uint>(payload.size() + sizeof(uint)));
        packet += payload;
        return connection_.send(packet);
    }

    std::string name_;
    platform::Connection connection_;
};

std::filesystem::path film_file(const std::filesystem::path& output) {
    return is_film_file(output) ? output : platform::path_of(output.string() + ".film");
}

// A missing checkpoint is no error: an array of jobs may start them all with --resume.
Film first_film(const Options& options, const Session& session, const std::filesystem::path& file) {
    Film film = session.renderer->make_film(session.configuration);
    if (!options.resume) return film;
    if (!std::filesystem::exists(file)) {
        if (!options.quiet)
            std::fprintf(stderr, "path_tracer: there is no '%s' to resume; starting from the beginning\n",
                         file.string().c_str());
        return film;
    }
    film.merge(load_film(file), "what is to be rendered", file.string());
    return film;
}

// The first message. The pixels and the words of the block set follow.
struct Summary {
    std::uint64_t path_rays, shadow_rays, non_finite, words;
};

// Rank 0 gets the films and statistics of the others, in their order; the others keep theirs. Waits for all.
void gather(const Ranks& ranks, Film& film, RenderStats& stats) {
    if (ranks.count() == 1) return;
    if (ranks.index() > 0) {
        const std::vector<uint> words = film.blocks.words();
        const Summary summary{stats.path_rays, stats.shadow_rays, stats.non_finite, words.size()};
        ranks.send(std::as_bytes(std::span(&summary, 1)));
        ranks.send(std::as_bytes(std::span(film.pixels)));
        ranks.send(std::as_bytes(std::span(words)));
        return;
    }
    for (uint rank = 1; rank < ranks.count(); ++rank) {
        Summary summary{};
        ranks.receive(std::as_writable_bytes(std::span(&summary, 1)), rank);
        Film other = Film::empty(film.width, film.height, film.block_size, film.configuration);
        ranks.receive(std::as_writable_bytes(std::span(other.pixels)), rank);
        std::vector<uint> words(summary.words);
        ranks.receive(std::as_writable_bytes(std::span(words)), rank);
        other.blocks = BlockSet(std::move(words));
        film.merge(other, "rank 0", "rank " + std::to_string(rank));
        stats.path_rays += summary.path_rays, stats.shadow_rays += summary.shadow_rays;
        stats.non_finite += summary.non_finite;
    }
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

    // A round that would end further beyond the time than it began before is not begun; the first always is.
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

    // The first one is due at once.
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
            write_picture(result_.film.mean(), {});
            preview_.restart();
            if (!std::exchange(has_preview_, true) && !options_.quiet)
                std::fprintf(stderr, "%s: written after %.1f s, still coarse; better pictures will replace it\n",
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

    // A viewer sees this rank's part. If it has been closed, the rendering continues.
    void show() {
        if (display_ && !display_->show(result_.film.mean())) {
            if (!options_.quiet) std::fprintf(stderr, "path_tracer: the display server has closed the connection\n");
            display_.reset();
        }
        display_due_.restart();
    }

    void write_picture(const HdrImage& picture, std::span<const ImageChannel> layers) const {
        if (!is_film_file(options_.output))
            write_picture_of(options_.output, result_.film.configuration, picture, options_.exposure, layers);
    }

    void write_output() {
        result_.picture = result_.film.mean();
        std::vector<ImageChannel> layers;
        if (options_.aovs || session_.denoiser) {
            const std::vector<FirstSurface> surfaces = session_.renderer->first_surfaces(accel_);
            if (session_.denoiser)
                result_.picture =
                    session_.denoiser->denoised(std::move(result_.picture), surfaces, samples_of_first_surfaces);
            if (options_.aovs) layers = layers_of(surfaces, samples_of_first_surfaces);
        }
        if (options_.aovs)
            for (ImageChannel& channel : layers_of(result_.film)) layers.push_back(std::move(channel));
        write_picture(result_.picture, layers);
    }

    // The signal may come from mpirun, because a rank is lost: each rank saves its film, and none waits for others.
    void stop() {
        ranks_.abandon();
        if (options_.checkpoint_seconds) save_film(file_, result_.film);
        if (ranks_.index() == 0) write_output();
    }

    // A checkpoint has no use beside a finished picture.
    void finish() {
        const bool has_checkpoint = options_.checkpoint_seconds &&
                                    (options_.resume || checkpoint_.elapsed() < time_.elapsed() || ranks_.count() > 1);
        if (ranks_.count() > 1) save_film(file_, result_.film);  // a rank may be lost while others wait for it
        gather(ranks_, result_.film, result_.stats);
        const std::filesystem::path whole = film_file(options_.output);
        if (ranks_.index() == 0) {
            write_output();
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
    if (ranks.count() > 1)
        return platform::path_of(text(output.string(), ".rank", ranks.index(), "of", ranks.count(), ".film"));
    return film_file(output);
}

Rendering render_film(const Options& options, const Session& session, AbstractAccel& accel, Ranks& ranks) {
    return FilmRenderer(options, session, accel, ranks).run();
}

}  // namespace twinray::path_tracer
