// SPDX-License-Identifier: MIT
// Traversal of a SwTlasHeader, of any layout: one loop over nodes, primitives and instances.
//
// The remaining children of a node are one entry of the stack, and the way out of an instance is another. The stack is
// short: once it is empty and has lost entries, the ray goes from the root of its tree to where it is, and puts what it
// passes on the stack again. The order of siblings does not depend on the hits found meanwhile, except that those
// behind them are left out.
//
// The including file decides where the stack's words are: load_entry(slot) and store_entry(slot, word), slot <
// stack_size(), a power of two.
#ifndef TWINRAY_SHARED_TRAVERSE_H
#define TWINRAY_SHARED_TRAVERSE_H
#include "shaders/shared/entered_children.h"

const uint NO_STACK_ENTRY = 0u;

// The stack of a traversal: the last entry in registers, as many below it as shared memory has room for at full
// occupancy. If more are pushed, the lowest are overwritten, and `bottom` is not 0 (Laine, "Restart Trail for Stackless
// BVH Traversal", 2010).
//
// Below `last`, which may be NO_STACK_ENTRY, are entries bottom to top - 1, each in the slot of its number modulo the
// stack's capacity. Those below `bottom` are lost.
struct ShortStack {
    uint last;
    uint second;  // its other word, where entries have two
    uint top;
    uint bottom;
};

// `has_lost`: as if entries had been lost.
FUNC ShortStack empty_stack(bool has_lost) {
    ShortStack stack;
    stack.last = NO_STACK_ENTRY;
    stack.second = 0u;
    stack.top = has_lost ? 1u : 0u;
    stack.bottom = stack.top;
    return stack;
}

FUNC uint stack_capacity(bool has_two_words) { return has_two_words ? stack_size() / 2u : stack_size(); }

FUNC void push_entry(INOUT(ShortStack) stack, uint entry, uint second, bool has_two_words) {
    uint capacity = stack_capacity(has_two_words);
    if (stack.last != NO_STACK_ENTRY) {
        uint slot = stack.top & (capacity - 1u);
        store_entry(slot, stack.last);
        if (has_two_words) store_entry(slot + capacity, stack.second);
        stack.top = stack.top + 1u;
        bool is_over = stack.top - stack.bottom > capacity;
        stack.bottom = is_over ? stack.bottom + 1u : stack.bottom;
    }
    stack.last = entry;
    if (has_two_words) stack.second = second;
}

// Fetches the entry below if there is no last one.
FUNC void fetch_last(INOUT(ShortStack) stack, bool has_two_words) {
    if (stack.last == NO_STACK_ENTRY && stack.top != stack.bottom) {
        stack.top = stack.top - 1u;
        uint capacity = stack_capacity(has_two_words);
        uint slot = stack.top & (capacity - 1u);
        stack.last = load_entry(slot);
        if (has_two_words) stack.second = load_entry(slot + capacity);
    }
}

const uint LEAVE_INSTANCE = 1u;  // an entry of the stack that no group and no edge is

// The position of a ray in the trees, and its remaining visits.
struct Traversal {
    SwTree tree;
    TreePosition at;
    InInstance inside;
    RaySpace space;     // of the tree
    bool is_elsewhere;  // the ray is still to be prepared for the tree
    ShortStack stack;
    uint outside;  // the edge of the instance that the ray is in, or NOTHING
    uint target;   // the edge that the ray is on its way back to, or NOTHING
};

FUNC Traversal begin_traversal(SwTlasHeader scene, Ray ray, bool is_binary, TraceOptions options) {
    Traversal here;
    if ((options.features & FEATURE_INSTANCES) != 0u) {
        here.tree = top_tree(scene);
        here.inside = in_no_instance();
    } else {
        SwInstance instance = load_instance(scene.instances, 0u);
        here.tree = tree_of(instance);
        here.inside = enter_instance(instance, 0u, options);
        here.space = space_of(ray_in_instance(instance, here.inside, ray, options));
    }
    here.at = at_root(here.tree, is_binary);
    here.is_elsewhere = true;
    here.stack = empty_stack(false);
    here.outside = NOTHING;
    here.target = NOTHING;
    return here;
}

