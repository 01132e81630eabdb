// The targets that are fuzzed, the contract of their readers, and files made of bytes. Each function gets any bytes at
// all and must return: the code it calls either takes them or throws one Error. Another exception, a message of a
// sanitizer, a hang or gigabytes of memory is a finding; see docs/fuzzing.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include <twinray/geometry.h>

namespace twinray::fuzz {

using Input = std::span<const std::uint8_t>;

void accel(Input input);        // histories of calls of AbstractAccel, against a model of docs/contract.md
void command(Input input);      // command lines
void csv(Input input);          // rays, points, groups of faces, positions of the sun
void encodings(Input input);    // gzip, base64, per cent signs
void events(Input input);       // events that a viewer plays
void exr(Input input);          // OpenEXR
void film(Input input);         // checkpoints of the path tracer
void gltf(Input input);         // .gltf and .glb
void hdr(Input input);          // Radiance RGBE
void image(Input input);        // PNG and JPEG
void json(Input input);         // records of reports, replays, states of leak tests, limits of kernels
void obj(Input input);          // .obj and the .mtl that it names
void ply(Input input);          // .ply
void rays(Input input);         // rays as .npy and as raw records
void rows(Input input);         // unfinished rows of view factors
void saved_accel(Input input);  // a saved SwTlas
void stl(Input input);          // .stl, text and binary

struct Target {
    const char* name;
    void (*run)(Input input);
};
inline constexpr Target all_targets[] = {
    {"accel", accel},   {"command", command}, {"csv", csv},   {"encodings", encodings},
    {"events", events}, {"exr", exr},         {"film", film}, {"gltf", gltf},
    {"hdr", hdr},       {"image", image},     {"json", json}, {"obj", obj},
    {"ply", ply},       {"rays", rays},       {"rows", rows}, {"saved_accel", saved_accel},
    {"stl", stl},
};

// Ends the process, as a sanitizer does, if `holds` is false.
void require(bool holds, const std::string& promise);

// Returns whether `read` took its input; false means that it refused by an Error, which says something. Every other
// exception goes through and is a finding.
template <class Read>
bool is_taken(const Read& read) {
    try {
        read();
        return true;
    } catch (const Error& error) {
        require(error.what()[0] != '\0', "an Error says what is wrong");
        return false;
    }
}

// Writes the bytes to a file of this name in a folder of this process, in memory if the system has such files. The file
// exists until the process ends.
std::filesystem::path file_of(Input bytes, const std::string& name);

}  // namespace twinray::fuzz
