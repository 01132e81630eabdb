// An accelerator after any history of calls, as docs/contract.md describes it, in a few plain arrays: which calls are
// refused, what is where, and what rays meet; and arguments of calls, decoded from the bytes of a fuzzer.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <twinray/abstract_accel.h>
#include <twinray/scene.h>

#include "engine/accel/geometry.h"
#include "tests/fuzz/targets.h"

namespace twinray::fuzz {

// The changes of the accelerator that the last sync has not seen.
enum class Pending : std::uint8_t { nothing, moves, structure };

// A mesh, or boxes, which no ray can meet without a program.
struct ModelGeometry {
    Mesh mesh;
    std::vector<Bounds> boxes;
    bool has_boxes = false;
    float unit = 1;  // of the positions at the last push or update
};

// The instances of one push. Handles may share a geometry.
struct ModelPlacing {
    AccelHandle handle;
    std::shared_ptr<ModelGeometry> geometry;
    std::vector<InstanceState> instances;
};

class AccelModel {
  public:
    std::vector<ModelPlacing> placings;  // of live handles, in push order
    std::vector<AccelHandle> dead;       // erased, of an earlier accelerator, or never given
    Pending pending = Pending::structure;
    std::uint64_t revision = 0;

    // Returns null for a dead handle.
    ModelPlacing* find(AccelHandle handle);
    void mark(Pending what) { pending = std::max(pending, what); }
    void sync();
    std::size_t instance_count() const;
    std::size_t geometry_count() const;
    // Returns whether a trace needs a program, for boxes or for instances that are not opaque.
    bool needs_program() const;
    // Tests each triangle of each instance.
    std::vector<Hit> closest_hits(std::span<const Ray> rays, std::uint8_t mask, Cull cull) const;
    // Ends the process if the accelerator differs. Everything that it holds as bytes must be the same.
    void check(const AbstractAccel& accel) const;
};

// Returns whether push() takes them for a geometry in this unit: each transform, also times the unit, has an inverse,
// and each custom index has 24 bits.
bool is_placeable(float unit, std::span<const Transform> transforms, std::span<const InstanceOptions> options);

// The arguments of a call, made of the remaining bytes; 0 after the last byte.
class Arguments {
  public:
    explicit Arguments(Input bytes) : bytes_(bytes) {}
    bool is_empty() const { return bytes_.empty(); }
    std::uint8_t byte() {
        if (bytes_.empty()) return 0;
        const std::uint8_t first = bytes_.front();
        bytes_ = bytes_.subspan(1);
        return first;
    }
    std::size_t below(std::size_t n) { return byte() % n; }
    // Returns most often a multiple of 1/16 between -8 and 8; now and then NaN, infinity or a number whose square is no
    // float.
    float number() {
        constexpr float odd[] = {NAN, INFINITY, -INFINITY, 1e30f, 1e-30f, 1e-42f, -0.0f, 3.4e38f};
        const std::uint8_t first = byte();
        return first < std::size(odd) ? odd[first] : (float(first) - 128) / 16;
    }
    vec3 point() {
        const float x = number(), y = number();
        return {x, y, number()};
    }
    Transform transform() {
        const auto kind = below(8);
        if (kind == 0) return {};
        if (kind < 4) return Transform::translation(point());
        if (kind < 6) return Transform::scaling(point());
        Transform any;
        for (vec4& row : any.rows) row = vec4(point(), number());
        return any;
    }
    std::vector<Transform> transforms(std::size_t count) {
        std::vector<Transform> all(count);
        for (Transform& each : all) each = transform();
        return all;
    }
    InstanceOptions options() {
        const std::uint8_t bits = byte();
        return {.custom_index = bits == 255 ? 1u << 24 : bits,
                .mask = bits % 4 ? std::uint8_t(0xff) : byte(),
                .disable_culling = bits % 8 == 1,
                .flip_facing = bits % 8 == 3,
                .non_opaque = bits % 32 == 7};
    }
    std::vector<InstanceOptions> options(std::size_t count) {
        std::vector<InstanceOptions> all(below(8) == 0 ? below(4) : below(2) * count);
        for (InstanceOptions& each : all) each = options();
        return all;
    }
    std::vector<vec3> points(std::size_t count) {
        std::vector<vec3> all(count);
        for (vec3& each : all) each = point();
        return all;
    }
    ModelGeometry geometry() {
        const auto kind = below(8);
        if (kind == 0) return {};
        if (kind == 1) return {{}, {{point(), point()}}, true, 1};
        if (kind < 4) return triangles(make_quad(point(), vec3(2, 0, 0), vec3(0, 2, 0)));
        Mesh mesh;
        mesh.positions = points(1 + below(6));
        for (std::size_t left = 1 + below(4); left > 0; --left) {
            const auto corner = [&] { return uint(below(mesh.positions.size() + (kind == 7))); };
            const uint x = corner(), y = corner();
            mesh.triangles.emplace_back(x, y, corner());
        }
        return triangles(std::move(mesh));
    }
    Ray ray() {
        const vec3 origin = point(), direction = point();
        const auto ends = below(4);
        return {origin, ends == 1 ? number() : 0, direction, ends >= 2 ? INFINITY : 4.0f};
    }

  private:
    static ModelGeometry triangles(Mesh mesh) {
        const float unit = Geometry::near_unit(mesh.positions);
        return {std::move(mesh), {}, false, unit};
    }

    Input bytes_;
};

}  // namespace twinray::fuzz
