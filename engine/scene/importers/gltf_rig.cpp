#include "engine/scene/importers/gltf_parts.h"

#include <set>

#include "engine/scene/importers/gltf_json.h"

namespace twinray {
namespace {

using nlohmann::json;

// Returns the node's weights, else the mesh's, else none of any target.
std::vector<double> rest_weights(const GltfFile& file, const GltfNode& node) {
    const tinygltf::Node& source = file.model.nodes[node.index];
    if (source.mesh < 0 || std::size_t(source.mesh) >= file.model.meshes.size()) return {};
    const tinygltf::Mesh& mesh = file.model.meshes[std::size_t(source.mesh)];
    std::size_t count = 0;
    for (const tinygltf::Primitive& primitive : mesh.primitives) count = std::max(count, primitive.targets.size());
    const std::vector<double>& given = source.weights.empty() ? mesh.weights : source.weights;
    if (given.empty()) return std::vector<double>(count, 0.0);
    if (given.size() != count)
        file.fail(node.name, ": there are ", given.size(), " morph weights, but its mesh has ", count, " targets");
    for (const double weight : given)
        if (!std::isfinite(static_cast<float>(weight)))
            file.fail(node.name, ": has the morph weight ", weight, ", which is not a finite float");
    return given;
}

std::vector<uint> read_joints(const GltfFile& file, const json& source, const std::vector<std::int32_t>& flat,
                              const std::string& object) {
    const json joints = source.is_object() ? source.value("joints", json()) : json();
    if (!joints.is_array() || joints.empty()) file.fail(object, ": has no list of joints");
    std::vector<uint> result;
    for (const json& joint : joints) {
        if (!joint.is_number_unsigned() || joint.get<std::uint64_t>() >= flat.size())
            file.fail(object, ": joint ", joint.dump().substr(0, 40), " does not exist; the file has ", flat.size(),
                      " nodes");
        const std::int32_t node = flat[joint.get<std::size_t>()];
        if (node < 0) file.fail(object, ": joint ", joint.dump(), " is a node that is not in the shown scene");
        result.push_back(static_cast<uint>(node));
    }
    return result;
}

std::vector<glm::dmat4> read_inverse_binds(const GltfFile& file, const json& source, std::size_t count,
                                           const std::string& object) {
    if (!source.contains("inverseBindMatrices")) return std::vector<glm::dmat4>(count, glm::dmat4(1));
    const auto accessor = json_count(source, "inverseBindMatrices");
    const std::string name = object + ": inverseBindMatrices";
    if (!accessor || *accessor > INT32_MAX) file.fail(name, " is not a non-negative integer");
    const std::vector<float> floats = read_floats(file, static_cast<int>(*accessor), 16, name);
    const std::vector<double> entries(floats.begin(), floats.end());
    if (entries.size() / 16 < count)
        file.fail(name, " has ", entries.size() / 16, " matrices, but there are ", count, " joints");
    std::vector<glm::dmat4> matrices;
    for (std::size_t i = 0; i < count; ++i) {
        const auto matrix = std::span(entries).subspan(16 * i).first<16>();
        matrices.push_back(affine_matrix(file, matrix, text(name, " ", i)));
    }
    return matrices;
}

Skin read_gltf_skin(const GltfFile& file, std::size_t index, const std::vector<std::int32_t>& flat) {
    const json& source = file.motion->at("skins")[index];
    Skin skin;
    skin.name = source.is_object() ? json_string(source, "name") : std::string();
    const std::string object = gltf_name("skin", index, skin.name);
    skin.joints = read_joints(file, source, flat, object);
    skin.inverse_binds = read_inverse_binds(file, source, skin.joints.size(), object);
    return skin;
}

// Reads skins. A mesh whose skin cannot be read has no place and is not shown. Its node loses it, with a warning.
std::vector<Skin> read_used_skins(GltfFile& file, const std::vector<GltfNode>& nodes,
                                  const std::vector<std::int32_t>& flat) {
    const json& sources = file.motion->at("skins");
    std::vector<Skin> skins(sources.is_array() ? sources.size() : 0);
    for (const GltfNode& node : nodes) {
        tinygltf::Node& source = file.model.nodes[node.index];
        if (source.skin < 0 || source.mesh < 0) continue;
        try {
            Skin& skin = file.entry(skins, source.skin, node.name, "skin");
            if (skin.joints.empty()) skin = read_gltf_skin(file, std::size_t(source.skin), flat);
        } catch (const Error& error) {
            file.warn(text(file.fault_of(error), "; the mesh of ", node.name, " is not shown"));
            source.mesh = source.skin = -1;
        }
    }
    return skins;
}

using Path = Animation::Channel::Path;

std::optional<Path> path_of(const std::string& name) {
    if (name == "translation") return Path::translation;
    if (name == "rotation") return Path::rotation;
    if (name == "scale") return Path::scale;
    if (name == "weights") return Path::weights;
    return std::nullopt;
}

std::optional<Interpolation> interpolation_of(const std::string& name) {
    if (name.empty() || name == "LINEAR") return Interpolation::linear;
    if (name == "STEP") return Interpolation::step;
    if (name == "CUBICSPLINE") return Interpolation::cubic_spline;
    return std::nullopt;
}

// Builds one animation. Throws Error naming the channel or sampler.
class AnimationReader {
  public:
    AnimationReader(const GltfFile& file, const Rig& rig, const std::vector<std::int32_t>& flat, const json& source,
                    Animation& animation)
        : file_(file), rig_(rig), flat_(flat), source_(source), animation_(animation) {}

