// SPDX-License-Identifier: Apache-2.0
#include "osteon/metrics/line_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <fstream>
#include <limits>

#include "osteon/base/error.h"

namespace osteon::metrics {
namespace {

constexpr double kWidth = 640, kHeight = 400;                        // pixels
constexpr double kLeft = 64, kRight = 150, kTop = 40, kBottom = 56;  // margins: the names stand in the right one
constexpr double kLineHeight = 18;                                   // of the names
// Okabe, Ito. Color Universal Design. 2008: told apart by everybody.
constexpr std::array<const char*, 6> kColors{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00"};

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  double step = 1.0;

  void add(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
};

// 1, 2 or 5 times a power of ten: about `count` of them in the length.
double round_step(double length, int count) {
  const double raw = length / count, power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (raw <= factor * power * 1.0001) return factor * power;
  return 10.0 * power;
}

// From a round number to a round number, unless the axis says otherwise.
Range rounded(const Range& data, const PlotAxis& axis, int steps) {
  Range out{axis.low.value_or(data.low), axis.high.value_or(data.high)};
  if (!(out.high > out.low)) out.high = out.low + 1.0;
  out.step = round_step(out.high - out.low, steps);
  if (!axis.low) out.low = out.step * std::floor(out.low / out.step + 1e-6);
  if (!axis.high) out.high = out.step * std::ceil(out.high / out.step - 1e-6);
  return out;
}

bool finite(const std::pair<double, double>& p) { return std::isfinite(p.first) && std::isfinite(p.second); }

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return out;
}

class Drawing {
 public:
  explicit Drawing(const LinePlot& plot) : plot_(plot) {
    Range x, y;
    for (const PlotLine& line : plot.lines)
      for (const auto& point : line.points)
        if (finite(point)) {
          x.add(point.first);
          y.add(point.second);
        }
    assert(x.low <= x.high && plot.lines.size() <= kColors.size());
    x_ = rounded(x, plot.x, 8);
    y_ = rounded(y, plot.y, 6);
  }

  std::string svg() {
    out_ = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" font-family=\"Helvetica, Arial, "
        "sans-serif\" font-size=\"13\" fill=\"#333\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n",
        kWidth, kHeight);
    text(kLeft, 24, "start", plot_.title, "font-weight=\"bold\" font-size=\"15\"");
    axes();
    for (std::size_t i = 0; i < plot_.lines.size(); ++i) line(plot_.lines[i], color_of(i));
    names();
    return out_ + "</svg>\n";
  }

 private:
  const char* color_of(std::size_t line) const { return plot_.lines[line].dashed ? "#777" : kColors[line]; }
  double px(double x) const { return kLeft + (x - x_.low) / (x_.high - x_.low) * (kWidth - kLeft - kRight); }
  double py(double y) const { return kHeight - kBottom - (y - y_.low) / (y_.high - y_.low) * (kHeight - kTop - kBottom); }

  void text(double x, double y, const char* anchor, const std::string& words, const std::string& style = "") {
    out_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" {}>{}</text>\n", x, y, anchor, style, escaped(words));
  }
  void stroke(double x1, double y1, double x2, double y2, const char* color) {
    out_ += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n", x1, y1, x2, y2, color);
  }

  void axes() {
    const double bottom = kHeight - kBottom, right = kWidth - kRight;
    const auto ticks = [](const Range& r) { return static_cast<int>(std::floor((r.high - r.low) / r.step + 1e-6)); };
    for (int i = 0; i <= ticks(y_); ++i) {
      const double y = y_.low + i * y_.step;
      stroke(kLeft, py(y), right, py(y), i == 0 ? "#333" : "#ddd");
      text(kLeft - 8, py(y) + 4, "end", fmt::format("{:.6g}", y));
    }
    for (int i = 0; i <= ticks(x_); ++i) {
      const double x = x_.low + i * x_.step;
      stroke(px(x), bottom, px(x), bottom + 5, "#333");
      text(px(x), bottom + 20, "middle", fmt::format("{:.6g}", x));
    }
    text(0.5 * (kLeft + right), kHeight - 14, "middle", plot_.x.label);
    const double middle = 0.5 * (kTop + bottom);
    text(18, middle, "middle", plot_.y.label, fmt::format("transform=\"rotate(-90 18 {:.1f})\"", middle));
  }

  void line(const PlotLine& line, const char* color) {
    std::string path, dots;
    for (const auto& point : line.points) {
      if (!finite(point)) continue;
      const double x = px(point.first), y = py(point.second);
      path += fmt::format("{:.1f},{:.1f} ", x, y);
      if (!line.dashed) dots += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"/>\n", x, y, color);
    }
    out_ += fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"{}/>\n{}", path, color,
                        line.dashed ? " stroke-dasharray=\"6 5\"" : "", dots);
  }

  // At the heights of the lines' right ends, pushed apart where they are too close.
  void names() {
    struct Name {
      double y;
      std::size_t line;
    };
    std::vector<Name> list;
    for (std::size_t i = 0; i < plot_.lines.size(); ++i) {
      const auto& points = plot_.lines[i].points;
      const auto last = std::find_if(points.rbegin(), points.rend(), finite);
      if (last != points.rend()) list.push_back({py(last->second), i});
    }
    std::ranges::stable_sort(list, {}, &Name::y);
    for (std::size_t i = 1; i < list.size(); ++i) list[i].y = std::max(list[i].y, list[i - 1].y + kLineHeight);
    double highest = kHeight - kBottom;
    for (std::size_t i = list.size(); i-- > 0; highest = list[i].y - kLineHeight) list[i].y = std::min(list[i].y, highest);
    for (const Name& name : list)
      text(kWidth - kRight + 12, name.y + 4, "start", plot_.lines[name.line].name, fmt::format("fill=\"{}\"", color_of(name.line)));
  }

  const LinePlot& plot_;
  Range x_, y_;
  std::string out_;
};

}  // namespace

std::string to_svg(const LinePlot& plot) { return Drawing(plot).svg(); }

void save_svg(const std::filesystem::path& path, const LinePlot& plot) {
  std::ofstream file(path);
  file << to_svg(plot);
  file.close();
  if (!file) throw Error("{}: cannot write the diagram", path.string());
}

}  // namespace osteon::metrics
