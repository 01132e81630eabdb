// SPDX-License-Identifier: MIT
// From hits to surfaces: against float64, against the same functions on the host, on both accelerators.
#include "engine/accel/surface_tables.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <set>

#include "tests/accel/accel_fixture.h"
#include "test_surface_kernel.spv.h"

namespace twinray {
namespace {

constexpr double u = 0x1p-24;

// A mesh with everything that surfaces may have, in random numbers.
struct FullMesh {
    Mesh mesh;
    std::vector<float> heat, weights;  // by vertex; by face, three each
    std::array<uint, 3> whole{};       // of the mesh

    FullMesh(Mesh shape, std::mt19937& random) : mesh(std::move(shape)), whole{uint(random()), uint(random()), 7} {
        mesh.uvs.clear();
        std::uniform_real_distribution<float> unit(-1, 1);
        const auto one = [&] { return unit(random); };
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            mesh.tangents.push_back({one(), one(), one(), random() % 2 ? 1.0f : -1.0f});
            mesh.uvs.push_back({8 * one(), one()});
            mesh.second_uvs.push_back({one(), 1e-3f * one()});
            mesh.colors.push_back({std::abs(one()), std::abs(one()), std::abs(one()), std::abs(one())});
            heat.push_back(300 * one());
        }
        if (mesh.normals.empty())
            for (std::size_t i = 0; i < mesh.positions.size(); ++i) mesh.normals.push_back({one(), one(), one()});
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
            mesh.materials.push_back(uint(random()));
            for (int k = 0; k < 3; ++k) weights.push_back(one());
        }
        attributes_ = {{"heat", 1, false, heat}, {"weights", 3, true, weights}};
    }
    FullMesh(FullMesh&&) = default;

    MeshView view() const {
        MeshView view(mesh);
        view.attributes = attributes_;
        view.metadata = std::as_bytes(std::span(whole));
        return view;
    }

  private:
    std::vector<AttributeView> attributes_;
};

struct Placed {
    FullMesh shape;
    std::vector<Transform> transforms;
    std::vector<InstanceOptions> options;
};

class Surfaces : public test::AccelTest {
  protected:
    AccelOptions accel_options() const override { return {.keeps_surfaces = true, .compiles_in_background = false}; }

    Transform random_transform() {
        for (;;) {
            Transform transform;
            for (vec4& row : transform.rows)
                row = vec4(unit_(random_), unit_(random_), unit_(random_), 2 * unit_(random_));
            if (std::abs(determinant(transform)) > 0.05) return transform;
        }
    }
    void add(Mesh mesh, std::size_t instances) {
        Placed placed{FullMesh(std::move(mesh), random_), {}, {}};
        for (std::size_t i = 0; i < instances; ++i) {
            placed.transforms.push_back(random_transform());
            placed.options.push_back(
                {.custom_index = i % 3 == 0 ? uint(random_() % 1000 + 1) : 0, .flip_facing = i % 4 == 1});
        }
        placed_.push_back(std::move(placed));
    }
    void add_some() {
        add(make_icosphere(3), 5);
        add(make_soup(300, 3, 0.4f), 4);  // without normals of its own
        Mesh tiny = make_icosphere(2), huge = make_box(vec3(-1), vec3(1));
        for (vec3& p : tiny.positions) p *= 1e-3f;
        add(std::move(tiny), 2);
        placed_.back().transforms = {Transform::scaling(vec3(1e3f)), Transform::scaling({-900, 700, 300})};
        for (vec3& p : huge.positions) p *= 3e4f;
        add(std::move(huge), 1);
        placed_.back().transforms = {Transform::scaling(vec3(-1e-4f))};
    }
    std::vector<AccelHandle> push_all(AbstractAccel& accel) {
        std::vector<AccelHandle> handles;
        for (const Placed& placed : placed_)
            handles.push_back(accel.push(placed.shape.view(), placed.transforms, placed.options));
        return handles;
    }
    std::vector<Ray> random_rays(std::size_t count) {
        std::vector<Ray> rays;
        for (std::size_t i = 0; i < count; ++i)
            rays.push_back({3.0f * vec3(unit_(random_), unit_(random_), unit_(random_)), 0,
                            vec3(unit_(random_), unit_(random_), unit_(random_)), INFINITY});
        return rays;
    }
    // Which mesh an instance is of, and its transform.
    std::pair<const Placed*, std::size_t> owner(uint instance) const {
        for (const Placed& placed : placed_) {
            if (instance < placed.transforms.size()) return {&placed, instance};
            instance -= static_cast<uint>(placed.transforms.size());
        }
        return {nullptr, 0};
    }

