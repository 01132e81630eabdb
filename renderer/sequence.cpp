#include "renderer/sequence.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iomanip>
#include <numbers>
#include <numeric>
#include <sstream>

#include <twinray/scene.h>

#include "engine/core/platform.h"
#include "samples/support/text.h"
#include "twinray/glsl/cpp.h"

namespace twinray::path_tracer {
using samples::fail;
using samples::text;
namespace {

TimeRange parse_range(const std::string& text) {
    TimeRange range;
    char colon = 0;
    std::istringstream in(text);
    if (!(in >> range.begin >> colon >> range.end) || colon != ':' || !(in >> std::ws).eof() ||
        !(range.begin <= range.end))
        fail("--time-range '", text, "': must be A:B in seconds, with A at most B");
    return range;
}

std::string names_of(const std::vector<AnimationInfo>& animations) {
    std::string names;
    for (std::size_t i = 0; i < animations.size(); ++i)
        names += text(i ? ", " : "", i, animations[i].name.empty() ? "" : " '" + animations[i].name + "'");
    return names;
}

std::size_t find_animation(const std::vector<AnimationInfo>& animations, const std::string& wanted) {
    const auto named = std::ranges::find(animations, wanted, &AnimationInfo::name);
    if (named != animations.end() && !wanted.empty()) return static_cast<std::size_t>(named - animations.begin());
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), index);
    const bool is_index = error == std::errc() && end == wanted.data() + wanted.size();
    if (!is_index || index >= animations.size())
        fail("--animation '", wanted, "': does not exist; the scene has ", names_of(animations));
    return index;
}

std::optional<std::size_t> chosen_animation(const SequenceOptions& options, const Scene& scene) {
    if (!options.plays_animation()) return {};
    if (!scene.rig)
        fail("--frames ", *options.frames, ": the scene has no animations; --turntable moves the camera around it");
    return find_animation(animations_of(*scene.rig), options.animation.empty() ? "0" : options.animation);
}

std::vector<Instance> instances_at(const Scene& scene, const Pose& pose) {
    std::vector<Instance> instances = scene.instances;
    const std::vector<Transform> transforms = instance_transforms(*scene.rig, pose);
    for (std::size_t i = 0; i < instances.size(); ++i) instances[i].transform = transforms[i];
    return instances;
}

}  // namespace

Sequence make_sequence(const SequenceOptions& options, const Scene& scene) {
    Sequence sequence;
    sequence.animation = chosen_animation(options, scene);
    sequence.frames = *options.frames;
    sequence.fps = options.fps;
    sequence.turntable = options.turntable;
    if (!sequence.animation) {
        if (options.fps || !options.time_range.empty())
            fail("--fps and --time-range require an animation, and --turntable plays none unless --animation names it");
        return sequence;
    }
    const AnimationInfo animation = animations_of(*scene.rig)[*sequence.animation];
    if (!animation.fault.empty()) fail("animation '", animation.name, "' cannot be played: ", animation.fault);
    sequence.range = options.time_range.empty() ? animation.range : parse_range(options.time_range);
    return sequence;
}

double Sequence::time_of(uint frame) const {
    const double duration = range.end - range.begin;
    if (!(duration > 0)) return range.begin;
    return range.begin + (fps ? std::fmod(frame / *fps, duration) : duration * frame / frames);
}

double Sequence::angle_of(uint frame) const { return turntable ? 2 * std::numbers::pi * frame / frames : 0; }

Scene swept(const Scene& scene, const Sequence& sequence) {
    constexpr uint most_moments = 16;
    Scene all;
    all.meshes = scene.meshes;
    all.instances = scene.instances;
    all.materials = scene.materials;
    if (!sequence.animation) return all;
    const std::vector<Instance> at_rest = instances_at(scene, rest_pose(*scene.rig));
    const std::vector<uint> deformed_by_pose = deformed_meshes(*scene.rig);
    all.instances = at_rest;
    const uint moments = std::min(sequence.frames, most_moments);
    for (uint i = 0; i < moments; ++i) {
        const uint frame = static_cast<uint>(std::uint64_t{i} * sequence.frames / moments);
        const Pose pose = pose_at(*scene.rig, *sequence.animation, sequence.time_of(frame));
        std::vector<uint> shapes(scene.meshes.size());
        std::iota(shapes.begin(), shapes.end(), 0u);
        for (std::size_t k = 0; k < deformed_by_pose.size(); ++k) {
            const uint mesh = deformed_by_pose[k];
            shapes[mesh] = static_cast<uint>(all.meshes.size());
            all.meshes.push_back(scene.meshes[mesh]);
            all.meshes.back().positions = deformed(*scene.rig, k, pose).positions;
        }
        std::vector<Instance> moved = instances_at(scene, pose);
        for (std::size_t k = 0; k < moved.size(); ++k) {
            moved[k].mesh = shapes[moved[k].mesh];
            const bool has_moved = moved[k].mesh != at_rest[k].mesh || moved[k].transform != at_rest[k].transform;
            if (has_moved) all.instances.push_back(std::move(moved[k]));
        }
    }
    std::erase_if(all.instances, [](const Instance& instance) { return !fault_of(instance.transform).empty(); });
    return all;
}

std::filesystem::path frame_file(const std::filesystem::path& pattern, uint frame) {
    const std::string name = pattern.filename().string();
    const auto number = [&](std::size_t digits) {
        std::ostringstream out;
        out << std::setw(static_cast<int>(digits)) << std::setfill('0') << frame + 1;
        return out.str();
    };
    const std::size_t last = name.find_last_of('#');
    if (last == std::string::npos)
        return pattern.parent_path() /
               platform::path_of(pattern.stem().string() + "_" + number(4) + pattern.extension().string());
    const std::size_t before = name.find_last_not_of('#', last), first = before == std::string::npos ? 0 : before + 1;
    return pattern.parent_path() /
           platform::path_of(name.substr(0, first) + number(last + 1 - first) + name.substr(last + 1));
}

Camera turned_about(const Camera& camera, vec3 center, double angle) {
    const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
    const Transform turn{{vec4(c, 0, s, 0), vec4(0, 1, 0, 0), vec4(-s, 0, c, 0)}};
    Camera turned = camera;
    turned.camera_to_world =
        Transform::translation(center) * (turn * (Transform::translation(-center) * camera.camera_to_world));
    return turned;
}

}  // namespace twinray::path_tracer
