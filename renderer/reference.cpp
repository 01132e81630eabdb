#include "renderer/reference.h"

#include "samples/support/text.h"

namespace twinray::path_tracer {
using samples::fail;

PictureError error_against(const HdrImage& picture, const HdrImage& reference) {
    PictureError error;
    for (std::size_t i = 0; i < picture.rgb.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const double right = static_cast<double>(reference.rgb[i][c]);
            const double off = static_cast<double>(picture.rgb[i][c]) - right;
            error.mse += off * off;
            error.relative_mse += off * off / (right * right + 0.01);
        }
    const double count = 3.0 * static_cast<double>(picture.rgb.size());
    return {error.mse / count, error.relative_mse / count};
}

std::vector<double> block_means(const HdrImage& picture, uint block) {
    const uint count = picture.width / block;
    std::vector<double> means(std::size_t{count} * (picture.height / block) * 3);
    for (uint y = 0; y < picture.height / block * block; ++y)
        for (uint x = 0; x < count * block; ++x)
            for (int channel = 0; channel < 3; ++channel)
                means[(std::size_t{y / block} * count + x / block) * 3 + static_cast<std::size_t>(channel)] +=
                    double{picture.rgb[std::size_t{y} * picture.width + x][channel]} / (block * block);
    return means;
}

HdrImage load_reference(const std::filesystem::path& file, uint width, uint height) {
    HdrImage image = load_hdr_image(file);
    if (image.width != width || image.height != height)
        fail("'", file.string(), "': ", image.width, " x ", image.height, " pixels, but the picture has ", width, " x ",
             height);
    return image;
}

}  // namespace twinray::path_tracer
