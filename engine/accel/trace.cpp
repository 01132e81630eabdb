// SPDX-License-Identifier: MIT
// Tracing through AbstractAccel: what every accelerator checks, and the host's convenience.
#include "engine/accel/abstract_accel.h"
#include "engine/core/error.h"

namespace twinray {

void AbstractAccel::check_synced(const char* action) const {
    if (dirty_ != Dirty::no) fail(name_, ": ", action, ": edits are pending; call sync() first");
}

AccelView AbstractAccel::view() const {
    check_synced("view");
    return {scene_->address, id_, revision_, features_};
}

void AbstractAccel::trace(Commands& commands, const AccelView& view, const TraceDesc& desc) const {
    check_desc(view, desc);
    if (desc.count == 0) return;
    if (!desc.rays.address || !desc.hits.address) fail(name_, ": trace: the address of rays or hits is 0");
    const TraceArgs args{view.scene,          desc.rays,           desc.hits,
                         desc.indirect_count, desc.user_data,      static_cast<uint>(desc.count),
                         desc.mask,           flags_of(desc.cull), 0};
    program_for(view, desc).record(commands, args, desc.query, desc.level);
}

void AbstractAccel::check_desc(const AccelView& view, const TraceDesc& desc) const {
    if (view.accel != id_) fail(name_, ": trace: the view belongs to another accelerator");
    if (view.revision != revision_)
        fail(name_, ": trace: stale view of revision ", view.revision, "; the accelerator is at ", revision_);
    if (desc.rays.address % 4 || desc.hits.address % 4 || desc.indirect_count.address % 4)
        fail(name_, ": trace: rays at ", desc.rays.address, ", hits at ", desc.hits.address, " and indirect count at ",
             desc.indirect_count.address, " must be aligned to 4 bytes");
    if (desc.count > UINT32_MAX) fail(name_, ": trace: ", desc.count, " rays; at most ", UINT32_MAX, " in one call");
    if (const Capability level = capability(feature_of(desc.level)); level.support == Support::unsupported)
        fail(name_, ": trace: ", name_of(level.feature), " is unsupported: ", level.note);
    if (desc.level >= Level::refined && desc.level > options_.level)
        fail(name_, ": trace: ", name_of(feature_of(desc.level)), " is more than the accelerator was made for, ",
             name_of(feature_of(options_.level)), "; see AccelOptions");
}

const TraceProgram& AbstractAccel::own_program(uint features) const {
    const uint without_program = features & ~(FEATURE_BOXES | FEATURE_FILTERS);
    std::unique_ptr<TraceProgram>& program = own_programs_[without_program];
    if (!program) program = create_program(nullptr, without_program);
    return *program;
}

// Boxes that nothing can meet, and hits that nobody judges, are no answer.
const TraceProgram& AbstractAccel::program_for(const AccelView& view, const TraceDesc& desc) const {
    const TraceProgram& program = desc.program ? *desc.program : own_program(view.features);
    if (program.accel() != id_) fail(name_, ": trace: program '", program.name(), "' was made by another accelerator");
    if (const uint missing = view.features & ~program.features(); missing)
        fail(name_, ": trace: the scene has ",
             missing & FEATURE_BOXES     ? "boxes"
             : missing & FEATURE_FILTERS ? "filtered instances"
                                         : "several instances",
             ", and ",
             desc.program ? "program '" + program.name() + "' is not specialised for them"
                          : std::string("TraceDesc::program is not set"));
    return program;
}

std::unique_ptr<TraceProgram> AbstractAccel::make_program(const TraceProgramCode& code, uint features) const {
    std::unique_ptr<TraceProgram> program = create_program(&code, features | own_features());
    program->prepare(Query::closest, Level::watertight);
    return program;
}

std::vector<Hit> AbstractAccel::closest_hits(std::span<const Ray> rays, const TraceDesc& desc) {
    TraceDesc closest = desc;
    closest.query = Query::closest;
    return trace_host(rays, closest);
}

std::vector<Hit> AbstractAccel::any_hits(std::span<const Ray> rays, const TraceDesc& desc) {
    TraceDesc any = desc;
    any.query = Query::any;
    return trace_host(rays, any);
}

std::vector<Hit> AbstractAccel::trace_host(std::span<const Ray> rays, TraceDesc desc) {
    sync();
    if (rays.empty()) return {};
    const Buffer ray_buffer(context_, {.name = "rays", .bytes = rays.size_bytes()});
    const Buffer hit_buffer(context_, {.name = "hits", .bytes = rays.size() * sizeof(Hit)});
    desc.rays = ray_buffer.ref<Ray>();
    desc.hits = hit_buffer.ref<Hit>();
    desc.count = rays.size();
    Commands commands(context_, name_ + " trace");
    {
        const auto pass = commands.pass("upload rays");
        commands.upload(ray_buffer, rays);
    }
    trace(commands, view(), desc);
    commands.submit();
    return download<Hit>(context_, hit_buffer, rays.size());
}

}  // namespace twinray
