// Finds surfaces and handles of hits for the host.

#include <algorithm>
#include <numeric>

#include <twinray/world.h>

#include "engine/accel/held_geometry.h"
#include "engine/accel/refinement.h"
#include "engine/core/device_list.h"
#include "engine/core/error.h"
#include "engine_interpolate.spv.h"
#include "engine_surfaces.spv.h"

namespace twinray {

SurfaceKernels::SurfaceKernels(Context& context)
    : surfaces(context, lazy_kernel("engine_surfaces", engine_surfaces_spirv)),
      interpolate(context, lazy_kernel("engine_interpolate", engine_interpolate_spirv)) {}

const AccelBackend::InstanceOwners& AccelBackend::instance_owners(const char* action) const {
    check_synced(action);
    if (owners_.revision == revision_) return owners_;
    InstanceOwners owners{.revision = revision_, .of_instance = {}, .all = {}};
    for (const auto& [id, pushed] : pushed_) {
        const std::size_t first = owners.of_instance.size(), count = pushed.instances.records.size();
        owners.of_instance.insert(owners.of_instance.end(), count, static_cast<uint>(owners.all.size()));
        owners.all.push_back({{id}, first, pushed.held->geometry.primitive_count()});
    }
    return owners_ = std::move(owners);
}

const AccelBackend::InstanceOwners::Owner& AccelBackend::owner_of(const Hit& hit, const char* action) const {
    const InstanceOwners& owners = instance_owners(action);
    if (hit.hit == 0) fail(name_, ": ", action, ": a miss names no instance");
    if (hit.instance_index >= owners.of_instance.size())
        fail(name_, ": ", action, ": the hit names instance ", hit.instance_index, " of ", owners.of_instance.size());
    return owners.all[owners.of_instance[hit.instance_index]];
}

AccelHandle AccelBackend::handle_of(const Hit& hit) const { return owner_of(hit, "handle_of").handle; }

std::size_t AccelBackend::index_in_handle(const Hit& hit) const {
    return hit.instance_index - owner_of(hit, "index_in_handle").first_instance;
}

std::vector<HitExact> AccelBackend::exact_hits(std::span<const Ray64> rays, const TraceDesc& desc) {
    if (!refinement_)
        fail(name_, ": exact_hits: made for level ", name_of(options_.level), "; it takes refined or more");
    std::vector<std::size_t> asked(rays.size());
    std::iota(asked.begin(), asked.end(), std::size_t{0});
    std::vector<Ray64> given(rays.begin(), rays.end());
    sync();
    const Bounds box = world_bound();
    std::vector<double> ways;
    for (Ray64& ray : given) ways.push_back(bring_near(ray, box));
    std::vector<Ray> rounded;
    for (const Ray64& ray : given)
        rounded.push_back(
            {vec3(ray.origin), static_cast<float>(ray.t_min), vec3(ray.direction), static_cast<float>(ray.t_max)});
    TraceDesc at_level = desc;
    at_level.level = options_.level;
    std::vector<HitExact> found(rays.size());
    // If float64 finds a hit outside the ray's interval, the ray continues behind it, in steps that start at the
    // distance by which rounding moves the origin and double: until then float32 may find the same triangle again.
    std::vector<float> steps;
    for (const Ray& ray : rounded)
        steps.push_back(std::max(largest_entry(ray.origin) / largest_entry(ray.direction) * 0x1p-24f, 0x1p-100f));
    while (!asked.empty()) {
        const std::vector<Hit> hits = closest_hits(rounded, at_level);
        const std::vector<HitDouble> exact = refinement_->exact(given, hits);
        std::size_t left = 0;
        for (std::size_t i = 0; i < hits.size(); ++i) {
            const Hit& hit = hits[i];
            if (!hit.hit) continue;
            if (exact[i].t > given[i].t_min && exact[i].t < given[i].t_max) {
                found[asked[i]] = {1,
                                   hit.primitive_index,
                                   hit.custom_index,
                                   hit.instance_index,
                                   handle_of(hit),
                                   ways[asked[i]] + exact[i].t,
                                   exact[i].u,
                                   exact[i].v};
                continue;
            }
            asked[left] = asked[i], given[left] = given[i], rounded[left] = rounded[i], steps[left] = 2 * steps[i];
            rounded[left++].t_min = hit.t + steps[i];
        }
        asked.resize(left), given.resize(left), rounded.resize(left), steps.resize(left);
    }
    return found;
}

void AccelBackend::check_keeps_surfaces(const char* action) const {
    if (!options_.keeps_surfaces) fail(name_, ": ", action, ": made without AccelOptions::keeps_surfaces");
}

void AccelBackend::check_hits(std::span<const Ray> rays, std::span<const Hit> hits, const char* action) const {
    check_keeps_surfaces(action);
    check_synced(action);
    if (rays.size() != hits.size())
        fail(name_, ": ", action, ": ", rays.size(), " rays for ", hits.size(), " hits; the lengths must match");
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (hits[i].hit == 0) continue;
        const InstanceOwners::Owner& owner = owner_of(hits[i], action);
        if (hits[i].primitive_index >= owner.primitive_count)
            fail(name_, ": ", action, ": hit ", i, " names primitive ", hits[i].primitive_index, " of ",
                 owner.primitive_count);
    }
}

template <class Out, class Record>
std::vector<Out> AccelBackend::of_hits(std::span<const Ray> rays, std::span<const Hit> hits,
                                       const Record& record) const {
    if (hits.empty()) return {};
    context_.wait(synced_);
    if (!surface_kernels_) surface_kernels_ = std::make_unique<SurfaceKernels>(context_);
    const Buffer ray_buffer(context_, {.name = "rays", .bytes = rays.size_bytes()});
    const Buffer hit_buffer(context_, {.name = "hits", .bytes = hits.size_bytes()});
    const Buffer out(context_, {.name = "surfaces", .bytes = hits.size() * sizeof(Out)});
    Commands commands(context_, name_ + " surfaces");
    {
        const auto pass = commands.pass("upload hits");
        commands.upload(ray_buffer, rays);
        commands.upload(hit_buffer, hits);
    }
    record(commands, SurfaceArgs{surfaces_->table(), ray_buffer.ref<Ray>(), hit_buffer.ref<Hit>(), out.address(),
                                 static_cast<uint>(hits.size()), 0});
    commands.submit();
    return download<Out>(context_, out, hits.size());
}

std::vector<Surface> AccelBackend::surfaces(std::span<const Ray> rays, std::span<const Hit> hits) const {
    check_hits(rays, hits, "surfaces");
    return of_hits<Surface>(rays, hits, [&](Commands& commands, const SurfaceArgs& args) {
        surface_kernels_->surfaces.dispatch(commands, args, args.count);
    });
}

uint AccelBackend::attribute_number(std::string_view name) const {
    check_keeps_surfaces("attribute_number");
    const std::optional<uint> number = surfaces_->names().number_of(name);
    if (!number) fail(name_, ": attribute_number: no mesh that was pushed has an attribute '", name, "'");
    return *number;
}

std::vector<vec4> AccelBackend::attributes(std::string_view name, std::span<const Ray> rays, std::span<const Hit> hits,
                                           vec4 missing) const {
    check_hits(rays, hits, "attributes");
    const uint number = attribute_number(name);
    return of_hits<vec4>(rays, hits, [&](Commands& commands, const SurfaceArgs& args) {
        surface_kernels_->interpolate.dispatch(commands, {args, missing, number, 0}, args.count);
    });
}

}  // namespace twinray
