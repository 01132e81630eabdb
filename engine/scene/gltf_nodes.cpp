// SPDX-License-Identifier: MIT
#include "engine/scene/gltf_nodes.h"

#include <cmath>

namespace twinray {
namespace {

constexpr int MAX_DEPTH = 1000;

std::string node_name(const GltfFile& file, std::size_t index) {
    return gltf_name("node", index, file.model.nodes[index].name);
}

// Every node's parent or -1. Throws when a child does not exist or has two parents.
std::vector<int> find_parents(const GltfFile& file) {
    const auto& nodes = file.model.nodes;
    std::vector<int> parents(nodes.size(), -1);
    for (std::size_t i = 0; i < nodes.size(); ++i)
        for (const int child : nodes[i].children) {
            if (child < 0 || std::size_t(child) >= nodes.size())
                file.fail(node_name(file, i), ": child ", child, " does not exist; the file has ", nodes.size(),
                          " nodes");
            int& parent = parents[std::size_t(child)];
            if (parent >= 0)
                file.fail(node_name(file, std::size_t(child)), ": is a child of both ",
                          node_name(file, std::size_t(parent)), " and ", node_name(file, i),
                          "; nodes must form a tree");
            parent = static_cast<int>(i);
        }
    return parents;
}

// With one parent each, a node that no root leads to is on a cycle or below one.
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

std::vector<int> shown_roots(const GltfFile& file, const std::vector<int>& parents) {
    const auto& scenes = file.model.scenes;
    const int shown = file.model.defaultScene;
    if (shown != -1) {
        if (shown < 0 || std::size_t(shown) >= scenes.size())
            file.fail("scene ", shown, ", the default, does not exist; the file has ", scenes.size(), " scenes");
        check_roots(file, scenes[std::size_t(shown)].nodes, parents);
        return scenes[std::size_t(shown)].nodes;
    }
    std::vector<int> roots;
    for (std::size_t i = 0; i < parents.size(); ++i)
        if (parents[i] < 0) roots.push_back(static_cast<int>(i));
    return roots;
}

glm::dmat4 local_matrix(const GltfFile& file, std::size_t index, const std::string& object) {
    const tinygltf::Node& node = file.model.nodes[index];
    if (node.matrix.empty()) return matrix_of(file, node.translation, node.rotation, node.scale, object);
    if (node.matrix.size() != 16) file.fail(object, ": matrix has ", node.matrix.size(), " numbers instead of 16");
    glm::dmat4 matrix;
    for (std::size_t i = 0; i < 16; ++i) matrix[int(i / 4)][int(i % 4)] = node.matrix[i];
    if (matrix[0][3] != 0 || matrix[1][3] != 0 || matrix[2][3] != 0 || matrix[3][3] != 1)
        file.fail(object, ": the last row of its matrix is not 0 0 0 1");
    return matrix;
}

void check_length(const GltfFile& file, const std::vector<double>& list, std::size_t length, const std::string& what) {
    if (!list.empty() && list.size() != length) file.fail(what, " has ", list.size(), " numbers instead of ", length);
}

glm::dmat3 rotation_matrix(const GltfFile& file, const std::vector<double>& q, const std::string& object) {
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    const double length2 = x * x + y * y + z * z + w * w;
    if (!(length2 > 0) || !std::isfinite(length2)) file.fail(object, ": rotation has length ", std::sqrt(length2));
    const double s = 2 / length2;  // files round their unit quaternions
    return {1 - s * (y * y + z * z), s * (x * y + z * w),     s * (x * z - y * w),
            s * (x * y - z * w),     1 - s * (x * x + z * z), s * (y * z + x * w),
            s * (x * z + y * w),     s * (y * z - x * w),     1 - s * (x * x + y * y)};
}

}  // namespace

glm::dmat4 matrix_of(const GltfFile& file, const std::vector<double>& translation, const std::vector<double>& rotation,
                     const std::vector<double>& scale, const std::string& object) {
    check_length(file, translation, 3, object + ": translation");
    check_length(file, rotation, 4, object + ": rotation");
    check_length(file, scale, 3, object + ": scale");
    glm::dmat4 matrix(1);
    if (!rotation.empty()) matrix = glm::dmat4(rotation_matrix(file, rotation, object));
    for (int i = 0; i < 3; ++i) {
        if (!scale.empty()) matrix[i] *= scale[std::size_t(i)];
        if (!translation.empty()) matrix[3][i] = translation[std::size_t(i)];
    }
    return matrix;
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

std::vector<GltfNode> flatten_nodes(const GltfFile& file) {
    const auto& nodes = file.model.nodes;
    const std::vector<int> parents = find_parents(file);
    check_tree(file, parents);
    std::vector<GltfNode> flat;
    const auto add = [&](int index, const glm::dmat4& above) {
        GltfNode node{std::size_t(index), node_name(file, std::size_t(index)), above};
        node.world = above * local_matrix(file, node.index, node.name);
        rounded_transform(file, node.world, node.name);
        flat.push_back(std::move(node));
    };
    for (const int root : shown_roots(file, parents)) add(root, glm::dmat4(1));
    for (std::size_t i = 0; i < flat.size(); ++i) {
        const glm::dmat4 world = flat[i].world;  // add() moves flat's nodes
        for (const int child : nodes[flat[i].index].children) add(child, world);
    }
    return flat;
}

}  // namespace twinray
