#include <twinray/queries.h>

#include <algorithm>
#include <tuple>

#include "all_hits_hw.spv.h"
#include "all_hits_sw.spv.h"
#include "engine/accel/trace_desc.h"
#include "engine/core/device_list.h"
#include "engine/core/error.h"
#include "engine/core/kernel.h"
#include "engine/core/ray.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/all_hits.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(RayHit) == 36);

namespace {

constexpr std::size_t batch = 1 << 20;  // rays

AbstractAccel& checked(AbstractAccel& accel) {
    accel.check_kernel_queries("all hits");
    return accel;
}

KernelDesc kernel_for(const AbstractAccel& accel) {
    KernelDesc desc{.name = "all_hits_hw",
                    .spirv = all_hits_hw_spirv,
                    .constants = {{FEATURES_CONSTANT, FEATURES_ALL & ~FEATURE_BOXES},
                                  {LEVEL_CONSTANT, static_cast<std::uint32_t>(Level::watertight)}}};
    if (accel.is_software()) desc.name = "all_hits_sw", desc.spirv = all_hits_sw_spirv;
    return desc;
}

bool is_same(const RayHit& a, const RayHit& b) {
    return a.ray == b.ray && a.hit.instance_index == b.hit.instance_index &&
           a.hit.primitive_index == b.hit.primitive_index;
}

// Sorts, and removes duplicates.
void tidy(std::vector<RayHit>& found) {
    const auto key = [](const RayHit& of) {
        return std::tuple(of.ray, of.hit.t, of.hit.instance_index, of.hit.primitive_index);
    };
    std::sort(found.begin(), found.end(), [&](const RayHit& a, const RayHit& b) { return key(a) < key(b); });
    found.erase(std::unique(found.begin(), found.end(), is_same), found.end());
}

}  // namespace

struct AllHits::State {
    explicit State(AbstractAccel& traced)
        : accel(checked(traced)),
          kernel(traced.context(), kernel_for(traced)),
          found(traced.context(), "hits", sizeof(RayHit)) {}

    std::vector<RayHit> find(const AccelView& view, std::span<const Ray> some, const TraceDesc& desc);

    AbstractAccel& accel;
    Kernel<AllHitsArgs> kernel;
    Buffer rays;
    DeviceList found;
};

AllHits::AllHits(AbstractAccel& accel) : state_(std::make_unique<State>(accel)) {}
AllHits::~AllHits() = default;

std::uint64_t AllHits::max_hits() const { return state_->found.limit(); }
void AllHits::set_max_hits(std::uint64_t count) { state_->found.set_limit(count); }

// Returns them in order.
std::vector<RayHit> AllHits::State::find(const AccelView& view, std::span<const Ray> some, const TraceDesc& desc) {
    grow(accel.context(), rays, "rays", some.size_bytes());
    const auto record = [&](Commands& commands, const DeviceList::View& list, std::uint64_t first,
                            std::uint64_t count) {
        {
            const auto pass = commands.pass("upload rays");
            commands.upload(rays, some.subspan(first, count), first * sizeof(Ray));
        }
        kernel.dispatch(commands,
                        {view.scene,
                         rays.ref<Ray>(),
                         {list.address},
                         list.total,
                         static_cast<uint>(first),
                         static_cast<uint>(first + count),
                         list.capacity,
                         desc.mask,
                         flags_of(desc.cull),
                         0},
                        count);
    };
    const std::uint64_t count = found.fill(record, some.size(), 2 * some.size(), accel.name() + ": all hits");
    std::vector<RayHit> hits = download<RayHit>(accel.context(), found.buffer(), count);
    tidy(hits);
    return hits;
}

HitsOfRays AllHits::operator()(std::span<const Ray> rays, const TraceDesc& desc) {
    AbstractAccel& accel = state_->accel;
    accel.sync();
    const AccelView view = accel.view();
    if (view.features & FEATURE_BOXES) fail(accel.name(), ": all hits: the scene has boxes, which need a program");
    HitsOfRays result{.first = {0}, .hits = {}};
    for (std::size_t begin = 0; begin < rays.size(); begin += batch) {
        const std::span<const Ray> some = rays.subspan(begin, std::min(batch, rays.size() - begin));
        const std::vector<RayHit> found = state_->find(view, some, desc);
        auto next = found.begin();
        for (std::size_t ray = 0; ray < some.size(); ++ray) {
            for (; next != found.end() && next->ray == ray; ++next) result.hits.push_back(next->hit);
            result.first.push_back(result.hits.size());
        }
    }
    return result;
}

}  // namespace twinray