    std::mt19937 random_{20'261'126};
    std::uniform_real_distribution<float> unit_{-1, 1};
    std::vector<Placed> placed_;
};
TWINRAY_OVER_EVERY_ACCEL(Surfaces);

dvec3 mapped(const Transform& m, const dvec3& p, double w) {
    dvec3 result(0);
    for (int row = 0; row < 3; ++row) {
        const dvec4 r(m.rows[static_cast<std::size_t>(row)]);
        result[row] = r.x * p.x + r.y * p.y + r.z * p.z + r.w * w;
    }
    return result;
}

// The inverse transpose of the linear part, times its determinant: cofactors.
dvec3 by_cofactors(const Transform& m, const dvec3& n) {
    const dvec3 a(m.rows[0]), b(m.rows[1]), c(m.rows[2]);
    const dvec3 x = cross(b, c), y = cross(c, a), z = cross(a, b);
    return dvec3(dot(x, n), dot(y, n), dot(z, n)) * (dot(a, x) < 0 ? -1.0 : 1.0);
}

// What interpolating in float64 gives, and its bound.
template <class V>
void expect_interpolated(const std::vector<V>& values, const Surface& surface, const V& found, const char* what) {
    const double weights[] = {1 - double(surface.uv.x) - double(surface.uv.y), surface.uv.x, surface.uv.y};
    const uint vertices[] = {surface.vertices.x, surface.vertices.y, surface.vertices.z};
    constexpr int n = sizeof(V) / sizeof(float);
    const auto component = [](const V& v, int i) {
        float all[n];
        std::memcpy(all, &v, sizeof(V));
        return double(all[i]);
    };
    for (int i = 0; i < n; ++i) {
        double sum = 0, size = 0;
        for (int k = 0; k < 3; ++k) {
            sum += weights[k] * component(values[vertices[k]], i);
            size += std::abs(component(values[vertices[k]], i));
        }
        ASSERT_LE(std::abs(component(found, i) - sum), 4 * u * size) << what << " component " << i;
    }
}

