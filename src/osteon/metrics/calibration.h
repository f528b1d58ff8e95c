// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace osteon::metrics {

// One thing that was predicted: what was known of it, and how it came out (0 wrong .. 1 right).
struct Outcome {
  std::vector<float> evidence;
  double success;
  std::size_t group;  // outcomes of one character belong together
};

// p = 1 / (1 + exp(-(bias + factors * evidence)))
struct LogisticFit {
  double bias;
  std::vector<double> factors;

  double operator()(std::span<const float> evidence) const;
};

enum class Factors { any, not_negative };

// The factors that make the outcomes likeliest, by Newton's method (McCullagh, Nelder. Generalized Linear Models. 1989, section 4.4;
// outcomes between 0 and 1: Papke, Wooldridge 1996). `ridge` times the sum of the squared factors of the standardised evidence is added to
// the loss, so that few outcomes do not fit too closely. Not negative: evidence that would speak against success is left out. Pre: there
// are outcomes, all with equally much evidence.
LogisticFit fit_logistic(std::span<const Outcome> outcomes, Factors allowed = Factors::any, double ridge = 1.0);

// For every outcome the prediction of a fit to all outcomes but those of its group.
std::vector<double> cross_validated(std::span<const Outcome> outcomes, Factors allowed = Factors::any, double ridge = 1.0);

struct ReliabilityBin {
  double predicted, success;  // means; NaN where the bin is empty
  std::size_t count;
};

// Outcomes by what was predicted of them, in equal steps of 0..1. Pre: equally many of both.
std::vector<ReliabilityBin> reliability(std::span<const double> predicted, std::span<const double> success, std::size_t bins = 10);

// Mean of |predicted - success| over the bins, weighted by count: the expected calibration error. Naeini, Cooper, Hauskrecht. Obtaining
// well calibrated probabilities using Bayesian binning. AAAI 2015.
double calibration_error(std::span<const ReliabilityBin> bins);

}  // namespace osteon::metrics
