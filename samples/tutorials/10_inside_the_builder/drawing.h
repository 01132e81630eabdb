// SPDX-License-Identifier: MIT
// Pictures of a mesh in the plane z = 0 and of trees over it, as SVG.
#pragma once

#include <filesystem>
#include <string>

#include "tree.h"

// Draws the objects in [0, 1]^2 on the left, a tree on the right.
class Drawing {
  public:
    void triangles(const Mesh& mesh);
    void curve(const Sorted& sorted, std::span<const Bounds> boxes);
    void cells(uint bits);  // of the Morton grid, within the box of the centres
    // Node `root` and all below it: their boxes, and the tree itself with leaves by position.
    void tree(std::span<const Node> nodes, int root, std::size_t leaves);
    void write(const std::filesystem::path& file) const;

  private:
    double x_of(double x) const { return 20 + 440 * x; }
    double y_of(double y) const { return 460 - 440 * y; }
    void line(double x0, double y0, double x1, double y1, const std::string& style);
    void rectangle(const Bounds& box, double inset, const std::string& style);

    std::string body_;
    Bounds centers_;
    double width_ = 480;
};
