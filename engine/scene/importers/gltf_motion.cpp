#include "engine/scene/importers/gltf_parts.h"

namespace twinray {
namespace {

using tinygltf::Primitive;

constexpr uint set_size = 4;  // joints in JOINTS_n

uint set_count(const Primitive& primitive) {
    uint count = 0;
    while (attribute_of(primitive.attributes, text("JOINTS_", count)) >= 0 &&
           attribute_of(primitive.attributes, text("WEIGHTS_", count)) >= 0)
        ++count;
    return count;
}

std::vector<float> read_set(const GltfFile& file, const Primitive& primitive, const std::string& name,
                            std::size_t vertex_count, const std::string& object) {
    std::vector<float> values =
        read_floats(file, attribute_of(primitive.attributes, name), set_size, object + " " + name);
    check_element_count(file, values.size() / set_size, vertex_count, object, name);
    return values;
}

void read_influences(const GltfFile& file, const Primitive& primitive, std::size_t vertex_count,
                     const std::string& object, VertexMotion& motion) {
    motion.joints.resize(vertex_count * motion.influences);
    motion.weights.resize(vertex_count * motion.influences);
    for (uint set = 0; set < set_count(primitive); ++set) {
        const std::vector<float> joints = read_set(file, primitive, text("JOINTS_", set), vertex_count, object);
        const std::vector<float> weights = read_set(file, primitive, text("WEIGHTS_", set), vertex_count, object);
        for (std::size_t i = 0; i < joints.size(); ++i) {
            if (!(weights[i] >= 0) || !std::isfinite(weights[i]))
                file.fail(object, ": WEIGHTS_", set, " of vertex ", i / set_size, " is ", weights[i]);
            if (weights[i] == 0) continue;  // files name any joint there
            if (!(joints[i] >= 0) || joints[i] != std::floor(joints[i]) || joints[i] >= 16777216)
                file.fail(object, ": JOINTS_", set, " of vertex ", i / set_size, " is ", joints[i]);
            const std::size_t at = i / set_size * motion.influences + set * set_size + i % set_size;
            motion.joints[at] = static_cast<uint>(joints[i]);
            motion.weights[at] = weights[i];
        }
    }
}

// Returns how many vertices had no weight.
std::size_t normalize_weights(VertexMotion& motion) {
    std::size_t weightless = 0;
    for (std::size_t first = 0; first < motion.weights.size(); first += motion.influences) {
        double sum = 0;
        for (uint i = 0; i < motion.influences; ++i) sum += static_cast<double>(motion.weights[first + i]);
        if (sum == 0) {
            motion.weights[first] = 1;
            ++weightless;
            continue;
        }
        for (uint i = 0; i < motion.influences; ++i) {
            float& weight = motion.weights[first + i];
            weight = static_cast<float>(static_cast<double>(weight) / sum);
        }
    }
    return weightless;
}

}  // namespace

MotionLayout motion_layout(const GltfFile& file, const std::vector<const Primitive*>& primitives,
                           const std::string& object, bool is_skinned) {
    MotionLayout layout;
    if (!primitives.empty()) layout.targets = primitives.front()->targets.size();
    for (const Primitive* primitive : primitives) {
        if (primitive->targets.size() != layout.targets)
            file.fail(object, ": one primitive has ", layout.targets, " morph targets, another ",
                      primitive->targets.size());
        for (const GltfAttributes& target : primitive->targets) {
            layout.normals |= attribute_of(target, "NORMAL") >= 0;
            layout.tangents |= attribute_of(target, "TANGENT") >= 0;
        }
        // A primitive without joints, beside others or alone, follows the first joint.
        if (is_skinned) layout.influences = std::max({layout.influences, set_count(*primitive) * set_size, set_size});
    }
    return layout;
}

VertexMotion read_gltf_motion(GltfFile& file, const Primitive& primitive, const MotionLayout& layout,
                              std::size_t vertex_count, const std::string& object) {
    VertexMotion motion;
    for (std::size_t i = 0; i < layout.targets; ++i) {
        const std::string name = text(object, " target ", i);
        const auto read = [&](const char* attribute) {
            return read_attribute<3>(file, primitive.targets[i], attribute, vertex_count, name);
        };
        motion.targets.push_back({read("POSITION"), layout.normals ? read("NORMAL") : std::vector<vec3>(),
                                  layout.tangents ? read("TANGENT") : std::vector<vec3>()});
    }
    motion.influences = layout.influences;
    if (layout.influences) read_influences(file, primitive, vertex_count, object, motion);
    if (const std::size_t count = layout.influences ? normalize_weights(motion) : 0)
        file.warn(text(object, ": ", count, " vertices have no weights and follow the skin's first joint"));
    return motion;
}

void append(VertexMotion& all, const VertexMotion& part) {
    all.influences = part.influences;
    all.targets.resize(part.targets.size());
    for (std::size_t i = 0; i < part.targets.size(); ++i) {
        append(all.targets[i].positions, part.targets[i].positions);
        append(all.targets[i].normals, part.targets[i].normals);
        append(all.targets[i].tangents, part.targets[i].tangents);
    }
    append(all.joints, part.joints);
    append(all.weights, part.weights);
}

VertexMotion picked(const VertexMotion& motion, const std::vector<uint>& vertices) {
    VertexMotion result;
    for (const MorphTarget& target : motion.targets)
        result.targets.push_back({picked(target.positions, 1, vertices), picked(target.normals, 1, vertices),
                                  picked(target.tangents, 1, vertices)});
    result.influences = motion.influences;
    result.joints = picked(motion.joints, motion.influences, vertices);
    result.weights = picked(motion.weights, motion.influences, vertices);
    return result;
}

void check_joints(const GltfFile& file, const VertexMotion& motion, std::size_t joint_count,
                  const std::string& object) {
    for (std::size_t i = 0; i < motion.joints.size(); ++i)
        if (motion.joints[i] >= joint_count)
            file.fail(object, ": vertex ", i / motion.influences, " follows joint ", motion.joints[i],
                      ", but its skin has ", joint_count);
}

}  // namespace twinray
