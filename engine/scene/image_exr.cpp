// SPDX-License-Identifier: MIT
#include "engine/scene/image_exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>

#include "engine/core/error.h"

namespace twinray {
namespace {

HdrImage read_pixels(Imf::InputFile& in, const std::string& object) {
    const Imath::Box2i window = in.header().dataWindow();
    const std::int64_t width = std::int64_t(window.max.x) - window.min.x + 1;
    const std::int64_t height = std::int64_t(window.max.y) - window.min.y + 1;
    check_image_size(width, height, object);
    const Imf::ChannelList& channels = in.header().channels();
    const bool is_grey = !channels.findChannel("R") && channels.findChannel("Y");
    if (!is_grey && !(channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B")))
        fail("'", object, "': has neither channels R, G and B nor Y");

    HdrImage image{static_cast<uint>(width), static_cast<uint>(height), {}};
    image.rgb.resize(static_cast<std::size_t>(width * height));
    constexpr std::size_t x_stride = sizeof(vec3);
    const std::size_t y_stride = x_stride * image.width;
    Imf::FrameBuffer frame;
    const std::vector<const char*> names = is_grey ? std::vector{"Y"} : std::vector{"R", "G", "B"};
    for (std::size_t i = 0; i < names.size(); ++i) {
        float* first = &image.rgb[0].x + i;
        frame.insert(names[i], Imf::Slice::Make(Imf::FLOAT, first, window, x_stride, y_stride));
    }
    in.setFrameBuffer(frame);
    in.readPixels(window.min.y, window.max.y);
    if (is_grey)
        for (vec3& pixel : image.rgb) pixel = vec3(pixel.x);
    return image;
}

}  // namespace

HdrImage load_exr_image(const std::filesystem::path& file) {
    try {
        Imf::InputFile in(file.string().c_str());
        return read_pixels(in, file.string());
    } catch (const Error&) {
        throw;
    } catch (const std::exception& e) {  // OpenEXR's own, and running out of memory on a false size
        fail("'", file.string(), "': not a readable OpenEXR image (", e.what(), ")");
    }
}

}  // namespace twinray
