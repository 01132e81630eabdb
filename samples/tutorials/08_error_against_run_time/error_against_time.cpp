// SPDX-License-Identifier: MIT
// Error of t against the time of a ray, for each level of both accelerators: error_against_time FOLDER
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>

#include "contestants.h"

using namespace twinray;

namespace {

// The results of a contestant.
struct Result {
    std::string name;
    double ns = 0, ns_low = 0, ns_high = 0;          // of a ray: the median, and its 95 % interval
    double ulp_median = 0, ulp_99 = 0, ulp_max = 0;  // error of t
    std::uint64_t faults = 0, aimed = 0;             // rays aimed at vertices that were answered wrongly, and all
};

// [time]
// Rays on the device, and room for their hits.
struct Batch {
    std::uint64_t count;
    Buffer rays, hits;

    Batch(Context& context, const std::vector<Ray>& from)
        : count(from.size()),
          rays(context, {.name = "rays", .bytes = count * sizeof(Ray)}),
          hits(context, {.name = "hits", .bytes = count * sizeof(Hit)}) {
        Commands commands(context, "upload rays");
        commands.upload(rays, std::span(from));
        commands.submit_and_wait();
    }
};

// Returns nanoseconds per ray by the clock of the GPU: only of the trace, without transfers from and to the host.
double time_of_ray(const Contestant& contestant, const Batch& batch) {
    AbstractAccel& accel = *contestant.accel;
    Commands commands(accel.context(), "trace");
    accel.trace(commands, accel.view(),
                {.rays = batch.rays.ref<Ray>(),
                 .hits = batch.hits.ref<Hit>(),
                 .count = batch.count,
                 .level = contestant.level});
    return 1e9 * commands.submit_and_wait() / double(batch.count);
}

// [rounds]
constexpr int rounds = 15;

// In each round every contestant has one turn, so that other work of the machine affects all alike.
std::vector<std::vector<double>> times_of(const std::vector<Contestant>& contestants, const Batch& batch) {
    std::vector<std::vector<double>> times(contestants.size());
    for (const Contestant& contestant : contestants) time_of_ray(contestant, batch);  // compiles
    for (int round = 0; round < rounds; ++round)
        for (std::size_t i = 0; i < contestants.size(); ++i) times[i].push_back(time_of_ray(contestants[i], batch));
    for (std::vector<double>& of_one : times) std::sort(of_one.begin(), of_one.end());
    return times;
}

// [measure]
Result measure(const Contestant& contestant, const Reference& reference, const std::vector<Ray>& rays,
               const std::vector<ReferenceHit>& truth) {
    Result result{.name = contestant.name};
    const auto trace = [&](const std::vector<Ray>& of) {
        return contestant.accel->closest_hits(of, {.level = contestant.level});
    };
    const std::vector<double> errors = errors_of_t(truth, trace(rays));
    result.ulp_median = quantile(errors, 0.5);
    result.ulp_99 = quantile(errors, 0.99);
    result.ulp_max = errors.back();

    const std::vector<Ray> aimed = vertex_aimed_rays(reference, 20'000, 2);
    const HitClassCounts classes = count(reference.classify(aimed, trace(aimed), contestant.by));
    result.faults = classes.faults_of_ours() + classes.faults_of_hardware();
    result.aimed = classes.total();
    return result;
}

// [front]
// Returns those without a fault that no other beats in both time and error; the fastest first.
std::vector<Result> front_of(std::vector<Result> results) {
    std::erase_if(results, [](const Result& result) { return result.faults > 0; });
    std::sort(results.begin(), results.end(), [](const Result& a, const Result& b) { return a.ns < b.ns; });
    std::vector<Result> front;
    for (const Result& result : results)
        if (front.empty() || result.ulp_99 < front.back().ulp_99) front.push_back(result);
    return front;
}
// [/front]

void write_csv(const std::filesystem::path& file, const std::vector<Result>& results) {
    std::ofstream out(file);
    out << "name,ns,ns_low,ns_high,ulp_median,ulp_99,ulp_max,faults,aimed\n";
    for (const Result& r : results)
        out << r.name << ',' << r.ns << ',' << r.ns_low << ',' << r.ns_high << ',' << r.ulp_median << ',' << r.ulp_99
            << ',' << r.ulp_max << ',' << r.faults << ',' << r.aimed << '\n';
    if (!out.flush()) throw Error("'" + file.string() + "' could not be written");
}

void print(const Result& r) {
    std::cout << std::left << std::setw(21) << r.name << std::right << std::fixed << std::setprecision(1)
              << std::setw(7) << r.ns << " (" << r.ns_low << " to " << r.ns_high << ")" << std::setprecision(2)
              << std::setw(9) << r.ulp_median << std::setw(8) << r.ulp_99 << std::setw(9) << r.ulp_max << std::setw(8)
              << r.faults << '\n';
}

// Checks what holds on every device.
void check(const std::vector<Result>& results, const std::vector<Result>& front) {
    for (const Result& result : results) {
        const bool is_ours = result.name.starts_with("twinray"), is_fast = result.name.ends_with("fast");
        if (is_ours && !is_fast && result.faults > 0) throw Error(result.name + ": a wrong answer");
        if (is_fast && result.faults == 0) throw Error("level fast lost no ray: nothing was seen to go wrong");
        const bool is_float64 = result.name.ends_with("refined") || result.name.ends_with("certified");
        if (is_ours && is_float64 && result.ulp_max > 0.51) throw Error(result.name + ": t is not float64's");
        if (!(result.ns > 0) || result.ns_low > result.ns || result.ns_high < result.ns) throw Error("wrong times");
    }
    if (front.empty()) throw Error("the front is empty");
}

}  // namespace

int main(int argc, char** argv) try {
    if (argc != 2) throw Error("usage: error_against_time FOLDER");
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder);
    Context context;
    // [main]
    Scene scene;
    scene.meshes = {make_icosphere(6)};
    scene.instances = {{"sphere", 0, {}}};
    const Contest contest = make_contest(context, scene);

    const Reference reference(scene);
    const std::vector<Ray> rays = random_rays(bounds_of(scene), 1 << 16, 1);
    const std::vector<ReferenceHit> truth = truth_of(reference, rays);
    std::vector<Result> results;
    for (const Contestant& contestant : contest.contestants)
        results.push_back(measure(contestant, reference, rays, truth));

    const std::vector<std::vector<double>> times = times_of(contest.contestants, Batch(context, rays));
    for (std::size_t i = 0; i < results.size(); ++i) {
        results[i].ns = times[i][rounds / 2];
        results[i].ns_low = times[i][3];  // of 15 values the 4th and the 12th enclose the median in 96 % of cases
        results[i].ns_high = times[i][11];
    }
    const std::vector<Result> front = front_of(results);
    write_csv(folder / "error_against_time.csv", results);
    write_csv(folder / "error_against_time_front.csv", front);
    // [/main]
    std::cout << context.properties().name
              << "\n                     ns a ray (95 %)       ulp: median    99 %      max  faults of "
              << results.front().aimed << '\n';
    for (const Result& result : results) print(result);
    std::cout << "the front:";
    for (const Result& result : front) std::cout << "  " << result.name;
    std::cout << '\n';
    check(results, front);
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
