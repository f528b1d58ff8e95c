// SPDX-License-Identifier: Apache-2.0
#include "osteon/metrics/score_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "osteon/base/random.h"

namespace osteon::metrics {
namespace {

using json = nlohmann::json;
using Group = std::vector<const ScoreRow*>;

constexpr int kResamples = 2000;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double mean(std::span<const double> values) {
  double sum = 0.0;
  for (double v : values) sum += v;
  return values.empty() ? kNaN : sum / static_cast<double>(values.size());
}

std::vector<double> resampled_means(std::span<const double> values) {
  Random random(1);
  std::vector<double> means;
  for (int i = 0; i < kResamples; ++i) {
    double sum = 0.0;
    for (std::size_t k = 0; k < values.size(); ++k) sum += values[random.below(values.size())];
    means.push_back(sum / static_cast<double>(values.size()));
  }
  std::sort(means.begin(), means.end());
  return means;
}

std::vector<double> column_of(const Group& rows, std::size_t column) {
  std::vector<double> values;
  for (const ScoreRow* row : rows) values.push_back(row->values[column]);
  return values;
}

std::map<std::string, Group> by_category(const ScoreTable& table) {
  std::map<std::string, Group> groups;
  for (const ScoreRow& row : table.rows) groups[row.category].push_back(&row);
  return groups;
}

Group all_rows(const ScoreTable& table) {
  Group rows;
  for (const ScoreRow& row : table.rows) rows.push_back(&row);
  return rows;
}

std::string number(double value, const ScoreColumn& column) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value * column.factor, column.digits);
}

std::vector<std::string> line_of(const std::string& name, const Group& rows, const ScoreTable& table) {
  std::vector<std::string> line{name, std::to_string(rows.size())};
  for (std::size_t c = 0; c < table.columns.size(); ++c) line.push_back(number(estimate(column_of(rows, c)).mean, table.columns[c]));
  return line;
}

std::vector<std::string> interval_line(const Group& rows, const ScoreTable& table) {
  std::vector<std::string> line{"95 % interval", ""};
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const Estimate e = estimate(column_of(rows, c));
    line.push_back(number(e.low, table.columns[c]) + ".." + number(e.high, table.columns[c]));
  }
  return line;
}

// The first column to the left, the others to the right.
std::string aligned(const std::vector<std::vector<std::string>>& lines) {
  std::vector<std::size_t> widths(lines.front().size(), 0);
  for (const auto& line : lines)
    for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], line[c].size());
  std::string text;
  for (const auto& line : lines) {
    text += fmt::format("{:<{}}", line[0], widths[0]);
    for (std::size_t c = 1; c < line.size(); ++c) text += fmt::format("  {:>{}}", line[c], widths[c]);
    text += '\n';
  }
  return text;
}

json value_or_null(double value) { return std::isnan(value) ? json(nullptr) : json(value); }

json summary(const Group& rows, const ScoreTable& table) {
  json out{{"characters", rows.size()}};
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const Estimate e = estimate(column_of(rows, c));
    out[table.columns[c].key] = {
        {"mean", value_or_null(e.mean)}, {"low", value_or_null(e.low)}, {"high", value_or_null(e.high)}, {"count", e.count}};
  }
  return out;
}

}  // namespace

Estimate estimate(std::span<const double> values) {
  std::vector<double> defined;
  std::copy_if(values.begin(), values.end(), std::back_inserter(defined), [](double v) { return !std::isnan(v); });
  if (defined.empty()) return {kNaN, kNaN, kNaN, 0};
  const auto means = resampled_means(defined);
  const auto at = [&](double share) { return means[static_cast<std::size_t>(share * static_cast<double>(means.size() - 1))]; };
  return {mean(defined), at(0.025), at(0.975), defined.size()};
}

std::string to_text(const ScoreTable& table) {
  std::vector<std::string> head{table.title, "n"};
  for (const ScoreColumn& column : table.columns) head.push_back(column.name);
  std::vector<std::vector<std::string>> lines{head};
  for (const auto& [category, rows] : by_category(table)) lines.push_back(line_of(category, rows, table));
  if (table.rows.size() > 1) {
    lines.push_back(line_of("all", all_rows(table), table));
    lines.push_back(interval_line(all_rows(table), table));
  }
  std::string text = aligned(lines);
  for (const std::string& failure : table.failures) text += "failed: " + failure + '\n';
  return text;
}

json to_json(const ScoreTable& table) {
  json out{{"title", table.title}, {"all", summary(all_rows(table), table)}, {"failures", table.failures}};
  for (const auto& [category, rows] : by_category(table)) out["categories"][category] = summary(rows, table);
  out["characters"] = json::array();
  for (const ScoreRow& row : table.rows) {
    json entry{{"id", row.id}, {"category", row.category}};
    for (std::size_t c = 0; c < table.columns.size(); ++c) entry[table.columns[c].key] = value_or_null(row.values[c]);
    out["characters"].push_back(std::move(entry));
  }
  return out;
}

}  // namespace osteon::metrics
