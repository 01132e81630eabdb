#include "engine/core/kernel.h"
#include "engine/scene/mesh.h"
#include "engine/scene/rig.h"
#include "scene_deform.spv.h"
#include "twinray/glsl/vector_math.h"

namespace twinray {
namespace {

using glm::dmat3;

// The blend of a vertex's joints.
struct Blend {
    dmat3 linear = dmat3(1);
    dvec3 offset = dvec3(0);
};

Blend blend_of(const VertexMotion& motion, std::size_t vertex, std::span<const Transform> joints) {
    if (joints.empty()) return {};
    Blend blend{dmat3(0), dvec3(0)};
    for (std::size_t i = vertex * motion.influences; i < (vertex + 1) * motion.influences; ++i) {
        const double weight = motion.weights[i];
        if (weight == 0) continue;  // of unused joints, which may be infinite
        for (int row = 0; row < 3; ++row) {
            const vec4& entries = joints[motion.joints[i]].rows[static_cast<std::size_t>(row)];
            for (int column = 0; column < 3; ++column)
                blend.linear[column][row] += weight * static_cast<double>(entries[column]);
            blend.offset[row] += weight * static_cast<double>(entries.w);
        }
    }
    return blend;
}

dmat3 cofactors(const dmat3& m) { return {cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])}; }

dvec3 displaced(dvec3 value, const std::vector<MorphTarget>& targets, std::vector<vec3> MorphTarget::*part,
                std::size_t vertex, std::span<const double> weights) {
    for (std::size_t i = 0; i < targets.size(); ++i)
        if (const std::vector<vec3>& displacements = targets[i].*part; weights[i] != 0 && !displacements.empty())
            value += weights[i] * dvec3(displacements[vertex]);
    return value;
}

}  // namespace

#include "twinray/glsl/cpp_begin.h"
#include "shaders/scene/deform.h"
#include "twinray/glsl/cpp_end.h"

struct Deformer::State {
    State(Context& context, std::shared_ptr<const Rig> rig);

    void record(Commands& commands, const Pose& pose) {
        if (meshes_.empty()) return;
        {
            const auto pass = commands.pass("deformer pose");
            for (std::size_t i = 0; i < meshes_.size(); ++i) {
                const DeformedMesh& mesh = rig_->meshes[i];
                const std::vector<double>& weights = pose->weights[mesh.node];
                const std::vector<float> rounded(weights.begin(), weights.end());
                if (!mesh.motion.targets.empty())
                    commands.upload(meshes_[i].target_weights, std::span(rounded).first(mesh.motion.targets.size()));
                if (mesh.skin < 0) continue;
                const std::vector<Transform> joints =
                    joint_transforms(rig_->skins[static_cast<std::size_t>(mesh.skin)], pose);
                commands.upload(meshes_[i].joint_rows, std::span(joints));
            }
        }
        const auto pass = commands.pass("scene_deform");
        for (const Buffers& mesh : meshes_) kernel_.dispatch(commands, mesh.args, mesh.args.vertex_count);
    }

    struct Buffers {
        std::vector<Buffer> inputs;  // that stay as they are
        Buffer moved_positions, moved_normals, moved_tangents, target_weights, joint_rows;
        DeformArgs args;
    };

