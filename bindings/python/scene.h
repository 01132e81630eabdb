// The scene of twinray's Python package, without Python: meshes by number on one accelerator, and queries of them. Any
// thread may call; calls on one device take turns.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

#include <sys/mman.h>
#include <unistd.h>

#include <twinray/queries.h>
#include <twinray/tlas.h>

namespace twinray::python {

// Large arrays lie in huge pages where the system has them, as NumPy's do: touching 20 MB for the first time in pages
// of 4 KB takes half as long as tracing a million rays.
template <class T>
class Column {
    static_assert(std::is_trivially_copyable_v<T>);

  public:
    Column() = default;
    explicit Column(std::size_t count) : items_(static_cast<T*>(allocate(count * sizeof(T)))), count_(count) {}
    std::size_t size() const { return count_; }
    T* data() const { return items_.get(); }
    T& operator[](std::size_t i) const { return items_.get()[i]; }

  private:
    static void* allocate(std::size_t bytes) {
        constexpr std::size_t huge = std::size_t{2} << 20;
        const std::size_t alignment = bytes < huge ? alignof(std::max_align_t) : huge;
        const std::size_t rounded = (bytes + alignment - 1) / alignment * alignment;
        void* memory = std::aligned_alloc(alignment, rounded ? rounded : alignment);
        if (!memory) throw std::bad_alloc();
        if (alignment == huge) madvise(memory, rounded, MADV_HUGEPAGE);
        return memory;
    }
    struct Free {
        void operator()(T* items) const { std::free(items); }
    };
    std::unique_ptr<T, Free> items_;
    std::size_t count_ = 0;
};

// These have no initial value, unlike twinray's vectors, which are 0 at first.
struct Numbers2 {
    float x, y;
};
struct Numbers3 {
    float x, y, z;
};

// A recursive mutex that threads get in turn: a waiting thread comes before one that asks again.
class TurnMutex {
  public:
    using Clock = std::chrono::steady_clock;
    bool try_lock_until(Clock::time_point end);
    void lock() { static_cast<void>(try_lock_until(Clock::time_point::max())); }
    bool try_lock() { return try_lock_until(Clock::now()); }
    void unlock();

  private:
    std::timed_mutex next_;  // held by the thread that waits for `held_`
    std::timed_mutex held_;
    std::atomic<std::thread::id> owner_;
    int depth_ = 0;  // how often the owner holds it
};

// One context for all scenes of a device, kept until the end of the program. It does not outlive a fork.
struct Device {
    explicit Device(const std::string& request);
    bool is_of_this_process() const { return process == getpid(); }

    const pid_t process = getpid();
    TurnMutex mutex;
    std::vector<std::string> log;  // warnings that nobody has taken yet
    Context context;
};
// Throws Error with the reason against each device if none fits.
std::shared_ptr<Device> device_for(const std::string& request);
// Scenes that are alive keep theirs.
void forget_devices();

// Keeps other threads from the device while it lives. Throws Error for a device of another process, and Interrupted.
class DeviceLock {
  public:
    explicit DeviceLock(Device& device);
    ~DeviceLock() { device_.mutex.unlock(); }
    DeviceLock(const DeviceLock&) = delete;
    DeviceLock& operator=(const DeviceLock&) = delete;

  private:
    Device& device_;
};

// A lock for destructors, which Python calls with its own lock held. It waits for the device without that lock, since
// the thread that uses the device may need it to look for signals.
class LastLock {
  public:
    explicit LastLock(Device& device);
    ~LastLock() { device_.mutex.unlock(); }
    LastLock(const LastLock&) = delete;
    LastLock& operator=(const LastLock&) = delete;

  private:
    Device& device_;
};

// Places on triangles. Where there is no place, both numbers are 2^32 - 1 and the rest is 0.
struct Places {
    Places() = default;
    Places(std::size_t count, bool with_normals)
        : geometry(count), primitive(count), uv(count), normal(with_normals ? count : 0) {}

    Column<uint> geometry, primitive;
    Column<Numbers2> uv;
    Column<Numbers3> normal;  // unit, of the triangle in world space; empty unless asked for
};

// Rays as Python has them: origin and direction, one after the other, with an interval for all.
struct RayRows {
    std::span<const float> floats = {};    // six per ray
    std::span<const double> doubles = {};  // in place of `floats`
    dvec3 origin = dvec3(0);               // of the device's coordinates, in those of the rays
    double t_near = 0, t_far = std::numeric_limits<double>::infinity();

    std::size_t size() const { return (floats.size() + doubles.size()) / 6; }
};
std::vector<Ray> rays_of(const RayRows& rows);

// The hit of each ray; t is infinite for a miss.
struct Cast {
    Column<float> t;
    Column<double> far_t;  // in place of t if a ray began far from the scene
    Places places;
};

// The hits of a ray, ascending by t, are those from first[ray] to first[ray + 1] - 1.
struct Listed {
    std::vector<std::uint64_t> first;
    Cast hits;
};

// The nearest place to each point; the distance is infinite if nothing is found.
struct Nearest {
    Column<dvec3> position;
    Column<double> distance;
    Places places;
};

// All that was pushed: meshes, and the geometries that place them, by number. `count` numbers were given.
struct Content {
    struct Geometry {
        uint number, mesh;
        Transform transform;
        bool is_flat;
    };
    std::vector<SharedMesh> meshes;
    std::vector<Geometry> geometries;
    uint count = 0;
};

// A scene. In a child process it opens the device once more and pushes its contents there.
class Scene {
  public:
    static constexpr uint most_geometries = 1u << 24;  // custom indices have 24 bits

