// Surfaces of hits, compared with float64 and with the same functions on the host, on both accelerators.
#include "engine/accel/surface_tables.h"

#include "tests/accel/surfaces_fixture.h"
#include "test_surface_kernel.spv.h"

namespace twinray {
namespace {

constexpr double u = 0x1p-24;

using test::Placed;

class Surfaces : public test::SurfacesTest {};
TWINRAY_OVER_EVERY_ACCEL(Surfaces);

dvec3 mapped(const Transform& m, const dvec3& p, double w) {
    dvec3 result(0);
    for (int row = 0; row < 3; ++row) {
        const dvec4 r(m.rows[static_cast<std::size_t>(row)]);
        result[row] = r.x * p.x + r.y * p.y + r.z * p.z + r.w * w;
    }
    return result;
}

// Maps a normal by the inverse transpose of the linear part, times its determinant: by cofactors.
dvec3 by_cofactors(const Transform& m, const dvec3& n) {
    const dvec3 a(m.rows[0]), b(m.rows[1]), c(m.rows[2]);
    const dvec3 x = cross(b, c), y = cross(c, a), z = cross(a, b);
    return dvec3(dot(x, n), dot(y, n), dot(z, n)) * (dot(a, x) < 0 ? -1.0 : 1.0);
}

// Expects the result of interpolation in float64, within its bound.
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
    const std::vector<Ray> rays = random_rays(1'000'000);
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

        // The point lies on the triangle, and on the ray, within the bound and the rounding of t.
        const dvec3 on_triangle = mapped(transform, a + (b - a) * double(s.uv.x) + (c - a) * double(s.uv.y), 1);
        ASSERT_LE(length(dvec3(s.point.position) - on_triangle), 2 * double(s.point.offset) + 1e-12);
        const dvec3 on_ray = dvec3(rays[i].origin) + dvec3(rays[i].direction) * double(s.t);
        const double grazing = std::abs(dot(normalize(dvec3(rays[i].direction)), dvec3(s.point.normal)));
        widest = std::max(widest, length(dvec3(s.point.position) - on_ray) * grazing / double(s.point.offset));

        const dvec3 geometric = normalize(by_cofactors(transform, cross(b - a, c - a)));
        ASSERT_LE(length(dvec3(s.point.normal) - geometric), 1e-5) << i;
        const bool seen = dot(geometric, dvec3(rays[i].direction)) < 0;
        ASSERT_EQ(s.is_front != 0, seen != placed->options[index].flip_facing);
        ASSERT_EQ(hits[i].flags, s.is_front ? HIT_FRONT : 0u) << i;

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

        // The bitangent, also of mirrored instances, is the map of the mesh's own.
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

// Returns the index of the first word whose bits differ, or -1.
int differing_word(const Surface& a, const Surface& b) {
    std::array<uint, sizeof(Surface) / 4> words[2];
    std::memcpy(&words[0], &a, sizeof(Surface));
    std::memcpy(&words[1], &b, sizeof(Surface));
    const auto differing = std::ranges::mismatch(words[0], words[1]).in1;
    return differing == words[0].end() ? -1 : static_cast<int>(differing - words[0].begin());
}

// The same ids give the same bits, whichever accelerator found them.
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

// The data that the device's functions read, in the host's memory.
struct HostTable {
    struct Block {
        std::byte before[GEOMETRY_SOURCE_OFFSET];
        GeometrySource source;
    };
    std::vector<Geometry> geometries;
    std::vector<SharedArray<vec3>> positions;
    std::vector<Block> blocks;
    std::vector<InstanceRecord> records;
    std::vector<uint> geometry_of_instance;
    std::vector<SurfaceGeometry> rows;
    std::vector<SurfaceAttribute> attributes;

