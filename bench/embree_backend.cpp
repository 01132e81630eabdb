// Embree 3 as backends: its scenes, its calls for many rays, and the variants of both.

#include <embree3/rtcore.h>

#include <algorithm>
#include <atomic>

#include "bench/measure.h"
#include "engine/core/device_properties.h"
#include "engine/core/error.h"
#include "engine/core/parallel.h"
#include "validation/cpu_reference/flush_denormals.h"

namespace twinray::bench {
namespace {

struct EmbreeOptions {
    RTCBuildQuality quality = RTC_BUILD_QUALITY_MEDIUM;           // of a scene
    RTCBuildQuality geometry_quality = RTC_BUILD_QUALITY_MEDIUM;  // heeded in scenes of quality low alone
    RTCSceneFlags flags = RTC_SCENE_FLAG_NONE;
    unsigned threads = 1;
};

// Meshes with one instance that is not moved lie in the top scene, all others under instances.
class EmbreeScene {
  public:
    explicit EmbreeScene(const EmbreeOptions& options)
        : options_(options), device_(rtcNewDevice(text("threads=", options.threads).c_str())) {
        if (!device_) fail("Embree: no device: error ", static_cast<int>(rtcGetDeviceError(nullptr)));
        rtcSetDeviceMemoryMonitorFunction(device_.get(), count_bytes, this);
    }

    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    BuildFigures build(const Scene& scene) {
        top_.reset();
        bottoms_.clear();
        meshes_.clear();
        const std::int64_t before = bytes_;
        peak_bytes_ = before;

        const Stopwatch whole;
        std::vector<uint> uses(scene.meshes.size());
        for (const Instance& instance : scene.instances) ++uses[instance.mesh];
        for (const Mesh& mesh : scene.meshes) {
            meshes_.push_back({mesh.positions, mesh.triangles});
            meshes_.back().positions.emplace_back(0.0f);
        }
        bottoms_.resize(meshes_.size());

        const Stopwatch building;
        top_ = make_scene();
        for (uint i = 0; i < scene.instances.size(); ++i) {
            const Instance& instance = scene.instances[i];
            const PaddedMesh& mesh = meshes_[instance.mesh];
            if (mesh.triangles.empty()) continue;
            if (uses[instance.mesh] == 1 && instance.transform == Transform()) {
                attach(top_.get(), triangles_of(mesh), i);
                continue;
            }
            ScenePointer& bottom = bottoms_[instance.mesh];
            if (!bottom) {
                bottom = make_scene();
                attach(bottom.get(), triangles_of(mesh), 0);
                rtcCommitScene(bottom.get());
            }
            GeometryPointer placed(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE));
            rtcSetGeometryInstancedScene(placed.get(), bottom.get());
            rtcSetGeometryTransform(placed.get(), 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, &instance.transform);
            attach(top_.get(), std::move(placed), i);
        }
        rtcCommitScene(top_.get());
        const double ms = building.ms(), wall_ms = whole.ms();
        check("build");
        return {ms, wall_ms, static_cast<std::uint64_t>(bytes_ - before),
                static_cast<std::uint64_t>(peak_bytes_ - bytes_)};
    }

    RTCScene top() const { return top_.get(); }
    unsigned threads() const { return options_.threads; }

  private:
    // Embree reads 16 bytes where the last vertex has 12.
    struct PaddedMesh {
        std::vector<vec3> positions;
        std::vector<uvec3> triangles;
    };
    template <auto release>
    struct Release {
        template <class T>
        void operator()(T* object) const {
            release(object);
        }
    };
    using DevicePointer = std::unique_ptr<RTCDeviceTy, Release<rtcReleaseDevice>>;
    using ScenePointer = std::unique_ptr<RTCSceneTy, Release<rtcReleaseScene>>;
    using GeometryPointer = std::unique_ptr<RTCGeometryTy, Release<rtcReleaseGeometry>>;

    static bool count_bytes(void* scene, ssize_t bytes, bool) {
        auto& self = *static_cast<EmbreeScene*>(scene);
        const std::int64_t now = self.bytes_ += bytes;
        std::int64_t peak = self.peak_bytes_;
        while (peak < now && !self.peak_bytes_.compare_exchange_weak(peak, now)) {}
        return true;
    }

    void check(const char* action) const {
        const RTCError error = rtcGetDeviceError(device_.get());
        if (error != RTC_ERROR_NONE) fail("Embree: ", action, ": error ", static_cast<int>(error));
    }

