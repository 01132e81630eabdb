// SPDX-License-Identifier: MIT
#include "bench/embree_scene.h"

#include "bench/stopwatch.h"
#include "engine/core/error.h"

namespace twinray::bench {

EmbreeScene::EmbreeScene(const EmbreeOptions& options)
    : options_(options), device_(rtcNewDevice(text("threads=", options.threads).c_str())) {
    if (!device_) fail("Embree: no device: error ", static_cast<int>(rtcGetDeviceError(nullptr)));
    rtcSetDeviceMemoryMonitorFunction(device_.get(), count_bytes, this);
}

bool EmbreeScene::count_bytes(void* scene, ssize_t bytes, bool) {
    auto& self = *static_cast<EmbreeScene*>(scene);
    const std::int64_t now = self.bytes_ += bytes;
    std::int64_t peak = self.peak_bytes_;
    while (peak < now && !self.peak_bytes_.compare_exchange_weak(peak, now)) {}
    return true;
}

void EmbreeScene::check(const char* action) const {
    const RTCError error = rtcGetDeviceError(device_.get());
    if (error != RTC_ERROR_NONE) fail("Embree: ", action, ": error ", static_cast<int>(error));
}

EmbreeScene::ScenePointer EmbreeScene::make_scene() const {
    ScenePointer scene(rtcNewScene(device_.get()));
    rtcSetSceneFlags(scene.get(), options_.flags);
    rtcSetSceneBuildQuality(scene.get(), options_.quality);
    return scene;
}

void EmbreeScene::attach(RTCScene scene, GeometryPointer geometry, uint id) const {
    rtcSetGeometryBuildQuality(geometry.get(), options_.geometry_quality);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(scene, geometry.get(), id);
}

EmbreeScene::GeometryPointer EmbreeScene::triangles_of(const PaddedMesh& mesh) const {
    GeometryPointer geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions.data(), 0,
                               sizeof(vec3), mesh.positions.size() - 1);
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                               sizeof(uvec3), mesh.triangles.size());
    return geometry;
}

BuildFigures EmbreeScene::build(const Scene& scene) {
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
    return {ms, wall_ms, static_cast<std::uint64_t>(bytes_ - before), static_cast<std::uint64_t>(peak_bytes_ - bytes_)};
}

}  // namespace twinray::bench
