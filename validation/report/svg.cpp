// SPDX-License-Identifier: MIT
// Drawing a plot.
#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

#include "validation/report/plots.h"

namespace twinray::report {
namespace {

constexpr double width = 760, height = 380;
constexpr double left = 70, right = 540, top = 34, bottom = 330;  // of the axes; the legend is to their right

// Okabe and Ito's colours, told apart with any colour vision; each curve has a marker of its own, too.
constexpr std::array<const char*, 8> colors = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                               "#e69f00", "#56b4e9", "#000000", "#8c6d00"};

// Logarithmic, from values to the page.
struct Axis {
    double log_low, log_high, at_low, at_high;

    Axis(Interval range, double page_low, double page_high)
        : log_low(std::log10(range.low)), log_high(std::log10(range.high)), at_low(page_low), at_high(page_high) {}
    double at(double value) const {
        const double part = (std::log10(value) - log_low) / (log_high - log_low);
        return at_low + (at_high - at_low) * std::clamp(part, 0.0, 1.0);
    }
};

// As character references.
std::string superscript(int exponent) {
    constexpr std::array digits = {"&#8304;", "&#185;",  "&#178;",  "&#179;",  "&#8308;",
                                   "&#8309;", "&#8310;", "&#8311;", "&#8312;", "&#8313;"};
    std::string result;
    for (const char c : std::to_string(exponent)) result += c == '-' ? "&#8315;" : digits.at(std::size_t(c - '0'));
    return result;
}

class Drawing {
  public:
    explicit Drawing(const Plot& plot)
        : plot_(plot), x_(range_of(plot, true), left, right), y_(range_of(plot, false), bottom, top) {
        out_ << std::fixed << std::setprecision(1);
    }
    std::string draw();

  private:
    static Interval range_of(const Plot& plot, bool is_error);
    void line(double x0, double y0, double x1, double y1, const std::string& style);
    void text(double x, double y, const std::string& what, const std::string& style);
    void draw_axis(const Axis& axis, bool is_horizontal);
    void draw_floor();
    void draw_bars(const PlotPoint& point, const char* color);
    void draw_marker(const PlotPoint& point, std::size_t style);
    void draw_fit(const PlotCurve& curve, const char* color);
    void draw_legend();

