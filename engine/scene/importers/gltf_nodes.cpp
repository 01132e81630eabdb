#include "engine/scene/importers/gltf_parts.h"

namespace twinray {
namespace {

constexpr int MAX_DEPTH = 1000;

std::string node_name(const GltfFile& file, std::size_t index) {
    return gltf_name("node", index, file.model.nodes[index].name);
}

// Returns every node's parent or -1. A node that is a child of two stays with the first; the other loses it, with a
// warning. Throws Error when a child does not exist.
std::vector<int> find_parents(GltfFile& file) {
    auto& nodes = file.model.nodes;
    std::vector<int> parents(nodes.size(), -1);
    for (std::size_t i = 0; i < nodes.size(); ++i)
        std::erase_if(nodes[i].children, [&](const int child) {
            if (child < 0 || std::size_t(child) >= nodes.size())
                file.fail(node_name(file, i), ": child ", child, " does not exist; the file has ", nodes.size(),
                          " nodes");
            int& parent = parents[std::size_t(child)];
            if (parent >= 0) {
                file.warn(text(node_name(file, std::size_t(child)), ": is a child of both ",
                               node_name(file, std::size_t(parent)), " and ", node_name(file, i),
                               ", and shown once, below the first"));
                return true;
            }
            parent = static_cast<int>(i);
            return false;
        });
    return parents;
}

// Checks that no node is on a cycle or below one: with one parent each, no root leads to such a node.
void check_tree(const GltfFile& file, const std::vector<int>& parents) {
    std::vector<int> depths(parents.size(), 0);  // 0 = not known yet
    for (std::size_t i = 0; i < parents.size(); ++i) {
        std::vector<std::size_t> path;
        int above = 0;
        for (int node = static_cast<int>(i); node >= 0; node = parents[std::size_t(node)]) {
            if (above = depths[std::size_t(node)]; above > 0) break;
            if (path.size() > parents.size()) file.fail(node_name(file, i), ": the node hierarchy has a cycle");
            path.push_back(std::size_t(node));
        }
        for (; !path.empty(); path.pop_back()) depths[path.back()] = ++above;
        if (above > MAX_DEPTH) file.fail(node_name(file, i), ": is ", above, " levels deep; the limit is ", MAX_DEPTH);
    }
}

void check_roots(const GltfFile& file, const std::vector<int>& roots, const std::vector<int>& parents) {
    std::vector<bool> is_listed(parents.size(), false);
    for (const int root : roots) {
        if (root < 0 || std::size_t(root) >= parents.size())
            file.fail("the scene lists node ", root, ", which does not exist; the file has ", parents.size(), " nodes");
        const std::size_t index = std::size_t(root);
        if (is_listed[index]) file.fail(node_name(file, index), ": is listed twice in the scene");
        if (parents[index] >= 0)
            file.fail(node_name(file, index), ": is listed in the scene but is a child of ",
                      node_name(file, std::size_t(parents[index])));
        is_listed[index] = true;
    }
}

// Scenes are alternatives: without a default the first one is shown.
std::vector<int> shown_roots(GltfFile& file, const std::vector<int>& parents) {
    const auto& scenes = file.model.scenes;
    const int shown = file.model.defaultScene == -1 && !scenes.empty() ? 0 : file.model.defaultScene;
    if (shown != -1) {
        if (shown < 0 || std::size_t(shown) >= scenes.size())
            file.fail("scene ", shown, ", the default, does not exist; the file has ", scenes.size(), " scenes");
        if (file.model.defaultScene == -1 && scenes.size() > 1)
            file.warn(text("none of the ", scenes.size(), " scenes is the default; ",
                           gltf_name("scene", 0, scenes[0].name), " is shown"));
        check_roots(file, scenes[std::size_t(shown)].nodes, parents);
        return scenes[std::size_t(shown)].nodes;
    }
    std::vector<int> roots;
    for (std::size_t i = 0; i < parents.size(); ++i)
        if (parents[i] < 0) roots.push_back(static_cast<int>(i));
    return roots;
}

bool is_visible(const GltfFile& file, std::size_t index, const std::string& object) {
    const tinygltf::Value* extension = find_extension(file.model.nodes[index].extensions, "KHR_node_visibility");
    const tinygltf::Value* visible = extension ? find_member(*extension, "visible") : nullptr;
    if (visible && !visible->IsBool()) file.fail(object, ": KHR_node_visibility visible is neither true nor false");
    return !visible || visible->Get<bool>();
}

Rig::Node read_local(const GltfFile& file, std::size_t index, std::int32_t parent, const std::string& object) {
    const tinygltf::Node& source = file.model.nodes[index];
    Rig::Node node;
    node.name = source.name;
    node.parent = parent;
    node.is_fixed = !source.matrix.empty();
    if (!node.is_fixed)
        node.rest = read_trs(file, source.translation, source.rotation, source.scale, object);
    else if (source.matrix.size() == 16)
        node.matrix = affine_matrix(file, std::span<const double, 16>(source.matrix), object + ": matrix");
    else
        file.fail(object, ": matrix has ", source.matrix.size(), " numbers instead of 16");
    return node;
}

void check_length(const GltfFile& file, const std::vector<double>& list, std::size_t length, const std::string& what) {
    if (!list.empty() && list.size() != length) file.fail(what, " has ", list.size(), " numbers instead of ", length);
}

}  // namespace

// Exporters multiply float matrices, inverses among them: a condition number of 1000 leaves 14 of their 24 bits.
glm::dmat4 affine_matrix(const GltfFile& file, std::span<const double, 16> entries, const std::string& object) {
    constexpr double rounding = 0x1p-14;
    glm::dmat4 matrix;
    for (std::size_t i = 0; i < 16; ++i) {
        if (!std::isfinite(entries[i])) file.fail(object, " has the entry ", entries[i]);
        matrix[int(i / 4)][int(i % 4)] = entries[i];
    }
    const double a = matrix[0][3], b = matrix[1][3], c = matrix[2][3], d = matrix[3][3];
    if (!(std::max({std::abs(a), std::abs(b), std::abs(c), std::abs(d - 1)}) <= rounding))
        file.fail(object, ": the last row is ", a, ' ', b, ' ', c, ' ', d, ", not 0 0 0 1");
    matrix[0][3] = matrix[1][3] = matrix[2][3] = 0;
    return matrix / d;
}

Trs read_trs(const GltfFile& file, const std::vector<double>& translation, const std::vector<double>& rotation,
             const std::vector<double>& scale, const std::string& object) {
    check_length(file, translation, 3, object + ": translation");
    check_length(file, rotation, 4, object + ": rotation");
    check_length(file, scale, 3, object + ": scale");
    Trs trs;
    if (!translation.empty()) trs.translation = {translation[0], translation[1], translation[2]};
    if (!rotation.empty()) trs.rotation = {rotation[0], rotation[1], rotation[2], rotation[3]};
    if (!scale.empty()) trs.scale = {scale[0], scale[1], scale[2]};
    const double length2 = dot(trs.rotation, trs.rotation);
    if (!(length2 > 0) || !std::isfinite(length2)) file.fail(object, ": rotation has length ", std::sqrt(length2));
    return trs;
}

Transform rounded_transform(const GltfFile& file, const glm::dmat4& matrix, const std::string& object) {
    Transform transform;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column) {
            const float entry = static_cast<float>(matrix[column][row]);
            if (!std::isfinite(entry))
                file.fail(object, ": its transform to the world has the entry ", matrix[column][row],
                          ", which is not a finite float");
            transform.rows[std::size_t(row)][column] = entry;
        }
    return transform;
}