    ScenePointer make_scene() const {
        ScenePointer scene(rtcNewScene(device_.get()));
        rtcSetSceneFlags(scene.get(), options_.flags);
        rtcSetSceneBuildQuality(scene.get(), options_.quality);
        return scene;
    }

    void attach(RTCScene scene, GeometryPointer geometry, uint id) const {
        rtcSetGeometryBuildQuality(geometry.get(), options_.geometry_quality);
        rtcCommitGeometry(geometry.get());
        rtcAttachGeometryByID(scene, geometry.get(), id);
    }

    GeometryPointer triangles_of(const PaddedMesh& mesh) const {
        GeometryPointer geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
        rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions.data(),
                                   0, sizeof(vec3), mesh.positions.size() - 1);
        rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                                   sizeof(uvec3), mesh.triangles.size());
        return geometry;
    }

    EmbreeOptions options_;
    std::atomic<std::int64_t> bytes_ = 0, peak_bytes_ = 0;
    DevicePointer device_;
    std::vector<PaddedMesh> meshes_;
    std::vector<ScenePointer> bottoms_;  // by mesh; null where it has no scene of its own
    ScenePointer top_;
};

// Rays and hits of a trace by Embree's calls for many rays.
struct EmbreeTrace {
    RTCScene scene;
    Query query;
    std::span<const Ray> rays;
    std::span<Hit> hits;  // one for each ray
};

constexpr std::size_t packet = 8;
constexpr std::size_t stream = 256;

struct Found {
    float t, u, v;
    uint primitive, geometry, instance;
};

// Instances, and meshes without one, are attached under the index of the instance.
Hit hit_of(const Found& found) {
    if (found.geometry == RTC_INVALID_GEOMETRY_ID) return miss();
    Hit hit = miss();
    hit.hit = 1;
    hit.t = found.t;
    hit.primitive_index = found.primitive;
    hit.u = found.u;
    hit.v = found.v;
    hit.instance_index = found.instance == RTC_INVALID_GEOMETRY_ID ? found.geometry : found.instance;
    return hit;
}

// Embree sets the end of rays that are occluded to minus infinity.
Hit occlusion_of(float t_far) {
    Hit hit = miss();
    if (t_far < 0) {
        hit.hit = 1;
        hit.t = 0;
    }
    return hit;
}

void set(RTCRay8& packed, std::size_t i, const Ray& ray) {
    packed.org_x[i] = ray.origin.x;
    packed.org_y[i] = ray.origin.y;
    packed.org_z[i] = ray.origin.z;
    packed.tnear[i] = ray.t_min;
    packed.dir_x[i] = ray.direction.x;
    packed.dir_y[i] = ray.direction.y;
    packed.dir_z[i] = ray.direction.z;
    packed.tfar[i] = ray.t_max;
    packed.time[i] = 0;
    packed.mask[i] = ~0u;
    packed.id[i] = 0;
    packed.flags[i] = 0;
}

RTCRay ray_of(const Ray& ray) {
    return {ray.origin.x,
            ray.origin.y,
            ray.origin.z,
            ray.t_min,
            ray.direction.x,
            ray.direction.y,
            ray.direction.z,
            0,
            ray.t_max,
            ~0u,
            0,
            0};
}

void trace_packet(const EmbreeTrace& part, RTCIntersectContext& context) {
    const auto& [scene, query, rays, hits] = part;
    alignas(32) std::array<int, packet> valid{};
    RTCRayHit8 packed;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        valid[i] = -1;
        set(packed.ray, i, rays[i]);
        packed.hit.geomID[i] = packed.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    if (query == Query::any) {
        rtcOccluded8(valid.data(), scene, &context, &packed.ray);
        for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = occlusion_of(packed.ray.tfar[i]);
        return;
    }
    rtcIntersect8(valid.data(), scene, &context, &packed);
    for (std::size_t i = 0; i < rays.size(); ++i)
        hits[i] = hit_of({packed.ray.tfar[i], packed.hit.u[i], packed.hit.v[i], packed.hit.primID[i],
                          packed.hit.geomID[i], packed.hit.instID[0][i]});
}

