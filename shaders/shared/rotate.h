// SPDX-License-Identifier: MIT
// Tree rotations (Kensler, "Tree Rotations for Improving Bounding Volume Hierarchies", 2008): if a child of a node and
// a grandchild on its other side, or two grandchildren, change places, boxes may become smaller. A node is rotated as
// soon as it has both children, so that one pass from the leaves to the root rotates all; the nodes that a rotation
// changed below are rotated again, some levels down, and then the node itself once more.
#ifndef TWINRAY_SHARED_ROTATE_H
#define TWINRAY_SHARED_ROTATE_H
#include "shaders/shared/node_child.h"

const uint ROTATE_LEVELS = 4u;  // that changes are followed down

// A subtree of four leaves becomes one node of four children, whatever its shape.
const uint FEWEST_ROTATED = 5u;

FUNC bool is_rotated(NodeChild tree) { return leaves_in(tree.subtree) >= FEWEST_ROTATED; }

FUNC NodeChild select_child(bool is_first, NodeChild a, NodeChild b) {
    NodeChild chosen;
    chosen.box.lo = is_first ? a.box.lo : b.box.lo;
    chosen.box.hi = is_first ? a.box.hi : b.box.hi;
    chosen.child = is_first ? a.child : b.child;
    chosen.subtree = is_first ? a.subtree : b.subtree;
    return chosen;
}

// The nodes below that a rotation changed; NOTHING if it changed none.
struct Rotated {
    uint node0;
    uint node1;
};

FUNC uint height_above(NodeChild p, NodeChild q) { return 1u + max(height_in(p.subtree), height_in(q.subtree)); }

FUNC void keep_better(INOUT(float) best, INOUT(uint) best_move, float gain, uint move, bool is_allowed) {
    bool is_better = is_allowed && gain > best;
    best = is_better ? gain : best;
    best_move = is_better ? move : best_move;
}

// Rotates a node with children a and b by the best rotation, if it gains and leaves the node within `limit` nodes of
// height. It is one function of six like cases, which share their loads: split up it would be no clearer.
FUNC Rotated rotate_node(BvhChildren nodes, uint node, NodeChild a, NodeChild b, uint limit, float scale) {
    NodeChild a0 = a, a1 = a, b0 = b, b1 = b;
    float area_a = area_of(a.box, scale);
    float area_b = area_of(b.box, scale);
    float best = 0.0f;
    uint move = NOTHING;
    if (is_inner(b)) {
        b0 = get_child(nodes, b.child, 0u);
        b1 = get_child(nodes, b.child, 1u);
        keep_better(best, move, area_b - area_around(a, b1, scale), 0u,
                    max(height_in(b0.subtree), height_above(a, b1)) < limit);
        keep_better(best, move, area_b - area_around(a, b0, scale), 1u,
                    max(height_in(b1.subtree), height_above(a, b0)) < limit);
    }
    if (is_inner(a)) {
        a0 = get_child(nodes, a.child, 0u);
        a1 = get_child(nodes, a.child, 1u);
        keep_better(best, move, area_a - area_around(b, a1, scale), 2u,
                    max(height_in(a0.subtree), height_above(b, a1)) < limit);
        keep_better(best, move, area_a - area_around(b, a0, scale), 3u,
                    max(height_in(a1.subtree), height_above(b, a0)) < limit);
    }
    if (is_inner(a) && is_inner(b)) {
        float both = area_a + area_b;
        keep_better(best, move, both - area_around(a1, b0, scale) - area_around(a0, b1, scale), 4u,
                    max(height_above(a1, b0), height_above(a0, b1)) < limit);
        keep_better(best, move, both - area_around(a0, b0, scale) - area_around(a1, b1, scale), 5u,
                    max(height_above(a0, b0), height_above(a1, b1)) < limit);
    }
    Rotated done;
    done.node0 = NOTHING;
    done.node1 = NOTHING;
    if (move == NOTHING) return done;
    // One child's child on `side` goes up, and the node beside it, or in an exchange its child, down in its place.
    bool is_of_b = move < 2u;
    bool is_exchange = move > 3u;
    uint side = move & 1u;
    bool is_second = side == 1u;
    NodeChild first = select_child(is_of_b, b0, a0);
    NodeChild second = select_child(is_of_b, b1, a1);
    NodeChild up = select_child(is_second, second, first);
    NodeChild stays = select_child(is_second, first, second);
    NodeChild down = select_child(is_of_b, a, select_child(is_exchange, b0, b));
    done.node0 = is_of_b ? b.child : a.child;
    put_child(nodes, done.node0, side, down);
    put_child(nodes, node, is_of_b ? 1u : 0u, joined_child(down, stays, done.node0));
    if (is_exchange) {
        done.node1 = b.child;
        put_child(nodes, b.child, 0u, up);
        up = joined_child(up, b1, b.child);
    }
    put_child(nodes, node, is_of_b ? 0u : 1u, up);
    return done;
}

