// Parts that importers share: words of text files, and polygons cut into triangles; and files of type .stl.
#include "engine/scene/importers/faces.h"

#include <numbers>

#include "engine/scene/importers/words.h"
#include "tests/scene/load_text.h"

namespace twinray::test {
namespace {

TEST(Words, LinesEndInThreeWays) {
    std::string_view rest = "a\n\nb\r\n\r\nc\r\rd\n";
    for (const char* line : {"a", "", "b", "", "c", "", "d"}) EXPECT_EQ(cut_line(rest), line);
    EXPECT_TRUE(rest.empty());
    EXPECT_EQ(cut_line(rest), "");
}

TEST(Words, WordsStandBetweenBlanks) {
    std::string_view rest = " \tone  two\v ";
    EXPECT_EQ(cut_word(rest), "one");
    EXPECT_EQ(cut_word(rest), "two");
    EXPECT_EQ(cut_word(rest), "");
    EXPECT_EQ(trimmed(" \t a b\r\n"), "a b");
    EXPECT_EQ(trimmed(" \n"), "");
    EXPECT_EQ(lowered("Solid \xc3\x84"), "solid \xc3\x84");
}

TEST(Words, NumbersAreWholeWords) {
    for (const auto& [word, value] : std::initializer_list<std::pair<const char*, double>>{{"1", 1},
                                                                                           {"+2.5E+000", 2.5},
                                                                                           {"-.5", -0.5},
                                                                                           {"3.", 3},
                                                                                           {"0.1", 0.1},
                                                                                           {"1e999", INFINITY},
                                                                                           {"-1e999", -INFINITY},
                                                                                           {"1e-999", 0},
                                                                                           {"inf", INFINITY},
                                                                                           {"1.#INF", INFINITY},
                                                                                           {"-1.#INF00", -INFINITY}})
        EXPECT_EQ(parse_number(word), value) << word;
    for (const char* word : {"nan", "-nan", "NaN", "nan(ind)", "-1.#IND", "1.#QNAN", "1.#IND00"})
        EXPECT_TRUE(parse_number(word) && std::isnan(*parse_number(word))) << word;
    for (const char* word : {"", "+", "-", "x", "1x", "1,5", "0x1", "1.5#INF", "2.#INF", "1#INF", "#"})
        EXPECT_FALSE(parse_number(word)) << word;
}

TEST(Words, TextHasNoMarkAndNoZeroByte) {
    const Bytes marked = {0xef, 0xbb, 0xbf, 'a'}, utf16 = {0xff, 0xfe, 'a', 0};
    EXPECT_EQ(text_of(marked, "x"), "a");
    EXPECT_EQ(text_of({}, "x"), "");
    expect_error("'file': not a text file in ASCII or UTF-8 (byte 3 is zero)", [&] { text_of(utf16, "file"); });
}

using Outline = std::vector<dvec3>;

double doubled_area(const dvec3& a, const dvec3& b, const dvec3& c) { return cross(b - a, c - a).z; }

double area_of(const Outline& outline) {
    double area = 0;
    for (std::size_t i = 2; i < outline.size(); ++i) area += doubled_area(outline[0], outline[i - 1], outline[i]) / 2;
    return area;
}

// Expects triangles that cover a simple outline once: none is turned over, and their areas add up to its area. Returns
// how many have no area.
std::size_t expect_cover(const Outline& outline, double rounding = 0) {
    const Triangulation cut = triangulate_polygon(outline);
    EXPECT_FALSE(cut.overlaps);
    EXPECT_EQ(cut.triangles.size(), outline.size() - 2);
    double area = 0;
    std::size_t flat = 0;
    for (const uvec3& t : cut.triangles) {
        const double part = doubled_area(outline[t.x], outline[t.y], outline[t.z]) / 2;
        EXPECT_GE(part, -rounding);
        flat += part == 0 ? 1 : 0;
        area += part;
    }
    EXPECT_NEAR(area, area_of(outline), 1e-9 * area);
    return flat;
}

// Makes a comb, with teeth 1 wide, 1 apart and 4 high on a back 1 high.
Outline comb(int teeth) {
    Outline outline = {{0, 0, 0}, {2 * teeth - 1, 0, 0}};
    for (int i = teeth - 1; i >= 0; --i) {
        outline.insert(outline.end(), {dvec3(2 * i + 1, 5, 0), dvec3(2 * i, 5, 0)});
        if (i > 0) outline.insert(outline.end(), {dvec3(2 * i, 1, 0), dvec3(2 * i - 1, 1, 0)});
    }
    return outline;
}

TEST(Polygon, ConcaveOnesAreCoveredOnceFromWhereverTheyStart) {
    for (Outline outline : {Outline{{0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {1, 1, 0}},
                            Outline{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {3, 1, 0}, {0, 4, 0}, {1, 1, 0}}, comb(7)})
        for (std::size_t first = 0; first < outline.size(); ++first) {
            expect_cover(outline);
            std::rotate(outline.begin(), outline.begin() + 1, outline.end());
        }
}

TEST(Polygon, ConvexOnesAreFansAboutTheFirstCorner) {
    EXPECT_EQ(triangulate_polygon(Outline{{0, 0, 0}, {2, 0, 0}, {3, 2, 0}, {1, 3, 0}, {-1, 2, 0}}).triangles,
              (std::vector<uvec3>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

// If one were left out, or in a triangle without an area, the neighbour that shares it would be a rounding apart.
TEST(Polygon, CornersInTheMiddleOfSidesAreOnesOfTriangles) {
    for (Outline outline :
         {Outline{{0, 0, 0}, {2, 0, 0}, {4, 0, 0}, {4, 2, 0}, {3, 2, 0}, {2, 2, 0}, {2, 4, 0}, {0, 4, 0}, {0, 3, 0}},
          Outline{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {0, 1, 0}}})
        for (std::size_t first = 0; first < outline.size(); ++first) {
            EXPECT_EQ(expect_cover(outline), 0u);
            std::rotate(outline.begin(), outline.begin() + 1, outline.end());
        }
}

TEST(Polygon, HolesReachedBySlitsStayOpen) {
    const Outline window = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0},
                            {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}};
    expect_cover(window);
    // A hole that touches the outline in two corners.
    expect_cover({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {3, 2, 0}, {0, 0, 0}, {2, 3, 0}, {4, 4, 0}, {0, 4, 0}});
    // One with a corner in a corner of the outline, reached from another one: no ear may be cut across it there.
    Outline touched = {{0, 0, 0},   {4, 0, 0},   {4, 4, 0}, {3.5, 3, 0}, {0, 0, 0},
                       {3, 3.5, 0}, {3.5, 3, 0}, {4, 4, 0}, {0, 4, 0}};
    for (std::size_t first = 0; first < touched.size(); ++first) {
        expect_cover(touched);
        std::rotate(touched.begin(), touched.begin() + 1, touched.end());
    }
}

// Outlines cells of a grid that hang together as a tree: there are slits between other cells, and corners that touch.
Outline around_cells(std::mt19937& random, int side) {
    const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
    const int dx[] = {1, 0, -1, 0}, dy[] = {0, 1, 0, -1};
    struct Cell {
        bool is_in = false, is_open[4] = {};
    };
    std::vector<Cell> cells(static_cast<std::size_t>(side * side));
    const auto at = [&](int x, int y) -> Cell& { return cells[static_cast<std::size_t>(y * side + x)]; };
    std::vector<std::pair<int, int>> grown = {{0, 0}};
    at(0, 0).is_in = true;
    for (int tries = 0; tries < 3 * side * side; ++tries) {
        const auto [x, y] = grown[below(grown.size())];
        const std::size_t d = below(4);
        const int to_x = x + dx[d], to_y = y + dy[d];
        if (to_x < 0 || to_y < 0 || to_x >= side || to_y >= side || at(to_x, to_y).is_in) continue;
        at(to_x, to_y).is_in = at(x, y).is_open[d] = at(to_x, to_y).is_open[(d + 2) % 4] = true;
        grown.emplace_back(to_x, to_y);
    }
    const int corner_x[] = {1, 1, 0, 0}, corner_y[] = {0, 1, 1, 0};  // where the side that looks to d begins
    Outline outline;
    int x = 0, y = 0;
    for (std::size_t d = 3; outline.empty() || x != 0 || y != 0 || d != 3;) {
        outline.emplace_back(x + corner_x[d], y + corner_y[d], 0);
        d = (d + 1) % 4;
        while (at(x, y).is_open[d]) {
            x += dx[d], y += dy[d];
            d = (d + 3) % 4;
        }
    }
    return outline;
}

TEST(Polygon, OutlinesThatTouchThemselvesAreCoveredOnce) {
    std::mt19937 random(1);
    for (int i = 0; i < 3000; ++i) {
        Outline outline = around_cells(random, 3 + i % 6);
        std::rotate(outline.begin(), outline.begin() + static_cast<std::ptrdiff_t>(random() % outline.size()),
                    outline.end());
        SCOPED_TRACE(i);
        expect_cover(outline);
    }
}

TEST(Polygon, ManyCornersTakeNoLongerThanTheyMust) {
    std::mt19937 random(1);
    Outline circle, star, line;
    for (int i = 0; i < 30'000; ++i) {
        const double angle = 2 * std::numbers::pi * i / 30'000, radius = 0.1 + static_cast<double>(random()) * 0x1p-32;
        circle.emplace_back(std::cos(angle), std::sin(angle), 0);
        star.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
        line.emplace_back(i, 0, 0);
    }
    expect_cover(comb(10'000));
    expect_cover(circle, 1e-15);
    expect_cover(star, 1e-15);
    EXPECT_EQ(triangulate_polygon(line).triangles.size(), 29'998u);
}

TEST(Polygon, ALineThatGoesOutAndBackHasNoArea) {
    Outline outline = {{0, 0, 0}};
    constexpr int length = 3000;
    for (int i = -length; i <= length; ++i) outline.emplace_back(1 + length - std::abs(i), std::abs(i) - length, 0);
    outline.insert(outline.end(), {dvec3(1, 1, 0), dvec3(0, 1, 0)});
    EXPECT_EQ(area_of(outline), 1);
    EXPECT_EQ(expect_cover(outline), outline.size() - 4);
}

TEST(Polygon, FarFromTheOriginItIsAsNear) {
    Outline outline = comb(20);
    for (dvec3& p : outline) p = p * 0.125 + dvec3(500'000, 5'400'000, 300);
    expect_cover(outline);
    for (dvec3& p : outline) p = (p - dvec3(500'000, 5'400'000, 300)) * 0x1p-900;
    EXPECT_FALSE(triangulate_polygon(outline).overlaps);
}

TEST(Polygon, WindingIsKeptInEveryPlane) {
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {1.0, -1.0}) {
            Outline outline(4, dvec3(0));
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            outline[1][u] = outline[2][u] = 1;
            outline[2][v] = outline[3][v] = side;
            for (const uvec3& t : triangulate_polygon(outline).triangles)
                EXPECT_EQ(cross(outline[t.y] - outline[t.x], outline[t.z] - outline[t.x])[axis], side);
        }
}

TEST(Polygon, WhatHasNoAreaIsAFan) {
    const std::vector<uvec3> fan = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
    for (const dvec3& point : {dvec3(1), dvec3(NAN), dvec3(0, 0, INFINITY)}) {
        const Triangulation cut = triangulate_polygon(Outline(5, point));
        EXPECT_EQ(cut.triangles, fan);
        EXPECT_FALSE(cut.overlaps);
    }
    EXPECT_TRUE(triangulate_polygon(Outline(2, dvec3(1))).triangles.empty());
    EXPECT_TRUE(triangulate_polygon({}).triangles.empty());
}

TEST(Polygon, WhatCrossesItselfIsToldAndKeepsItsCorners) {
    const Triangulation bow = triangulate_polygon(Outline{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}});
    EXPECT_TRUE(bow.overlaps);
    EXPECT_EQ(bow.triangles.size(), 2u);
    std::mt19937 random(1);
    Outline scribble;
    for (int i = 0; i < 2000; ++i)
        scribble.emplace_back(static_cast<double>(random()), static_cast<double>(random()), 0);
    const Triangulation cut = triangulate_polygon(scribble);
    EXPECT_TRUE(cut.overlaps);
    EXPECT_EQ(cut.triangles.size(), 1998u);
}

const std::string STL_SQUARE =
    "solid s\n"
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\nendfacet\n"
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\n"
    "endsolid s\n";

// Returns the same square; the count may be a lie.
std::string binary_square(const std::string& header = "made by a test", std::uint32_t count = 2, float normal = 1) {
    std::string file = header;
    file.resize(80, ' ');
    const auto put = [&](auto value) { file.append(reinterpret_cast<const char*>(&value), sizeof value); };
    put(count);
    for (const auto& corners : {std::array<vec3, 3>{vec3(0, 0, 0), vec3(1, 0, 0), vec3(1, 1, 0)},
                                std::array<vec3, 3>{vec3(0, 0, 0), vec3(1, 1, 0), vec3(0, 1, 0)}}) {
        put(vec3(normal));
        put(corners);
        put(std::uint16_t{0x8421});
    }
    return file;
}

Scene load_stl(const std::string& content, const std::string& name = "a.stl") { return load_text(content, name); }

void expect_stl_error(const std::string& content, const std::string& part) {
    expect_load_error(content, "a.stl", part);
}

void expect_stl_square(const std::string& content, const std::string& name = "a.stl") {
    const Scene scene = load_stl(content, name);
    ASSERT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.meshes[0].positions, (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(scene.meshes[0].triangles, (std::vector<uvec3>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_TRUE(scene.meshes[0].normals.empty());
    EXPECT_TRUE(scene.warnings.empty()) << joined(scene.warnings);
}

TEST(Stl, TextAndBinaryAreToldApartByTheCount) {
    expect_stl_square(STL_SQUARE);
    expect_stl_square(binary_square());
    expect_stl_square(binary_square("solid part_7 exported by a CAD program"));
    expect_stl_square(binary_square(std::string("solid\0", 6)));
    expect_stl_square(gzip_bytes(STL_SQUARE), "a.stl.gz");
    expect_stl_square(gzip_bytes(binary_square()), "a.STL.gz");
}

TEST(Stl, FacetNormalsAreNotRead) {
    expect_stl_square(binary_square("x", 2, NAN));
    for (const char* normal : {"nan nan nan", "-nan 0 0", "-1.#IND -1.#IND -1.#IND", "1.#QNAN 0 0", "inf 0 0", "", "?"})
        expect_stl_square(replaced(STL_SQUARE, "0 0 1\n", std::string(normal) + "\n"));
}

TEST(Stl, LinesAreFree) {
    expect_stl_square("\xef\xbb\xbf \n" + replaced(STL_SQUARE, "\n", "  \r\n\t "));
    expect_stl_square(replaced(STL_SQUARE, "\n", "\r"));
    expect_stl_square(replaced(replaced(STL_SQUARE, "solid", "SOLID"), "vertex", "VERTEX"));
    expect_stl_square(replaced(STL_SQUARE, "endsolid", "end solid"));
    expect_stl_square(STL_SQUARE.substr(0, STL_SQUARE.find("endsolid")));
    expect_stl_square(replaced(STL_SQUARE, " 1 ", " +1.0E+000 "));
    expect_stl_square(replaced(STL_SQUARE, "solid s", "solid assembly - 300K_can-1 facet"));
}

TEST(Stl, BytesAfterTheLastTriangleAreTold) {
    for (const std::size_t tail : {1, 2, 10, 512}) {
        const Scene scene = load_stl(binary_square("solid x") + std::string(tail, '\n'));
        EXPECT_EQ(count_triangles(scene), 2u);
        expect_warnings(scene, {text("ignored ", tail, " bytes after the last triangle")});
    }
}

TEST(Stl, EachSolidIsAMeshOfItsName) {
    const Scene scene = load_stl(STL_SQUARE + replaced(STL_SQUARE, "solid s", "solid two words") +
                                 "solid empty\nendsolid\n" + replaced(STL_SQUARE, "solid s", "solid"));
    ASSERT_EQ(scene.meshes.size(), 3u);
    EXPECT_EQ(scene.meshes[0].name, "s");
    EXPECT_EQ(scene.meshes[1].name, "two words");
    EXPECT_EQ(scene.instances[2].name, "a");  // the file's name
    EXPECT_EQ(load_stl(binary_square()).meshes[0].name, "a");
}

TEST(Stl, OtherFacetsThanTrianglesAndOtherWords) {
    const Scene scene = load_stl(
        "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 2 0 0\nvertex 2 1 0\nvertex 0 1 "
        "0\nendloop\nendfacet\n"
        "facet\ncolor 1 0 0\nvertex 0 0 0\nvertex 2 0 0\n");
    EXPECT_EQ(scene.meshes[0].triangles, (std::vector<uvec3>{{0, 1, 2}, {0, 2, 3}}));
    expect_warnings(
        scene, {"skipped 1 faces of fewer than 3 vertices", "passed over lines that begin with 'color' (line 11)"});
}

TEST(Stl, FaultsAreNamed) {
    expect_stl_error("", "not an STL file");
    expect_stl_error("facet normal 0 0 1\n", "not an STL file");
    expect_stl_error(std::string(100, 'x'), "not an STL file");
    expect_stl_error("solid s\nendsolid s\n", "holds no triangles to place");
    expect_stl_error(binary_square("x", 0), "holds no triangles to place (ignored 100 bytes after the last triangle)");
    expect_stl_error(binary_square("x", 3), "it says that it holds 3 triangles, but ends after 2");
    expect_stl_error(binary_square("solid", ~0u), "it says that it holds 4294967295 triangles, but ends after 2");
    expect_stl_error(replaced(STL_SQUARE, "vertex 1 0 0", "vertex 1 O 0"), "line 5: 'O' is not a number");
    expect_stl_error(replaced(STL_SQUARE, "vertex 1 0 0", "vertex 1 0"), "line 5: '' is not a number");
}

TEST(Stl, NonFiniteVerticesStayAndAreCounted) {
    const Scene scene = load_stl(replaced(STL_SQUARE, "vertex 1 0 0", "vertex -1.#IND 0 0"));
    EXPECT_EQ(count_triangles(scene), 2u);
    expect_warnings(scene, {"1 of 2 triangles have a NaN or infinite coordinate"});
}

}  // namespace
}  // namespace twinray::test
