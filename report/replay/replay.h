// One faulty ray as a file, with all that is needed to trace it again and to see what went wrong; its scene as a file
// that keeps every float.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "validation/verify/comparison.h"

namespace twinray::replay {

struct Replay {
    std::filesystem::path scene;  // a file for load_scene(); in a replay file, relative to that file's folder
    std::string scene_hash;       // hash_of() the traced scene
    std::string backend;          // "sw", "hw", "hw-pipeline"
    std::string level;            // "watertight", ...
    std::string kind;             // class of the answer: "HW_LEAK"
    Ray ray{};
    Hit answer{};
    ReferenceHit reference;
    std::string device, driver, twinray;  // of the answer
};

// Write and read JSON with floats as hexadecimal words, so that none is rounded. Throw Error naming the file and what
// is wrong with it.
void write(const std::filesystem::path& file, const Replay& replay);
Replay read(const std::filesystem::path& file);

// Writes a file for each fault, "random-SW_LEAK-1.json" of the set "random", into the folder, which it makes; without
// `with_driver` only faults of twinray. `common`: what all have in common, with the driver's backend; `reference`
// returns what is right. Returns how many files were written.
std::size_t write_faults(const std::filesystem::path& folder, const std::string& set, std::span<const Fault> faults,
                         bool with_driver, Replay common, const std::function<ReferenceHit(const Ray&)>& reference);

// Returns the geometry of a reference: meshes in the order of its instances, triangles with the same numbers. Triangles
// that cannot be hit have all vertices at 0. Masks and culling are left out.
Scene scene_of(const ReferenceScene& reference);

// Writes binary glTF of positions and transforms alone, relative to the scene's origin: load_scene(file, dvec3(0))
// returns the same floats, triangles and instances. Throws Error if the file cannot be written.
void write_glb(const std::filesystem::path& file, const Scene& scene);

// Returns 16 hexadecimal digits over all positions, triangles and transforms (FNV-1a).
std::string hash_of(const Scene& scene);

// Loads the scene that a replay of this file names. A user's scene is loaded in the same way as for the trace; one that
// write_glb() made has the floats that were traced. Throws Error if its hash is not that of the traced scene.
Scene load_traced_scene(const std::filesystem::path& file, const Replay& replay);

}  // namespace twinray::replay