std::vector<GltfNode> flatten_nodes(GltfFile& file) {
    const auto& nodes = file.model.nodes;
    const std::vector<int> parents = find_parents(file);
    check_tree(file, parents);
    std::vector<GltfNode> flat;
    const auto add = [&](int index, std::int32_t parent) {
        GltfNode node{std::size_t(index), node_name(file, std::size_t(index)), {}, glm::dmat4(1), glm::dmat4(1)};
        node.local = read_local(file, node.index, parent, node.name);
        node.world = node.local.is_fixed ? node.local.matrix : matrix_of(node.local.rest);
        node.frame = node.local.is_fixed ? node.local.matrix : frame_of(node.local.rest);
        node.is_visible = is_visible(file, node.index, node.name);
        if (parent >= 0) {
            const GltfNode& above = flat[std::size_t(parent)];
            node.world = above.world * node.world;
            node.frame = above.frame * node.frame;
            node.is_visible &= above.is_visible;
        }
        node.frame[3] = node.world[3];
        rounded_transform(file, node.world, node.name);
        flat.push_back(std::move(node));
    };
    for (const int root : shown_roots(file, parents)) add(root, -1);
    for (std::size_t i = 0; i < flat.size(); ++i) {
        look_for_interruption();
        for (const int child : nodes[flat[i].index].children) add(child, static_cast<std::int32_t>(i));
    }
    return flat;
}

}  // namespace twinray
