// SPDX-License-Identifier: MIT
// Error of a view factor against rays and against time: error_against_samples FOLDER
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <vector>

#include "contestants.h"

using namespace twinray;

namespace {

// A method with so many rays, over many seeds.
struct Point {
    std::uint64_t rays = 0;
    double error = 0;  // root mean square of the relative errors
    double ms = 0;     // the shortest: others on the machine only ever add to it
};

constexpr uint seeds = 32;

Point point_of(Estimator& estimator, const Method& method, std::uint64_t rays) {
    double squares = 0, ms = INFINITY;
    for (uint seed = 1; seed <= seeds; ++seed) {
        const TimedFactor found = estimator.estimate(method, rays, seed);
        squares += std::pow(found.value / known_factor() - 1, 2);
        ms = std::min(ms, found.ms);
    }
    return {rays, std::sqrt(squares / seeds), ms};
}

// error = factor * rays^slope is a straight line between logarithms: it is found by least squares.
struct Fit {
    double slope = 0, factor = 0;

    // Returns how many rays reduce the error to this.
    std::uint64_t rays_for(double error) const { return std::uint64_t(std::pow(error / factor, 1 / slope)); }
};

Fit fit_of(const std::vector<Point>& points) {
    double x_mean = 0, y_mean = 0, xx = 0, xy = 0;
    for (const Point& p : points) {
        x_mean += std::log(double(p.rays)) / double(points.size());
        y_mean += std::log(p.error) / double(points.size());
    }
    for (const Point& p : points) {
        const double x = std::log(double(p.rays)) - x_mean;
        xx += x * x;
        xy += x * (std::log(p.error) - y_mean);
    }
    return {xy / xx, std::exp(y_mean - xy / xx * x_mean)};
}

// [curve]
constexpr double wanted_error = 0.002;

// A method's errors, the law that they follow, and a test of its prediction.
struct Curve {
    std::vector<Point> points;
    Fit fit;
    Point tried;
};

Curve curve_of(Estimator& estimator, const Method& method) {
    Curve curve;
    for (std::uint64_t rays = 1 << 8; rays <= 1 << 16; rays *= 4)
        curve.points.push_back(point_of(estimator, method, rays));
    curve.fit = fit_of(curve.points);
    if (curve.fit.slope > -0.3) throw Error(std::string(method.name) + ": the error does not fall");
    curve.tried = point_of(estimator, method, curve.fit.rays_for(wanted_error));
    return curve;
}
// [/curve]

void print(const Method& method, const Curve& curve) {
    std::cout << std::left << std::setw(13) << method.name << std::right << std::fixed << std::setprecision(2)
              << std::setw(7) << curve.fit.slope << std::setw(12) << curve.tried.rays << std::setw(10)
              << 100 * curve.tried.error << " %" << std::setw(9) << curve.tried.ms << " ms\n";
}

// Checks what holds on every device.
void check(const Method& method, const Curve& curve) {
    const bool is_random = method.sequence == Sequence::random;
    const double low = is_random ? -0.6 : -1.2, high = is_random ? -0.4 : -0.5;
    if (curve.fit.slope < low || curve.fit.slope > high) throw Error(std::string(method.name) + ": another slope");
    if (curve.tried.error > 2 * wanted_error || curve.tried.error < wanted_error / 3)
        throw Error(std::string(method.name) + ": the error is not the one foretold");
}

}  // namespace

int main(int argc, char** argv) try {
    if (argc != 2) throw Error("usage: error_against_samples FOLDER");
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder);
    Context context;
    Estimator estimator(context);
    std::ofstream csv(folder / "error_against_samples.csv");
    csv << "method,rays,error,ms\n";
    std::cout << "               slope   rays for " << 100 * wanted_error << " %  error    time\n";
    for (const Method& method : methods) {
        const Curve curve = curve_of(estimator, method);
        for (const Point& p : curve.points)
            csv << method.name << ',' << p.rays << ',' << p.error << ',' << p.ms << '\n';
        print(method, curve);
        check(method, curve);
    }
    if (!csv.flush()) throw Error("error_against_samples.csv could not be written");
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