// A rotation of `node` and of the nodes that it changes below. It is done one node at a time, so that where invocations
// go through a program together none waits for one that has more nodes to rotate.
struct Rotation {
    uint node;
    uint limit;   // of the node's height
    uint turns;   // in which the node itself was rotated
    uint next;    // the node to rotate next; NOTHING: all are
    uint levels;  // that changes of the next one are followed down
    // node | levels << 28, the next first; NOTHING: no more. Indexed by constants alone
    uint waiting[ROTATE_LEVELS + 1u];
};

FUNC Rotation no_rotation() {
    Rotation rotation;
    rotation.node = NOTHING;
    rotation.limit = 0u;
    rotation.turns = 0u;
    rotation.next = NOTHING;
    rotation.levels = 0u;
    UNROLL for (uint i = 0u; i < ROTATE_LEVELS + 1u; i = i + 1u) rotation.waiting[i] = NOTHING;
    return rotation;
}

// Rotates a node with both its halves, whose subtrees are finished; it then has a height of at most `limit`, if it had.
// Below the node no subtree becomes higher; the given heights are upper bounds.
FUNC Rotation rotation_of(uint node, uint limit) {
    Rotation rotation = no_rotation();
    rotation.node = node;
    rotation.limit = limit;
    rotation.next = node;
    rotation.levels = ROTATE_LEVELS;
    return rotation;
}

FUNC void wait_for(INOUT(Rotation) rotation, uint node) {
    uint moved = node | rotation.levels << 28u;
    UNROLL for (uint i = 0u; i < ROTATE_LEVELS + 1u; i = i + 1u) {
        uint here = rotation.waiting[i];
        rotation.waiting[i] = moved;
        moved = here;
    }
}

FUNC void choose_next(INOUT(Rotation) rotation) {
    uint waiting = rotation.waiting[0];
    if (waiting != NOTHING) {
        rotation.next = waiting & 0xfffffffu;
        rotation.levels = (waiting >> 28u) - 1u;
        UNROLL for (uint i = 0u; i < ROTATE_LEVELS; i = i + 1u) rotation.waiting[i] = rotation.waiting[i + 1u];
        rotation.waiting[ROTATE_LEVELS] = NOTHING;
    } else if (rotation.turns == 1u) {
        rotation.next = rotation.node;
        rotation.levels = ROTATE_LEVELS;
        rotation.turns = 2u;
    } else
        rotation.next = NOTHING;
}

FUNC void rotate_next(BvhChildren nodes, INOUT(Rotation) rotation, float scale) {
    NodeChild a = get_child(nodes, rotation.next, 0u);
    NodeChild b = get_child(nodes, rotation.next, 1u);
    bool is_top = rotation.next == rotation.node;
    Rotated done = rotate_node(nodes, rotation.next, a, b, is_top ? rotation.limit : height_above(a, b), scale);
    if (done.node0 != NOTHING) {
        rotation.turns = rotation.turns + (is_top ? 1u : 0u);
        if (rotation.levels > 0u) {
            wait_for(rotation, done.node0);
            if (done.node1 != NOTHING) wait_for(rotation, done.node1);
        }
    }
    choose_next(rotation);
}

// Does all steps at once. Returns the node's height.
FUNC uint rotate(BvhChildren nodes, uint node, uint limit, float scale) {
    Rotation rotation = rotation_of(node, limit);
    while (rotation.next != NOTHING) rotate_next(nodes, rotation, scale);
    return height_of(nodes, node);
}
#endif
