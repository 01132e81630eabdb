// SPDX-License-Identifier: MIT
#include "bench/embree_trace.h"

#include <algorithm>
#include <array>

namespace twinray::bench {
namespace {

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
        std::transform(rays.begin(), rays.end(), list.begin(), ray_of);
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

template <class Part>
void in_parts(std::size_t size, const EmbreeTrace& whole, const Part& trace_part) {
    for (std::size_t begin = 0; begin < whole.rays.size(); begin += size) {
        const std::size_t count = std::min(size, whole.rays.size() - begin);
        trace_part({whole.scene, whole.query, whole.rays.subspan(begin, count), whole.hits.subspan(begin, count)});
    }
}

}  // namespace

void trace_packets(const EmbreeTrace& trace) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    in_parts(packet, trace, [&](const EmbreeTrace& part) { trace_packet(part, context); });
}

void trace_streams(const EmbreeTrace& trace, bool is_coherent) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = is_coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    in_parts(stream, trace, [&](const EmbreeTrace& part) { trace_stream(part, context); });
}

}  // namespace twinray::bench