void trace_stream(const EmbreeTrace& part, RTCIntersectContext& context) {
    const auto& [scene, query, rays, hits] = part;
    const auto count = static_cast<unsigned>(rays.size());
    if (query == Query::any) {
        std::array<RTCRay, stream> list;
        std::ranges::transform(rays, list.begin(), ray_of);
        rtcOccluded1M(scene, &context, list.data(), count, sizeof(RTCRay));
        for (std::size_t i = 0; i < count; ++i) hits[i] = occlusion_of(list[i].tfar);
        return;
    }
    std::array<RTCRayHit, stream> list;
    for (std::size_t i = 0; i < count; ++i) {
        list[i].ray = ray_of(rays[i]);
        list[i].hit.geomID = list[i].hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect1M(scene, &context, list.data(), count, sizeof(RTCRayHit));
    for (std::size_t i = 0; i < count; ++i)
        hits[i] = hit_of({list[i].ray.tfar, list[i].hit.u, list[i].hit.v, list[i].hit.primID, list[i].hit.geomID,
                          list[i].hit.instID[0]});
}

// Rays go in packets of 8 (rtcIntersect8, rtcOccluded8) or in streams of 256 (rtcIntersect1M, rtcOccluded1M), in the
// given order; streams are told whether they are coherent.
void trace_parts(const EmbreeTrace& whole, bool in_streams, bool is_coherent) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (in_streams && is_coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    const std::size_t size = in_streams ? stream : packet;
    for (std::size_t begin = 0; begin < whole.rays.size(); begin += size) {
        const std::size_t count = std::min(size, whole.rays.size() - begin);
        const EmbreeTrace part{whole.scene, whole.query, whole.rays.subspan(begin, count),
                               whole.hits.subspan(begin, count)};
        (in_streams ? trace_stream : trace_packet)(part, context);
    }
}

class EmbreeBackend : public Backend {
  public:
    EmbreeBackend(Labels labels, const EmbreeOptions& options, bool in_streams)
        : Backend(std::move(labels)), scene_(options), in_streams_(in_streams) {}

    BuildFigures build(const Scene& scene) override { return scene_.build(scene); }

    double trace(const RayBatch& batch) override {
        const std::span<const Ray> rays = batch.rays();
        hits_.resize(rays.size());
        const Stopwatch watch;
        const auto trace_tiles = [&](std::size_t begin, std::size_t end) {
            const FlushDenormals flush;  // as Embree asks its callers to
            const std::size_t first = begin * rays_a_tile, count = std::min(end * rays_a_tile, rays.size()) - first;
            trace_parts(
                {scene_.top(), batch.query(), rays.subspan(first, count), std::span(hits_).subspan(first, count)},
                in_streams_, batch.is_coherent());
        };
        parallel_for(count_tiles(rays.size()), trace_tiles, scene_.threads());
        return watch.ms();
    }

    std::vector<Hit> hits(const RayBatch&) const override { return hits_; }

  private:
    EmbreeScene scene_;
    bool in_streams_;
    std::vector<Hit> hits_;
};

struct Variant {
    const char* name;
    const char* quality_name;
    RTCBuildQuality quality, geometry_quality;
    RTCSceneFlags flags = RTC_SCENE_FLAG_NONE;
    bool in_streams = false;
};

constexpr RTCBuildQuality low = RTC_BUILD_QUALITY_LOW, medium = RTC_BUILD_QUALITY_MEDIUM, high = RTC_BUILD_QUALITY_HIGH;
constexpr Variant variants[] = {
    {"embree8", "medium", medium, medium},
    {"embree8 robust", "medium", medium, medium, RTC_SCENE_FLAG_ROBUST},
    {"embree8 low", "low", low, low},                 // Morton codes
    {"embree8 low scene", "low scene", low, medium},  // binned SAH in two levels
    {"embree8 high", "high", high, high},             // spatial splits
    {"embree stream", "medium", medium, medium, RTC_SCENE_FLAG_NONE, true},
};

}  // namespace

LineUp embree_line_up(const std::function<bool(const std::string&)>& is_wanted) {
    LineUp line_up;
    for (const Variant& variant : variants) {
        if (!is_wanted(variant.name)) continue;
        Labels labels{.name = variant.name,
                      .backend = "embree",
                      .path = variant.in_streams ? "stream" : "packets of 8",
                      .builder = variant.quality_name,
                      .level = variant.flags == RTC_SCENE_FLAG_ROBUST ? "robust" : "fast"};
        line_up.push_back(std::make_unique<EmbreeBackend>(
            std::move(labels),
            EmbreeOptions{variant.quality, variant.geometry_quality, variant.flags, count_cpu_threads()},
            variant.in_streams));
    }
    return line_up;
}

std::string why_no_embree() { return ""; }

}  // namespace twinray::bench
