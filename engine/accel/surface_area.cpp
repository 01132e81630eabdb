#include "engine/accel/surface_area.h"

#include <algorithm>
#include <utility>

#include "engine_join_areas.spv.h"

namespace twinray {
namespace {

std::uint64_t groups_of(std::uint64_t items) {
    return std::max<std::uint64_t>((items + AREA_GROUP - 1) / AREA_GROUP, 1);
}

}  // namespace

CostLog::CostLog(Context& context)
    : costs_(context, {.name = "tree costs", .bytes = (1 + places_) * sizeof(TreeCost), .memory = Memory::readback}) {}

CostTarget CostLog::target() const {
    return {costs_.ref<TreeCost>(), costs_.ref<TreeCost>((1 + next_) * sizeof(TreeCost)), !last_.value};
}

void CostLog::commit(bool is_build, SyncPoint done) {
    if (is_build) points_ = {};
    points_[next_] = last_ = done;
    next_ = (next_ + 1) % places_;
}

std::optional<TreeCost> CostLog::newest(const Context& context) const {
    for (std::size_t back = 1; back <= places_; ++back) {
        const std::size_t place = (next_ + places_ - back) % places_;
        if (!points_[place].value || !context.is_reached(points_[place])) continue;
        TreeCost cost;
        std::memcpy(&cost, costs_.mapped() + (1 + place) * sizeof cost, sizeof cost);
        return cost;
    }
    return std::nullopt;
}

SurfaceArea::SurfaceArea(Context& context)
    : join_(context, lazy_kernel("engine_join_areas", engine_join_areas_spirv, AREA_GROUP)) {}

std::uint64_t AreaWork::bytes() const { return (item_count + groups_of(item_count)) * sizeof(AreaItem); }

void SurfaceArea::place(std::uint64_t address, std::span<AreaWork> work) {
    for (AreaWork& tree : work) {
        tree.items.address = address;
        tree.joined.address = address + tree.item_count * sizeof(AreaItem);
        address += tree.bytes();
    }
}

void SurfaceArea::place(Commands& commands, std::span<AreaWork> work) {
    std::uint64_t bytes = 0;
    for (const AreaWork& tree : work) bytes += tree.bytes();
    Buffer items(commands.context(), {.name = "area items", .bytes = bytes});
    place(items.address(), work);
    commands.retain(std::move(items));
}

void SurfaceArea::record(Commands& commands, std::vector<AreaWork> work) const {
    while (!work.empty()) {
        const auto pass = commands.pass(join_.name());
        for (AreaWork& tree : work) {
            const std::uint64_t groups = groups_of(tree.item_count);
            const Ref<TreeCost> result = groups == 1 ? tree.target.result : Ref<TreeCost>{};
            join_.dispatch_groups(commands,
                                  {tree.items, tree.joined, tree.root, tree.target.kept, result,
                                   static_cast<uint>(tree.item_count), tree.is_build ? 1u : 0u},
                                  groups);
            std::swap(tree.items, tree.joined);
            tree.item_count = groups == 1 ? 0 : groups;
        }
        std::erase_if(work, [](const AreaWork& tree) { return tree.item_count == 0; });
    }
}

}  // namespace twinray