    void read() {
        const json& channels = list("channels");
        for (std::size_t i = 0; i < channels.size(); ++i) read_channel(channels[i], text("channel ", i));
    }

  private:
    const json& list(const char* key) const {
        const auto found = source_.find(key);
        if (found == source_.end() || !found->is_array()) file_.fail(key, " is not a list");
        return *found;
    }

    int accessor_of(const json& sampler, const char* key, const std::string& object) const {
        const auto accessor = json_count(sampler, key);
        if (!accessor || *accessor > INT32_MAX) file_.fail(object, ": ", key, " is missing or no index of an accessor");
        return static_cast<int>(*accessor);
    }

    // Channels that name no node, or one that is not shown, have no effect.
    void read_channel(const json& channel, const std::string& object) {
        const json target = channel.is_object() ? channel.value("target", json()) : json();
        if (!target.is_object()) file_.fail(object, ": has no target");
        if (!target.contains("node")) return;
        const auto node = json_count(target, "node");
        if (!node || *node >= flat_.size())
            file_.fail(object, ": node ", target["node"].dump().substr(0, 40), " does not exist; the file has ",
                       flat_.size());
        const std::optional<Path> path = path_of(json_string(target, "path"));
        if (!path) file_.fail(object, ": path is neither translation, rotation, scale nor weights");
        if (flat_[*node] < 0) return;
        add(static_cast<uint>(flat_[*node]), *path, channel, object);
    }

    void add(uint node, Path path, const json& channel, const std::string& object) {
        if (!driven_.insert({node, path}).second) file_.fail(object, ": drives the same property as another channel");
        if (rig_.nodes[node].is_fixed && path != Path::weights)
            file_.fail(object, ": drives a node that has a matrix instead of translation, rotation and scale");
        const std::size_t targets = rig_.nodes[node].weights.size();
        if (path == Path::weights && targets == 0)
            file_.fail(object, ": drives weights of a node without morph targets");
        const uint width = path == Path::weights ? static_cast<uint>(targets) : path == Path::rotation ? 4 : 3;
        const auto sampler = json_count(channel, "sampler");
        if (!sampler || *sampler >= list("samplers").size())
            file_.fail(object, ": its sampler does not exist; there are ", list("samplers").size());
        const auto [known, is_new] = keyframes_.try_emplace({*sampler, width, path == Path::rotation},
                                                            static_cast<uint>(animation_.keyframes.size()));
        if (is_new)
            animation_.keyframes.push_back(
                read_keyframes(list("samplers")[*sampler], width, path, text("sampler ", *sampler)));
        animation_.channels.push_back({node, path, known->second});
    }

    Keyframes read_keyframes(const json& sampler, uint width, Path path, const std::string& object) const {
        if (!sampler.is_object()) file_.fail(object, ": is not an object");
        const auto interpolation = interpolation_of(json_string(sampler, "interpolation"));
        if (!interpolation) file_.fail(object, ": interpolation is neither LINEAR, STEP nor CUBICSPLINE");
        Keyframes keyframes{*interpolation, path == Path::rotation, width, {}, {}};
        keyframes.times = read_floats(file_, accessor_of(sampler, "input", object), 1, object + " input");
        check_times(keyframes.times, object);
        const int components = path == Path::weights ? 1 : static_cast<int>(width);
        keyframes.values = read_floats(file_, accessor_of(sampler, "output", object), components, object + " output");
        check_values(keyframes, object);
        return keyframes;
    }

