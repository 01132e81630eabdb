// Many pictures of one scene: which moment, view and file each has. Pure decisions.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <twinray/scene.h>

namespace twinray::path_tracer {

// Options of --frames; none: one picture of the scene at rest.
struct SequenceOptions {
    std::optional<uint> frames = {};
    std::optional<double> fps = {};
    std::string animation = {};   // name or index
    std::string time_range = {};  // "A:B", in seconds
    bool turntable = false;

    bool is_wanted() const { return frames.has_value(); }
    bool plays_animation() const { return is_wanted() && (!turntable || !animation.empty()); }
};

// The moving parts and their times.
struct Sequence {
    std::optional<std::size_t> animation = {};  // of the scene's rig; none: nothing moves
    TimeRange range = {};
    std::optional<double> fps = {};  // none: the frames share the range evenly, and would begin anew after the last
    uint frames = 1;
    bool turntable = false;

    // Returns seconds of the animation; times past the range begin anew.
    double time_of(uint frame) const;
    // Returns the radians by which the camera has gone round.
    double angle_of(uint frame) const;
};

// Returns the animation that the options name; without a name the first, or none with --turntable. Throws Error if it
// does not exist or cannot be played, and if nothing would move.
Sequence make_sequence(const SequenceOptions& options, const Scene& scene);

// Returns the scene at up to 16 of the sequence's moments, all at once, to be framed, without cameras and lights.
Scene swept(const Scene& scene, const Sequence& sequence);

// Returns `pattern` with the frame's number, from 1 on: in place of the last row of '#', with at least so many digits,
// else "_0001" before the suffix.
std::filesystem::path frame_file(const std::filesystem::path& pattern, uint frame);

// Moves the camera round the vertical axis through `center`, counter-clockwise as seen from above.
Camera turned_about(const Camera& camera, vec3 center, double angle);

}  // namespace twinray::path_tracer
