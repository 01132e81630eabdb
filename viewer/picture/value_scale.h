// Colours for values, and from values to places along a colour bar: pure functions.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <twinray/scene.h>

namespace twinray {

enum class ColorMap : std::uint8_t {
    magnitude,  // viridis, from dark to bright in even steps of lightness (van der Walt and Smith 2015)
    diverging,  // blue to red through light grey in the middle, which is 0 (cool to warm, Moreland 2009)
};

// position: from 0 to 1; positions outside take the colour of the end.
Rgb color_at(ColorMap map, double position);

inline constexpr Rgb no_value_color = {158, 158, 158};

// Colours for kinds of things, which people of any colour vision can distinguish (Okabe and Ito 2008).
namespace categorical {
inline constexpr Rgb orange = {230, 159, 0}, sky_blue = {86, 180, 233}, green = {0, 158, 115}, yellow = {240, 228, 66},
                     blue = {0, 114, 178}, vermilion = {213, 94, 0}, purple = {204, 121, 167};
}  // namespace categorical

struct Tick {
    double position;  // along the scale, from 0 to 1
    std::string label;
};

class ValueScale {
  public:
    // Throws Error unless lo < hi, both finite.
    static ValueScale linear(double lo, double hi);
    // Throws Error unless 0 < lo < hi, both finite.
    static ValueScale logarithmic(double lo, double hi);
    // Makes a scale from 0 to a round number that is not below the largest; with values below 0 it goes as far to
    // either side. Values that are not finite do not count.
    static ValueScale linear_for(std::span<const double> values);
    // Makes a scale from the smallest above 0 to the largest, but over no more than 10^6.
    static ValueScale logarithmic_for(std::span<const double> values);

    double lo() const { return lo_; }
    double hi() const { return hi_; }
    bool is_logarithmic() const { return is_logarithmic_; }
    // Returns the position from 0 to 1; values beyond have that of the nearest end.
    double position(double value) const;
    // Returns the value at a position: the inverse of position().
    double value_at(double position) const;
    // Returns a colour of the diverging map if 0 is inside of a linear scale. NaN has `no_value_color`, and so have 0
    // and below on a logarithmic scale.
    Rgb color(double value) const;
    // At most `most` round numbers (Heckbert, "Nice numbers for graph labels", 1990): 1, 2 or 5 times powers of ten.
    std::vector<Tick> ticks(std::size_t most) const;

  private:
    ValueScale(double lo, double hi, bool is_logarithmic) : lo_(lo), hi_(hi), is_logarithmic_(is_logarithmic) {}
    std::vector<Tick> linear_ticks(std::size_t most) const;
    std::vector<Tick> decade_ticks(std::size_t most) const;

    double lo_, hi_;
    bool is_logarithmic_;
};

// Returns a number in few characters, with as many digits after the point as multiples of `step` need.
std::string label_of(double value, double step);

}  // namespace twinray