    // accel: "auto", "sw" or "hw"; device: as ContextDesc::device; level: as name_of(Level).
    Scene(const std::string& accel, const std::string& device, const std::string& level);
    ~Scene();

    // Returns the number of the new geometry: 0, 1, ...; none is given twice. Throws Error as AbstractAccel::push does.
    uint add(Mesh&& mesh, const Transform& transform);
    uint add_instance(uint of, const Transform& transform);
    // Adds a geometry for each instance of the file. Throws Error as load_scene() does, which gets `origin`. If that
    // was not set, it becomes the one that load_scene() chose.
    std::vector<uint> add_file(const std::string& file, std::optional<dvec3>& origin);
    void remove(uint geometry);
    void set_transform(uint geometry, const Transform& transform);
    // Changes all instances of the mesh.
    void update_vertices(uint geometry, std::vector<vec3>&& positions);
    std::vector<uint> geometries();
    std::size_t triangle_count();
    std::vector<std::uint64_t> first_faces();  // by number, and their count at the end
    Bounds bounds();                           // in world space
    struct Reach {
        float farthest = 0, extent = 0;
    };
    Reach reach(uint geometry);  // its largest coordinate in world space and its largest side, or a little more
    Content content();
    // Fills a scene that holds nothing yet. Throws Error for numbers that name nothing and as AbstractAccel::push does;
    // the scene is then unusable.
    void restore(Content&& content);

    Cast cast(const RayRows& rows, bool with_normals);
    Column<bool> occlusions(const RayRows& rows);
    Column<int> counts(const RayRows& rows);
    Listed list(const RayRows& rows, bool with_normals);

    Nearest closest(std::span<const dvec3> points, bool with_normals);
    std::vector<double> winding_numbers(std::span<const dvec3> points);  // generalized ones, where meshes are open
    // Returns three vertices per triangle. Mirrored ones have the last two exchanged, so that fronts stay fronts.
    std::vector<dvec3> world_triangles();

    // Returns what computes, each with its name.
    std::vector<std::pair<const char*, std::string>> backend();
    std::vector<std::string> take_log();
    // Returns the device of this process.
    std::shared_ptr<Device> device();

    // The view factors that are being computed, or were last: how many of their rows are done, and how many there are.
    // It can be read at any time.
    struct Progress {
        std::atomic<std::uint64_t> done = 0, total = 0;
    };
    Progress& progress() { return progress_; }

    class Lock : DeviceLock {
      public:
        explicit Lock(Scene& scene) : DeviceLock(scene.open_device()) {}
    };
    // While it lives, no other thread uses the scene's device.
    class Turn {
      public:
        explicit Turn(Scene& scene) : scene_(scene), lock_(scene) {}
        AbstractAccel& accel() const { return *scene_.accel_; }
        Level level() const { return scene_.level_; }

      private:
        Scene& scene_;
        Lock lock_;
    };

  private:
    // The accelerator's own arrays.
    struct KeptMesh : SharedMesh {
        std::optional<Bounds> box = {};  // set when first asked for
        const Bounds& bounds();
    };
    struct Part {
        AccelHandle handle;
        std::shared_ptr<KeptMesh> mesh;
        Transform transform;
        AccelHandle listed = {};  // in lister_, while that exists
        bool is_flat = false;     // by the transform that it was added with; see twinray::flatten()
    };

    void make_empty();
    void leave();
    // Returns the device of this process. Throws Error if there is none.
    Device& open_device();
    void push_parts(AbstractAccel& accel, AccelHandle Part::*handle);
    Part& part(uint geometry, const char* action);
    Part& movable(uint geometry, const char* action);  // throws Error for a flat one
    uint keep(AccelHandle handle, std::shared_ptr<KeptMesh> mesh, const Transform& transform);
    void changed();
    void forget_lister();
    InstanceOptions options_of_next() const;
    static AccelHandle push_instance(AbstractAccel& accel, AccelHandle pushed, const Transform& transform,
                                     const InstanceOptions& options);
    Numbers3 normal_of(uint geometry, uint primitive) const;
    // Writes a place. Both numbers are 2^32 - 1 for none.
    void put(const Places& places, std::size_t i, uint geometry, uint primitive, Numbers2 uv) const;
    static Bounds around(const Part& part);
    Bounds around() const;
    void put(const Cast& cast, std::size_t first, std::span<const Hit> hits) const;
    template <class Trace>
    void in_blocks(const RayRows& rows, const Trace& trace);
    AbstractAccel& lister();
    HitsOfRays all_hits(std::span<const Ray> rays);
    PointQuery& points();

    std::string request_;  // of the device
    std::string accel_name_;
    Level level_;
    std::shared_ptr<Device> device_;
    std::atomic<pid_t> process_ = getpid();  // of the device
    AccelChoice choice_;
    std::unique_ptr<AbstractAccel> accel_;
    std::vector<std::optional<Part>> parts_;  // by number
    std::vector<Ray> rays_;     // of a block, kept since touching new memory costs as much as tracing its rays
    std::vector<double> ways_;  // by how much of t each of them was brought near the scene
    std::unique_ptr<AbstractAccel> lister_;  // software that lists: a driver's structures promise nothing at edges
    std::unique_ptr<AllHits> all_hits_;
    std::unique_ptr<PointQuery> points_;
    Progress progress_;
    bool is_searchable_ = false;    // points_ holds what the accelerator does
    std::optional<Bounds> bounds_;  // of all geometries; set when first asked for
};

}  // namespace twinray::python
