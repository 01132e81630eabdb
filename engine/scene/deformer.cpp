// SPDX-License-Identifier: MIT
#include "engine/core/kernel.h"
#include "engine/scene/rig.h"
#include "scene_deform.spv.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/scene/deform.h"
#include "twinray/glsl/cpp_end.h"

namespace {

Buffer like(Context& context, const Buffer& other) {
    return Buffer(context, {.name = "moved " + other.name(), .bytes = other.bytes()});
}

}  // namespace

struct Deformer::State {
    State(Context& context, std::shared_ptr<const Rig> rig);
    void record(Commands& commands, const Pose& pose);

    struct Buffers {
        Buffer positions, normals, tangents;
        Buffer moved_positions, moved_normals, moved_tangents;
        Buffer target_positions, target_normals, target_tangents, target_weights;
        Buffer joints, joint_weights, joint_rows;
        DeformArgs args;
    };
    Buffers make_buffers(Commands& commands, const DeformedMesh& mesh) const;
    template <class T>
    Buffer upload(Commands& commands, const char* name, const std::vector<T>& values) const;
    template <class T>
    Buffer upload_targets(Commands& commands, const char* name, const DeformedMesh& mesh,
                          std::vector<T> MorphTarget::*part) const;

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

template <class T>
Buffer Deformer::State::upload(Commands& commands, const char* name, const std::vector<T>& values) const {
    Buffer buffer(context_, {.name = name, .bytes = std::span(values).size_bytes()});
    if (!values.empty()) commands.upload(buffer, std::span(values));
    return buffer;
}

template <class T>
Buffer Deformer::State::upload_targets(Commands& commands, const char* name, const DeformedMesh& mesh,
                                       std::vector<T> MorphTarget::*part) const {
    std::vector<T> all;
    for (const MorphTarget& target : mesh.motion.targets)
        all.insert(all.end(), (target.*part).begin(), (target.*part).end());
    return upload(commands, name, all);
}

Deformer::State::Buffers Deformer::State::make_buffers(Commands& commands, const DeformedMesh& mesh) const {
    const VertexMotion& motion = mesh.motion;
    const std::size_t joint_count = mesh.skin < 0 ? 0 : rig_->skins[static_cast<std::size_t>(mesh.skin)].joints.size();
    Buffers b;
    b.positions = upload(commands, "positions", mesh.base.positions);
    b.normals = upload(commands, "normals", mesh.base.normals);
    b.tangents = upload(commands, "tangents", mesh.base.tangents);
    b.moved_positions = like(context_, b.positions);
    b.moved_normals = like(context_, b.normals);
    b.moved_tangents = like(context_, b.tangents);
    b.target_positions = upload_targets(commands, "target positions", mesh, &MorphTarget::positions);
    b.target_normals = upload_targets(commands, "target normals", mesh, &MorphTarget::normals);
    b.target_tangents = upload_targets(commands, "target tangents", mesh, &MorphTarget::tangents);
    b.target_weights = Buffer(context_, {.name = "target weights", .bytes = motion.targets.size() * sizeof(float)});
    b.joints = upload(commands, "joints", motion.joints);
    b.joint_weights = upload(commands, "joint weights", motion.weights);
    b.joint_rows = Buffer(context_, {.name = "joint rows", .bytes = joint_count * sizeof(Transform)});
    b.args = {b.positions.ref<float>(),
              b.normals.ref<float>(),
              b.tangents.ref<float>(),
              b.moved_positions.ref<float>(),
              b.moved_normals.ref<float>(),
              b.moved_tangents.ref<float>(),
              b.target_positions.ref<float>(),
              b.target_normals.ref<float>(),
              b.target_tangents.ref<float>(),
              b.target_weights.ref<float>(),
              b.joints.ref<uint>(),
              b.joint_weights.ref<float>(),
              b.joint_rows.ref<vec4>(),
              static_cast<uint>(mesh.base.positions.size()),
              static_cast<uint>(motion.targets.size()),
              mesh.skin < 0 ? 0 : motion.influences};
    return b;
}

Deformer::Deformer(Context& context, std::shared_ptr<const Rig> rig)
    : state_(std::make_unique<State>(context, std::move(rig))) {}
Deformer::~Deformer() = default;

void Deformer::record(Commands& commands, const Pose& pose) { state_->record(commands, pose); }

Deformer::Output Deformer::output(std::size_t index) const {
    const State::Buffers& buffers = state_->meshes_[index];
    return {buffers.moved_positions, buffers.moved_normals, buffers.moved_tangents, buffers.args.vertex_count};
}

void Deformer::State::record(Commands& commands, const Pose& pose) {
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

}  // namespace twinray