TEST_P(Surfaces, AreWhatFloat64MakesOfTheHit) {
    add_some();
    push_all(accel());
    const std::vector<Ray> rays = random_rays(40'000);
    const std::vector<Hit> hits = accel().closest_hits(rays);
    const std::vector<Surface> surfaces = accel().surfaces(rays, hits);
    const std::vector<vec4> heat = accel().attributes("heat", rays, hits, vec4(-1));
    const std::vector<vec4> weights = accel().attributes("weights", rays, hits);
    ASSERT_EQ(surfaces.size(), rays.size());
    std::size_t found = 0, mirrored = 0;
    double widest = 0, worst_normal = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Surface& s = surfaces[i];
        ASSERT_EQ(s.is_hit, hits[i].hit);
        if (!s.is_hit) continue;
        ++found;
        ASSERT_EQ(s.instance_index, hits[i].instance_index);
        ASSERT_EQ(s.primitive_index, hits[i].primitive_index);
        const auto [placed, index] = owner(s.instance_index);
        const Mesh& mesh = placed->shape.mesh;
        const Transform& transform = placed->transforms[index];
        mirrored += determinant(transform) < 0;
        ASSERT_EQ(s.vertices, mesh.triangles[s.primitive_index]);
        const dvec3 a(mesh.positions[s.vertices.x]), b(mesh.positions[s.vertices.y]), c(mesh.positions[s.vertices.z]);

        // The point lies on the triangle, and on the ray, within the bound and what t is rounded by.
        const dvec3 on_triangle = mapped(transform, a + (b - a) * double(s.uv.x) + (c - a) * double(s.uv.y), 1);
        ASSERT_LE(length(dvec3(s.point.position) - on_triangle), 2 * double(s.point.offset) + 1e-12);
        const dvec3 on_ray = dvec3(rays[i].origin) + dvec3(rays[i].direction) * double(s.t);
        const double grazing = std::abs(dot(normalize(dvec3(rays[i].direction)), dvec3(s.point.normal)));
        widest = std::max(widest, length(dvec3(s.point.position) - on_ray) * grazing / double(s.point.offset));

        const dvec3 geometric = normalize(by_cofactors(transform, cross(b - a, c - a)));
        ASSERT_LE(length(dvec3(s.point.normal) - geometric), 1e-5) << i;
        const bool seen = dot(geometric, dvec3(rays[i].direction)) < 0;
        ASSERT_EQ(s.is_front != 0, seen != placed->options[index].flip_facing);

        dvec3 normal(0);
        const double w[] = {1 - double(s.uv.x) - double(s.uv.y), s.uv.x, s.uv.y};
        for (int k = 0; k < 3; ++k) normal += w[k] * dvec3(mesh.normals[s.vertices[static_cast<std::size_t>(k)]]);
        if (length(normal) > 0.1) {
            dvec3 expected = normalize(by_cofactors(transform, normal));
            if (dot(expected, geometric) < 0) expected = -expected;
            if (std::abs(dot(expected, geometric)) > 1e-4) {
                const double error = length(dvec3(s.normal) - expected);
                worst_normal = std::max(worst_normal, error);
                ASSERT_LE(error, 1e-5) << i;
            }
        }
        expect_interpolated(mesh.uvs, s, s.uv0, "uv0");
        expect_interpolated(mesh.second_uvs, s, s.uv1, "uv1");
        expect_interpolated(mesh.colors, s, s.color, "color");
        expect_interpolated(placed->shape.heat, s, heat[i].x, "heat");
        EXPECT_EQ(heat[i].w, 1) << "of components that it lacks";
        const std::size_t face = 3 * std::size_t{s.primitive_index};
        EXPECT_EQ(weights[i], vec4(placed->shape.weights[face], placed->shape.weights[face + 1],
                                   placed->shape.weights[face + 2], 1));
        const uint own = placed->options[index].custom_index;
        ASSERT_EQ(s.face_metadata, own ? own : mesh.materials[s.primitive_index]);

        // The bitangent, of mirrored instances, too: the map of the mesh's own.
        dvec4 tangent(0);
        for (int k = 0; k < 3; ++k) tangent += w[k] * dvec4(mesh.tangents[s.vertices[static_cast<std::size_t>(k)]]);
        const dvec3 world_tangent = mapped(transform, dvec3(tangent), 0);
        ASSERT_LE(length(normalize(world_tangent) - dvec3(s.tangent)), 1e-4 / length(dvec3(tangent))) << i;
        const dvec3 bitangent = mapped(transform, cross(normal, dvec3(tangent)), 0) * (tangent.w < 0 ? -1.0 : 1.0);
        const dvec3 told = cross(dvec3(s.normal), dvec3(s.tangent)) * double(s.tangent.w);
        if (std::abs(tangent.w) > 1e-3 && std::abs(dot(normalize(bitangent), normalize(told))) > 1e-3) {
            ASSERT_GT(dot(bitangent, told), 0) << i;
        }
    }
    EXPECT_GT(found, 5'000u);
    EXPECT_GT(mirrored, 1'000u);
    std::printf("%zu hits; from the ray at most %.2f of the bound; normals within %.1e\n", found, widest, worst_normal);
    EXPECT_LE(widest, 1);
}

// The first of their words that are not the same bits; -1: none.
int differing_word(const Surface& a, const Surface& b) {
    std::array<uint, sizeof(Surface) / 4> words[2];
    std::memcpy(&words[0], &a, sizeof(Surface));
    std::memcpy(&words[1], &b, sizeof(Surface));
    const auto differing = std::ranges::mismatch(words[0], words[1]).in1;
    return differing == words[0].end() ? -1 : static_cast<int>(differing - words[0].begin());
}

// For the same ids the same bits, whoever found them.
TEST_P(Surfaces, AreTheSameBitsOnEveryAccelerator) {
    add_some();
    push_all(accel());
    SwTlas software(context(), accel_options());
    push_all(software);
    const std::vector<Ray> rays = random_rays(20'000);
    const std::vector<Hit> hits = accel().closest_hits(rays);
    software.sync();
    const std::vector<Surface> ours = accel().surfaces(rays, hits), theirs = software.surfaces(rays, hits);
    for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(differing_word(ours[i], theirs[i]), -1) << i;
}

// What the device's functions read, in the host's memory.
struct HostTable {
    struct Block {
        std::byte before[GEOMETRY_SOURCE_OFFSET];
        GeometrySource source;
    };
    std::vector<Geometry> geometries;
    std::vector<Block> blocks;
    std::vector<InstanceRecord> records;
    std::vector<uint> geometry_of_instance;
    std::vector<SurfaceGeometry> rows;
    std::vector<SurfaceAttribute> attributes;

    explicit HostTable(const std::vector<Placed>& placed) : blocks(placed.size()) {
        for (const Placed& each : placed) geometries.emplace_back(each.shape.view());
        for (std::size_t i = 0; i < placed.size(); ++i) {
            const Mesh& mesh = placed[i].shape.mesh;
            blocks[i].source = {Floats::to(&geometries[i].positions[0].x), Uints::to(&geometries[i].triangles[0].x),
                                geometries[i].scale, 0};
            rows.push_back({i, Uints::to(mesh.materials.data()), 0, static_cast<uint>(records.size()),
                            static_cast<uint>(mesh.triangles.size())});
            for (const auto& [data, components] :
                 {std::pair(&mesh.normals[0].x, 3u), std::pair(&mesh.tangents[0].x, 4u), std::pair(&mesh.uvs[0].x, 2u),
                  std::pair(&mesh.second_uvs[0].x, 2u), std::pair(&mesh.colors[0].x, 4u)})
                attributes.push_back({Floats::to(data), components, 0});
            for (std::size_t k = 0; k < placed[i].transforms.size(); ++k) {
                records.push_back(make_instance_record(placed[i].transforms[k], placed[i].options[k]));
                records.back().geometry = reinterpret_cast<std::uint64_t>(&blocks[i]);
                geometry_of_instance.push_back(static_cast<uint>(i));
            }
        }
    }
    SurfaceTable table() const {
        return {Ref<InstanceRecord>::to(records.data()),
                Uints::to(geometry_of_instance.data()),
                Ref<SurfaceGeometry>::to(rows.data()),
                Ref<SurfaceAttribute>::to(attributes.data()),
                5,
                0};
    }
};

// To the last bit but for what has been made a unit vector, by roots and quotients that devices round in their own
// ways.
TEST_P(Surfaces, AreWhatTheSameFunctionsGiveOnTheHost) {
    add_some();
    push_all(accel());
    const std::vector<Ray> rays = random_rays(20'000);
    const std::vector<Hit> hits = accel().closest_hits(rays);
    const std::vector<Surface> surfaces = accel().surfaces(rays, hits);
    const HostTable host(placed_);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i].hit) continue;
        const Surface expected = surface_at(surface_place(host.table(), rays[i], hits[i]), hits[i].instance_index);
        const Surface& found = surfaces[i];
        ASSERT_EQ(found.point.position, expected.point.position) << i;
        ASSERT_EQ(found.t, expected.t) << i;
        ASSERT_EQ(found.uv, expected.uv) << i;
        ASSERT_EQ(found.vertices, expected.vertices) << i;
        ASSERT_EQ(found.is_front, expected.is_front) << i;
        ASSERT_EQ(found.uv0, expected.uv0) << i;
        ASSERT_EQ(found.uv1, expected.uv1) << i;
        ASSERT_EQ(found.color, expected.color) << i;
        ASSERT_EQ(found.face_metadata, expected.face_metadata) << i;
        ASSERT_LE(length(expected.point.normal - found.point.normal), 1e-6f) << i;
        ASSERT_LE(length(expected.normal - found.normal), 1e-6f) << i;
        ASSERT_LE(length(vec3(expected.tangent) - vec3(found.tangent)), 1e-6f) << i;
        ASSERT_EQ(expected.tangent.w, found.tangent.w) << i;
    }
}

TEST_P(Surfaces, KernelsOfUsersFindThem) {
    struct Args {
        std::uint64_t accel;
        Ref<Ray> rays;
        Ref<Hit> hits;
        Ref<Surface> surfaces;
        Ref<vec4> others;
        uint count, heat;
    };
    add_some();
    const std::vector<AccelHandle> handles = push_all(accel());
    const std::vector<Ray> rays = random_rays(5'000);
    const std::vector<Hit> hits = accel().closest_hits(rays);
    const Buffer ray_buffer = device_copy(rays), hit_buffer = device_copy(hits);
    const Buffer surfaces(context(), {.name = "surfaces", .bytes = rays.size() * sizeof(Surface)});
    const Buffer others(context(), {.name = "others", .bytes = rays.size() * 2 * sizeof(vec4)});
    const Kernel<Args> kernel(context(), {.name = "surface kernel", .spirv = test_surface_kernel_spirv});
    Commands commands(context(), "surfaces");
    kernel.dispatch(commands,
                    {accel().view().scene, ray_buffer.ref<Ray>(), hit_buffer.ref<Hit>(), surfaces.ref<Surface>(),
                     others.ref<vec4>(), static_cast<uint>(rays.size()), accel().attribute_number("heat")},
                    rays.size());
    commands.submit();
    const std::vector<Surface> found = download<Surface>(context(), surfaces, rays.size());
    const std::vector<vec4> told = download<vec4>(context(), others, 2 * rays.size());
    const std::vector<Surface> expected = accel().surfaces(rays, hits);
    const std::vector<vec4> heat = accel().attributes("heat", rays, hits);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i].hit) continue;
        ASSERT_EQ(differing_word(found[i], expected[i]), -1) << i;
        ASSERT_EQ(told[2 * i].x, heat[i].x);
        ASSERT_EQ(std::bit_cast<uint>(told[2 * i].y), expected[i].face_metadata);
        ASSERT_EQ(std::bit_cast<uint>(told[2 * i].z), accel().index_in_handle(hits[i]));
        ASSERT_EQ(std::bit_cast<uint>(told[2 * i].w), static_cast<uint>(accel().handle_of(hits[i]).id));
        const auto owner_of_hit = std::ranges::find(handles, accel().handle_of(hits[i])) - handles.begin();
        ASSERT_EQ(std::bit_cast<uint>(told[2 * i + 1].x),
                  placed_[static_cast<std::size_t>(owner_of_hit)].shape.whole[1]);
    }
}