// Prepares it for the tree of the instance, or of the top level: in one place, because it is much code.
FUNC void prepare_ray(INOUT(Traversal) here, SwTlasHeader scene, Ray ray, TraceOptions options) {
    LocalRay local;
    if (here.outside == NOTHING)
        local = ray_in_world(scene, ray);
    else {
        SwInstance instance = load_instance(scene.instances, here.inside.index);
        here.tree = tree_of(instance);
        here.inside = enter_instance(instance, here.inside.index, options);
        local = ray_in_instance(instance, here.inside, ray, options);
    }
    here.space = space_of(local);
    here.is_elsewhere = false;
}

// Continues to a child, unless the ray enters none, or is back where it was.
FUNC bool visit_children(INOUT(Traversal) here, EnteredChildren children, TraceOptions options) {
    if (children.others != NO_STACK_ENTRY)
        push_entry(here.stack, children.others, children.siblings, may_be_wide(options));
    bool descends = children.is_entered && children.first.edge != here.target;
    if (children.is_entered) here.at = children.first;
    if (here.at.edge == here.target) here.target = NOTHING;
    return descends;
}

FUNC bool visit_instance(INOUT(Traversal) here, SwTlasHeader scene, uint index, bool is_binary, TraceOptions options) {
    bool enters = is_visible(scene.instances, index, options);
    if (enters) {
        push_entry(here.stack, LEAVE_INSTANCE, 0u, may_be_wide(options));
        here.inside.index = index;
        here.outside = here.at.edge;
        here.at.edge = ROOT_EDGE;
        here.at.item = is_binary ? AT(scene.instances, index).root : 0u;
        here.is_elsewhere = true;
    }
    return enters;
}

FUNC void leave_instance(INOUT(Traversal) here, SwTlasHeader scene) {
    here.tree = top_tree(scene);
    here.at.edge = here.outside;
    here.outside = NOTHING;
    here.is_elsewhere = true;
}

// Takes the next child off the last entry.
FUNC void take_child(INOUT(Traversal) here, bool is_binary, TraceOptions options) {
    uint entry = here.stack.last;
    if (is_surely_wide(options) || (may_be_wide(options) && here.stack.second != 0u)) {
        here.at = at_next_of_visits(entry, here.stack.second);
        here.stack.last = rest_of_visits(entry);
        return;
    }
    here.at = at_record(next_of(entry));
    if (is_binary) {
        here.at.item = child_at(here.tree.nodes, entry);
        here.at.edge = entry;
    }
    here.stack.last = is_binary ? NO_STACK_ENTRY : rest_of(entry);
}

// Sends the ray from the root to where it is.
FUNC void restart(INOUT(Traversal) here, bool is_inside, bool is_binary, TraceOptions options) {
    here.stack = empty_stack(is_inside);
    if (is_inside) push_entry(here.stack, LEAVE_INSTANCE, 0u, may_be_wide(options));
    here.target = here.at.edge;
    here.at = at_root(here.tree, is_binary);
}

// Continues with the next entry. Returns false if there is none.
FUNC bool visit_next(INOUT(Traversal) here, SwTlasHeader scene, bool is_binary, TraceOptions options) {
    bool has_top = (options.features & FEATURE_INSTANCES) != 0u;
    fetch_last(here.stack, may_be_wide(options));
    if (has_top && here.stack.last == LEAVE_INSTANCE) {
        leave_instance(here, scene);
        here.stack.last = NO_STACK_ENTRY;
        fetch_last(here.stack, may_be_wide(options));
    }
    bool waits = here.stack.last != NO_STACK_ENTRY;
    if (waits)
        take_child(here, is_binary, options);
    else if (here.stack.bottom != 0u && here.at.edge != ROOT_EDGE) {
        restart(here, has_top && here.outside != NOTHING, is_binary, options);
        waits = true;
    }
    return waits;
}

