// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osteon::metrics {

// A diagram of lines, for documentation: axes from a round number to a round number, a light grid, the lines' names at their right ends.
struct PlotLine {
  std::string name;
  std::vector<std::pair<double, double>> points;  // x rising; points that are not finite are left out
  bool dashed = false;                            // for what others are to be compared with: grey, without dots
};

struct PlotAxis {
  std::string label;
  std::optional<double> low = {}, high = {};  // else what the lines need
};

struct LinePlot {
  std::string title;
  PlotAxis x, y;
  std::vector<PlotLine> lines;  // at most 6: as many colours
};

// As an SVG picture, 640 x 400. Throws Error naming the file when it cannot be written. Pre: some point is finite.
std::string to_svg(const LinePlot& plot);
void save_svg(const std::filesystem::path& path, const LinePlot& plot);

}  // namespace osteon::metrics
