// Tracing through AccelBackend: the checks of every accelerator, and the host's convenience.
#include <algorithm>
#include <cstring>

#include "engine/accel/held_geometry.h"
#include "engine/accel/pipeline_variants.h"
#include "engine/accel/ray_sort.h"
#include "engine/core/error.h"
#include "engine/core/commands.h"

namespace twinray {
namespace {

constexpr std::size_t rays_of_block = 1 << 20;  // rays of the host that are on the device at a time

// Returns the words for the first of the features, for messages.
const char* words_for(uint features) {
    if (features & FEATURE_BOXES) return "boxes";
    if (features & FEATURE_FILTERS) return "non-opaque instances";
    if (features & FEATURE_INSTANCES) return "several instances";
    if (features & FEATURE_TRANSFORMS) return "instances with transforms";
    if (features & FEATURE_MASKS) return "instances that the mask may hide";
    return "sides that are culled";
}

TraceDesc part_of(const TraceDesc& desc, std::uint64_t first, std::uint64_t count) {
    TraceDesc part = desc;
    part.rays.address += first * sizeof(Ray);
    part.hits.address += first * sizeof(Hit);
    part.count = count;
    return part;
}

}  // namespace

SpecializationConstant AccelView::features_constant() const { return {FEATURES_CONSTANT, features}; }

void AccelBackend::check_synced(const char* action) const {
    if (dirty_ != Dirty::no) fail(name_, ": ", action, ": edits are pending; call sync() first");
}

AccelTraits AccelBackend::accel_traits() const { return {is_software(), options_.layout, reorders()}; }

AccelView AccelBackend::view() const {
    check_synced("view");
    return {scene_->address, id_, revision_, features_of(accel_traits(), *traits_, TraceTraits::of_every_kind())};
}

void AccelBackend::trace(Commands& commands, const AccelView& view, const TraceDesc& desc) const {
    check_desc(view, desc);
    if (desc.count == 0) return;
    check_buffers(desc);
    record_rays(commands, view, desc);
}

void AccelBackend::trace(Commands& commands, const AccelView& view, const TraceDesc& desc, Pace& pace) const {
    check_desc(view, desc);
    if (desc.indirect_count.address) fail(name_, ": trace: a count on the device cannot be cut into parts");
    if (desc.count == 0) return;
    check_buffers(desc);
    pace.record(commands, desc.count, [&](std::uint64_t first, std::uint64_t count) {
        record_rays(commands, view, part_of(desc, first, count));
    });
}

void AccelBackend::check_buffers(const TraceDesc& desc) const {
    if (!desc.rays.address || !desc.hits.address) fail(name_, ": trace: the address of rays or hits is 0");
    const std::uint64_t bytes = desc.count * sizeof(Ray), rays = desc.rays.address, hits = desc.hits.address;
    if ((rays < hits ? hits - rays : rays - hits) < bytes)
        fail(name_, ": trace: ", bytes, " bytes of rays at ", rays, " and of hits at ", hits, " must not overlap");
}

void AccelBackend::record_rays(Commands& commands, const AccelView& view, const TraceDesc& desc) const {
    const TraceProgram& program = program_for(desc);
    const TraceArgs args{.scene = view.scene,
                         .rays = desc.rays,
                         .hits = desc.hits,
                         .indirect_count = desc.indirect_count,
                         .user_data = desc.user_data ? desc.user_data : context_.absent(),
                         .order = record_order(commands, desc),
                         .count = static_cast<uint>(desc.count),
                         .mask = desc.mask,
                         .flags = flags_of(desc.cull),
                         .first = 0};
    program.record(commands, args, desc.query, desc.level);
}

// The result is for TraceArgs::order.
Uints AccelBackend::record_order(Commands& commands, const TraceDesc& desc) const {
    if (desc.order == RayOrder::given || !works_on_device()) return {};
    if (!ray_sort_) ray_sort_ = std::make_unique<RaySort>(context_);
    const auto count = static_cast<uint>(desc.count);
    Buffer scratch(context_,
                   {.name = "ray sort scratch", .bytes = RaySort::scratch_bytes(count, context_.state().tuning())});
    const Uints order = ray_sort_->record(commands, scratch, desc.rays, count, desc.indirect_count).values;
    commands.retain(std::move(scratch));
    return order;
}

void AccelBackend::check_desc(const AccelView& view, const TraceDesc& desc) const {
    if (view.accel != id_) fail(name_, ": trace: the view belongs to another accelerator");
    if (view.revision != revision_)
        fail(name_, ": trace: stale view of revision ", view.revision, "; the accelerator is at ", revision_);
    if (desc.rays.address % 8 || desc.hits.address % 8)
        fail(name_, ": trace: rays at ", std::uint64_t{desc.rays.address}, " and hits at ",
             std::uint64_t{desc.hits.address}, " must be aligned to 8 bytes");
    if (desc.indirect_count.address % 4)
        fail(name_, ": trace: indirect count at ", std::uint64_t{desc.indirect_count.address},
             " must be aligned to 4 bytes");
    if (desc.count > UINT32_MAX) fail(name_, ": trace: ", desc.count, " rays; at most ", UINT32_MAX, " in one call");
    check_level(*this, "trace", desc.level);
}

uint AccelBackend::features_for(const TraceDesc& desc) const {
    check_synced("features_for");
    return features_of(accel_traits(), *traits_, TraceTraits::of(desc));
}

const TraceProgram& AccelBackend::variant_for(uint features, const TraceDesc& desc) const {
    if (!pipeline_variants_) {
        const uint all = features_of(accel_traits(), SceneTraits::of_every_kind(), TraceTraits::of_every_kind());
        pipeline_variants_ =
            std::make_unique<PipelineVariants>([this](uint wanted) { return create_program(nullptr, wanted); }, all,
                                               is_software() && options_.compiles_in_background);
    }
    return pipeline_variants_->get(features, desc.query, desc.level);
}

void AccelBackend::wait_for_programs() const {
    if (pipeline_variants_) pipeline_variants_->wait();
}

// A trace must not ignore boxes or leave hits undecided: it then needs a program.
const TraceProgram& AccelBackend::program_for(const TraceDesc& desc) const {
    const uint needed = features_of(accel_traits(), *traits_, TraceTraits::of(desc));
    if (const uint of_user = needed & (FEATURE_BOXES | FEATURE_FILTERS); !desc.program && of_user)
        fail(name_, ": trace: the scene has ", words_for(of_user), ", and TraceDesc::program is not set");
    if (!desc.program) return variant_for(needed, desc);
    const TraceProgram& program = *desc.program;
    if (program.accel() != id_) fail(name_, ": trace: program '", program.name(), "' was made by another accelerator");
    if (const uint missing = needed & ~program.features())
        fail(name_, ": trace: the scene has ", words_for(missing), ", and program '", program.name(),
             "' is not specialised for them");
    return program;
}

std::unique_ptr<TraceProgram> AccelBackend::make_program(const TraceProgramCode& code, uint features) const {
    const uint of_any_scene = features_of(accel_traits(), {.has_transforms = options_.can_move}, {});
    std::unique_ptr<TraceProgram> program = create_program(&code, (features & FEATURES_ALL) | of_any_scene);
    program->prepare(Query::closest, Level::watertight);
    return program;
}

std::vector<Hit> AccelBackend::closest_hits(std::span<const Ray> rays, const TraceDesc& desc) {
    TraceDesc closest = desc;
    closest.query = Query::closest;
    return trace_host(rays, closest);
}

std::vector<Hit> AccelBackend::any_hits(std::span<const Ray> rays, const TraceDesc& desc) {
    TraceDesc any = desc;
    any.query = Query::any;
    any.occlusion_only = false;
    return trace_host(rays, any);
}

std::vector<Hit> AccelBackend::trace_host(std::span<const Ray> rays, TraceDesc desc) {
    sync();
    if (rays.empty()) return {};
    const std::size_t most = std::min(rays.size(), rays_of_block);
    const Buffer ray_buffer(context_, {.name = "rays", .bytes = most * sizeof(Ray)});
    const Buffer hit_buffer(context_, {.name = "hits", .bytes = most * sizeof(Hit)});
    const Buffer staging(context_, {.name = "rays and hits", .bytes = most * sizeof(Ray), .memory = Memory::readback});
    desc.rays = ray_buffer.ref<Ray>();
    desc.hits = hit_buffer.ref<Hit>();
    desc.count = most;
    const AccelView view = this->view();
    check_desc(view, desc);
    Pace pace(context_);
    std::vector<Hit> hits(rays.size());
    for (std::size_t begin = 0; begin < rays.size(); begin += most) {
        const std::span<const Ray> block = rays.subspan(begin, std::min(most, rays.size() - begin));
        Commands commands(context_, name_ + " trace");
        std::memcpy(staging.mapped(), block.data(), block.size_bytes());
        {
            const auto pass = commands.pass("upload rays");
            commands.copy(staging, 0, ray_buffer, 0, block.size_bytes());
        }
        pace.record(commands, block.size(), [&](std::uint64_t first, std::uint64_t count) {
            record_rays(commands, view, part_of(desc, first, count));
        });
        {
            const auto pass = commands.pass("download hits");
            commands.copy(hit_buffer, 0, staging, 0, block.size() * sizeof(Hit));
        }
        pace.finish(commands);
        std::memcpy(&hits[begin], staging.mapped(), block.size() * sizeof(Hit));
    }
    return hits;
}

}  // namespace twinray