    Buffers make_buffers(Commands& commands, const DeformedMesh& mesh) const {
        const VertexMotion& motion = mesh.motion;
        const std::size_t joint_count =
            mesh.skin < 0 ? 0 : rig_->skins[static_cast<std::size_t>(mesh.skin)].joints.size();
        Buffers b;
        const auto room = [&](const char* name, std::size_t bytes) {
            return Buffer(context_, {.name = name, .bytes = bytes});
        };
        const auto input = [&](const char* name, const auto& values) {
            const Buffer& buffer = b.inputs.emplace_back(room(name, std::span(values).size_bytes()));
            if (!values.empty()) commands.upload(buffer, std::span(values));
            return buffer.address();
        };
        const auto targets = [&](const char* name, std::vector<vec3> MorphTarget::*part) {
            std::vector<vec3> all;
            for (const MorphTarget& target : motion.targets)
                all.insert(all.end(), (target.*part).begin(), (target.*part).end());
            return input(name, all);
        };
        b.moved_positions = room("moved positions", std::span(mesh.base.positions).size_bytes());
        b.moved_normals = room("moved normals", std::span(mesh.base.normals).size_bytes());
        b.moved_tangents = room("moved tangents", std::span(mesh.base.tangents).size_bytes());
        b.target_weights = room("target weights", motion.targets.size() * sizeof(float));
        b.joint_rows = room("joint rows", joint_count * sizeof(Transform));
        b.args = {{input("positions", mesh.base.positions)},
                  {input("normals", mesh.base.normals)},
                  {input("tangents", mesh.base.tangents)},
                  b.moved_positions.ref<float>(),
                  b.moved_normals.ref<float>(),
                  b.moved_tangents.ref<float>(),
                  {targets("target positions", &MorphTarget::positions)},
                  {targets("target normals", &MorphTarget::normals)},
                  {targets("target tangents", &MorphTarget::tangents)},
                  b.target_weights.ref<float>(),
                  {input("joints", motion.joints)},
                  {input("joint weights", motion.weights)},
                  b.joint_rows.ref<vec4>(),
                  static_cast<uint>(mesh.base.positions.size()),
                  static_cast<uint>(motion.targets.size()),
                  mesh.skin < 0 ? 0 : motion.influences};
        return b;
    }

    Context& context_;
    std::shared_ptr<const Rig> rig_;
    Kernel<DeformArgs> kernel_;
    std::vector<Buffers> meshes_;
};

Deformer::State::State(Context& context, std::shared_ptr<const Rig> rig)
    : context_(context), rig_(std::move(rig)), kernel_(context, {.name = "scene_deform", .spirv = scene_deform_spirv}) {
    if (rig_->meshes.empty()) return;
    Commands commands(context, "deformer upload");
    {
        const auto pass = commands.pass("deformer upload");
        for (const DeformedMesh& mesh : rig_->meshes) meshes_.push_back(make_buffers(commands, mesh));
    }
    commands.submit();
}

Deformer::Deformer(Context& context, std::shared_ptr<const Rig> rig)
    : state_(std::make_unique<State>(context, std::move(rig))) {}
Deformer::~Deformer() = default;

void Deformer::record(Commands& commands, const Pose& pose) { state_->record(commands, pose); }

Deformer::Output Deformer::output(std::size_t index) const {
    const State::Buffers& buffers = state_->meshes_[index];
    return {buffers.moved_positions, buffers.moved_normals, buffers.moved_tangents, buffers.args.vertex_count};
}

MeshVertices deformed(const MeshVertices& base, const VertexMotion& motion, std::span<const double> weights,
                      std::span<const Transform> joints) {
    MeshVertices result = base;
    for (std::size_t i = 0; i < base.positions.size(); ++i) {
        const auto morphed = [&](const auto& value, std::vector<vec3> MorphTarget::*part) {
            return displaced(dvec3(value), motion.targets, part, i, weights);
        };
        const Blend blend = blend_of(motion, i, joints);
        result.positions[i] = vec3(blend.linear * morphed(base.positions[i], &MorphTarget::positions) + blend.offset);
        if (!base.normals.empty())
            result.normals[i] =
                vec3(unit_or_zero(cofactors(blend.linear) * morphed(base.normals[i], &MorphTarget::normals)));
        if (!base.tangents.empty())
            result.tangents[i] =
                vec4(vec3(unit_or_zero(blend.linear * morphed(base.tangents[i], &MorphTarget::tangents))),
                     base.tangents[i].w);
    }
    return result;
}

MeshVertices deformed(const Rig& rig, const DeformedMesh& mesh, const Pose& pose) {
    std::vector<Transform> joints;
    if (mesh.skin >= 0) joints = joint_transforms(rig.skins[static_cast<std::size_t>(mesh.skin)], pose);
    return deformed(mesh.base, mesh.motion, pose->weights[mesh.node], joints);
}

MeshVertices deformed(const Rig& rig, std::size_t index, const Pose& pose) {
    return deformed(rig, rig.meshes[index], pose);
}

std::vector<uint> deformed_meshes(const Rig& rig) {
    std::vector<uint> meshes;
    for (const DeformedMesh& mesh : rig.meshes) meshes.push_back(mesh.mesh);
    return meshes;
}

}  // namespace twinray
