// SPDX-License-Identifier: MIT
// Reports about a run.
#pragma once

#include <map>
#include <string>

#include <twinray/validation.h>

#include "renderer/cross_check.h"
#include "renderer/moving_scene.h"
#include "samples/path_tracer/rendering.h"

namespace twinray::path_tracer {

// Notes on a frame of a sequence.
struct FrameNote {
    uint number = 1, count = 1;
    double seconds = 0;                     // of the animation
    double build_ms = 0;                    // of the accelerator, before the first frame
    std::optional<MotionTimes> times = {};  // none: nothing moves but the camera
};

// Returns the device's time of the accelerator's last build or refit.
double build_ms(const AbstractAccel& accel);

// Prints one line per render, unless quiet, and warnings about dropped contributions. Appends the JSON record that the
// options request.
void report_render(const Options& options, const Session& session, const AbstractAccel& accel,
                   const Rendering& rendering, const FrameNote* frame = nullptr);

void say_interrupted(const Rendering& rendering, const std::filesystem::path& checkpoint);

// Prints one line, unless quiet.
void report_merge(const MergeOptions& options, const Film& film);

// The result of one cross-check.
struct CrossCheck {
    std::string hardware_path;
    std::uint64_t path_rays = 0, shadow_rays = 0;
    std::uint64_t disagreeing = 0;
    std::uint64_t classified = 0;
    std::map<std::pair<HitClass, HitClass>, std::uint64_t> classes;  // (software, hardware) of the classified rays
    std::uint64_t faults_of_ours = 0;
    PictureDifference pictures;
    std::uint64_t pixel_count = 0;

    bool passed() const { return faults_of_ours == 0 && pictures.unexplained == 0; }
};

// Classifies each disagreeing ray by the float64 reference. `first` of each is hardware, `second` software.
void classify_disagreements(const Scene& scene, const std::vector<Disagreement>& disagreements, CrossCheck& result);

// Prints to stdout and writes the file: one JSON object if it ends in .json, else the text.
void report_cross_check(const Options& options, const Session& session, const CrossCheck& result);

}  // namespace twinray::path_tracer
