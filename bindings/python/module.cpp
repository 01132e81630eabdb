// twinray._core: scene.h and analyses for Python, and memory that Python's array packages share. Arguments are checked
// and cast in Python, which has the public names.
#include <atomic>
#include <tuple>
#include <utility>

#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>

#include "bindings/python/convert.h"

namespace twinray::python {
namespace {

using PointRows = Rows<double, 3>;
using TransformRows = nb::ndarray<const float, nb::shape<3, 4>, nb::c_contig, nb::device::cpu>;

template <class Row, class Array>
std::vector<Row> copied(const Array& rows) {
    const std::span<const Row> span = as<Row>(rows);
    return {span.begin(), span.end()};
}

Transform transform_of(const TransformRows& matrix) {
    Transform transform;
    for (std::size_t i = 0; i < 12; ++i) transform.rows[i / 4][i % 4] = matrix.data()[i];
    return transform;
}

std::atomic<bool> calls_end = false;

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

// Binds a question about rays in numbers of type T, which are not converted.
template <class T, class... More, class Answer, class... Args>
void bind_question(nb::class_<Scene>& scene_class, const char* name, const Answer& answer, const Args&... more) {
    scene_class.def(
        name,
        [answer](Scene& scene, const RayArray<T>& array, const Vector& origin, double t_near, double t_far,
                 More... options) { return answer(scene, rows_of(array, origin, t_near, t_far), options...); },
        nb::arg("rays").noconvert(), nb::arg("origin"), nb::arg("t_near"), nb::arg("t_far"), more...);
}

template <class T>
void bind_rays(nb::class_<Scene>& scene_class) {
    const nb::arg normals("with_normals");
    bind_question<T, bool>(
        scene_class, "cast",
        [](Scene& scene, const RayRows& rows, bool with_normals) {
            return dict_of(unlocked([&] { return scene.cast(rows, with_normals); }));
        },
        normals);
    bind_question<T>(scene_class, "occlusions", [](Scene& scene, const RayRows& rows) {
        return given<bool>(unlocked([&] { return scene.occlusions(rows); }));
    });
    bind_question<T>(scene_class, "counts", [](Scene& scene, const RayRows& rows) {
        return given<int>(unlocked([&] { return scene.counts(rows); }));
    });
    bind_question<T, bool>(
        scene_class, "list",
        [](Scene& scene, const RayRows& rows, bool with_normals) {
            Listed found = unlocked([&] { return scene.list(rows, with_normals); });
            return nb::make_tuple(given<std::uint64_t>(std::move(found.first)), dict_of(std::move(found.hits)));
        },
        normals);
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
        .def("backend",
             [](Scene& scene) {
                 nb::dict names;
                 for (const auto& [name, value] : unlocked([&] { return scene.backend(); })) names[name] = value;
                 return names;
             })
        .def("progress",
             [](Scene& scene) { return nb::make_tuple(scene.progress().done.load(), scene.progress().total.load()); })
        .def("take_log", [](Scene& scene) { return unlocked([&] { return scene.take_log(); }); });
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

bool no_signal_ends_it() {
    const nb::gil_scoped_acquire acquired;
    if (calls_end) PyErr_SetNone(PyExc_KeyboardInterrupt);
    return !calls_end && PyErr_CheckSignals() == 0;
}

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
