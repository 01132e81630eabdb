// Meshes with everything that surfaces may have, pushed into an accelerator that keeps it.
#pragma once

#include "tests/accel/accel_fixture.h"

namespace twinray::test {

// A mesh with random values for everything that surfaces may have.
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

class SurfacesTest : public AccelTest {
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
    // Returns the mesh that an instance is of, and the index of its transform.
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

}  // namespace twinray::test
