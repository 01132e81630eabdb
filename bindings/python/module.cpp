// SPDX-License-Identifier: MIT
// twinray._core: scene.h and analysis.h for Python, and memory that Python's array packages share. Arguments are
// checked and cast in Python, which has the public names. One file of more than 400 lines, since all bindings share the
// helpers that convert arrays and give back Python's lock.
#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>
#include <tuple>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "bindings/python/analysis.h"
#include "bindings/python/parallel.h"
#include "bindings/python/scene.h"

namespace twinray::python {
namespace {

namespace nb = nanobind;

// Rows of N numbers; the Python side has cast and checked them.
template <class T, int N>
using Rows = nb::ndarray<const T, nb::shape<-1, N>, nb::c_contig, nb::device::cpu>;

// Rows as structs of the same numbers.
template <class Row, class Array>
std::span<const Row> as(const Array& rows) {
    static_assert(sizeof(Row) == 3 * sizeof(*rows.data()));
    return {reinterpret_cast<const Row*>(rows.data()), rows.shape(0)};
}

// Makes an array that owns its memory, of `columns` numbers of type T a row; 0: one number, without the second axis.
template <class T, class Rows>
nb::object given(Rows&& rows, std::size_t columns = 0) {
    auto owner = std::make_unique<Rows>(std::move(rows));
    const std::size_t shape[] = {owner->size(), columns};
    auto* data = reinterpret_cast<T*>(owner->data());
    nb::capsule capsule(owner.get(), [](void* p) noexcept { delete static_cast<Rows*>(p); });
    owner.release();
    return nb::cast(nb::ndarray<nb::numpy, T>(data, columns ? 2 : 1, shape, capsule));
}

template <class T>
using RayArray = Rows<T, 6>;
using Vector = std::array<double, 3>;
using PointRows = Rows<double, 3>;
using TransformRows = nb::ndarray<const float, nb::shape<3, 4>, nb::c_contig, nb::device::cpu>;

dvec3 vector_of(const Vector& v) { return {v[0], v[1], v[2]}; }

template <class T>
RayRows rows_of(const RayArray<T>& array, const Vector& origin) {
    const std::span<const T> numbers(array.data(), 6 * array.shape(0));
    if constexpr (std::is_same_v<T, float>)
        return {.floats = numbers, .doubles = {}, .origin = vector_of(origin)};
    else
        return {.floats = {}, .doubles = numbers, .origin = vector_of(origin)};
}

template <class T>
RayRows rows_of(const RayArray<T>& array, const Vector& origin, double t_near, double t_far) {
    RayRows rows = rows_of(array, origin);
    rows.t_near = t_near, rows.t_far = t_far;
    return rows;
}

Transform transform_of(const TransformRows& matrix) {
    Transform transform;
    for (std::size_t i = 0; i < 12; ++i) transform.rows[i / 4][i % 4] = matrix.data()[i];
    return transform;
}

template <class Row, class Array>
std::vector<Row> copied(const Array& rows) {
    const std::span<const Row> span = as<Row>(rows);
    return {span.begin(), span.end()};
}

std::atomic<bool> calls_end = false;

bool no_signal_ends_it() {
    const nb::gil_scoped_acquire acquired;
    if (calls_end) PyErr_SetNone(PyExc_KeyboardInterrupt);
    return !calls_end && PyErr_CheckSignals() == 0;
}

// Calls without the GIL, so that others go on while the device works. Ctrl-C ends the call.
template <class Call>
auto unlocked(const Call& call) {
    try {
        const nb::gil_scoped_release released;
        const InterruptScope scope(&no_signal_ends_it);
        return call();
    } catch (const Interrupted&) {
        throw nb::python_error();  // the one of the signal's handler
    }
}

void add_places(nb::dict& arrays, Places&& places) {
    arrays["geometry_ids"] = given<uint>(std::move(places.geometry));
    arrays["primitive_ids"] = given<uint>(std::move(places.primitive));
    arrays["primitive_uvs"] = given<float>(std::move(places.uv), 2);
    if (places.normal.size()) arrays["primitive_normals"] = given<float>(std::move(places.normal), 3);
}

nb::dict dict_of(Cast&& hits) {
    nb::dict arrays;
    arrays["t_hit"] = hits.far_t.size() ? given<double>(std::move(hits.far_t)) : given<float>(std::move(hits.t));
    add_places(arrays, std::move(hits.places));
    return arrays;
}

nb::dict dict_of(Nearest&& found) {
    nb::dict arrays;
    arrays["points"] = given<double>(std::move(found.position), 3);
    arrays["distances"] = given<double>(std::move(found.distance));
    add_places(arrays, std::move(found.places));
    return arrays;
}

nb::dict dict_of(const Backend& backend) {
    nb::dict names;
    names["device"] = backend.device;
    names["driver"] = backend.driver;
    names["kind"] = backend.kind;
    names["accel"] = backend.accel;
    names["why"] = backend.why;
    names["path"] = backend.path;
    names["level"] = backend.level;
    names["lists"] = backend.lists;
    return names;
}

uint add(Scene& scene, const Rows<float, 3>& positions, const Rows<uint, 3>& triangles,
         const TransformRows& transform) {
    Mesh mesh;
    mesh.positions = copied<vec3>(positions);
    mesh.triangles = copied<uvec3>(triangles);
    const Transform placed = transform_of(transform);
    return unlocked([&] { return scene.add(std::move(mesh), placed); });
}

nb::object corners_of(const Bounds& box) {
    std::vector<Vector> corners{{box.lo.x, box.lo.y, box.lo.z}, {box.hi.x, box.hi.y, box.hi.z}};
    return given<double>(std::move(corners), 3);
}

// Binds questions about rays in float32 or float64, which are not converted.
template <class T>
void bind_rays(nb::class_<Scene>& scene_class) {
    const auto rays = nb::arg("rays").noconvert();
    const nb::arg origin("origin"), near("t_near"), far("t_far"), normals("with_normals");
    scene_class
        .def(
            "cast",
            [](Scene& scene, const RayArray<T>& array, const Vector& origin, double t_near, double t_far,
               bool with_normals) {
                const RayRows rows = rows_of(array, origin, t_near, t_far);
                return dict_of(unlocked([&] { return scene.cast(rows, with_normals); }));
            },
            rays, origin, near, far, normals)
        .def(
            "occlusions",
            [](Scene& scene, const RayArray<T>& array, const Vector& origin, double t_near, double t_far) {
                const RayRows rows = rows_of(array, origin, t_near, t_far);
                return given<bool>(unlocked([&] { return scene.occlusions(rows); }));
            },
            rays, origin, near, far)
        .def(
            "counts",
            [](Scene& scene, const RayArray<T>& array, const Vector& origin, double t_near, double t_far) {
                const RayRows rows = rows_of(array, origin, t_near, t_far);
                return given<int>(unlocked([&] { return scene.counts(rows); }));
            },
            rays, origin, near, far)
        .def(
            "list",
            [](Scene& scene, const RayArray<T>& array, const Vector& origin, double t_near, double t_far,
               bool with_normals) {
                const RayRows rows = rows_of(array, origin, t_near, t_far);
                Listed found = unlocked([&] { return scene.list(rows, with_normals); });
                return nb::make_tuple(given<std::uint64_t>(std::move(found.first)), dict_of(std::move(found.hits)));
            },
            rays, origin, near, far, normals);
}

nb::tuple add_file(Scene& scene, const std::string& file, const std::optional<Vector>& asked) {
    std::optional<dvec3> origin;
    if (asked) origin = vector_of(*asked);
    const std::vector<uint> added = unlocked([&] { return scene.add_file(file, origin); });
    return nb::make_tuple(added, nb::make_tuple(origin->x, origin->y, origin->z));
}

// Returns (positions, triangles) of each mesh, (number, mesh, transform, is_flat) of each geometry, and the count of
// numbers given.
nb::tuple bound_content(Scene& scene) {
    Content content = unlocked([&] { return scene.content(); });
    nb::list meshes, geometries;
    for (const SharedMesh& mesh : content.meshes) {
        std::vector<vec3> positions(mesh.positions.begin(), mesh.positions.end());
        std::vector<uvec3> triangles(mesh.triangles.begin(), mesh.triangles.end());
        meshes.append(nb::make_tuple(given<float>(std::move(positions), 3), given<uint>(std::move(triangles), 3)));
    }
    for (const auto& [number, mesh, transform, is_flat] : content.geometries) {
        std::vector<vec4> rows(transform.rows.begin(), transform.rows.end());
        geometries.append(nb::make_tuple(number, mesh, given<float>(std::move(rows), 4), is_flat));
    }
    return nb::make_tuple(meshes, geometries, content.count);
}

void restore(Scene& scene, const std::vector<std::pair<Rows<float, 3>, Rows<uint, 3>>>& meshes,
             const std::vector<std::tuple<uint, uint, TransformRows, bool>>& geometries, uint count) {
    Content content{.meshes = {}, .geometries = {}, .count = count};
    for (const auto& [positions, triangles] : meshes)
        content.meshes.push_back({"", copied<vec3>(positions), copied<uvec3>(triangles)});
    for (const auto& [number, mesh, transform, is_flat] : geometries)
        content.geometries.push_back({number, mesh, transform_of(transform), is_flat});
    unlocked([&] { scene.restore(std::move(content)); });
}

void bind_scene(nb::module_& m) {
    nb::class_<Scene> scene_class(m, "Scene");
    bind_rays<float>(scene_class);
    bind_rays<double>(scene_class);
    scene_class
        .def("__init__", [](Scene* place, const std::string& accel, const std::string& device,
                            const std::string& level) { unlocked([&] { new (place) Scene(accel, device, level); }); })
        .def("add", &add)
        .def("add_instance",
             [](Scene& scene, uint of, const TransformRows& matrix) {
                 return unlocked([&] { return scene.add_instance(of, transform_of(matrix)); });
             })
        .def("add_file", &add_file)
        .def("remove", [](Scene& scene, uint geometry) { unlocked([&] { scene.remove(geometry); }); })
        .def("content", &bound_content)
        .def("restore", &restore)
        .def("set_transform",
             [](Scene& scene, uint geometry, const TransformRows& matrix) {
                 unlocked([&] { scene.set_transform(geometry, transform_of(matrix)); });
             })
        .def("update_vertices",
             [](Scene& scene, uint geometry, const Rows<float, 3>& positions) {
                 unlocked([&] { scene.update_vertices(geometry, copied<vec3>(positions)); });
             })
        .def("geometries", [](Scene& scene) { return unlocked([&] { return scene.geometries(); }); })
        .def("triangle_count", [](Scene& scene) { return unlocked([&] { return scene.triangle_count(); }); })
        .def("reach",
             [](Scene& scene, uint geometry) {
                 const Scene::Reach reach = unlocked([&] { return scene.reach(geometry); });
                 return nb::make_tuple(reach.farthest, reach.extent);
             })
        .def("first_faces",
             [](Scene& scene) { return given<std::uint64_t>(unlocked([&] { return scene.first_faces(); })); })
        .def("bounds", [](Scene& scene) { return corners_of(unlocked([&] { return scene.bounds(); })); })
        .def("closest",
             [](Scene& scene, const PointRows& points, bool with_normals) {
                 return dict_of(unlocked([&] { return scene.closest(as<dvec3>(points), with_normals); }));
             })
        .def("winding_numbers",
             [](Scene& scene, const PointRows& points) {
                 return given<double>(unlocked([&] { return scene.winding_numbers(as<dvec3>(points)); }));
             })
        .def("world_triangles",
             [](Scene& scene) { return given<double>(unlocked([&] { return scene.world_triangles(); }), 3); })
        .def("backend", [](Scene& scene) { return dict_of(unlocked([&] { return scene.backend(); })); })
        .def("progress",
             [](Scene& scene) { return nb::make_tuple(scene.progress().done.load(), scene.progress().total.load()); })
        .def("take_log", [](Scene& scene) { return unlocked([&] { return scene.take_log(); }); });
}

nb::dict bound_rows(MatrixRows& rows, std::size_t first, std::size_t last) {
    Matrix matrix = unlocked([&] { return rows.rows(first, last); });
    nb::dict arrays;
    arrays["first"] = given<std::uint64_t>(std::move(matrix.first));
    arrays["column"] = given<uint>(std::move(matrix.column));
    arrays["value"] = given<float>(std::move(matrix.value));
    arrays["low"] = given<float>(std::move(matrix.low));
    arrays["high"] = given<float>(std::move(matrix.high));
    arrays["open"] = given<double>(std::move(matrix.open));
    arrays["rays"] = matrix.rays;
    return arrays;
}

void make_rows(MatrixRows* to, Scene& scene, std::vector<uint> groups, bool both_sides, std::uint64_t rays,
               std::optional<double> target_error, std::uint32_t seed, const std::string& estimator) {
    unlocked([&] { new (to) MatrixRows(scene, {std::move(groups), both_sides, rays, target_error, seed, estimator}); });
}

nb::tuple bound_centroid(Scene& scene, const Vector& direction, std::uint32_t side, std::uint64_t seed) {
    const Centroid found = unlocked([&] { return centroid_of(scene, vector_of(direction), side, seed); });
    const auto tuple = [](const std::optional<dvec3>& v) {
        return v ? nb::object(nb::make_tuple(v->x, v->y, v->z)) : nb::object(nb::none());
    };
    return nb::make_tuple(tuple(found.mean), tuple(found.standard_error), found.point_count, found.ray_count);
}

template <class T>
nb::dict bound_verify(Scene& scene, const RayArray<T>& array, const Vector& origin, std::size_t count,
                      std::uint64_t seed) {
    std::vector<Ray> rays = rays_of(rows_of(array, origin));
    VerifyResult result = unlocked([&] { return verify(scene, std::move(rays), count, seed); });
    nb::dict counts, found;
    for (std::size_t i = 0; i < hit_class_count; ++i) {
        const std::string_view name = name_of(static_cast<HitClass>(i));
        counts[nb::str(name.data(), name.size())] = result.counts.counts[i];
    }
    found["counts"] = counts;
    found["faults"] = result.counts.faults_of_ours() + result.counts.faults_of_hardware();
    found["bound_95"] = result.counts.bound_95();
    found["classes"] = given<std::uint8_t>(std::move(result.classes));
    found["rays"] = given<float>(std::move(result.rays), 8);
    return found;
}

void bind_analysis(nb::module_& m) {
    nb::class_<MatrixRows>(m, "ViewFactors")
        .def("__init__", &make_rows, nb::keep_alive<1, 2>(), nb::arg("scene"), nb::arg("groups"), nb::arg("both_sides"),
             nb::arg("rays"), nb::arg("target_error").none(), nb::arg("seed"), nb::arg("estimator"))
        .def("count", &MatrixRows::count)
        .def("rows", &bound_rows);
    m.def("illumination", [](Scene& scene, const Vector& direction, std::uint32_t side, bool both_sides,
                             std::uint64_t seed, const std::vector<uint>& groups) {
        Light light =
            unlocked([&] { return illumination(scene, vector_of(direction), side, both_sides, seed, groups); });
        return nb::make_tuple(given<double>(std::move(light.groups), 6), light.rays);
    });
    m.def("sky_light",
          [](Scene& scene, const Vector& zenith, std::uint32_t samples, bool both_sides, std::uint64_t seed) {
              return given<double>(
                  unlocked([&] { return sky_light(scene, vector_of(zenith), samples, both_sides, seed); }), 3);
          });
    m.def("centroid", &bound_centroid);
    m.def("collide", [](Scene& scene, bool self, bool by_position, bool segments) {
        Touching found = unlocked([&] { return collide(scene, self, by_position, segments); });
        return nb::make_tuple(given<uint>(std::move(found.contacts), 5), given<double>(std::move(found.segments), 6));
    });
    const auto unconverted = nb::arg("rays").noconvert();
    m.def("verify", &bound_verify<float>, nb::arg("scene"), unconverted, nb::arg("origin"), nb::arg("count"),
          nb::arg("seed"));
    m.def("verify", &bound_verify<double>, nb::arg("scene"), unconverted, nb::arg("origin"), nb::arg("count"),
          nb::arg("seed"));
    m.def("sky_patches", [](const std::string& name) {
        std::vector<std::array<double, 4>> rows;
        for (const SkyPatch& patch : sky_patches(name))
            rows.push_back({patch.direction.x, patch.direction.y, patch.direction.z, patch.solid_angle});
        return given<double>(std::move(rows), 4);
    });
    m.def("visible", [](Scene& scene, const Rows<float, 3>& points, const Rows<float, 3>& vectors,
                        const Rows<float, 3>& normals, float t_near, float t_far) {
        return given<std::uint8_t>(unlocked(
            [&] { return visible(scene, as<vec3>(points), as<vec3>(vectors), as<vec3>(normals), t_near, t_far); }));
    });
    nb::enum_<HorizonMeasure>(m, "HorizonMeasure")
        .value("slope", HorizonMeasure::slope)
        .value("light", HorizonMeasure::light)
        .value("solid_angle", HorizonMeasure::solid_angle);
    // corner and size: column and row
    m.def("horizon",
          [](Scene& scene, const nb::ndarray<const float, nb::ndim<2>, nb::c_contig, nb::device::cpu>& heights,
             std::array<uint, 2> corner, std::array<uint, 2> size, const Rows<float, 2>& ways, HorizonMeasure measure,
             float lift, float curvature, float reach) {
              const HeightRaster raster{.heights = {heights.data(), heights.size()},
                                        .columns = static_cast<uint>(heights.shape(1)),
                                        .rows = static_cast<uint>(heights.shape(0))};
              const HorizonDesc desc{.corner = {corner[0], corner[1]},
                                     .size = {size[0], size[1]},
                                     .ways = {reinterpret_cast<const vec2*>(ways.data()), ways.shape(0)},
                                     .measure = measure,
                                     .lift = lift,
                                     .curvature = curvature,
                                     .reach = reach};
              return given<float>(unlocked([&] { return horizon(scene, raster, desc); }));
          });
}

Buffer make_buffer(Context& context, std::uint64_t bytes, bool in_host_memory) {
    const BufferDesc desc{.name = "array shared with Python",
                          .bytes = bytes,
                          .memory = in_host_memory ? Memory::readback : Memory::device};
    return in_host_memory ? Buffer(context, desc) : Buffer::exportable(context, desc);
}

// Memory of a scene's device that Python's array packages also see. If the device is a CPU, it lies in the host's
// memory; else it can be exported.
class DeviceMemory {
  public:
    // The host's memory is possible only if the device is a CPU. Throws Error if the device cannot export memory.
    DeviceMemory(Scene& scene, std::uint64_t bytes, bool in_host_memory);
    ~DeviceMemory();

