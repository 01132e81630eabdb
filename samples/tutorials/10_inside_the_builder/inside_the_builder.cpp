// SPDX-License-Identifier: MIT
// The steps of a tree's build, with a picture for each, and the engine's tree beside it: inside_the_builder FOLDER
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

#include "tree.h"

namespace {

const char* const depth_colors[] = {"#222222", "#c1272d", "#d98c1f", "#3f8f4f", "#2a7fb8", "#7d4fa8", "#8a8a8a"};
std::string color_of(std::size_t depth) { return depth_colors[std::min(depth, std::size(depth_colors) - 1)]; }

template <class... Parts>
std::string text_of(const Parts&... parts) {
    std::ostringstream out;
    out.precision(5);
    (out << ... << parts);
    return out.str();
}

// A picture as SVG of a mesh in the plane z = 0 and of trees over it: the objects in [0, 1]^2 on the left, a tree on
// the right.
class Drawing {
  public:
    void triangles(const Mesh& mesh) {
        for (const uvec3& t : mesh.triangles) {
            body_ += "<polygon fill='#cfdbe6' stroke='#8fa3b5' points='";
            for (const uint vertex : {t.x, t.y, t.z})
                body_ += text_of(x_of(mesh.positions[vertex].x), ',', y_of(mesh.positions[vertex].y), ' ');
            body_ += "'/>\n";
        }
        for (const Bounds& box : boxes_of(mesh)) centers_.include(box.center());
    }

    void curve(const Sorted& sorted, std::span<const Bounds> boxes) {
        std::string points;
        for (std::size_t i = 0; i < sorted.order.size(); ++i) {
            const vec3 at = boxes[sorted.order[i]].center();
            const double x = x_of(at.x), y = y_of(at.y);
            points += text_of(x, ',', y, ' ');
            body_ += text_of("<circle cx='", x, "' cy='", y, "' r='3' fill='#c1272d'/><text x='", x + 4, "' y='", y - 4,
                             "' font-size='11'>", i, "</text>\n");
        }
        body_ += text_of("<polyline fill='none' stroke='#c1272d' stroke-width='1.5' points='", points, "'/>\n");
    }

    // The Morton grid, within the box of the centres.
    void cells(uint bits) {
        const vec3 lo = centers_.lo, hi = centers_.hi;
        for (uint i = 0; i <= 1u << bits; ++i) {
            const double part = double(i) / (1u << bits);
            const double x = x_of(lo.x + part * (hi.x - lo.x)), y = y_of(lo.y + part * (hi.y - lo.y));
            const std::string style = text_of("stroke='#bbbbbb' stroke-width='", i % 4 == 0 ? 1.2 : 0.5, "'");
            line(x, y_of(lo.y), x, y_of(hi.y), style);
            line(x_of(lo.x), y, x_of(hi.x), y, style);
        }
    }

    // Node `root` and all below it: their boxes, and the tree itself with leaves by position.
    void tree(std::span<const Node> nodes, int root, std::size_t leaves) {
        width_ = 960;
        const double step = 440.0 / double(leaves);
        const auto x = [&](int first, int last) { return 500 + step * (0.5 * (first + last) + 0.5); };
        std::vector<std::pair<int, std::size_t>> open = {{root, 0}};
        while (!open.empty()) {
            const auto [index, depth] = open.back();
            open.pop_back();
            const Node& node = nodes[std::size_t(index)];
            const std::string stroke = text_of("stroke='", color_of(depth), "'");
            rectangle(node.box, 4.0 - 0.6 * double(depth),
                      stroke + text_of(" stroke-width='", depth < 2 ? 2.5 : 1.5, "'"));
            const double y = 40 + 44 * double(depth), here = x(node.first, node.last);
            for (const int child : node.children) {
                const Node* below = child < 0 ? nullptr : &nodes[std::size_t(child)];
                const double there = below ? x(below->first, below->last) : x(~child, ~child);
                line(here, y, there, y + 44, stroke + " stroke-width='1.5'");
                if (below)
                    open.push_back({child, depth + 1});
                else
                    body_ += text_of("<text x='", there, "' y='", y + 56, "' font-size='10' text-anchor='middle'>",
                                     ~child, "</text>\n");
            }
            body_ += text_of("<circle cx='", here, "' cy='", y, "' r='4' fill='", color_of(depth), "'/>\n");
        }
    }

    void write(const std::filesystem::path& file) const {
        std::ofstream out(file);
        out << "<svg xmlns='http://www.w3.org/2000/svg' width='" << width_ << "' height='480' viewBox='0 0 " << width_
            << " 480' font-family='sans-serif'>\n<rect width='100%' height='100%' fill='white'/>\n"
            << body_ << "</svg>\n";
        if (!out.flush()) throw Error(file.string() + ": could not be written");
    }

  private:
    double x_of(double x) const { return 20 + 440 * x; }
    double y_of(double y) const { return 460 - 440 * y; }
    void line(double x0, double y0, double x1, double y1, const std::string& style) {
        body_ += text_of("<line x1='", x0, "' y1='", y0, "' x2='", x1, "' y2='", y1, "' ", style, "/>\n");
    }

    void rectangle(const Bounds& box, double inset, const std::string& style) {
        const double x = x_of(box.lo.x) - inset, y = y_of(box.hi.y) - inset;
        body_ += text_of("<rect x='", x, "' y='", y, "' width='", x_of(box.hi.x) + inset - x, "' height='",
                         y_of(box.lo.y) + inset - y, "' fill='none' ", style, "/>\n");
    }

    std::string body_;
    Bounds centers_;
    double width_ = 480;
};

}  // namespace

int main(int argc, char** argv) try {
    if (argc != 2) throw Error("usage: inside_the_builder FOLDER");
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder);
    // [steps]
    const Mesh scene = make_scene(32, 5);
    const std::vector<Bounds> boxes = boxes_of(scene);
    const Sorted sorted = morton_order(boxes);
    std::vector<Node> binary;
    const int root = radix_tree(sorted, boxes, binary);
    const std::vector<Node> wide = collapse(binary, root, 4);
    std::cout << scene.triangles.size() << " triangles, " << binary.size() << " binary nodes, " << wide.size()
              << " nodes of up to four children\n";
    // [/steps]
    Drawing morton, radix, four;
    morton.triangles(scene);
    morton.cells(3);
    morton.curve(sorted, boxes);
    morton.write(folder / "10_morton.svg");
    radix.triangles(scene);
    radix.tree(binary, root, boxes.size());
    radix.write(folder / "10_radix_tree.svg");
    four.triangles(scene);
    four.tree(wide, 0, boxes.size());
    four.write(folder / "10_wide_tree.svg");
    Context context;
    check_binary(context, scene, sorted, binary, root);
    const std::size_t compared = check_wide(context, scene, sorted, wide);
    std::cout << "the engine's binary tree is the same, bit for bit; so are " << compared
              << " records of its tree of four\n";
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
