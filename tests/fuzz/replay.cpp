// Runs inputs through a target without a fuzzer, so that any compiler's tests hold what fuzzing has found.
//   fuzz_replay TARGET MUTATIONS FILE|FOLDER...    each file, and so many copies of it with a few bytes changed
// Ends by a signal if a target's contract is broken, and with exit status 1 if an input took too long or too much
// memory.
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "tests/fuzz/targets.h"

namespace twinray::fuzz {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr double most_seconds = 5;
constexpr long most_kibibytes = 2l << 20;

std::vector<std::filesystem::path> files_in(const std::filesystem::path& path) {
    if (!std::filesystem::is_directory(path)) return {path};
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path))
        if (entry.is_regular_file()) files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
}

// Returns the bytes with some changed, removed or repeated; the same for the same generator.
Bytes changed(Bytes bytes, std::mt19937& random) {
    const auto below = [&](std::size_t n) {
        return static_cast<std::ptrdiff_t>(random() % std::max<std::size_t>(n, 1));
    };
    for (std::ptrdiff_t times = 1 + below(4); times > 0 && !bytes.empty(); --times) {
        const auto first = bytes.begin() + below(bytes.size());
        const auto last = first + std::min<std::ptrdiff_t>(1 + below(16), bytes.end() - first);
        const auto kind = below(8);
        if (kind < 5)
            *first = static_cast<std::uint8_t>(kind < 2 ? random() : kind < 4 ? *first ^ (1u << below(8)) : 0xff);
        else if (kind == 5)
            bytes.erase(first, below(8) == 0 ? bytes.end() : last);
        else if (kind == 6) {
            const Bytes again(first, last);
            bytes.insert(first, again.begin(), again.end());
        } else
            std::copy(first, last, bytes.begin() + below(static_cast<std::size_t>(first - bytes.begin())));
    }
    return bytes;
}

bool is_within_limits(const std::string& name, std::chrono::steady_clock::time_point start) {
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    if (seconds <= most_seconds && used.ru_maxrss <= most_kibibytes) return true;
    std::cerr << "fuzz: " << name << ": " << seconds << " s, " << used.ru_maxrss / 1024 << " MiB at most; allowed are "
              << most_seconds << " s and " << most_kibibytes / 1024 << " MiB\n";
    return false;
}

// An input at hand when the process ends, so that it can be run again.
bool run(const Target& target, const std::string& name, const Bytes& bytes) {
    const auto start = std::chrono::steady_clock::now();
    target.run(bytes);
    return is_within_limits(name, start);
}

bool replay(const Target& target, const std::filesystem::path& file, int mutations) {
    std::ifstream in(file, std::ios::binary);
    const Bytes bytes{std::istreambuf_iterator<char>(in), {}};
    std::cout << target.name << ": " << file.string() << std::endl;
    std::mt19937 random(1);
    bool is_good = run(target, file.string(), bytes);
    for (int i = 0; i < mutations; ++i)
        is_good &= run(target, file.string() + ", mutation " + std::to_string(i), changed(bytes, random));
    return is_good;
}

}  // namespace
}  // namespace twinray::fuzz

int main(int argc, char** argv) {
    using namespace twinray::fuzz;
    const std::vector<std::string> words(argv + 1, argv + argc);
    const auto target = std::ranges::find_if(
        all_targets, [&](const Target& each) { return words.size() > 2 && words[0] == each.name; });
    if (target == std::end(all_targets)) {
        std::cerr << "usage: fuzz_replay TARGET MUTATIONS FILE|FOLDER...\n";
        return 2;
    }
    int failures = 0, count = 0;
    for (std::size_t i = 2; i < words.size(); ++i)
        for (const std::filesystem::path& file : files_in(words[i]))
            ++count, failures += !replay(*target, file, std::stoi(words[1]));
    std::cout << target->name << ": " << count << " inputs, " << failures << " beyond the limits\n";
    return failures != 0;
}
