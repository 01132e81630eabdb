// The moving parts of a scene: the node hierarchy of its file with animations, skins and morph targets, as in glTF 2.0
// (3.7.2.2, 3.7.3 and 3.11), and the pose that they give at a time. Pure data, pure functions, in float64.
#pragma once

#include <glm/mat4x4.hpp>

#include <twinray/scene.h>

namespace twinray {

// The transform of a node to its parent: scaled, then rotated, then moved.
struct Trs {
    dvec3 translation = dvec3(0);
    dvec4 rotation = dvec4(0, 0, 0, 1);  // quaternion x y z w, of any length but 0
    dvec3 scale = dvec3(1);
};
glm::dmat4 matrix_of(const Trs& trs);
// Replaces scales of 0 by 1: the axes remain when a node has shrunk to nothing.
glm::dmat4 frame_of(const Trs& trs);

enum class Interpolation : std::uint8_t { linear, step, cubic_spline };

// Values at times, and their interpolation.
struct Keyframes {
    Interpolation interpolation = Interpolation::linear;
    bool is_rotation = false;   // values are quaternions: interpolated on the sphere, of length 1
    uint width = 3;             // numbers of a value
    std::vector<float> times;   // seconds, not descending; at least one
    std::vector<float> values;  // one a time; of cubic_spline three: in-tangent, value, out-tangent
};

// Returns the value at `seconds`; before the first time and after the last, their values.
std::vector<double> value_at(const Keyframes& keyframes, double seconds);

struct Animation {
    // The property that keyframes drive.
    struct Channel {
        enum class Path : std::uint8_t { translation, rotation, scale, weights };
        uint node = 0;  // index into Rig::nodes
        Path path = Path::translation;
        uint keyframes = 0;  // index into Animation::keyframes
    };
    std::string name;
    std::vector<Keyframes> keyframes;
    std::vector<Channel> channels;
    std::string fault;  // why it cannot be played; empty: it can
};

TimeRange range_of(const Animation& animation);

// Joints that carry vertices.
struct Skin {
    std::string name;
    std::vector<uint> joints;               // indices into Rig::nodes
    std::vector<glm::dmat4> inverse_binds;  // by joint: from the mesh to the joint's frame as the mesh was bound to it
};

// Displacements of vertices; empty: none, else one a vertex. Tangents keep their sign.
struct MorphTarget {
    std::vector<vec3> positions, normals, tangents;
};

// The data that move the vertices of a mesh.
struct VertexMotion {
    std::vector<MorphTarget> targets;
    uint influences = 0;         // joints a vertex; 0: no skin
    std::vector<uint> joints;    // `influences` a vertex, indices into Skin::joints
    std::vector<float> weights;  // likewise; not negative, of sum 1 up to rounding
};

// A mesh of the scene whose vertices follow a pose.
struct DeformedMesh {
    uint mesh = 0;           // index into Scene::meshes, which holds it in the rest pose
    uint node = 0;           // its morph weights are used
    std::int32_t skin = -1;  // index into Rig::skins; then the vertices are in world space; -1: none
    MeshVertices base;       // before targets and skin
    VertexMotion motion;
};

// The data that pose a scene.
struct Rig {
    struct Node {
        std::string name;
        std::int32_t parent = -1;  // index into nodes, less than its own; -1: none
        Trs rest;
        glm::dmat4 matrix = glm::dmat4(1);  // replaces `rest` if is_fixed
        bool is_fixed = false;              // the file gives a matrix, which no animation may drive
        std::vector<double> weights;        // of the morph targets of its mesh, at rest
    };
    // An object that a node carries: it is placed at the node's transform to the world * local.
    struct Attachment {
        std::int32_t node = -1;  // -1: the world itself
        glm::dmat4 local = glm::dmat4(1);
        double thickness = 0x1p-10;  // of an instance where it loses a direction: see thickened()
    };
    std::vector<Node> nodes;
    std::vector<Animation> animations;
    std::vector<Skin> skins;
    std::vector<DeformedMesh> meshes;
    std::vector<Attachment> instances, cameras, lights;  // by index in Scene
    // An instance without area at rest, until an animation scales its node: see show_hidden().
    struct Hidden {
        Instance instance;
        Attachment attachment;
    };
    std::vector<Hidden> hidden;
    dvec3 origin = dvec3(0);  // of the scene, which poses are relative to
};

// The state of each node of a rig.
struct Pose::Nodes {
    std::vector<glm::dmat4> nodes;             // to world space, relative to the rig's origin
    std::vector<glm::dmat4> frames;            // the same with axes that scales of 0 leave: of cameras and lights
    std::vector<std::vector<double>> weights;  // of morph targets
};
// Nodes that the animation does not drive are at rest.
Pose pose_at(const Rig& rig, const Animation& animation, double seconds);

// Belongs to an instance.
glm::dmat4 matrix_of(const Pose& pose, const Rig::Attachment& attachment);
// Returns the frame of a camera or light, with the axes that a node scales to 0, since glTF excludes scales from both.
glm::dmat4 frame_of(const Pose& pose, const Rig::Attachment& attachment);
// Returns by joint the map from the mesh as it was bound to world space. Rounded once; not finite if the pose is not.
std::vector<Transform> joint_transforms(const Skin& skin, const Pose& pose);

// weights: of the morph targets, as many as `motion` has. joints: joint_transforms(); empty without skin.
MeshVertices deformed(const MeshVertices& base, const VertexMotion& motion, std::span<const double> weights,
                      std::span<const Transform> joints);
MeshVertices deformed(const Rig& rig, const DeformedMesh& mesh, const Pose& pose);
inline void set_vertices(Mesh& mesh, MeshVertices&& vertices) {
    mesh.positions = std::move(vertices.positions);
    mesh.normals = std::move(vertices.normals);
    mesh.tangents = std::move(vertices.tangents);
}

// Returns the frame without its scale, which glTF excludes from cameras and lights; nothing if an axis has no length.
std::optional<glm::dmat4> unscaled(const glm::dmat4& world);

// Rounds to float, whatever the result.
Transform transform_of(const glm::dmat4& matrix);

// Sets a light's position and direction; `frame` comes from unscaled().
void place_light(Light& light, const glm::dmat4& frame);

// Poses like pose_scene(scene, pose), by a rig that the scene need not have.
void pose_scene(Scene& scene, const Rig& rig, const Pose& pose);

// Moves a scene in its rest pose to a local origin, `wanted` or chosen for its contents, and the rig with it:
// transforms are composed again in float64, relative to the origin, and rounded once. Vertices that are themselves as
// large as that, or that a node brings back from far away, are also moved, and their instances the other way: rays are
// rounded in the space of the mesh. Without need, or if 0 is wanted, nothing changes, bit for bit.
void move_to_origin(const std::optional<dvec3>& wanted, Scene& scene, Rig& rig);

// Placements may lose one direction, as a scale of 1 1 0 does: they have no inverse, yet triangles keep an area.

// The coordinates that remain of a placement without an inverse.
struct FlatPlacement {
    dvec3 lost;     // the direction that it maps to nothing, unit, in the mesh's space; one of the two is chosen
    dvec3 normal;   // of the plane that it maps to, unit
    double extent;  // the length of the longest image of a unit axis
};
// The distance by which rounding moves the entries of a placement, in its extents: in products of float64, in float32.
inline constexpr double rounding_of_products = 0x1p-40, rounding_of_floats = 0x1p-22;
// Returns nothing for a placement that has an inverse in float32, and for one that loses more than one direction. A
// determinant that differs from 0 by no more than `rounding` explains counts as 0.
std::optional<FlatPlacement> flat_placement_of(const glm::dmat4& matrix, double rounding = rounding_of_products);

// Returns the placement with an inverse: the lost direction is mapped to the normal times the extent times `thickness`.
// Parts that are flat along the lost direction stay as they are.
glm::dmat4 thickened(const glm::dmat4& matrix, double thickness, double rounding = rounding_of_products);

// Projects positions onto the plane through 0 that is perpendicular to `lost`.
void flatten_positions(std::vector<vec3>& positions, const dvec3& lost);
// Does so with a mesh. Normals turn along `lost`, on the side on which they were; those of neither side point along
// `lost`. Tangents are projected into the plane, with length 1; 0 if they have no direction in it.
void flatten_along(Mesh& mesh, const dvec3& lost);

}  // namespace twinray
