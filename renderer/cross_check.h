// Compares two accelerators on the same rays.
#pragma once

#include "renderer/renderer.h"

namespace twinray::path_tracer {

// Traces every ray of a render again with a second accelerator and records those on which the two name different hits.
class CrossChecker final : public WaveObserver {
  public:
    // `second` must hold the scene, built.
    CrossChecker(Context& context, AbstractAccel& second, const Renderer& renderer, std::uint64_t pixel_count);

    void record(Commands& commands, const TraceDesc& desc, Uints pixels) override;
    void collect() override;

    // Returns the first max_kept of them.
    const std::vector<Disagreement>& recorded() const { return recorded_; }
    std::uint64_t found() const { return found_; }
    // Returns for each pixel whether any of its rays disagreed, recorded or not.
    std::vector<uint> marks();

    static constexpr std::size_t max_kept = 1 << 20;

  private:
    Context& context_;
    AbstractAccel& second_;
    Kernel<CompareArgs> compare_;
    Buffer hits_, batch_, batch_count_, batch_count_readback_, marks_;
    std::vector<Disagreement> recorded_;
    std::uint64_t found_ = 0;
};

// Pixels that differ in any bit, and those of them where no ray disagreed.
struct PictureDifference {
    std::uint64_t differing = 0;
    std::uint64_t unexplained = 0;
};
PictureDifference compare_pictures(const HdrImage& first, const HdrImage& second, const std::vector<uint>& marks);

// Returns a picture for viewing: `first`, dimmed and grey, with a dot of 3 x 3 pixels on every pixel that differs:
// yellow if a ray disagreed, red if none did. `white` is the white of the dots.
HdrImage difference_picture(const HdrImage& first, const HdrImage& second, const std::vector<uint>& marks, float white);

}  // namespace twinray::path_tracer
