// Keyframes, poses and deformed vertices against closed forms.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "engine/scene/rig.h"
#include "twinray/glsl/vector_math.h"

namespace twinray::test {
namespace {

using std::numbers::pi;

std::vector<float> quaternion_about_z(double angle) {
    return {0, 0, static_cast<float>(std::sin(angle / 2)), static_cast<float>(std::cos(angle / 2))};
}

std::vector<float> concatenated(std::vector<float> a, const std::vector<float>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

TEST(Keyframes, LinearOnesAreJoinedByLinesAndStayAtTheirEnds) {
    const Keyframes keyframes{Interpolation::linear, false, 2, {1, 2, 4}, {0, 10, 1, 20, 3, 0}};
    const auto at = [&](double seconds) { return value_at(keyframes, seconds); };
    EXPECT_EQ(at(0), (std::vector<double>{0, 10}));
    EXPECT_EQ(at(1), (std::vector<double>{0, 10}));
    EXPECT_EQ(at(1.5), (std::vector<double>{0.5, 15}));
    EXPECT_EQ(at(3), (std::vector<double>{2, 10}));
    EXPECT_EQ(at(4), (std::vector<double>{3, 0}));
    EXPECT_EQ(at(9), (std::vector<double>{3, 0}));
}

TEST(Keyframes, StepsHoldUntilTheNext) {
    const Keyframes keyframes{Interpolation::step, false, 1, {0, 1, 1, 2}, {5, 6, 7, 8}};
    EXPECT_EQ(value_at(keyframes, 0.999)[0], 5);
    EXPECT_EQ(value_at(keyframes, 1)[0], 7);  // the last of equal times
    EXPECT_EQ(value_at(keyframes, 1.5)[0], 7);
    EXPECT_EQ(value_at(keyframes, 2)[0], 8);
}

TEST(Keyframes, CubicSplinesReproduceACubic) {
    const auto f = [](double t) { return t * t * t - 2 * t * t + 3; };
    const auto slope = [](double t) { return 3 * t * t - 4 * t; };
    Keyframes keyframes{Interpolation::cubic_spline, false, 1, {-1, 0.5f, 2}, {}};
    for (const float time : keyframes.times)
        for (const double part : {slope(time), f(time), slope(time)})
            keyframes.values.push_back(static_cast<float>(part));
    for (const double t : {-1.0, -0.25, 0.5, 0.75, 1.9, 2.0}) EXPECT_NEAR(value_at(keyframes, t)[0], f(t), 1e-14) << t;
}

TEST(Keyframes, RotationsTurnEvenlyAlongTheShorterWay) {
    const std::vector<float> turned = quaternion_about_z(pi / 2);
    std::vector<float> negated = turned;
    for (float& x : negated) x = -x;
    for (const std::vector<float>& end : {turned, negated}) {
        const Keyframes keyframes{Interpolation::linear, true, 4, {0, 3}, concatenated(quaternion_about_z(0), end)};
        for (const double t : {1.0, 2.0}) {
            const std::vector<double> q = value_at(keyframes, t);
            EXPECT_NEAR(q[2], std::sin(t * pi / 12), 1e-7);
            EXPECT_NEAR(q[3], std::cos(t * pi / 12), 1e-7);
        }
    }
}

TEST(Keyframes, ATinyTurnIsHalvedRight) {
    const Keyframes keyframes{Interpolation::linear, true, 4, {0, 2}, {0, 0, 0, 1, 0, 0, 1e-20f, 1}};
    EXPECT_NEAR(value_at(keyframes, 1)[2] / 0.5e-20, 1, 1e-6);
    const Keyframes none{Interpolation::linear, true, 4, {0, 2}, {0, 0, 0, 2, 0, 0, 0, 2}};
    EXPECT_EQ(value_at(none, 1), (std::vector<double>{0, 0, 0, 1}));
}

// A turntable that carries an arm of length 2.
Rig arm() {
    Rig rig;
    rig.nodes.resize(2);
    rig.nodes[1].parent = 0;
    rig.nodes[1].rest.translation = {2, 0, 0};
    rig.nodes[1].weights = {0.25, 0};
    Animation animation{.name = "turn", .keyframes = {}, .channels = {}, .fault = {}};
    animation.keyframes.push_back(
        {Interpolation::linear, true, 4, {0, 1}, concatenated(quaternion_about_z(0), quaternion_about_z(pi / 2))});
    animation.keyframes.push_back({Interpolation::linear, false, 2, {0.5f, 2}, {0, 0, 1, 3}});
    animation.channels = {{0, Animation::Channel::Path::rotation, 0}, {1, Animation::Channel::Path::weights, 1}};
    rig.animations = {animation};
    return rig;
}

TEST(Pose, NodesMoveWithTheirParents) {
    const Rig rig = arm();
    EXPECT_EQ(rest_pose(rig)->nodes[1][3], dvec4(2, 0, 0, 1));
    EXPECT_EQ(rest_pose(rig)->weights[1], (std::vector<double>{0.25, 0}));
    const Pose pose = pose_at(rig, rig.animations[0], 0.5);
    EXPECT_NEAR(pose->nodes[1][3].x, std::sqrt(2), 1e-7);
    EXPECT_NEAR(pose->nodes[1][3].y, std::sqrt(2), 1e-7);
    EXPECT_EQ(pose_at(rig, rig.animations[0], 1.25)->weights[1], (std::vector<double>{0.5, 1.5}));
    EXPECT_EQ(range_of(rig.animations[0]).end, 2);
    EXPECT_EQ(matrix_of(pose, {.local = matrix_of(Trs{.translation = {1, 2, 3}})})[3], dvec4(1, 2, 3, 1));
}

// A triangle with its own normal and a tangent along its first edge.
MeshVertices triangle() {
    return {{{0, 0, 0}, {2, 0, 0}, {0, 1, 1}},
            std::vector<vec3>(3, normalize(vec3(0, -1, 1))),
            std::vector<vec4>(3, vec4(1, 0, 0, -1))};
}

VertexMotion two_joints(float first_weight) {
    VertexMotion motion{{}, 2, {}, {}};
    for (int i = 0; i < 3; ++i) {
        motion.joints.insert(motion.joints.end(), {0, 1});
        motion.weights.insert(motion.weights.end(), {first_weight, 1 - first_weight});
    }
    return motion;
}

// Frames keep the axes of nodes that have shrunk to nothing; their place is that of the nodes.
TEST(Pose, FramesOutliveScalesOfZero) {
    Rig rig;
    rig.nodes.resize(2);
    rig.nodes[0].rest = {.translation = {1, 2, 3}, .scale = {0, 2, 0}};
    rig.nodes[1].parent = 0;
    rig.nodes[1].rest = {.translation = {5, 5, 5}, .rotation = {0, 0, 1, 1}, .scale = {3, 1, 1}};
    const Pose pose = rest_pose(rig);
    const Rig::Attachment attachment{.node = 1};
    EXPECT_EQ(matrix_of(pose, attachment)[3], dvec4(1, 12, 3, 1));
    const glm::dmat4 frame = frame_of(pose, attachment);
    EXPECT_EQ(frame[3], dvec4(1, 12, 3, 1));
    EXPECT_NEAR(length(dvec4(frame[0]) - dvec4(0, 6, 0, 0)), 0, 1e-12);
    EXPECT_NEAR(length(dvec4(frame[1]) - dvec4(-1, 0, 0, 0)), 0, 1e-12);
    EXPECT_EQ(frame[2], dvec4(0, 0, 1, 0));
}

TEST(Deform, DirectionsThatAreNoNumbersBecomeZero) {
    MeshVertices base;
    base.positions.assign(3, vec3(0));
    base.normals = {{NAN, 0, 0}, {INFINITY, 0, 0}, {0, 0, 3e38f}};
    base.tangents = {{0, NAN, 0, -1}, {0, -INFINITY, 1, 1}, {0, 1e-45f, 0, 1}};
    const MeshVertices moved = deformed(base, {}, {}, {});
    EXPECT_EQ(moved.normals, (std::vector<vec3>{vec3(0), vec3(0), vec3(0, 0, 1)}));
    EXPECT_EQ(moved.tangents, (std::vector<vec4>{{0, 0, 0, -1}, {0, 0, 0, 1}, {0, 1, 0, 1}}));
}

TEST(Deform, VerticesLieBetweenWhereTheirJointsWouldCarryThem) {
    const Transform joints[] = {Transform::translation({4, 0, 0}), Transform::scaling({1, 3, 1})};
    const MeshVertices moved = deformed(triangle(), two_joints(0.25f), {}, joints);
    EXPECT_EQ(moved.positions[1], vec3(3, 0, 0));
    EXPECT_EQ(moved.positions[2], vec3(1, 2.5f, 1));
}

TEST(Deform, NormalsAndTangentsKeepToTheTriangle) {
    Transform mirror = Transform::scaling({-2, 1, 0.5f});
    mirror.rows[0].y = 0.75f;
    const Transform joints[] = {mirror, Transform::scaling({1, 4, 1})};
    for (const float weight : {1.0f, 0.0f, 0.9f}) {
        const MeshVertices moved = deformed(triangle(), two_joints(weight), {}, joints);
        const vec3 along = moved.positions[1] - moved.positions[0];
        const vec3 normal = normalize(cross(along, moved.positions[2] - moved.positions[0]));
        EXPECT_NEAR(dot(moved.normals[0], normal), 1, 1e-6) << weight;
        EXPECT_NEAR(dot(vec3(moved.tangents[0]), normalize(along)), 1, 1e-6) << weight;
        EXPECT_EQ(moved.tangents[0].w, -1);
    }
}

TEST(Deform, TargetsAddUpBeforeTheSkin) {
    VertexMotion motion = two_joints(1);
    motion.targets = {{{{0, 0, 0}, {1, 0, 0}, {0, 0, 2}}, std::vector<vec3>(3, vec3(0, 3, 0)), {}},
                      {{{0, 0, 0}, {0, 5, 0}, {0, 0, 0}}, {}, std::vector<vec3>(3, vec3(0, 1, 0))}};
    const Transform joints[] = {Transform::scaling({10, 1, 1}), Transform()};
    MeshVertices base = triangle();
    base.normals.assign(3, vec3(0, 0, 1));
    const MeshVertices moved = deformed(base, motion, std::vector<double>{0.5, -1}, joints);
    EXPECT_EQ(moved.positions[1], vec3(25, -5, 0));
    EXPECT_EQ(moved.positions[2], vec3(0, 1, 2));
    const vec3 normal = normalize(vec3(0, 1.5f, 1));  // scaling x leaves it
    EXPECT_NEAR(dot(moved.normals[0], normal), 1, 1e-6);
    const vec3 tangent = normalize(vec3(10, -1, 0));
    EXPECT_NEAR(dot(vec3(moved.tangents[0]), tangent), 1, 1e-6);
}

TEST(Deform, WhatHasNoLengthBecomesZero) {
    const Transform joints[] = {Transform::scaling({0, 0, 1}), Transform()};
    const MeshVertices moved = deformed(triangle(), two_joints(1), {}, joints);
    EXPECT_EQ(vec3(moved.tangents[0]), vec3(0));
    EXPECT_EQ(moved.normals[0], vec3(0));
    EXPECT_EQ(moved.positions[2], vec3(0, 0, 1));
}

}  // namespace
}  // namespace twinray::test