TEST_P(Surfaces, OfMeshesWithoutArraysHaveTheGeometry) {
    const Mesh square = test::square(0);
    const AccelHandle plain = accel().push(MeshView("plain", square.positions, square.triangles));
    const Ray ray = test::down(0.25f, 0.5f);
    const Hit hit = closest(ray);
    const Surface surface = accel().surfaces({&ray, 1}, {&hit, 1}).front();
    EXPECT_EQ(surface.point.position, vec3(0.25f, 0.5f, 0));
    EXPECT_EQ(surface.normal, vec3(0, 0, 1));
    EXPECT_EQ(surface.uv0, vec2(0));
    EXPECT_EQ(surface.color, vec4(1));
    EXPECT_EQ(surface.tangent, vec4(0));
    EXPECT_EQ(surface.face_metadata, 0u);
    EXPECT_EQ(surface.is_front, 1u);
    EXPECT_EQ(accel().handle_of(hit), plain);
    EXPECT_EQ(accel().attributes("uv0", {&ray, 1}, {&hit, 1}, vec4(3)).front(), vec4(3));
    EXPECT_EQ(accel().surfaces({}, {}).size(), 0u);
}

TEST_P(Surfaces, FollowEditsOfTheirMeshes) {
    Mesh mesh = test::square(0);
    mesh.normals.clear();
    mesh.materials = {4, 5};
    const AccelHandle first = accel().push(test::square(-5)), handle = accel().push(mesh);
    const Ray ray = test::down(0.75f, 0.5f);
    const auto surface = [&] {
        const Hit hit = closest(ray);
        return accel().surfaces({&ray, 1}, {&hit, 1}).front();
    };
    const uint was = surface().face_metadata;
    EXPECT_TRUE(was == 4 || was == 5);
    accel().erase(first);
    EXPECT_EQ(surface().face_metadata, was) << "after another was erased";

    std::vector<vec3> raised = mesh.positions;
    for (vec3& p : raised) p.z = p.x;
    accel().update_vertices(handle, raised);
    EXPECT_NEAR(surface().point.position.z, 0.75f, 1e-6f);
    EXPECT_NEAR(surface().normal.x, -std::sqrt(0.5f), 1e-6f) << "there are no normals to be out of date";
    for (vec3& p : raised) p.z = 2 * p.x;
    const Buffer on_device = device_copy(raised);
    accel().update_vertices(handle, on_device.ref<float>(), raised.size());
    EXPECT_NEAR(surface().point.position.z, 1.5f, 1e-6f);

    mesh.materials = {8, 8};
    accel().update(handle, mesh);
    EXPECT_EQ(surface().face_metadata, 8u);
    EXPECT_EQ(surface().point.position.z, 0);
    accel().update(handle, MeshView("bare", mesh.positions, mesh.triangles));
    EXPECT_EQ(surface().face_metadata, 0u);
}