    const Plot& plot_;
    Axis x_, y_;
    std::ostringstream out_;
};

Interval Drawing::range_of(const Plot& plot, bool is_error) {
    double low = std::numeric_limits<double>::infinity(), high = 0;
    const auto include = [&](double value) {
        if (!(value > 0) || !std::isfinite(value)) return;
        low = std::min(low, value);
        high = std::max(high, value);
    };
    for (const PlotCurve& curve : plot.curves)
        for (const PlotPoint& point : curve.points) {
            const Interval& around = is_error ? point.error_95 : point.time_95;
            for (const double value : {is_error ? point.error : point.time, around.low, around.high}) include(value);
        }
    if (is_error && plot.floor) include(*plot.floor);
    return decades_around(low, high);
}

void Drawing::line(double x0, double y0, double x1, double y1, const std::string& style) {
    out_ << "<line x1=\"" << x0 << "\" y1=\"" << y0 << "\" x2=\"" << x1 << "\" y2=\"" << y1 << "\" " << style << "/>\n";
}

void Drawing::text(double x, double y, const std::string& what, const std::string& style) {
    out_ << "<text x=\"" << x << "\" y=\"" << y << "\" " << style << ">" << escaped(what) << "</text>\n";
}

// A line and a label at each decade, at every n-th where they would overlap; ticks between within few decades.
void Drawing::draw_axis(const Axis& axis, bool is_horizontal) {
    const int first = static_cast<int>(std::lround(axis.log_low)), last = static_cast<int>(std::lround(axis.log_high));
    const int step = std::max(1, (last - first + 7) / 8);
    for (int decade = first; decade <= last; ++decade) {
        const double at = axis.at(std::pow(10.0, decade));
        const std::string style = "stroke=\"#ddd\"";
        is_horizontal ? line(at, top, at, bottom, style) : line(left, at, right, at, style);
        if ((decade - first) % step == 0) {
            const double x = is_horizontal ? at : left - 6, y = is_horizontal ? bottom + 16 : at + 4;
            out_ << "<text x=\"" << x << "\" y=\"" << y << "\" text-anchor=\"" << (is_horizontal ? "middle" : "end")
                 << "\">10" << superscript(decade) << "</text>\n";
        }
        for (int digit = 2; digit < 10 && decade < last && last - first <= 3; ++digit) {
            const double tick = axis.at(digit * std::pow(10.0, decade));
            is_horizontal ? line(tick, bottom - 4, tick, bottom, "stroke=\"#999\"")
                          : line(left, tick, left + 4, tick, "stroke=\"#999\"");
        }
    }
}

void Drawing::draw_floor() {
    if (!plot_.floor) return;
    const double at = x_.at(*plot_.floor);
    line(at, top, at, bottom, "stroke=\"#777\" stroke-dasharray=\"2 3\"");
    text(at + 3, top + 11, "floor: rounding", "fill=\"#777\" font-size=\"10\"");
}

void Drawing::draw_bars(const PlotPoint& point, const char* color) {
    const std::string style = std::string("stroke=\"") + color + "\" stroke-opacity=\"0.6\"";
    const double x = x_.at(point.error), y = y_.at(point.time);
    const auto low_end = [](double low, double value) { return low > 0 ? low : value; };
    line(x, y_.at(low_end(point.time_95.low, point.time)), x, y_.at(std::max(point.time_95.high, point.time)), style);
    if (point.is_zero) {  // the truth lies anywhere below
        line(x, y, x - 16, y, style);
        out_ << "<path class=\"zero\" d=\"M" << x - 20 << ' ' << y << " l6 -3.5 v7 z\" fill=\"" << color << "\"/>\n";
        return;
    }
    line(point.error_95.low > 0 ? x_.at(point.error_95.low) : left, y,
         x_.at(std::max(point.error_95.high, point.error)), y, style);
}

void Drawing::draw_marker(const PlotPoint& point, std::size_t style) {
    const char* color = colors[style % colors.size()];
    const double x = x_.at(point.error), y = y_.at(point.time);
    out_ << "<path class=\"point\" fill=\"" << (point.is_zero ? "#fff" : color) << "\" stroke=\"" << color << "\" d=\"M"
         << x << ' ' << y;
    switch (style % 4) {
        case 0: out_ << " m-4 0 a4 4 0 1 0 8 0 a4 4 0 1 0 -8 0 z"; break;
        case 1: out_ << " m-3.5 -3.5 h7 v7 h-7 z"; break;
        case 2: out_ << " m0 -4.5 l4 7.5 h-8 z"; break;
        default: out_ << " m0 -5 l5 5 l-5 5 l-5 -5 z"; break;
    }
    std::ostringstream value;
    value << point.label << ": error " << (point.is_zero ? "0, below " : "") << point.error << ", " << point.time << ' '
          << plot_.time_label;
    out_ << "\"><title>" << escaped(value.str()) << "</title></path>\n";
}

void Drawing::draw_fit(const PlotCurve& curve, const char* color) {
    if (!curve.fit) return;
    double low = std::numeric_limits<double>::infinity(), high = 0;
    for (const PlotPoint& point : curve.points)
        if (!point.is_zero) low = std::min(low, point.error), high = std::max(high, point.error);
    const auto time_at = [&](double error) { return curve.fit->scale * std::pow(error, curve.fit->slope); };
    line(x_.at(low), y_.at(time_at(low)), x_.at(high), y_.at(time_at(high)),
         std::string("class=\"fit\" stroke=\"") + color + "\" stroke-dasharray=\"5 4\" stroke-opacity=\"0.7\"");
}

void Drawing::draw_legend() {
    double y = top + 8;
    for (const PlotCurve& curve : plot_.curves) {
        const std::string fill = std::string("fill=\"") + colors[curve.style % colors.size()] + "\"";
        out_ << "<rect x=\"" << right + 18 << "\" y=\"" << y - 8 << "\" width=\"9\" height=\"9\" " << fill << "/>\n";
        text(right + 33, y, curve.name, "font-weight=\"600\"");
        std::ostringstream slope;
        if (curve.fit) {
            slope << std::fixed << std::setprecision(2) << "slope " << curve.fit->slope << " ["
                  << curve.fit->slope_95.low << ", " << curve.fit->slope_95.high << "]";
        } else {
            slope << curve.points.size() << (curve.points.size() == 1 ? " point" : " points");
        }
        text(right + 33, y + 14, slope.str(), "fill=\"#555\" font-size=\"10\"");
        y += 34;
    }
}

std::string Drawing::draw() {
    out_ << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " << width << ' ' << height << "\" width=\""
         << width << "\" height=\"" << height << "\" font-family=\"sans-serif\" font-size=\"11\" role=\"img\">\n"
         << "<rect width=\"" << width << "\" height=\"" << height << "\" fill=\"#fff\"/>\n";
    text(left, 20, plot_.title, "font-size=\"14\" font-weight=\"600\"");
    draw_axis(x_, true);
    draw_axis(y_, false);
    line(left, bottom, right, bottom, "stroke=\"#333\"");
    line(left, top, left, bottom, "stroke=\"#333\"");
    text((left + right) / 2, bottom + 36, plot_.error_label, "text-anchor=\"middle\"");
    out_ << "<text transform=\"translate(18 " << (top + bottom) / 2 << ") rotate(-90)\" text-anchor=\"middle\">"
         << escaped(plot_.time_label) << "</text>\n";
    draw_floor();
    for (const PlotCurve& curve : plot_.curves) {
        const char* color = colors[curve.style % colors.size()];
        draw_fit(curve, color);
        for (const PlotPoint& point : curve.points) draw_bars(point, color);
        for (const PlotPoint& point : curve.points) draw_marker(point, curve.style);
    }
    draw_legend();
    out_ << "</svg>\n";
    return out_.str();
}

}  // namespace

Interval decades_around(double low, double high) {
    if (!(low > 0) || !(high >= low)) return {0.1, 10};
    // A margin, so that no marker lies on the frame.
    const double first = std::floor(std::log10(low / 1.25)), last = std::ceil(std::log10(high * 1.25));
    return {std::pow(10.0, first), std::pow(10.0, std::max(last, first + 1))};
}

std::string svg(const Plot& plot) { return Drawing(plot).draw(); }

std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) switch (c) {
            case '&': result += "&amp;"; break;
            case '<': result += "&lt;"; break;
            case '>': result += "&gt;"; break;
            case '"': result += "&quot;"; break;
            default: result += static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t' ? '?' : c;
        }
    return result;
}

}  // namespace twinray::report