    explicit HostTable(const std::vector<Placed>& placed) : blocks(placed.size()) {
        for (const Placed& each : placed) geometries.emplace_back(each.shape.view());
        for (std::size_t i = 0; i < placed.size(); ++i) {
            const Mesh& mesh = placed[i].shape.mesh;
            positions.push_back(geometries[i].built_positions());
            blocks[i].source = {Floats::to(&positions[i][0].x), Uints::to(&geometries[i].triangles[0].x),
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

// Surfaces agree to the last bit on a device that rounds quotients to nearest, except for normalised vectors.
TEST_P(Surfaces, AreWhatTheSameFunctionsGiveOnTheHost) {
    add_some();
    push_all(accel());
    const std::vector<Ray> rays = random_rays(20'000);
    const std::vector<Hit> hits = accel().closest_hits(rays);
    const std::vector<Surface> surfaces = accel().surfaces(rays, hits);
    const HostTable host(placed_);
    const float off = context().state().tuning().row == TuningRow::cpu_driver ? 0.0f : 1e-5f;
    const auto distance_of = [](const auto& a, const auto& b) { return length(a - b); };
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i].hit) continue;
        const Surface expected = surface_at(surface_place(host.table(), rays[i], hits[i]), hits[i].instance_index);
        const Surface& found = surfaces[i];
        ASSERT_LE(distance_of(found.point.position, expected.point.position), off) << i;
        ASSERT_NEAR(found.t, expected.t, off * expected.t) << i;
        ASSERT_LE(distance_of(found.uv, expected.uv), off) << i;
        ASSERT_EQ(found.vertices, expected.vertices) << i;
        ASSERT_EQ(found.is_front, expected.is_front) << i;
        ASSERT_LE(distance_of(found.uv0, expected.uv0), off) << i;
        ASSERT_LE(distance_of(found.uv1, expected.uv1), off) << i;
        ASSERT_LE(distance_of(found.color, expected.color), off) << i;
        ASSERT_EQ(found.face_metadata, expected.face_metadata) << i;
        ASSERT_LE(length(expected.point.normal - found.point.normal), 1e-6f + off) << i;
        ASSERT_LE(length(expected.normal - found.normal), 1e-6f + off) << i;
        ASSERT_LE(length(vec3(expected.tangent) - vec3(found.tangent)), 1e-6f + off) << i;
        ASSERT_EQ(expected.tangent.w, found.tangent.w) << i;
    }
}

// The results of a user's kernel.
struct FoundByKernel {
    std::vector<Surface> surfaces;
    std::vector<vec4> others;  // two for each ray

    uint word(std::size_t i, int component) const { return std::bit_cast<uint>(others[i][component]); }
};

FoundByKernel run_surface_kernel(Context& context, std::uint64_t scene, std::span<const Ray> rays,
                                 std::span<const Hit> hits, uint heat) {
    struct Args {
        std::uint64_t accel;
        Ref<Ray> rays;
        Ref<Hit> hits;
        Ref<Surface> surfaces;
        Ref<vec4> others;
        uint count, heat;
    };
    const Buffer ray_buffer = test::device_copy(context, rays), hit_buffer = test::device_copy(context, hits);
    const Buffer surfaces(context, {.name = "surfaces", .bytes = rays.size() * sizeof(Surface)});
    const Buffer others(context, {.name = "others", .bytes = rays.size() * 2 * sizeof(vec4)});
    const Kernel<Args> kernel(context, {.name = "surface kernel", .spirv = test_surface_kernel_spirv});
    Commands commands(context, "surfaces");
    kernel.dispatch(commands,
                    {scene, ray_buffer.ref<Ray>(), hit_buffer.ref<Hit>(), surfaces.ref<Surface>(), others.ref<vec4>(),
                     static_cast<uint>(rays.size()), heat},
                    rays.size());
    commands.submit();
    return {download<Surface>(context, surfaces, rays.size()), download<vec4>(context, others, 2 * rays.size())};
}

TEST_P(Surfaces, KernelsOfUsersFindThem) {
    add_some();
    const std::vector<AccelHandle> handles = push_all(accel());
    const std::vector<Ray> rays = random_rays(5'000);
    const std::vector<Hit> hits = accel().closest_hits(rays);
    const FoundByKernel found =
        run_surface_kernel(context(), accel().view().scene, rays, hits, accel().attribute_number("heat"));
    const std::vector<Surface> expected = accel().surfaces(rays, hits);
    const std::vector<vec4> heat = accel().attributes("heat", rays, hits);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i].hit) continue;
        ASSERT_EQ(differing_word(found.surfaces[i], expected[i]), -1) << i;
        ASSERT_EQ(found.others[2 * i].x, heat[i].x);
        ASSERT_EQ(found.word(2 * i, 1), expected[i].face_metadata);
        ASSERT_EQ(found.word(2 * i, 2), accel().index_in_handle(hits[i]));
        ASSERT_EQ(found.word(2 * i, 3), static_cast<uint>(accel().handle_of(hits[i]).id));
        const auto owner_of_hit = std::ranges::find(handles, accel().handle_of(hits[i])) - handles.begin();
        ASSERT_EQ(found.word(2 * i + 1, 0), placed_[static_cast<std::size_t>(owner_of_hit)].shape.whole[1]);
    }
}

TEST_P(Surfaces, MetadataIsKeptWithoutMeshes) {
    add_some();
    push_all(accel());
    const auto lean = make_accel({.keeps_metadata = true, .keeps_meshes = false, .compiles_in_background = false});
    push_all(*lean);
    const std::vector<Ray> rays = random_rays(1'000);
    const std::vector<Hit> hits = accel().closest_hits(rays);
    ASSERT_EQ(lean->closest_hits(rays), hits);
    EXPECT_EQ(lean->memory_usage().vertices, 0u);
    const FoundByKernel found = run_surface_kernel(context(), lean->view().scene, rays, hits, 0);
    const FoundByKernel expected = run_surface_kernel(context(), accel().view().scene, rays, hits, 0);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i].hit) continue;
        for (const int component : {1, 2}) ASSERT_EQ(found.word(2 * i, component), expected.word(2 * i, component));
        ASSERT_EQ(found.word(2 * i, 3), static_cast<uint>(lean->handle_of(hits[i]).id));
        ASSERT_EQ(found.word(2 * i + 1, 0), expected.word(2 * i + 1, 0));
        ASSERT_EQ(found.surfaces[i].normal, vec3(0)) << "there is no surface";
    }
    test::expect_error("keeps_surfaces", [&] { lean->surfaces(rays, hits); });
}

}  // namespace
}  // namespace twinray