TEST_P(Surfaces, WrongUseIsNamed) {
    Mesh mesh = test::square(0);
    mesh.uvs = {vec2(0), vec2(1)};
    EXPECT_EQ(test::error_of([&] { accel().push(mesh); }), "mesh 'quad': 2 entries of 'uv0' for 4 vertices");
    mesh.uvs.clear();
    mesh.materials = {1};
    EXPECT_EQ(test::error_of([&] { accel().push(mesh); }), "mesh 'quad': 1 entries of 'face_metadata' for 2 triangles");
    mesh.materials.clear();
    const std::vector<float> four(4), eight(8);
    const auto push_with = [&](const AttributeView& attribute, const AttributeView& second = {}) {
        const AttributeView both[] = {attribute, second};
        MeshView view(mesh);
        view.attributes = std::span(both, second.name.empty() ? 1 : 2);
        accel().push(view);
    };
    EXPECT_EQ(test::error_of([&] {
                  push_with({"heat", 3, false, four});
              }),
              "mesh 'quad': 4 entries of 'heat' for 12 vertices, times its components");
    EXPECT_EQ(test::error_of([&] {
                  push_with({"heat", 5, false, four});
              }),
              "mesh 'quad': attribute 'heat' has 5 components; 1 to 4 fit");
    EXPECT_EQ(test::error_of([&] {
                  push_with({"uv0", 1, false, four});
              }),
              "mesh 'quad': an attribute's name, 'uv0', is taken");
    EXPECT_EQ(test::error_of([&] {
                  push_with({"a", 1, false, four}, {"a", 2, false, eight});
              }),
              "mesh 'quad': an attribute's name, 'a', is taken");
    EXPECT_EQ(test::error_of([&] {
                  push_with({"", 1, false, four});
              }),
              "mesh 'quad': an attribute's name, '', is empty");
    EXPECT_EQ(accel().n_geometries(), 0u);
    EXPECT_NE(test::error_of([&] { accel().attribute_number("heat"); }).find("'heat'"), std::string::npos)
        << "what was refused left nothing";

    accel().push(mesh);
    const Ray ray = test::down(0.5f, 0.25f);
    Hit hit = closest(ray);
    const auto error_with = [&](const Hit& wrong) {
        return test::error_of([&] { accel().surfaces({&ray, 1}, {&wrong, 1}); });
    };
    EXPECT_EQ(error_with(hit), "");
    Hit wrong = hit;
    wrong.instance_index = 1;
    EXPECT_NE(error_with(wrong).find("instance 1 of 1"), std::string::npos);
    wrong = hit;
    wrong.primitive_index = 2;
    EXPECT_NE(error_with(wrong).find("primitive 2 of 2"), std::string::npos);
    EXPECT_NE(test::error_of([&] { accel().surfaces({&ray, 1}, {}); }).find("1 rays for 0 hits"), std::string::npos);
    wrong = {};
    EXPECT_NE(test::error_of([&] { accel().handle_of(wrong); }).find("a miss"), std::string::npos);
    accel().push(mesh);
    EXPECT_NE(error_with(hit).find("sync"), std::string::npos) << "edits are pending";

    const auto without = make_accel({.compiles_in_background = false});
    without->push(mesh);
    hit = without->closest_hits({&ray, 1}).front();
    EXPECT_NE(test::error_of([&] {
                  without->surfaces({&ray, 1}, {&hit, 1});
              }).find("keeps_surfaces"),
              std::string::npos);
    EXPECT_NO_THROW(without->handle_of(hit));
}

