// SPDX-License-Identifier: MIT
// A tree of the lights with a position: at each node one child is chosen by how much of its light may arrive at a
// point. After Conty and Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting", 2018.
#ifndef TWINRAY_PATH_TRACER_LIGHT_TREE_H
#define TWINRAY_PATH_TRACER_LIGHT_TREE_H

const uint LIGHT_LEAF = 0x80000000u;
const uint LIGHT_TWO_SIDED = 0x40000000u;  // shines along its axis and against it
const uint LIGHT_PAIR = 0x20000000u;       // a leaf of two lights; the table chooses one: the halves of a square
const uint LIGHT_INDEX = 0x1fffffffu;
const uint LIGHT_LEVELS = 32u;  // below the root at most: a bit each in the way to a light

// 52 bytes. All lights of a node are in the box, have an axis in a cone and shine up to an angle from their axis.
struct LightNode {
    vec3 center;
    vec3 half_size;
    vec3 axis;        // unit, of the cone of axes
    float power;      // the sum of radiant intensities: of a surface its radiance times its area
    float cos_axes;   // of half the opening angle of the cone
    float cos_reach;  // of the largest angle between a light's axis and where it shines
    uint
        child;  // LIGHT_ flags, and the first of two nodes that follow each other or, in a leaf, the index of its light
};
BUFFER_OF(LightNode, 4);

const float FACING_ERROR = 1.220703125e-4f;  // 2^-13: the largest error of a packed normal, as a cosine

// The point that is to be lit. A path remembers all but the position, in 32 bits (see packed_facing).
struct LightReceiver {
    vec3 position;
    vec3 normal;         // unit
    bool has_two_sides;  // light from behind also counts: the surface transmits
};

// Returns cos and sin of max(a - b, 0), for angles from 0 to pi. Components: x cos, y sin.
FUNC vec2 angle_beyond(vec2 a, vec2 b) {
    if (a.x > b.x) return vec2(1.0f, 0.0f);
    return vec2(a.x * b.x + a.y * b.y, a.y * b.x - a.x * b.y);
}
FUNC vec2 angle_of(float cosine) { return vec2(cosine, sqrt(max(1.0f - cosine * cosine, 0.0f))); }

// Returns whether all of the node's box is behind the surface.
FUNC bool is_behind(LightNode node, LightReceiver at, vec3 way, float distance) {
    if (at.has_two_sides) return false;
    return dot(at.normal, way) + dot(abs(at.normal), node.half_size) + FACING_ERROR * distance <= 0.0f;
}

// Returns an estimate of the light of a node that arrives, never 0 if some may. Angles are taken as small as they can
// be for any light of the node: within the sphere around its box, and within its cone.
FUNC float light_importance(LightNode node, LightReceiver at) {
    const float MOST = 1.0e30f;  // so that two have a sum
    vec3 way = node.center - at.position;
    float distance2 = dot(way, way);
    float radius2 = dot(node.half_size, node.half_size);
    float distance = sqrt(distance2);
    if (is_behind(node, at, way, distance)) return 0.0f;
    if (distance2 <= radius2) return radius2 > 0.0f ? min(node.power / radius2, MOST) : 0.0f;
    vec3 direction = way / distance;
    vec2 spread = angle_of(sqrt(max(1.0f - radius2 / distance2, 0.0f)));
    float towards = min(dot(at.normal, direction) + FACING_ERROR, 1.0f);
    float along = -dot(node.axis, direction);
    if (at.has_two_sides) towards = abs(towards);
    if ((node.child & LIGHT_TWO_SIDED) != 0u) along = abs(along);
    float facing = angle_beyond(angle_of(towards), spread).x;
    vec2 from_cone = angle_beyond(angle_of(along), angle_of(node.cos_axes));
    float shining = angle_beyond(from_cone, spread).x;
    if (facing <= 0.0f || shining <= node.cos_reach) return 0.0f;
    return min(node.power * facing * shining / distance2, MOST);
}

