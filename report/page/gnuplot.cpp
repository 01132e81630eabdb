#include "report/page/figure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <numeric>
#include <sstream>

#include "engine/core/error.h"
#include "engine/core/platform.h"
#include "report/page/wording.h"

namespace twinray::report {
namespace {

// Each has a contrast of at least 3 to 1 with white and with nearly black.
constexpr std::array colors = {"#2f81f7", "#d9730d", "#a35bd6", "#2a9d5c", "#808080", "#c94f7c", "#17909c", "#8f8420"};
const char* color(std::size_t index) { return colors[std::min(index, colors.size() - 1)]; }

// One direction of the plot.
struct Axis {
    double low = 0, high = 1;
    bool is_log = false, is_reversed = false;

    double fraction(double value) const {
        const double part = is_log ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
        return is_reversed ? 1 - part : part;
    }
};

// Returns the range of the points, with a margin; it is larger if labels follow points, and for the arrow of a bound.
Axis axis_of(const std::vector<double>& values, bool is_log, double room_after) {
    Axis axis{*std::ranges::min_element(values), *std::ranges::max_element(values), is_log, false};
    if (is_log) {
        const double span = std::max(axis.high / axis.low, 2.0);
        axis.low /= std::pow(span, 0.08);
        axis.high *= std::pow(span, 0.08 + room_after);
    } else {
        const double span = std::max(axis.high - axis.low, 1e-3);
        axis.low -= 0.08 * span;
        axis.high += (0.08 + room_after) * span;
    }
    return axis;
}

struct Axes {
    Axis x, y;
};

bool labels_points(const Figure& figure) {
    return std::ranges::any_of(figure.series, [](const FigureSeries& series) {
        return std::ranges::any_of(series.points, [](const auto& p) { return !p.label.empty(); });
    });
}

Axes axes_of(const Figure& figure) {
    std::vector<double> x, y;
    for (const FigureSeries& series : figure.series)
        for (const FigurePoint& point : series.points) {
            for (const double value : {point.x, point.x_95.low, point.x_95.high})
                if (!figure.is_log_x || value > 0) x.push_back(value);
            if (point.is_bound) x.push_back(point.x / 3);
            y.insert(y.end(), {point.y, point.y_95.low, point.y_95.high});
        }
    if (figure.mark_x) x.push_back(*figure.mark_x);
    Axes axes{axis_of(x, figure.is_log_x, labels_points(figure) && !figure.rows.empty() ? 0.45 : 0.1), {}};
    if (figure.rows.empty())
        axes.y = axis_of(y, figure.is_log_y, 0);
    else
        axes.y = {-0.6, static_cast<double>(figure.rows.size()) - 0.4, false, true};
    return axes;
}

std::string quoted(std::string words) {
    std::ranges::replace(words, '\n', ' ');
    return text(std::quoted(words));
}

struct Label {
    std::string text;
    LabelPlace place;
    std::size_t color;
};

std::vector<Label> labels_of(const Figure& figure, const Axes& axes) {
    std::vector<Label> labels;
    const auto add = [&](const std::string& text, double x, double y, std::size_t of) {
        if (!text.empty()) labels.push_back({text, {axes.x.fraction(x), axes.y.fraction(y)}, of});
    };
    for (const FigureSeries& series : figure.series) {
        for (const FigurePoint& point : series.points)
            add(point.label, figure.rows.empty() ? point.x : std::max(point.x, point.x_95.high), point.y, series.color);
        if (series.points.empty()) continue;
        const auto last = std::ranges::max_element(series.points, {}, &FigurePoint::x);
        // The label is beside the plot, where no other line passes.
        add(series.label, labels_points(figure) ? last->x : axes.x.high, last->y, series.color);
    }
    std::vector<LabelPlace> places;
    for (const Label& label : labels) places.push_back(label.place);
    places = apart(std::move(places));
    for (std::size_t i = 0; i < labels.size(); ++i) labels[i].place = places[i];
    return labels;
}

// Writes tics if powers of ten alone would leave an axis with one number or none.
void write_tics(std::ostream& out, char axis, const Axis& range) {
    const std::vector<double> tics = log_tics(range.low, range.high);
    if (tics.empty()) return;
    out << "set " << axis << "tics (";
    for (std::size_t i = 0; i < tics.size(); ++i) out << (i ? ", " : "") << quoted(number(tics[i])) << ' ' << tics[i];
    out << ")\n";
}

void write_axes(std::ostream& out, const Figure& figure, const Axes& axes) {
    const std::string text_style = std::string(" textcolor rgb \"") + text_color + '"';
    out << "set border 3 linecolor rgb \"" << text_color << "\"\nset tics nomirror" << text_style
        << "\nset grid linecolor rgb \"#80808080\"\nset xlabel " << quoted(figure.x_label) << text_style << '\n'
        << "set xrange [" << axes.x.low << ':' << axes.x.high << "]\n";
    if (figure.is_log_x) out << "set logscale x\nset format x \"%g\"\n";
    if (figure.is_log_x) write_tics(out, 'x', axes.x);
    if (figure.rows.empty()) {
        out << "set ylabel " << quoted(figure.y_label) << text_style << "\nset yrange [" << axes.y.low << ':'
            << axes.y.high << "]\n";
        if (figure.is_log_y) out << "set logscale y\nset format y \"%g\"\n";
        if (figure.is_log_y) write_tics(out, 'y', axes.y);
        return;
    }
    out << "set yrange [" << axes.y.high << ':' << axes.y.low << "]\nset ytics (";
    for (std::size_t row = 0; row < figure.rows.size(); ++row)
        out << (row ? ", " : "") << quoted(figure.rows[row]) << ' ' << row;
    out << ")\n";
}

void write_marks(std::ostream& out, const Figure& figure, const Axes& axes) {
    const bool is_above = figure.rows.empty() && labels_points(figure);
    for (const Label& label : labels_of(figure, axes))
        out << "set label " << quoted(label.text) << " at graph " << label.place.x << ",graph " << label.place.y
            << (is_above ? " center offset 0,0.7" : " left offset 1,0") << " textcolor rgb \"" << color(label.color)
            << "\"\n";
    if (figure.mark_x)
        out << "set arrow from " << *figure.mark_x << ",graph 0 to " << *figure.mark_x
            << ",graph 1 nohead linecolor rgb \"#808080\" dashtype 2\n";
    for (const FigureSeries& series : figure.series)
        for (const FigurePoint& point : series.points)
            if (point.is_bound)
                out << "set arrow from " << point.x << ',' << point.y << " to " << point.x / 3 << ',' << point.y
                    << " linewidth 2 linecolor rgb \"" << color(series.color) << "\"\n";
}

void write_data(std::ostream& out, const Figure& figure) {
    for (std::size_t i = 0; i < figure.series.size(); ++i) {
        out << "$s" << i << " << END\n";
        for (const FigurePoint& point : figure.series[i].points) {
            const bool has_bar = point.x_95.high > point.x_95.low;
            out << point.x << ' ' << point.y << ' ' << (has_bar ? point.x_95.low : point.x) << ' '
                << (has_bar ? point.x_95.high : point.x) << '\n';
        }
        out << "END\n";
    }
    const char* separator = "plot ";
    for (std::size_t i = 0; i < figure.series.size(); ++i) {
        const FigureSeries& series = figure.series[i];
        const std::string style = std::string(" linecolor rgb \"") + color(series.color) + "\" linewidth 2";
        if (series.is_joined) out << separator << "$s" << i << " using 1:2 with lines" << style, separator = ", ";
        if (series.is_joined && series.label.empty()) continue;  // a line between points of others
        out << separator << "$s" << i << " using 1:2:3:4 with xerrorbars pointtype 7 pointsize 0.8" << style;
        separator = ", ";
    }
    out << '\n';
}

// Returns the text from <svg on, without fixed sizes, in the page's colour.
std::string element_of(std::string svg, const std::string& name) {
    svg.erase(0, svg.find("<svg"));
    const std::size_t end = svg.find('>');
    std::string head = svg.substr(0, end);
    for (const char* attribute : {" width=\"", " height=\""})
        if (const std::size_t at = head.find(attribute); at != std::string::npos)
            head.erase(at, head.find('"', at + std::string_view(attribute).size()) + 1 - at);
    svg = head + " role=\"img\" aria-label=\"" + name + '"' + svg.substr(end);
    for (const std::string written : {"rgb(  1,   2,   3)", "rgb(1,2,3)", "#010203"})
        for (std::size_t at; (at = svg.find(written)) != std::string::npos;)
            svg.replace(at, written.size(), "currentColor");
    // gnuplot's own colour of a group would become the current colour.
    for (const std::string black = " color=\"black\""; svg.find(black) != std::string::npos;)
        svg.erase(svg.find(black), black.size());
    return svg;
}

}  // namespace

std::vector<LabelPlace> apart(std::vector<LabelPlace> places) {
    constexpr double height = 0.07, width = 0.3;
    std::vector<std::size_t> order(places.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return places[a].y < places[b].y; });
    for (std::size_t i = 0; i < order.size(); ++i)
        for (std::size_t below = 0; below < i; ++below) {
            LabelPlace& here = places[order[i]];
            const LabelPlace& other = places[order[below]];
            if (std::abs(here.x - other.x) < width && std::abs(here.y - other.y) < height) here.y = other.y + height;
        }
    return places;
}

