// SPDX-License-Identifier: MIT
#include "renderer/layers.h"

#include <limits>

namespace twinray::path_tracer {
namespace {

template <class Value, class Item, class Of>
ImageChannel channel(const char* name, const std::vector<Item>& items, const Of& of) {
    std::vector<Value> values;
    values.reserve(items.size());
    for (const Item& item : items) values.push_back(static_cast<Value>(of(item)));
    return {name, std::move(values)};
}

}  // namespace

std::vector<ImageChannel> layers_of(const Film& film) {
    return {channel<uint>("samples.N", film.pixels, [&](const FilmPixel& p) { return p.count * film.block_size; }),
            channel<float>("variance.Y", film.variances(), [](double variance) { return variance; })};
}

std::vector<ImageChannel> layers_of(const std::vector<FirstSurface>& first, uint rays) {
    const auto number = static_cast<float>(rays);
    const auto albedo = [&](int i) { return [=](const FirstSurface& f) { return f.albedo[i] / number; }; };
    const auto normal = [&](int i) { return [=](const FirstSurface& f) { return f.normal[i] / number; }; };
    constexpr float infinity = std::numeric_limits<float>::infinity();
    return {channel<float>("albedo.R", first, albedo(0)),
            channel<float>("albedo.G", first, albedo(1)),
            channel<float>("albedo.B", first, albedo(2)),
            channel<float>("normal.X", first, normal(0)),
            channel<float>("normal.Y", first, normal(1)),
            channel<float>("normal.Z", first, normal(2)),
            channel<float>(
                "depth.Z", first,
                [](const FirstSurface& f) { return f.count ? f.distance / static_cast<float>(f.count) : infinity; }),
            channel<uint>("instance.ID", first, [](const FirstSurface& f) { return f.instance - 1; }),
            channel<uint>("primitive.ID", first,
                          [](const FirstSurface& f) { return f.instance ? f.primitive : 0xffffffffu; })};
}

}  // namespace twinray::path_tracer
