// SPDX-License-Identifier: Apache-2.0
#include "osteon/metrics/calibration.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <set>

namespace osteon::metrics {
namespace {

using Eigen::Index;

constexpr int kNewtonSteps = 50;
constexpr double kConverged = 1e-10;

// Each column to mean 0 and variance 1; a constant column to 0.
struct Standardisation {
  Eigen::RowVectorXd mean, scale;

  explicit Standardisation(const Eigen::MatrixXd& rows) : mean(rows.colwise().mean()) {
    const Eigen::RowVectorXd deviation = ((rows.rowwise() - mean).colwise().squaredNorm() / static_cast<double>(rows.rows())).cwiseSqrt();
    scale = (deviation.array() > 1e-9).select(deviation.array().inverse(), 0.0);
  }
  Eigen::MatrixXd apply(const Eigen::MatrixXd& rows) const { return (rows.rowwise() - mean).array().rowwise() * scale.array(); }
};

Eigen::VectorXd sigmoid(const Eigen::VectorXd& x) { return (1.0 + (-x.array()).exp()).inverse(); }

// (N, K + 1): the last column is 1.
Eigen::MatrixXd design(const Eigen::MatrixXd& rows) {
  Eigen::MatrixXd out(rows.rows(), rows.cols() + 1);
  out << rows, Eigen::VectorXd::Ones(rows.rows());
  return out;
}

Eigen::VectorXd newton(const Eigen::MatrixXd& x, const Eigen::VectorXd& y, double ridge) {
  Eigen::VectorXd w = Eigen::VectorXd::Zero(x.cols());
  Eigen::VectorXd penalty = Eigen::VectorXd::Constant(x.cols(), 2.0 * ridge);
  penalty(x.cols() - 1) = 1e-6;  // the bias is free, but finite where all outcomes are alike
  for (int step = 0; step < kNewtonSteps; ++step) {
    const Eigen::VectorXd p = sigmoid(x * w);
    const Eigen::VectorXd gradient = x.transpose() * (p - y) + penalty.cwiseProduct(w);
    const Eigen::VectorXd variance = p.array() * (1.0 - p.array());
    Eigen::MatrixXd curvature = x.transpose() * variance.asDiagonal() * x;
    curvature.diagonal() += penalty;
    const Eigen::VectorXd move = curvature.ldlt().solve(gradient);
    w -= move;
    if (move.norm() < kConverged) break;
  }
  return w;
}

double mean_or_nan(double sum, std::size_t count) {
  return count == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / static_cast<double>(count);
}

}  // namespace

double LogisticFit::operator()(std::span<const float> evidence) const {
  assert(evidence.size() == factors.size());
  double sum = bias;
  for (std::size_t k = 0; k < factors.size(); ++k) sum += factors[k] * static_cast<double>(evidence[k]);
  return 1.0 / (1.0 + std::exp(-sum));
}

LogisticFit fit_logistic(std::span<const Outcome> outcomes, Factors allowed, double ridge) {
  assert(!outcomes.empty());
  const auto rows = static_cast<Index>(outcomes.size()), columns = static_cast<Index>(outcomes.front().evidence.size());
  Eigen::MatrixXd evidence(rows, columns);
  Eigen::VectorXd success(rows);
  for (Index i = 0; i < rows; ++i) {
    const Outcome& outcome = outcomes[static_cast<std::size_t>(i)];
    evidence.row(i) = Eigen::Map<const Eigen::RowVectorXf>(outcome.evidence.data(), columns).cast<double>();
    success(i) = outcome.success;
  }
  const Standardisation standard(evidence);
  Eigen::MatrixXd known = design(standard.apply(evidence));
  Eigen::VectorXd w = newton(known, success, ridge);
  while (allowed == Factors::not_negative && w.head(columns).minCoeff() < 0.0) {
    for (Index k = 0; k < columns; ++k)
      if (w(k) < 0.0) known.col(k).setZero();
    w = newton(known, success, ridge);
  }
  const Eigen::RowVectorXd factors = w.head(columns).transpose().cwiseProduct(standard.scale);
  return {w(columns) - factors.dot(standard.mean), {factors.data(), factors.data() + columns}};
}

std::vector<double> cross_validated(std::span<const Outcome> outcomes, Factors allowed, double ridge) {
  std::set<std::size_t> groups;
  for (const Outcome& outcome : outcomes) groups.insert(outcome.group);
  std::vector<double> predicted(outcomes.size());
  for (const std::size_t group : groups) {
    std::vector<Outcome> others;
    std::ranges::copy_if(outcomes, std::back_inserter(others), [&](const Outcome& o) { return o.group != group; });
    const LogisticFit fit =
        others.empty() ? LogisticFit{0.0, std::vector<double>(outcomes.front().evidence.size())} : fit_logistic(others, allowed, ridge);
    for (std::size_t i = 0; i < outcomes.size(); ++i)
      if (outcomes[i].group == group) predicted[i] = fit(outcomes[i].evidence);
  }
  return predicted;
}

std::vector<ReliabilityBin> reliability(std::span<const double> predicted, std::span<const double> success, std::size_t bins) {
  assert(predicted.size() == success.size() && bins > 0);
  std::vector<ReliabilityBin> out(bins, {0.0, 0.0, 0});
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    const double place = std::clamp(predicted[i], 0.0, 1.0) * static_cast<double>(bins);
    ReliabilityBin& bin = out[std::min(static_cast<std::size_t>(place), bins - 1)];
    bin.predicted += predicted[i];
    bin.success += success[i];
    ++bin.count;
  }
  for (ReliabilityBin& bin : out) {
    bin.predicted = mean_or_nan(bin.predicted, bin.count);
    bin.success = mean_or_nan(bin.success, bin.count);
  }
  return out;
}

double calibration_error(std::span<const ReliabilityBin> bins) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const ReliabilityBin& bin : bins) {
    if (bin.count > 0) sum += static_cast<double>(bin.count) * std::abs(bin.predicted - bin.success);
    count += bin.count;
  }
  return mean_or_nan(sum, count);
}

}  // namespace osteon::metrics
