// The contents of a picture: for each pixel the sums of its samples, and the set of these samples. Films of the same
// configuration add up in any order to the same bits.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <twinray/scene.h>

#include "renderer/shared.h"

namespace twinray::path_tracer {

// Everything that the value of a sample depends on, except its number, by name: samples of unlike configurations do not
// belong into one picture.
using Configuration = std::vector<std::pair<std::string, std::string>>;

// Says "seed is 2, not 1; ..." for each difference; empty if there is none.
std::string difference(const Configuration& found, const Configuration& wanted);
// Returns the value of that name, or nothing.
std::string value_of(const Configuration& configuration, const std::string& name);
// Returns one "name: value" a line.
std::string text_of(const Configuration& configuration);

// The numbers of the blocks of samples that a film holds.
class BlockSet {
  public:
    void insert(uint number);
    bool contains(uint number) const;
    void unite(const BlockSet& other);
    uint count() const;
    // Returns 1 + the largest number; 0 if it is empty.
    uint end() const;
    // Returns a number that both hold, or nothing.
    std::optional<uint> common(const BlockSet& other) const;

    // Bit i % 32 of word i / 32 stands for block i; the last word is not 0.
    const std::vector<uint>& words() const { return words_; }
    explicit BlockSet(std::vector<uint> words = {}) : words_(std::move(words)) {}
    bool operator==(const BlockSet&) const = default;

  private:
    std::vector<uint> words_;
};

struct Film {
    uint width = 0;
    uint height = 0;
    uint block_size = 1;  // samples that are added as one
    Configuration configuration = {};
    BlockSet blocks = BlockSet{};
    std::vector<FilmPixel> pixels = {};

    // Makes a film without samples.
    static Film empty(uint width, uint height, uint block_size, Configuration configuration);

    // Adds a block's sum of one pixel: the CPU reference of accumulate.comp. The caller notes the block's number.
    void add(std::size_t pixel, vec3 sum);
    // Throws Error, naming both, if the other's samples are of another configuration or partly the same ones.
    void merge(const Film& other, const std::string& name, const std::string& other_name);

    HdrImage mean() const;
    // Returns the square of the standard error of each pixel's mean luminance, from how its blocks differ; infinite if
    // there are fewer than two.
    std::vector<double> variances() const;
    // Returns the root mean square of the pixels' standard errors over the picture's mean luminance. It estimates the
    // root mean square of its difference to the true picture (relative RMSE). Infinite if some pixel has fewer than two
    // blocks.
    double error() const;
    // Returns the average over pixels.
    double mean_samples() const;
};

// This is unbiased for samples that do not depend on each other. Samples of one Sobol sequence are spread more evenly
// than that, and the error is smaller than it says.

// Returns a sum of a pixel: red, green, blue, or of squared luminances (FILM_SQUARES).
double sum_of(const FilmPixel& pixel, uint sum);
double mean_luminance(const Film& film);

// Layers are the channels of .exr pictures besides radiance.
// samples.N: samples of each pixel; variance.Y: square of the standard error of its luminance.
std::vector<ImageChannel> layers_of(const Film& film);
// albedo.R G B, normal.X Y Z: means over the rays, 0 if there are none; depth.Z: distance from the camera, mean over
// the rays that see something, infinite if none does; instance.ID, primitive.ID: of the first sample, 2^32 - 1 if it
// sees nothing. rays: per pixel.
std::vector<ImageChannel> layers_of(const std::vector<FirstSurface>& first_surfaces, uint rays);

}  // namespace twinray::path_tracer