// The closest hit is the first by comes_before, whatever the layout and the order of traversal; with QUERY_ANY it is
// the first one found.
FUNC Hit traverse(SwTlasHeader scene, Ray ray, TraceOptions options) {
    bool has_top = (options.features & FEATURE_INSTANCES) != 0u;
    bool binary = is_binary(scene, options);
    Traversal here = begin_traversal(scene, ray, binary, options);
    bool is_traced = is_traceable(ray) && here.tree.root != NOTHING;
    if (!has_top) is_traced = is_traced && is_visible(scene.instances, 0u, options);
    Search search = begin_search(ray);
    while (is_traced) {
        if (has_top && here.is_elsewhere) prepare_ray(here, scene, ray, options);
        bool descends = false;
        CompressedRecord record;
        CompressedRecord second_half;
        if (!binary) record = load_record(here.tree.records, here.at.item & (MOST_RECORDS - 1u));
        bool is_wide = is_surely_wide(options) ? (here.at.item & LEAF_BIT) == 0u
                                               : !binary && may_be_wide(options) && is_wide_node(record);
        if (may_be_wide(options) && is_wide) second_half = load_record(here.tree.records, here.at.item + 1u);
        bool is_inner = binary ? (here.at.item & LEAF_BIT) == 0u : !is_leaf(record);
        bool is_place = has_top && (binary ? here.outside == NOTHING : is_instance(record));
        if (is_inner) {
            COUNT_STEPS(nodes, 1u);
            COUNT_STEPS(boxes, binary ? 2u : children_in(record));
            BoxRay boxes_ray = box_ray(here.space);
            EnteredChildren children;
            if (binary)
                children = children_of_node(here.at.item, here.tree, boxes_ray, search, here.target, options);
            else if (is_surely_wide(options) || (may_be_wide(options) && is_wide))
                children = children_of_wide(record, second_half, here.tree, boxes_ray, search, here.target);
            else
                children = children_of_record(record, here.tree, boxes_ray, search, here.target, options);
            descends = visit_children(here, children, options);
        } else if (!is_place) {
            bool is_at_second = !binary && (here.at.item & SECOND_BIT) != 0u;
            LeafVertices vertices;
            if (binary)
                vertices = vertices_of(load_triangle(here.tree.triangles, here.at.item & ~LEAF_BIT));
            else
                vertices = vertices_of_leaf(record, here.tree.vertices);
            if (options.level != LEVEL_FAST && is_sign_asked(search.sign_of_t)) {
                BvhTriangle asked = primitive_in(vertices, is_at_second);
                search.sign_of_t = told_sign(asked.v0, asked.v1, asked.v2, here.space.origin, search.sign_of_t);
                descends = search.sign_of_t != SIGN_UNASKED;  // to the same triangle, or the leaf's second
                if (!descends && (vertices.there & 2u) != 0u && !is_at_second) {
                    here.at.item = here.at.item | SECOND_BIT;
                    descends = true;
                }
            } else {
                LeafVisit visit = visit_in_leaf(vertices, is_at_second, has_box(here.inside, options), here.space,
                                                here.inside.error, options.level);
                COUNT_STEPS(leaves, search.sign_of_t == SIGN_UNASKED && !is_at_second ? 1u : 0u);
                COUNT_STEPS(primitives, search.sign_of_t == SIGN_UNASKED && !visit.is_missed ? 1u : 0u);
                if (!visit.is_missed) {
                    bool is_found = visit_leaf(visit, here.inside, here.space, options, search);
                    if (is_found && options.query == QUERY_ANY) break;
                    descends = options.level != LEVEL_FAST && is_sign_asked(search.sign_of_t);
                    if (!descends) search.sign_of_t = SIGN_UNASKED;
                }
                bool goes_on = !descends && visit.is_followed;
                if (goes_on || (descends && visit.is_second)) here.at.item = here.at.item | SECOND_BIT;
                descends = descends || goes_on;
            }
        } else {
            uint index = binary ? here.at.item & ~LEAF_BIT : index_in(record);
            descends = visit_instance(here, scene, index, binary, options);
        }
        if (!descends) is_traced = visit_next(here, scene, binary, options);
    }
    return hit_of(search, scene, options);
}
#endif
