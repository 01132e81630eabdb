// SPDX-License-Identifier: MIT
#include "engine/accel/surface_tables.h"

#include <algorithm>
#include <utility>

#include "engine/core/device_list.h"
#include "engine_copy_words.spv.h"

namespace twinray {

SurfaceTables::SurfaceTables(Context& context)
    : context_(context),
      copy_words_(context, {.name = "engine_copy_words", .spirv = engine_copy_words_spirv, .compiles_when_used = true}),
      table_(context, {.name = "surface table", .bytes = sizeof(SurfaceTable)}) {}

// Returns where its arrays are.
std::uint64_t SurfaceTables::stage_data(Commands& commands, SurfaceSlice& slice, Staged& staged) const {
    if (const auto shared = staged.data.find(&slice); shared != staged.data.end()) return shared->second.address();
    const std::uint64_t bytes = slice.pending_bytes();
    if (bytes == 0) return slice.data.bytes() ? slice.data.address() : 0;
    Buffer data(context_, {.name = "surface data", .bytes = bytes});
    if (!slice.packed.empty()) commands.upload(data, std::span<const std::byte>(slice.packed));
    for (const SurfaceSlice::Copy& copy : slice.copies)
        copy_words_.dispatch(commands, {copy.from, data.ref<uint>(copy.offset), static_cast<uint>(copy.words), 0},
                             copy.words);
    const std::uint64_t address = data.address();
    staged.data.emplace(&slice, std::move(data));
    return address;
}

SurfaceTables::Staged SurfaceTables::stage(Commands& commands, std::span<const Item> items,
                                           Ref<InstanceRecord> instances) const {
    Staged staged;
    const auto pass = commands.pass("surfaces");
    uint attribute_count = 0;
    for (const Item& item : items)
        for (const SurfaceSlice::Array& array : item.slice->arrays)
            attribute_count = std::max(attribute_count, array.number + 1);

    std::vector<SurfaceGeometry> geometries;
    std::vector<SurfaceAttribute> attributes(items.size() * attribute_count, {{context_.absent()}, 0, 0});
    std::vector<uint> geometry_of_instance;
    for (std::size_t i = 0; i < items.size(); ++i) {
        SurfaceSlice& slice = *items[i].slice;
        const std::uint64_t base = stage_data(commands, slice, staged);
        const auto at = [&](const std::optional<SurfaceSlice::Place>& place) {
            return place ? place->address(base) : context_.absent();
        };
        geometries.push_back({items[i].handle,
                              {at(slice.face_metadata)},
                              at(slice.metadata),
                              static_cast<uint>(geometry_of_instance.size()),
                              static_cast<uint>(items[i].faces)});
        for (const SurfaceSlice::Array& array : slice.arrays)
            attributes[i * attribute_count + array.number] = {
                {array.place.address(base)}, array.components, array.is_per_face ? 1u : 0u};
        geometry_of_instance.insert(geometry_of_instance.end(), items[i].instances, static_cast<uint>(i));
    }

    std::vector<std::byte> rows;
    const std::uint64_t of_geometries = append_aligned(rows, std::as_bytes(std::span(geometries)));
    const std::uint64_t of_attributes = append_aligned(rows, std::as_bytes(std::span(attributes)));
    const std::uint64_t of_instances = append_aligned(rows, std::as_bytes(std::span(geometry_of_instance)));
    staged.rows.emplace(context_, BufferDesc{.name = "surface rows", .bytes = rows.size()});
    const std::uint64_t address = rows.empty() ? context_.absent() : staged.rows->address();
    if (!rows.empty()) commands.upload(*staged.rows, std::span<const std::byte>(rows));
    commands.write(table_, SurfaceTable{instances,
                                        {address + of_instances},
                                        {address + of_geometries},
                                        {address + of_attributes},
                                        attribute_count,
                                        0});
    return staged;
}

void SurfaceTables::commit(Staged&& staged) {
    for (auto& [slice, data] : staged.data) {
        slice->data = std::move(data);
        slice->packed = std::vector<std::byte>();  // without its memory
        slice->copies = {};
    }
    if (staged.rows) rows_ = std::move(*staged.rows);
}

std::vector<uint> SurfaceTables::read(const SurfaceSlice& slice, const SurfaceSlice::Place& place,
                                      std::size_t count) const {
    if (!place.in_place) return download<uint>(context_, slice.data, count, place.offset);
    const Buffer copy(context_, {.name = "surface data", .bytes = count * sizeof(uint)});
    Commands commands(context_, "read surface data");
    copy_words_.dispatch(commands, {{place.in_place}, copy.ref<uint>(), static_cast<uint>(count), 0}, count);
    commands.submit();
    return download<uint>(context_, copy, count);
}

}  // namespace twinray