// Returns the probability of the first of two children; below 0: neither can light the receiver.
FUNC float chance_of_first(LightNode first, LightNode second, LightReceiver at) {
    float a = light_importance(first, at);
    float b = light_importance(second, at);
    if (!(a + b > 0.0f)) return -1.0f;
    return a / (a + b);
}

// Pack and unpack a unit vector on the octahedron, 16 bits per coordinate, with the number of sides in the last bit.
FUNC uint packed_facing(vec3 normal, bool has_two_sides) {
    vec3 n = normal / (abs(normal.x) + abs(normal.y) + abs(normal.z));
    vec2 p = vec2(n.x, n.y);
    if (n.z < 0.0f)
        p = vec2((1.0f - abs(n.y)) * (n.x < 0.0f ? -1.0f : 1.0f), (1.0f - abs(n.x)) * (n.y < 0.0f ? -1.0f : 1.0f));
    uint x = uint(clamp(p.x * 0.5f + 0.5f, 0.0f, 1.0f) * 65535.0f + 0.5f);
    uint y = uint(clamp(p.y * 0.5f + 0.5f, 0.0f, 1.0f) * 32767.0f + 0.5f);
    return x << 16u | y << 1u | (has_two_sides ? 1u : 0u);
}
FUNC LightReceiver receiver_of(vec3 position, uint facing) {
    vec2 p = vec2(float(facing >> 16u) / 65535.0f, float((facing >> 1u) & 0x7fffu) / 32767.0f) * 2.0f - vec2(1.0f);
    vec3 n = vec3(p.x, p.y, 1.0f - abs(p.x) - abs(p.y));
    float below = max(-n.z, 0.0f);
    n.x = n.x + (n.x < 0.0f ? below : -below);
    n.y = n.y + (n.y < 0.0f ? below : -below);
    LightReceiver at;
    at.position = position;
    at.normal = normalize(n);
    at.has_two_sides = (facing & 1u) != 0u;
    return at;
}

// A chosen leaf and its probability; 0: none can light the receiver.
struct ChosenLeaf {
    uint first;  // its lights
    uint count;
    float chance;
    float rest;  // in [0, 1): of the random number that chose it
};

// Chooses a leaf by u in [0, 1): its remainder at each level decides the next.
FUNC ChosenLeaf choose_leaf(REF(LightNode) tree, LightReceiver at, float u) {
    float chance = 1.0f;
    uint child = AT(tree, 0).child;
    while ((child & LIGHT_LEAF) == 0u && chance > 0.0f) {
        uint children = child & LIGHT_INDEX;
        float first = chance_of_first(AT(tree, children), AT(tree, children + 1u), at);
        bool is_first = u < first;
        u = is_first ? u / first : (u - first) / (1.0f - first);
        u = clamp(u, 0.0f, 0.99999994f);
        chance = first < 0.0f ? 0.0f : chance * (is_first ? first : 1.0f - first);
        child = AT(tree, is_first ? children : children + 1u).child;
    }
    ChosenLeaf leaf;
    leaf.first = child & LIGHT_INDEX;
    leaf.count = (child & LIGHT_PAIR) != 0u ? 2u : 1u;
    leaf.chance = chance;
    leaf.rest = u;
    return leaf;
}

// Returns the probability that choose_leaf takes the way: from its lowest bit on, a level each, 1 for the second child.
FUNC float chance_of_way(REF(LightNode) tree, LightReceiver at, uint way) {
    float chance = 1.0f;
    uint child = AT(tree, 0).child;
    while ((child & LIGHT_LEAF) == 0u && chance > 0.0f) {
        uint children = child & LIGHT_INDEX;
        float first = chance_of_first(AT(tree, children), AT(tree, children + 1u), at);
        bool is_first = (way & 1u) == 0u;
        chance = first < 0.0f ? 0.0f : chance * (is_first ? first : 1.0f - first);
        child = AT(tree, is_first ? children : children + 1u).child;
        way = way >> 1u;
    }
    return chance;
}
#endif