    void check_times(const std::vector<float>& times, const std::string& object) const {
        if (times.empty()) file_.fail(object, ": has no times");
        for (std::size_t i = 0; i < times.size(); ++i) {
            if (!std::isfinite(times[i])) file_.fail(object, ": time ", i, " is ", times[i]);
            if (i > 0 && times[i] < times[i - 1])
                file_.fail(object, ": time ", i, " is ", times[i], ", before the one before it, ", times[i - 1]);
        }
    }

    void check_values(const Keyframes& keyframes, const std::string& object) const {
        const bool is_cubic = keyframes.interpolation == Interpolation::cubic_spline;
        const std::size_t parts = is_cubic ? 3 : 1, width = keyframes.width;
        if (keyframes.values.size() != keyframes.times.size() * parts * width)
            file_.fail(object, ": output has ", keyframes.values.size(), " numbers, but ", keyframes.times.size(),
                       " times need ", keyframes.times.size() * parts * width);
        for (std::size_t i = 0; i < keyframes.values.size(); ++i)
            if (!std::isfinite(keyframes.values[i]))
                file_.fail(object, ": output has the number ", keyframes.values[i], " at time ", i / (parts * width));
        for (std::size_t key = 0; keyframes.is_rotation && key < keyframes.times.size(); ++key) {
            const float* q = &keyframes.values[(parts * key + parts / 2) * width];
            if (q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0)
                file_.fail(object, ": the rotation at time ", key, " has length 0");
        }
    }

    const GltfFile& file_;
    const Rig& rig_;
    const std::vector<std::int32_t>& flat_;
    const json& source_;
    Animation& animation_;
    std::set<std::pair<uint, Path>> driven_;
    std::map<std::tuple<std::uint64_t, uint, bool>, uint> keyframes_;
};

const json& member_of(const json& object, const char* key) {
    static const json none;
    const auto found = object.is_object() ? object.find(key) : object.end();
    return found == object.end() ? none : *found;
}

// Detects KHR_animation_pointer, whose channels name no node.
bool shows_and_hides_nodes(const json& animation) {
    const json& channels = member_of(animation, "channels");
    return std::ranges::any_of(channels, [](const json& channel) {
        const json& extensions = member_of(member_of(channel, "target"), "extensions");
        const json& extension = member_of(extensions, "KHR_animation_pointer");
        return extension.is_object() && json_string(extension, "pointer").ends_with("/KHR_node_visibility/visible");
    });
}

}  // namespace

Rig read_gltf_rig(GltfFile& file, const std::vector<GltfNode>& nodes) {
    std::vector<std::int32_t> flat(file.model.nodes.size(), -1);
    for (std::size_t i = 0; i < nodes.size(); ++i) flat[nodes[i].index] = static_cast<std::int32_t>(i);
    Rig rig;
    for (const GltfNode& node : nodes) {
        rig.nodes.push_back(node.local);
        rig.nodes.back().weights = rest_weights(file, node);
    }
    rig.skins = read_used_skins(file, nodes, flat);
    rig.animations = read_gltf_animations(file, rig, flat);
    return rig;
}

std::vector<Animation> read_gltf_animations(GltfFile& file, const Rig& rig, const std::vector<std::int32_t>& flat) {
    const json& sources = file.motion->at("animations");
    std::vector<Animation> animations;
    for (std::size_t i = 0; sources.is_array() && i < sources.size(); ++i) {
        Animation& animation = animations.emplace_back();
        try {
            if (!sources[i].is_object()) file.fail("is not an object");
            animation.name = json_string(sources[i], "name");
            AnimationReader(file, rig, flat, sources[i], animation).read();
            if (shows_and_hides_nodes(sources[i]))
                file.warn(gltf_name("animation", i, animation.name) +
                          ": shows and hides nodes, which stay as they are at rest");
        } catch (const Error& error) {
            animation.keyframes.clear();
            animation.channels.clear();
            animation.fault = file.fault_of(error);
            file.warn(gltf_name("animation", i, animation.name) + " cannot be played: " + animation.fault);
        }
    }
    return animations;
}

}  // namespace twinray