// What nobody asked for takes no memory.
TEST_P(Surfaces, TakeNoMemoryUnlessAskedFor) {
    std::mt19937 random(1);
    const FullMesh full(make_icosphere(4), random);
    const MeshView bare("bare", full.mesh.positions, full.mesh.triangles);
    const auto usage = [&](const MeshView& mesh, bool keeps) {
        const auto made = make_accel({.keeps_surfaces = keeps, .compiles_in_background = false});
        made->push(mesh);
        made->sync();
        return made->memory_usage();
    };
    const MemoryUsage none = usage(bare, false), ignored = usage(full.view(), false), shape = usage(bare, true),
                      all = usage(full.view(), true);
    EXPECT_EQ(ignored.total(), none.total());
    EXPECT_EQ(none.surfaces, 0u);
    EXPECT_EQ(none.vertices, 0u);
    EXPECT_GE(shape.vertices, full.mesh.positions.size() * sizeof(vec3) + full.mesh.triangles.size() * sizeof(uvec3));
    EXPECT_LT(shape.surfaces, 128u) << "the table of one geometry";
    const std::size_t n = full.mesh.positions.size(), faces = full.mesh.triangles.size();
    const std::size_t arrays = n * (12 + 16 + 8 + 8 + 16 + 4) + faces * (4 + 12);
    EXPECT_GE(all.surfaces, arrays);
    EXPECT_LT(all.surfaces, arrays + 512);
    EXPECT_EQ(all.geometries, none.geometries);
}

}  // namespace
}  // namespace twinray
