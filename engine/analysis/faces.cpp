#include "engine/analysis/faces.h"

#include <algorithm>
#include <numeric>
#include <set>

#include "engine/accel/accel_backend.h"
#include "engine/core/error.h"
#include "engine/core/parallel.h"
#include "engine/core/files.h"

namespace twinray {
namespace {

std::uint64_t count_faces(std::span<const std::size_t> triangle_counts) {
    const auto count = std::reduce(triangle_counts.begin(), triangle_counts.end(), std::uint64_t{0});
    constexpr std::uint64_t most = Faces::State::most;
    if (count > most) fail("faces: the scene has ", count, " with its instances; at most ", most, " fit");
    return count;
}

double largest_coordinate_of(const PlacedMeshes& placed, Face face) {
    const MeshView& mesh = placed.mesh_of(face.instance);
    const uvec3 triangle = mesh.triangles[face.primitive];
    double largest = 0;
    for (const uint vertex : {triangle.x, triangle.y, triangle.z}) {
        const dvec3 p = abs(in_world(placed.instances[face.instance].transform, mesh.positions[vertex]));
        largest = std::max({largest, p.x, p.y, p.z});
    }
    return largest;
}

void upload_instances(Context& context, Commands& commands, Faces::State& state) {
    std::vector<FacesOfInstance> instances;
    for (uint i = 0; i < state.placed.instances.size(); ++i) {
        const auto& [mesh, transform] = state.placed.instances[i];
        const auto& rows = transform.rows;
        const MeshOnDevice& on_device = state.meshes[mesh];
        instances.push_back({{scaled_map({rows[0], rows[1], rows[2]}, on_device.scale), on_device.mesh},
                             static_cast<uint>(state.faces.size()),
                             0});
        for (uint primitive = 0; primitive < state.triangle_counts[i]; ++primitive)
            state.faces.push_back({i, primitive});
    }
    state.instance_buffer = Buffer(context, {.name = "faces of instances", .bytes = std::span(instances).size_bytes()});
    state.face_buffer = Buffer(context, {.name = "faces", .bytes = std::span(state.faces).size_bytes()});
    commands.upload(state.instance_buffer, std::span<const FacesOfInstance>(instances));
    commands.upload(state.face_buffer, std::span<const Face>(state.faces));
}

std::vector<double> areas_of_faces(const PlacedMeshes& placed, std::span<const Face> faces) {
    std::vector<double> areas(faces.size());
    parallel_for(faces.size(), [&](std::size_t face) {
        areas[face] = length(area_vector(placed, faces[face]));
        const double largest = areas[face] > 0 ? largest_coordinate_of(placed, faces[face]) : 0;
        if (!(largest <= Faces::State::largest_coordinate))
            fail("faces: triangle ", faces[face].primitive, " of instance ", faces[face].instance,
                 " has a coordinate of ", largest, " in world space; at most 2^124, about 2.1e37");
    });
    return areas;
}

dvec3 area_vector(const MeshView& mesh, const Transform& transform, uint primitive) {
    const uvec3 triangle = mesh.triangles[primitive];
    const vec3 a = mesh.positions[triangle.x], b = mesh.positions[triangle.y], c = mesh.positions[triangle.z];
    if (!is_active_triangle(a, b, c)) return dvec3(0);
    const dvec3 origin = in_world(transform, a);
    const dvec3 twice = cross(in_world(transform, b) - origin, in_world(transform, c) - origin);
    return twice * (determinant(transform) < 0 ? -0.5 : 0.5);
}

}  // namespace

std::string_view name_of(FaceGrouping grouping) {
    constexpr std::array names = {"face", "mesh", "instance", "material", "group"};
    return names[static_cast<std::size_t>(grouping)];
}

dvec3 in_world(const Transform& transform, vec3 point) {
    const dvec4 p(point, 1.0);
    return {dot(dvec4(transform.rows[0]), p), dot(dvec4(transform.rows[1]), p), dot(dvec4(transform.rows[2]), p)};
}

dvec3 area_vector(const PlacedMeshes& placed, Face face) {
    return area_vector(placed.mesh_of(face.instance), placed.instances[face.instance].transform, face.primitive);
}

dvec3 area_vector(const Scene& scene, Face face) {
    const Instance& instance = scene.instances[face.instance];
    return area_vector(scene.meshes[instance.mesh], instance.transform, face.primitive);
}

void check_filled(const AbstractAccel& accel, std::span<const std::size_t> triangle_counts, const char* action) {
    constexpr const char* advice = "; fill it by push_scene() from the same scene";
    if (accel.n_instances() != triangle_counts.size())
        fail(accel.name(), ": ", action, ": it has ", accel.n_instances(), " instances and the scene ",
             triangle_counts.size(), advice);
    std::size_t instance = 0;
    for (const AccelHandle handle : accel.handles())
        for (std::size_t i = 0; i < accel.n_instances(handle); ++i, ++instance)
            if (accel.n_primitives(handle) != triangle_counts[instance])
                fail(accel.name(), ": ", action, ": its instance ", instance, " has ", accel.n_primitives(handle),
                     " primitives and the scene's ", triangle_counts[instance], " triangles", advice);
}

namespace {

const Faces::State::Held& held_by(const Faces& faces) {
    if (!faces.state().held) fail("faces: made of a scene, not of an accelerator");
    return *faces.state().held;
}

}  // namespace

// Uses ranks of the metadata of faces as materials, so that groups are numbered without gaps.
Faces::Faces(AbstractAccel& accel) : state_(std::make_unique<State>()) {
    state_->placed = PlacedMeshes(accel);
    std::set<uint> values;
    const std::vector<AccelHandle> handles = accel.handles();
    for (std::size_t i = 0; i < handles.size(); ++i) {
        std::vector<uint>& materials = state_->materials.emplace_back(accel.backend().face_metadata(handles[i]));
        materials.resize(state_->placed.meshes[i].triangles.size());
        values.insert(materials.begin(), materials.end());
    }
    state_->held = {{values.begin(), values.end()}, accel.view().accel, accel.backend().edit_count()};
    const std::vector<uint>& metadata = state_->held->metadata;
    for (std::vector<uint>& materials : state_->materials)
        for (uint& value : materials)
            value = static_cast<uint>(std::ranges::lower_bound(metadata, value) - metadata.begin());
    state_->material_count = metadata.size();
    state_->fill(accel.context());
}

const std::vector<uint>& Faces::metadata() const { return held_by(*this).metadata; }

bool Faces::is_current(AbstractAccel& accel) const {
    const State::Held& held = held_by(*this);
    accel.sync();
    return accel.view().accel == held.accel && accel.backend().edit_count() == held.at;
}

void check_faces(AbstractAccel& accel, const Faces& faces, const char* action) {
    if (!faces.state().held) return check_filled(accel, faces.triangle_counts(), action);
    if (!faces.is_current(accel))
        fail(
            accel.name(), ": ", action, ": the faces are of ",
            accel.view().accel == held_by(faces).accel ? "before its last sync; make new ones" : "another accelerator");
}

Faces::Faces(Context& context, const Scene& scene) : state_(std::make_unique<State>()) {
    state_->placed = scene;
    for (const Mesh& mesh : scene.meshes) state_->materials.push_back(mesh.materials);
    state_->material_count = scene.materials.size();
    state_->fill(context);
}

void Faces::State::fill(Context& context) {
    triangle_counts = twinray::triangle_counts(placed);
    faces.reserve(count_faces(triangle_counts));
    std::vector<uint> all(placed.meshes.size());
    std::iota(all.begin(), all.end(), 0u);
    Commands commands(context, "faces");
    meshes = placed.on_device(commands, all);
    {
        const auto pass = commands.pass("faces upload");
        upload_instances(context, commands, *this);
    }
    commands.submit();
    areas = areas_of_faces(placed, faces);
}

Faces::Faces(Faces&&) noexcept = default;
Faces& Faces::operator=(Faces&&) noexcept = default;
Faces::~Faces() = default;

std::size_t Faces::count() const { return state_->areas.size(); }
Face Faces::operator[](std::size_t face) const { return state_->faces[face]; }
const std::vector<double>& Faces::areas() const { return state_->areas; }
const std::vector<std::size_t>& Faces::triangle_counts() const { return state_->triangle_counts; }

std::uint32_t checksum_of(const Scene& scene) {
    std::uint32_t sum = 0;
    const auto add = [&](const auto& values) { sum = crc32_of(std::as_bytes(std::span(values)), sum); };
    for (const Mesh& mesh : scene.meshes) {
        const std::array sizes = {mesh.positions.size(), mesh.triangles.size(), mesh.materials.size()};
        add(sizes);
        add(mesh.positions);
        add(mesh.triangles);
        add(mesh.materials);
    }
    for (const Instance& instance : scene.instances) {
        add(std::array{instance.mesh});
        add(instance.transform.rows);
    }
    return sum;
}

void Faces::set_custom_groups(std::vector<uint> groups) {
    if (groups.size() != count()) fail("faces: ", groups.size(), " groups for ", count(), " faces");
    for (std::size_t face = 0; face < groups.size(); ++face)
        if (groups[face] >= count())
            fail("faces: face ", face, " is of group ", groups[face], ", which must be below the count of faces, ",
                 count());
    state_->custom_groups = std::move(groups);
}

std::vector<uint> Faces::groups(FaceGrouping grouping) const {
    if (grouping == FaceGrouping::custom) {
        if (state_->custom_groups.size() != count()) fail("faces: no groups of faces have been set");
        return state_->custom_groups;
    }
    std::vector<uint> groups(count());
    const auto group = [&](const Face& face) {
        const uint mesh = state_->placed.instances[face.instance].mesh;
        switch (grouping) {
            case FaceGrouping::mesh: return mesh;
            case FaceGrouping::instance: return face.instance;
            default: return state_->materials[mesh].empty() ? 0 : state_->materials[mesh][face.primitive];
        }
    };
    if (grouping == FaceGrouping::face)
        std::iota(groups.begin(), groups.end(), 0u);
    else
        std::transform(state_->faces.begin(), state_->faces.end(), groups.begin(), group);
    return groups;
}

std::size_t Faces::group_count(FaceGrouping grouping) const {
    switch (grouping) {
        case FaceGrouping::face: return count();
        case FaceGrouping::mesh: return state_->placed.meshes.size();
        case FaceGrouping::instance: return state_->placed.instances.size();
        case FaceGrouping::material: return state_->material_count;
        default: {
            const std::vector<uint> of = groups(grouping);
            return of.empty() ? 0 : *std::max_element(of.begin(), of.end()) + 1;
        }
    }
}

std::vector<std::vector<uint>> Faces::members(FaceGrouping grouping) const {
    std::vector<std::vector<uint>> members(group_count(grouping));
    const std::vector<uint> of = groups(grouping);
    for (uint face = 0; face < of.size(); ++face)
        if (state_->areas[face] > 0) members[of[face]].push_back(face);
    return members;
}

std::vector<double> Faces::areas_of(const std::vector<std::vector<uint>>& groups) const {
    std::vector<double> areas;
    for (const std::vector<uint>& group : groups) {
        double area = 0;
        for (const uint face : group) area += state_->areas[face];
        areas.push_back(area);
    }
    return areas;
}

std::uint64_t Faces::bytes() const {
    return bytes_of(state_->meshes) + state_->instance_buffer.bytes() + state_->face_buffer.bytes();
}

}  // namespace twinray
