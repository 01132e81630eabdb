#include "renderer/cross_check.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "path_tracer_compare.spv.h"

namespace twinray::path_tracer {
namespace {

constexpr uint batch_capacity = 1 << 16;  // disagreements recorded of one trace

bool same_bits(vec3 a, vec3 b) {
    return std::bit_cast<std::array<uint, 3>>(a) == std::bit_cast<std::array<uint, 3>>(b);
}

void draw_dot(HdrImage& picture, std::size_t pixel, vec3 color) {
    const std::size_t x = pixel % picture.width, y = pixel / picture.width;
    for (std::size_t row = y - (y > 0); row <= std::min<std::size_t>(y + 1, picture.height - 1); ++row)
        for (std::size_t column = x - (x > 0); column <= std::min<std::size_t>(x + 1, picture.width - 1); ++column)
            picture.rgb[row * picture.width + column] = color;
}

}  // namespace

CrossChecker::CrossChecker(Context& context, AbstractAccel& second, const Renderer& renderer, std::uint64_t pixel_count)
    : context_(context),
      second_(second),
      compare_(context, {.name = "path_tracer_compare", .spirv = path_tracer_compare_spirv, .group_size = PATH_GROUP}),
      hits_(array_of<Hit>(context, "second hits", renderer.batch_size())),
      batch_(array_of<Disagreement>(context, "disagreements", batch_capacity)),
      batch_count_(array_of<uint>(context, "disagreement count", 1)),
      batch_count_readback_(context,
                            {.name = "disagreement count readback", .bytes = sizeof(uint), .memory = Memory::readback}),
      marks_(array_of<uint>(context, "disagreement marks", pixel_count)) {
    submit_pass(context, "cross-check start", [&](Commands& commands) { commands.fill(marks_, 0, marks_.bytes(), 0); });
}

void CrossChecker::record(Commands& commands, const TraceDesc& desc, Uints pixels) {
    TraceDesc again = desc;
    again.hits = hits_.ref<Hit>();
    second_.trace(commands, second_.view(), again);
    {
        const auto pass = commands.pass("cross-check clear");
        commands.fill(batch_count_, 0, sizeof(uint), 0);
    }
    compare_.dispatch(commands,
                      {desc.rays, desc.hits, again.hits, pixels, batch_.ref<Disagreement>(), batch_count_.ref<uint>(),
                       marks_.ref<uint>(), static_cast<uint>(desc.count), batch_capacity, desc.query == Query::any},
                      desc.count);
    const auto pass = commands.pass("cross-check count");
    commands.copy(batch_count_, 0, batch_count_readback_, 0, sizeof(uint));
}

void CrossChecker::collect() {
    uint count = 0;
    std::memcpy(&count, batch_count_readback_.mapped(), sizeof count);
    found_ += count;
    const std::size_t room = std::min<std::size_t>({count, batch_capacity, max_kept - recorded_.size()});
    const auto found = download<Disagreement>(context_, batch_, room);
    recorded_.insert(recorded_.end(), found.begin(), found.end());
}

std::vector<uint> CrossChecker::marks() { return download<uint>(context_, marks_, marks_.bytes() / sizeof(uint)); }

PictureDifference compare_pictures(const HdrImage& first, const HdrImage& second, const std::vector<uint>& marks) {
    PictureDifference difference;
    for (std::size_t i = 0; i < first.rgb.size(); ++i) {
        if (same_bits(first.rgb[i], second.rgb[i])) continue;
        ++difference.differing;
        if (marks[i] == 0) ++difference.unexplained;
    }
    return difference;
}

HdrImage difference_picture(const HdrImage& first, const HdrImage& second, const std::vector<uint>& marks,
                            float white) {
    constexpr float dimming = 0.25f;
    const vec3 explained = vec3(1, 0.8f, 0) * white, unexplained = vec3(1, 0, 0) * white;
    HdrImage picture = first;
    for (vec3& pixel : picture.rgb) pixel = vec3(dimming * luminance(pixel));
    for (std::size_t i = 0; i < first.rgb.size(); ++i)
        if (!same_bits(first.rgb[i], second.rgb[i])) draw_dot(picture, i, marks[i] ? explained : unexplained);
    return picture;
}

}  // namespace twinray::path_tracer
