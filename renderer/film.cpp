#include "renderer/film.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "samples/support/text.h"

namespace twinray::path_tracer {
using samples::fail;
using samples::text;
namespace {

double number_of(uvec2 words) {
    return static_cast<double>(static_cast<std::int64_t>(std::uint64_t{words.y} << 32 | words.x));
}

double luminance_sum(const FilmPixel& pixel) {
    return 0.2126 * sum_of(pixel, 0) + 0.7152 * sum_of(pixel, 1) + 0.0722 * sum_of(pixel, 2);
}

// Returns the variance of the mean luminance of a sample.
double variance_of(const FilmPixel& pixel, uint block_size) {
    if (pixel.count < 2) return std::numeric_limits<double>::infinity();
    const double n = pixel.count, size = block_size, sum = luminance_sum(pixel), squares = sum_of(pixel, FILM_SQUARES);
    return std::max(0.0, squares - sum * sum / n) / (n * (n - 1)) / (size * size);
}

double luminance_of(const FilmPixel& pixel, uint block_size) {
    return pixel.count ? luminance_sum(pixel) / block_size / pixel.count : 0;
}

uvec2 digit_of(const FilmDigits& digits, uint sum) {
    const uvec2 all[] = {digits.red, digits.green, digits.blue, digits.square};
    return all[sum];
}

void add_digits(FilmDigits& digits, const FilmDigits& other) {
    digits.red = add64(digits.red, other.red);
    digits.green = add64(digits.green, other.green);
    digits.blue = add64(digits.blue, other.blue);
    digits.square = add64(digits.square, other.square);
}

void merge_pixel(FilmPixel& pixel, FilmPixel other) {
    film_raise_all(pixel, other.positions & 0xffffu, other.positions >> 16);
    film_raise_all(other, pixel.positions & 0xffffu, pixel.positions >> 16);
    add_digits(pixel.high, other.high);
    add_digits(pixel.low, other.low);
    pixel.count += other.count;
}

template <class Value, class Item, class Of>
ImageChannel channel(const char* name, const std::vector<Item>& items, const Of& of) {
    std::vector<Value> values;
    values.reserve(items.size());
    for (const Item& item : items) values.push_back(static_cast<Value>(of(item)));
    return {name, std::move(values)};
}

}  // namespace

std::string difference(const Configuration& found, const Configuration& wanted) {
    std::vector<std::string> parts;
    for (const auto& [name, value] : wanted)
        if (const std::string other = value_of(found, name); other != value)
            parts.push_back(text(name, " is ", other.empty() ? "missing" : other, ", not ", value));
    for (const auto& [name, value] : found)
        if (value_of(wanted, name).empty()) parts.push_back(text(name, " is ", value, ", not there"));
    std::string all;
    for (const std::string& part : parts) all += (all.empty() ? "" : "; ") + part;
    return all;
}

std::string value_of(const Configuration& configuration, const std::string& name) {
    for (const auto& [other, value] : configuration)
        if (other == name) return value;
    return {};
}

std::string text_of(const Configuration& configuration) {
    std::string all;
    for (const auto& [name, value] : configuration) all += text(name, ": ", value, '\n');
    return all;
}

void BlockSet::insert(uint number) {
    if (words_.size() <= number / 32) words_.resize(number / 32 + 1);
    words_[number / 32] |= 1u << number % 32;
}

bool BlockSet::contains(uint number) const {
    return number / 32 < words_.size() && (words_[number / 32] >> number % 32 & 1) != 0;
}

void BlockSet::unite(const BlockSet& other) {
    if (words_.size() < other.words_.size()) words_.resize(other.words_.size());
    for (std::size_t i = 0; i < other.words_.size(); ++i) words_[i] |= other.words_[i];
}

uint BlockSet::count() const {
    uint count = 0;
    for (const uint word : words_) count += static_cast<uint>(std::popcount(word));
    return count;
}

uint BlockSet::end() const {
    return words_.empty() ? 0
                          : static_cast<uint>(words_.size()) * 32 - static_cast<uint>(std::countl_zero(words_.back()));
}

std::optional<uint> BlockSet::common(const BlockSet& other) const {
    for (std::size_t i = 0; i < std::min(words_.size(), other.words_.size()); ++i)
        if (const uint both = words_[i] & other.words_[i])
            return static_cast<uint>(i) * 32 + static_cast<uint>(std::countr_zero(both));
    return {};
}

Film Film::empty(uint width, uint height, uint block_size, Configuration configuration) {
    Film film{.width = width, .height = height, .block_size = block_size, .configuration = std::move(configuration)};
    film.pixels.resize(std::size_t{width} * height);
    return film;
}

void Film::add(std::size_t pixel, vec3 sum) { film_add(pixels[pixel], sum, luminance(sum)); }

void Film::merge(const Film& other, const std::string& name, const std::string& other_name) {
    if (const std::string differs = difference(other.configuration, configuration); !differs.empty())
        fail("'", other_name, "' is not a film of the same picture as '", name, "': ", differs);
    if (other.width != width || other.height != height || other.block_size != block_size)
        fail("'", other_name, "': ", other.width, " x ", other.height, " pixels, but '", name, "' has ", width, " x ",
             height);
    if (const auto number = blocks.common(other.blocks))
        fail("'", other_name, "' and '", name, "' both hold samples ", std::uint64_t{*number} * block_size, " to ",
             std::uint64_t{*number} * block_size + block_size - 1, " of each pixel; a sample may count only once");
    for (std::size_t i = 0; i < pixels.size(); ++i) merge_pixel(pixels[i], other.pixels[i]);
    blocks.unite(other.blocks);
}

HdrImage Film::mean() const {
    HdrImage picture{width, height, {}};
    picture.rgb.reserve(pixels.size());
    for (const FilmPixel& pixel : pixels) {
        const double n = 1.0 * block_size * std::max(1u, pixel.count);
        picture.rgb.emplace_back(sum_of(pixel, 0) / n, sum_of(pixel, 1) / n, sum_of(pixel, 2) / n);
    }
    return picture;
}

std::vector<double> Film::variances() const {
    std::vector<double> variances;
    variances.reserve(pixels.size());
    for (const FilmPixel& pixel : pixels) variances.push_back(variance_of(pixel, block_size));
    return variances;
}

double Film::error() const {
    const std::vector<double> all = variances();
    const double sum = std::accumulate(all.begin(), all.end(), 0.0);
    return sum > 0 ? std::sqrt(sum / static_cast<double>(all.size())) / mean_luminance(*this) : 0;
}

double Film::mean_samples() const {
    double sum = 0;
    for (const FilmPixel& pixel : pixels) sum += pixel.count;
    return block_size * sum / static_cast<double>(pixels.size());
}

double sum_of(const FilmPixel& pixel, uint sum) {
    const bool is_square = sum == FILM_SQUARES;
    const int position = static_cast<int>(is_square ? pixel.positions >> 16 : pixel.positions & 0xffffu);
    const int unit = static_cast<int>(FILM_DIGIT_BITS) * position - (is_square ? 298 : 149);
    const auto high = number_of(digit_of(pixel.high, sum));
    const auto low = number_of(digit_of(pixel.low, sum));
    return std::ldexp(high, unit + static_cast<int>(FILM_DIGIT_BITS)) + std::ldexp(low, unit);
}

double mean_luminance(const Film& film) {
    double sum = 0;
    for (const FilmPixel& pixel : film.pixels) sum += luminance_of(pixel, film.block_size);
    return sum / static_cast<double>(film.pixels.size());
}

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