std::vector<double> log_tics(double low, double high) {
    std::vector<double> tics;
    const double powers_of_ten = std::floor(std::log10(high)) - std::ceil(std::log10(low)) + 1;
    if (powers_of_ten > 1) return tics;
    const std::vector<double> steps =
        high / low > 6 ? std::vector<double>{1, 2, 5} : std::vector<double>{1, 1.5, 2, 3, 4, 5, 7};
    for (double decade = std::pow(10, std::floor(std::log10(low))); decade <= high; decade *= 10)
        for (const double step : steps)
            if (step * decade >= low && step * decade <= high) tics.push_back(step * decade);
    return tics;
}

std::string gnuplot_script(const Figure& figure, const std::filesystem::path& svg) {
    const Axes axes = axes_of(figure);
    const double height = figure.rows.empty() ? 380 : 90 + 26 * static_cast<double>(figure.rows.size());
    std::ostringstream out;
    out.precision(9);
    out << "set encoding utf8\nset terminal svg size 720," << height
        << " dynamic noenhanced font \"system-ui,13\"\nset output " << quoted(svg.string()) << "\nunset key\n";
    if (!labels_points(figure)) out << "set rmargin at screen 0.72\n";
    write_axes(out, figure, axes);
    write_marks(out, figure, axes);
    write_data(out, figure);
    return out.str();
}

std::string draw(const Figure& figure, const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    const std::filesystem::path script = folder / (figure.id + ".gp"), svg = folder / (figure.id + ".svg");
    std::ofstream(script) << gnuplot_script(figure, svg);
    const auto end = platform::run_program({"gnuplot", {script.string()}});
    if (!end) return "";
    std::ifstream in(svg);
    std::ostringstream drawn;
    drawn << in.rdbuf();
    if (end->status != 0 || drawn.str().find("</svg>") == std::string::npos)
        fail("gnuplot cannot draw '", script.string(), "' (status ", end->status, ")");
    return element_of(drawn.str(), figure.title);
}

}  // namespace twinray::report
