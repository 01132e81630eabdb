// SPDX-License-Identifier: MIT
// The room of tutorial 5: panels of small triangles, each with a colour and, the lamp, with light of its own.
#pragma once

#include <vector>

#include <twinray/scene.h>

struct Panel {
    twinray::Mesh mesh;
    twinray::vec3 reflectance;
    twinray::vec3 emission;
};

// [panel]
// A rectangle of 2 n n triangles, whose front looks along cross(u, v).
inline twinray::Mesh make_panel(twinray::vec3 corner, twinray::vec3 u, twinray::vec3 v, twinray::uint n) {
    twinray::Mesh mesh;
    mesh.name = "panel";
    for (twinray::uint j = 0; j <= n; ++j)
        for (twinray::uint i = 0; i <= n; ++i) {
            const float a = float(i) / float(n), b = float(j) / float(n);
            mesh.positions.push_back(
                {corner.x + a * u.x + b * v.x, corner.y + a * u.y + b * v.y, corner.z + a * u.z + b * v.z});
        }
    for (twinray::uint j = 0; j < n; ++j)
        for (twinray::uint i = 0; i < n; ++i) {
            const twinray::uint p = j * (n + 1) + i, above = p + n + 1;
            mesh.triangles.push_back({p, p + 1, above + 1});
            mesh.triangles.push_back({p, above + 1, above});
        }
    return mesh;
}
// [/panel]

// The top and the four sides of a box on the floor, from (x, 0, z), turned by an angle whose cosine and sine are given.
inline void add_box(std::vector<Panel>& panels, twinray::vec3 from, float side, float height, twinray::vec2 turn) {
    const twinray::vec3 u(side * turn.x, 0, -side * turn.y), w(side * turn.y, 0, side * turn.x), up(0, height, 0);
    const auto sum = [](twinray::vec3 a, twinray::vec3 b) { return twinray::vec3(a.x + b.x, a.y + b.y, a.z + b.z); };
    const auto minus = [](twinray::vec3 a) { return twinray::vec3(-a.x, -a.y, -a.z); };
    const twinray::vec3 grey(0.7f), dark(0), far = sum(from, sum(u, w));
    for (const twinray::Mesh& mesh :
         {make_panel(sum(from, up), w, u, 6), make_panel(sum(from, w), u, up, 6), make_panel(from, w, up, 6),
          make_panel(far, minus(w), up, 6), make_panel(sum(from, u), minus(u), up, 6)})
        panels.push_back({mesh, grey, dark});
}

// A box of side 1, open towards +z, with a red wall on the left, a green one on the right and a lamp under the ceiling.
inline std::vector<Panel> room() {
    const twinray::vec3 grey(0.7f), red(0.6f, 0.06f, 0.05f), green(0.1f, 0.45f, 0.1f), dark(0);
    std::vector<Panel> panels = {
        {make_panel({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 14), grey, dark},            // floor
        {make_panel({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, 14), grey, dark},            // ceiling
        {make_panel({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 14), grey, dark},            // back
        {make_panel({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 14), red, dark},             // left
        {make_panel({1, 0, 0}, {0, 0, 1}, {0, 1, 0}, 14), green, dark},           // right
        {make_panel({0.35f, 0.98f, 0.35f}, {0.3f, 0, 0}, {0, 0, 0.3f}, 4), dark,  // lamp
         twinray::vec3(12, 11, 9)},
    };
    add_box(panels, {0.56f, 0, 0.5f}, 0.28f, 0.28f, {0.95f, -0.31225f});
    add_box(panels, {0.14f, 0, 0.24f}, 0.28f, 0.58f, {0.95f, 0.31225f});
    return panels;
}
