// Errors of a picture against a better one.
#pragma once

#include <filesystem>
#include <vector>

#include <twinray/scene.h>

namespace twinray::path_tracer {

// The difference of a picture to a better one: means over pixels and channels.
struct PictureError {
    double mse = 0;           // of the squared difference
    double relative_mse = 0;  // of the squared difference over the squared reference + 0.01, which keeps black out
};
PictureError error_against(const HdrImage& picture, const HdrImage& reference);

// Returns means over blocks of block x block pixels, by channel, in the order of pixels, without incomplete blocks.
std::vector<double> block_means(const HdrImage& picture, uint block);

// Throws Error unless the file is a picture of that size.
HdrImage load_reference(const std::filesystem::path& file, uint width, uint height);

}  // namespace twinray::path_tracer
