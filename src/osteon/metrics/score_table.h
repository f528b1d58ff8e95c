// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

namespace osteon::metrics {

struct ScoreColumn {
  std::string key;      // in JSON: "iou"
  std::string name;     // in the table: "IoU %"
  double factor = 1.0;  // values are shown times this: 100 for percent
  int digits = 2;       // after the decimal point
};

struct ScoreRow {
  std::string id, category;
  std::vector<double> values;  // one for each column; NaN where a measure is not defined for this character
};

struct ScoreTable {
  std::string title;
  std::vector<ScoreColumn> columns;
  std::vector<ScoreRow> rows;
  std::vector<std::string> failures;  // "id: reason" of the characters that gave no row
};

// Mean with a 95 % interval: the 2.5th and 97.5th percentile of the means of 2000 resamples (percentile bootstrap: Efron and Tibshirani,
// "An Introduction to the Bootstrap", 1993, ch. 13), drawn with a fixed seed. NaNs are left out.
struct Estimate {
  double mean, low, high;
  std::size_t count;
};
Estimate estimate(std::span<const double> values);

// Means by category, in alphabetical order, and overall with the interval, as aligned text; of a single row just that.
std::string to_text(const ScoreTable& table);
// The same with intervals for every category, every character's values and the failures; values without the columns' factor.
nlohmann::json to_json(const ScoreTable& table);

}  // namespace osteon::metrics
