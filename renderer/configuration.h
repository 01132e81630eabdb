// SPDX-License-Identifier: MIT
// What tells one picture from another, for checkpoints and reports.
#pragma once

#include "renderer/environment.h"
#include "renderer/lights.h"
#include "renderer/renderer.h"

namespace twinray::path_tracer {

// What a picture of the scene depends on: contents stand by their CRC-32, so that where files lie does not matter.
// environment: null for black. How many samples are taken, by which accelerator and on which device is no part of it.
Configuration configuration_of(const RenderSettings& settings, const Scene& scene, const LocalLights& lights,
                               const EnvironmentMap* environment, bool is_default_sky);

// Stops for a .png: as asked for, else 0 under the default sky, else automatic.
float exposure_of(const std::optional<float>& wanted, const Configuration& configuration, const HdrImage& picture);

// Where the film's pixels lie in the picture. Throws Error for a configuration that does not say it.
HdrImage::Part part_of(const Configuration& configuration);

// The mean, exposed so.
void write_picture_of(const std::filesystem::path& file, const Film& film, const std::optional<float>& exposure,
                      std::span<const ImageChannel> layers = {});

// CRC-32 of the text, to tell configurations apart at a glance.
std::string hash_of(const Configuration& configuration);

}  // namespace twinray::path_tracer
