// SPDX-License-Identifier: MIT
// A scene in Embree.
#pragma once

#include <embree3/rtcore.h>

#include <atomic>
#include <memory>
#include <vector>

#include "bench/backend.h"

namespace twinray::bench {

struct EmbreeOptions {
    RTCBuildQuality quality = RTC_BUILD_QUALITY_MEDIUM;           // of scenes
    RTCBuildQuality geometry_quality = RTC_BUILD_QUALITY_MEDIUM;  // heeded in scenes of quality low alone
    RTCSceneFlags flags = RTC_SCENE_FLAG_NONE;
    unsigned threads = 1;
};

// Meshes with one instance that is not moved lie in the top scene, all others under instances.
class EmbreeScene {
  public:
    explicit EmbreeScene(const EmbreeOptions& options);
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    BuildFigures build(const Scene& scene);
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

    static bool count_bytes(void* scene, ssize_t bytes, bool);
    void check(const char* action) const;
    ScenePointer make_scene() const;
    void attach(RTCScene scene, GeometryPointer geometry, uint id) const;
    GeometryPointer triangles_of(const PaddedMesh& mesh) const;

    EmbreeOptions options_;
    std::atomic<std::int64_t> bytes_ = 0, peak_bytes_ = 0;
    DevicePointer device_;
    std::vector<PaddedMesh> meshes_;
    std::vector<ScenePointer> bottoms_;  // by mesh; null where it has no scene of its own
    ScenePointer top_;
};

}  // namespace twinray::bench
