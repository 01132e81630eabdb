// Saves an accelerator, or loads one and prints a hash of its hits, so that programs for two systems read each other's
// files.
//   saved_accel save|load FILE
#include <cmath>
#include <filesystem>
#include <iostream>
#include <span>
#include <vector>

#include <twinray/context.h>
#include <twinray/geometry.h>
#include <twinray/tlas.h>
#include "engine/core/fnv1a.h"
#include "engine/core/platform.h"

namespace {

// Its corners have few bits: they are the same on every system.
twinray::Mesh mesh() {
    twinray::Mesh mesh = twinray::make_grid(64, 64);
    for (twinray::vec3& p : mesh.positions) p.z = p.x * p.y / 16;
    return mesh;
}

void save(twinray::Context& context, const std::filesystem::path& file) {
    twinray::SwTlas accel(context);
    const std::vector<twinray::Transform> transforms = {{}, twinray::Transform::translation({0.25f, 0, 4})};
    accel.push(mesh(), transforms);
    context.wait(accel.sync());
    accel.save(file);
}

std::uint64_t load(twinray::Context& context, const std::filesystem::path& file) {
    const auto loaded = twinray::SwTlas::load(context, file);
    std::vector<twinray::Ray> rays;
    for (int i = 0; i < 256 * 256; ++i) {
        const twinray::vec3 origin(static_cast<float>(i % 256) / 256, static_cast<float>(i / 256) / 256, 8);
        rays.push_back({origin, 0, twinray::vec3(0.125f, 0.0625f, -1), INFINITY});
    }
    const std::vector<twinray::Hit> hits = loaded.accel->closest_hits(rays);
    twinray::Fnv1a hash;
    hash.add_bytes(std::span(hits));
    return hash.value();
}

}  // namespace

int main(int argc, char** argv) try {
    const std::vector<std::string> words = twinray::platform::arguments_of(argc, argv);
    if (words.size() != 2 || (words[0] != "save" && words[0] != "load")) {
        std::cerr << "usage: saved_accel save|load FILE\n";
        return 2;
    }
    twinray::Context context(twinray::ContextDesc{});
    if (words[0] == "save")
        save(context, twinray::platform::path_of(words[1]));
    else
        std::cout << std::hex << load(context, twinray::platform::path_of(words[1])) << '\n';
} catch (const twinray::Error& error) {
    std::cerr << "saved_accel: " << error.what() << '\n';
    return 1;
}