    std::byte* mapped() const { return buffer_.mapped(); }  // null unless it lies in the host's memory
    std::uint64_t bytes() const { return buffer_.bytes(); }
    ExportedMemory exported() const {
        const DeviceLock lock(*device_);
        return buffer_.exported();
    }
    std::array<std::uint8_t, 16> device_uuid() const { return device_->context.properties().uuid; }
    Column<std::byte> download() const;

  private:
    friend void trace(Scene& scene, const DeviceMemory& rays, DeviceMemory& hits, std::size_t count, Query query);

    std::shared_ptr<Device> device_;
    Buffer buffer_;
};

DeviceMemory::DeviceMemory(Scene& scene, std::uint64_t bytes, bool in_host_memory) : device_(scene.device()) {
    const DeviceLock lock(*device_);
    buffer_ = make_buffer(device_->context, bytes, in_host_memory);
}

DeviceMemory::~DeviceMemory() {
    if (!device_->is_of_this_process()) return;
    const LastLock lock(*device_);
    buffer_ = {};
}

Column<std::byte> DeviceMemory::download() const {
    const DeviceLock lock(*device_);
    Column<std::byte> copy(bytes());
    download_bytes(device_->context, buffer_, 0, std::span(copy.data(), copy.size()));
    return copy;
}

// Writes what `count` Rays in one memory meet, as Hits into the other; waits. Throws Error for memory of another
// device.
void trace(Scene& scene, const DeviceMemory& rays, DeviceMemory& hits, std::size_t count, Query query) {
    for (const DeviceMemory* memory : {&rays, static_cast<const DeviceMemory*>(&hits)})
        const DeviceLock lock(*memory->device_);
    const Scene::Turn turn(scene);
    if (rays.device_ != scene.device() || hits.device_ != scene.device())
        throw Error("trace: rays and hits must be arrays of the scene's device");
    turn.accel().sync();
    Commands commands(rays.device_->context, "trace for Python");
    turn.accel().trace(commands, turn.accel().view(),
                       {.rays = rays.buffer_.ref<Ray>(),
                        .hits = hits.buffer_.ref<Hit>(),
                        .count = count,
                        .query = query,
                        .level = turn.level()});
    commands.submit_and_wait();
}

void bind_device_memory(nb::module_& m) {
    nb::class_<DeviceMemory>(m, "DeviceMemory")
        .def("__init__",
             [](DeviceMemory* place, Scene& scene, std::uint64_t bytes, bool in_host_memory) {
                 unlocked([&] { new (place) DeviceMemory(scene, bytes, in_host_memory); });
             })
        .def("mapped",
             [](nb::object self) -> nb::object {
                 const auto& memory = nb::cast<DeviceMemory&>(self);
                 if (!memory.mapped()) return nb::none();
                 const std::size_t shape[] = {memory.bytes()};
                 auto* bytes = reinterpret_cast<std::uint8_t*>(memory.mapped());
                 return nb::cast(nb::ndarray<nb::numpy, std::uint8_t>(bytes, 1, shape, self));
             })
        .def(
            "download",
            [](const DeviceMemory& memory) { return given<std::uint8_t>(unlocked([&] { return memory.download(); })); })
        .def("export_fd",
             [](const DeviceMemory& memory) {
                 const ExportedMemory exported = unlocked([&] { return memory.exported(); });
                 return nb::make_tuple(exported.handle, exported.bytes);
             })
        .def("device_uuid", [](const DeviceMemory& memory) {
            const auto uuid = memory.device_uuid();
            return nb::bytes(reinterpret_cast<const char*>(uuid.data()), uuid.size());
        });
    m.def("trace", [](Scene& scene, const DeviceMemory& rays, DeviceMemory& hits, std::size_t count, bool any_hit) {
        unlocked([&] { trace(scene, rays, hits, count, any_hit ? Query::any : Query::closest); });
    });
}

nb::list devices() {
    nb::list found;
    for (const DeviceProperties& device : unlocked([] { return list_devices(); })) {
        nb::dict properties;
        properties["name"] = device.name;
        properties["driver"] = device.driver;
        properties["kind"] = name_of(device.kind);
        properties["ray_query"] = device.ray_query;
        properties["ray_tracing_pipeline"] = device.ray_tracing_pipeline;
        properties["float64"] = device.shader_float64;
        found.append(properties);
    }
    return found;
}

}  // namespace

LastLock::LastLock(Device& device) : device_(device) {
    const nb::gil_scoped_release released;
    device_.mutex.lock();
}

NB_MODULE(_core, m) {
    // A process may end while others hold a scene: workers of PyTorch's DataLoader do.
    nb::set_leak_warnings(false);
    nb::exception<Error>(m, "Error", PyExc_RuntimeError);
    m.attr("__version__") = TWINRAY_VERSION;
    bind_scene(m);
    bind_analysis(m);
    bind_device_memory(m);
    m.def("devices", &devices);
    m.def("end_calls", [] { calls_end = true; });  // all calls, now and later, in all threads raise KeyboardInterrupt
    m.def("forget_devices", &forget_devices, nb::call_guard<nb::gil_scoped_release>());
}

}  // namespace twinray::python
