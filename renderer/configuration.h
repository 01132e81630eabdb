// The configuration that distinguishes pictures, for checkpoints and reports.
#pragma once

#include "renderer/environment.h"
#include "renderer/lights.h"
#include "renderer/renderer.h"

namespace twinray::path_tracer {

// Returns the settings and contents that a picture of the scene depends on; CRC-32 stands for contents, so that files
// may move. environment: null for black. The number of samples, the accelerator and the device are no part of it.
Configuration configuration_of(const RenderSettings& settings, const Scene& scene, const LocalLights& lights,
                               const EnvironmentMap* environment, bool is_default_sky);

// Returns the stops for a .png: the given ones, else 0 under the default sky, else automatic.
float exposure_of(const std::optional<float>& wanted, const Configuration& configuration, const HdrImage& picture);

// Returns the position of the film's pixels in the picture. Throws Error for a configuration without it.
HdrImage::Part part_of(const Configuration& configuration);

// Writes the picture of a film of this configuration, with this exposure.
void write_picture_of(const std::filesystem::path& file, const Configuration& configuration, HdrImage picture,
                      const std::optional<float>& exposure, std::span<const ImageChannel> layers = {});

// Returns the CRC-32 of the text, to tell configurations apart at a glance.
std::string hash_of(const Configuration& configuration);

}  // namespace twinray::path_tracer
