// SPDX-License-Identifier: MIT
#include <twinray/tlas.h>

#include "engine/core/files.h"
#include "swtlas/saved.h"
#include "swtlas/sw_backend.h"

namespace twinray {

SwTlas::SwTlas(Context& context, const AccelOptions& options)
    : AbstractAccel(std::make_unique<SwBackend>(context, options)) {}

SwBackend& SwTlas::backend() const { return static_cast<SwBackend&>(AbstractAccel::backend()); }

Capability SwTlas::capability_on(const DeviceProperties& device, Feature feature) {
    switch (feature) {
        case Feature::level_refined:
        case Feature::level_certified:
            if (device.shader_float64) return {feature, Support::native, ""};
            return {feature, Support::unsupported, "the device has no float64"};
        case Feature::compaction: return {feature, Support::native, "its arrays have their exact size when built"};
        default: return {feature, Support::native, ""};
    }
}

void SwTlas::save(const std::filesystem::path& file) const { backend().save(file); }

SwTlas::Loaded SwTlas::load(Context& context, const std::filesystem::path& file) {
    DecodedSave saved = decode_save(read_file(file), file.string());
    Loaded loaded{std::make_unique<SwTlas>(context, AccelOptions{.layout = saved.layout}), {}};
    Commands commands(context, "SwTlas load");
    for (SavedGeometry& geometry : saved.geometries)
        loaded.handles.push_back(loaded.accel->backend().push_saved(commands, std::move(geometry)));
    commands.submit();
    return loaded;
}

BuiltTree download_geometry(const SwTlas& accel, AccelHandle handle) {
    return accel.backend().download_geometry(handle);
}
BuiltTree download_scene(const SwTlas& accel) { return accel.backend().download_scene(); }

}  // namespace twinray
