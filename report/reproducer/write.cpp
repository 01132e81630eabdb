// SPDX-License-Identifier: MIT
#include "report/reproducer/write.h"

#include <fstream>
#include <ostream>
#include <set>

#include "engine/core/error.h"
#include "engine/core/stopwatch.h"
#include "report/replay/scene_file.h"
#include "report/reproducer/program.h"
#include "report/reproducer/reproduce.h"

namespace twinray::reproducer {
namespace {

namespace fs = std::filesystem;

void write_bytes(const fs::path& file, const void* bytes, std::size_t size) {
    std::ofstream out(file, std::ios::binary);
    out.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
    if (!out.flush()) fail("'", file.string(), "' cannot be written");
}

void write_text(const fs::path& file, const std::string& words) { write_bytes(file, words.data(), words.size()); }

frame::Backend backend_of(const replay::Replay& replay) {
    for (const frame::Backend backend : frame::all_backends)
        if (frame::name_of(backend) == replay.backend && !frame::is_ours(backend)) return backend;
    fail("a fault of '", replay.backend, "' is not a fault of the driver; reproducers only show faults of drivers");
}

// Returns the replay of the reduced fault on the current device.
replay::Replay replay_of(const Reproduction& found, const replay::Replay& original, const DeviceProperties& device) {
    const ReferenceScene reference = ReferenceScene::of(found.scene);
    replay::Replay replay = original;
    replay.scene = "scene.glb";
    replay.scene_hash = replay::hash_of(found.scene);
    replay.level = name_of(Level::watertight);
    replay.kind = name_of(found.kind);
    replay.ray = found.ray;
    replay.answer = found.answer;
    replay.reference = reference.closest_hit(found.ray);
    replay.device = device.name;
    replay.driver = device.driver;
    return replay;
}

}  // namespace

std::string write_reproducer(const fs::path& folder, const Scene& scene, const replay::Replay& replay,
                             frame::Devices& devices, double seconds) {
    const frame::Backend backend = backend_of(replay);
    if (const std::string reason = devices.why_not({backend, Level::watertight}); !reason.empty()) fail(reason);
    const Reproduction found = reproduce(devices, backend, scene, replay.ray, seconds);
    const replay::Replay reduced = replay_of(found, replay, devices.context(backend).properties());
    fs::create_directories(folder);
    replay::write_glb(folder / "scene.glb", found.scene);
    replay::write(folder / "replay.json", reduced);
    write_text(folder / "report.md", page_text(found, reduced));
    const std::string found_on =
        text(reduced.device, ", ", reduced.driver, ", which answered ", words_of(found.answer));
    write_text(folder / "reproducer.c",
               program_text({found.scene, found.ray, found.right, backend == frame::Backend::pipeline, found_on}));
    for (const ProgramShader& shader : program_shaders())
        write_bytes(folder / text(shader.name, ".spv"), shader.spirv.data(), shader.spirv.size_bytes());
    const std::size_t triangles = count_triangles(found.scene);
    return text(name_of(found.kind), " in ", triangles, triangles == 1 ? " triangle" : " triangles", ", of ",
                found.triangles_before, ": ", (folder / "reproducer.c").string());
}

std::string write_reproducer(const fs::path& folder, const fs::path& replay_file, frame::Devices& devices,
                             double seconds) {
    const replay::Replay replay = replay::read(replay_file);
    const Scene scene = replay::load_traced_scene(replay_file, replay);
    try {
        return write_reproducer(folder, scene, replay, devices, seconds);
    } catch (const std::exception& error) {
        fail("replay '", replay_file.string(), "': ", error.what());
    }
}

std::size_t write_reproducers(const fs::path& folder, std::span<const fs::path> replay_files, frame::Devices& devices,
                              std::ostream& out, double seconds) {
    const Stopwatch begin;
    std::set<std::string> done;
    for (const fs::path& file : replay_files) {
        const double left = seconds - begin.seconds();
        if (left <= 0) break;
        try {
            const replay::Replay replay = replay::read(file);
            if (replay.backend == frame::name_of(frame::Backend::software) || done.contains(replay.kind)) continue;
            out << "  " << write_reproducer(folder / replay.kind, file, devices, left) << '\n';
            done.insert(replay.kind);
        } catch (const Error& error) {
            out << "  no reproducer: " << error.what() << '\n';
        }
    }
    return done.size();
}

}  // namespace twinray::reproducer
