// SPDX-License-Identifier: Apache-2.0
#include "calibration.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>

#include "evaluation.h"
#include "osteon/base/error.h"
#include "osteon/base/parallel.h"
#include "osteon/metrics/calibration.h"
#include "osteon/metrics/line_plot.h"
#include "osteon/pipelines/confidence_fit.h"
#include "osteon/synth/objects.h"
#include "progress_line.h"

namespace osteon::app {
namespace {

using metrics::LogisticFit;
using Outcomes = std::vector<metrics::Outcome>;

constexpr std::uint64_t kFitSeeds = 2, kHeldOutSeeds = 4;  // of each kind of object, from 1 and from 1001 on
constexpr double kMargin = 0.9;                            // the refusal threshold, in parts of the least confidence in a character
constexpr std::size_t kLeastShown = 10;                    // joints of a bin, to be in the diagram

// One rig: of a character, or of an object, of which no joint is right.
struct Case {
  std::string id;
  std::vector<std::optional<pipelines::JointEvidence>> joints;  // none: a hand's, which no fit is for
  std::vector<double> right;                                    // (J) 1 where the joint is one of the reference's
  pipelines::CharacterEvidence character{};
  double iou = 0.0;
  std::vector<double> joint_confidence;  // (J) as shipped
  double confidence = 0.0;

  double share_right() const { return mean(right); }
  static double mean(const std::vector<double>& values) {
    return values.empty() ? 0.0 : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  }
};

Case case_of(std::string id, const pipelines::RignetResult& result) {
  Case out;
  out.id = std::move(id);
  out.joints = result.joint_evidence;
  out.character = result.character_evidence;
  out.right.assign(out.joints.size(), 0.0);
  out.joint_confidence.assign(result.report.joint_confidence.begin(), result.report.joint_confidence.end());
  out.confidence = static_cast<double>(result.report.confidence);
  return out;
}

std::vector<Case> characters(const std::filesystem::path& data, const std::string& split, const infer::RignetModels& models,
                             const pipelines::RignetOptions& options) {
  std::vector<Case> cases;
  const auto failures = for_each_character(
      data, split, [&](std::size_t count) { cases.resize(count); },
      [&](std::size_t i, const Subject& subject) {
        const auto result = pipelines::rig_character(subject.rig.mesh, models, options);
        const Reference& reference = subject.reference;
        cases[i] = case_of(subject.info.id, result);
        cases[i].iou = reference.skeleton_scores(result.skeleton).iou;
        const auto found = metrics::found_joints(reference.in_frame(result.skeleton), reference.rig.skeleton, reference.tolerances);
        for (std::size_t j = 0; j < cases[i].right.size(); ++j) cases[i].right[j] = found.raw()[j] ? 1.0 : 0.0;
      });
  for (const std::string& failure : failures) spdlog::warn("left out: {}", failure);
  std::erase_if(cases, [](const Case& one) { return one.joints.empty(); });
  return cases;
}

std::vector<Case> objects(std::uint64_t first_seed, std::uint64_t seeds, const infer::RignetModels& models,
                          const pipelines::RignetOptions& options) {
  std::vector<Case> cases(synth::kObjects.size() * seeds);
  ProgressLine progress("evaluating objects", cases.size());
  parallel_for(cases.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t kind = i / seeds;
      const std::uint64_t seed = first_seed + i % seeds;
      cases[i] = case_of(fmt::format("{}-{}", synth::kObjects[kind], seed),
                         pipelines::rig_character(synth::make_object(kind, seed), models, options));
      progress.advance();
    }
  });
  return cases;
}

Outcomes joint_outcomes(const std::vector<Case>& cases) {
  Outcomes out;
  for (std::size_t c = 0; c < cases.size(); ++c)
    for (std::size_t j = 0; j < cases[c].joints.size(); ++j)
      if (const auto& joint = cases[c].joints[j]) out.push_back({{joint->begin(), joint->end()}, cases[c].right[j], c});
  return out;
}

Outcomes character_outcomes(const std::vector<Case>& known, const std::vector<Case>& strange) {
  Outcomes out;
  for (const std::vector<Case>* cases : {&known, &strange})
    for (const Case& one : *cases) out.push_back({{one.character.begin(), one.character.end()}, cases == &known ? 1.0 : 0.0, out.size()});
  return out;
}

std::vector<double> success_of(const Outcomes& outcomes) {
  std::vector<double> out;
  for (const auto& outcome : outcomes) out.push_back(outcome.success);
  return out;
}

std::vector<double> predictions(const LogisticFit& fit, const Outcomes& outcomes) {
  std::vector<double> out;
  for (const auto& outcome : outcomes) out.push_back(fit(outcome.evidence));
  return out;
}

// What a joint's votes say of themselves, were it taken for a probability.
std::vector<double> attention_of(const std::vector<Case>& cases) {
  std::vector<double> out;
  for (const Case& one : cases)
    for (const auto& evidence : one.joints)
      if (evidence) out.push_back(static_cast<double>((*evidence)[1]));
  return out;
}

// The confidence in all joints, where `fitted` is that in those that were voted for.
std::vector<double> and_in_hands(const std::vector<double>& fitted, const std::vector<Case>& cases) {
  std::vector<double> out;
  auto next = fitted.begin();
  for (const Case& one : cases)
    for (std::size_t j = 0; j < one.joints.size(); ++j) out.push_back(one.joints[j] ? *next++ : one.joint_confidence[j]);
  return out;
}

double mean_error(const std::vector<double>& predicted, const std::vector<double>& truth) {
  double sum = 0.0;
  for (std::size_t i = 0; i < predicted.size(); ++i) sum += std::abs(predicted[i] - truth[i]);
  return sum / static_cast<double>(predicted.size());
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const auto n = static_cast<Eigen::Index>(a.size());
  const Eigen::ArrayXd x = Eigen::Map<const Eigen::ArrayXd>(a.data(), n), y = Eigen::Map<const Eigen::ArrayXd>(b.data(), n);
  const Eigen::ArrayXd dx = x - x.mean(), dy = y - y.mean();
  return (dx * dy).sum() / std::sqrt((dx * dx).sum() * (dy * dy).sum());
}

// How far confidence is true, and what becomes of objects.
struct Quality {
  std::vector<metrics::ReliabilityBin> bins;  // joints of characters
  double joint_error;                         // expected calibration error
  double error, correlation;                  // of the confidence in characters with the share of their joints that is right
  double threshold;                           // below it a rig is refused
  std::size_t characters, characters_refused, objects, objects_refused;
};

std::size_t below(double threshold, const std::vector<double>& values) {
  return static_cast<std::size_t>(std::ranges::count_if(values, [&](double v) { return v < threshold; }));
}

// `joints`: confidence in all joints of the characters; `confidence` and `of_objects`: in the characters and in the objects.
Quality quality_of(const std::vector<Case>& known, const std::vector<double>& joints, const std::vector<double>& confidence,
                   const std::vector<double>& of_objects, double threshold) {
  std::vector<double> right, share;
  for (const Case& one : known) {
    right.insert(right.end(), one.right.begin(), one.right.end());
    share.push_back(one.share_right());
  }
  Quality out{metrics::reliability(joints, right),
              0.0,
              mean_error(confidence, share),
              correlation(confidence, share),
              threshold,
              confidence.size(),
              below(threshold, confidence),
              of_objects.size(),
              below(threshold, of_objects)};
  out.joint_error = metrics::calibration_error(out.bins);
  return out;
}

std::string to_text(const std::string& title, const Quality& q) {
  std::string text = fmt::format("{}\n  confidence in a joint   joints   right %\n", title);
  for (const auto& bin : q.bins)
    if (bin.count > 0) text += fmt::format("  {:21.2f}   {:6}   {:7.1f}\n", bin.predicted, bin.count, 100.0 * bin.success);
  text += fmt::format("  expected calibration error of the joints {:.3f}\n", q.joint_error);
  text += fmt::format("  confidence and share of right joints of the characters: mean difference {:.3f}, correlation {:.2f}\n", q.error,
                      q.correlation);
  text += fmt::format("  below {:.3f}: {} of {} characters, {} of {} objects\n", q.threshold, q.characters_refused, q.characters,
                      q.objects_refused, q.objects);
  return text;
}

nlohmann::json to_json(const Quality& q) {
  nlohmann::json bins = nlohmann::json::array();
  for (const auto& bin : q.bins)
    if (bin.count > 0) bins.push_back({{"predicted", bin.predicted}, {"right", bin.success}, {"joints", bin.count}});
  return {{"bins", bins},
          {"joint_calibration_error", q.joint_error},
          {"mean_error", q.error},
          {"correlation", q.correlation},
          {"threshold", q.threshold},
          {"characters", q.characters},
          {"characters_refused", q.characters_refused},
          {"objects", q.objects},
          {"objects_refused", q.objects_refused}};
}

// Everything that a fit sees, for other ways to fit.
nlohmann::json to_json(const std::vector<Case>& cases) {
  nlohmann::json out = nlohmann::json::array();
  for (const Case& one : cases) {
    nlohmann::json evidence = nlohmann::json::array();
    for (const auto& joint : one.joints) evidence.push_back(joint ? nlohmann::json(*joint) : nlohmann::json(nullptr));
    out.push_back({{"id", one.id},
                   {"iou", one.iou},
                   {"confidence", one.confidence},
                   {"evidence", one.character},
                   {"joints", {{"right", one.right}, {"confidence", one.joint_confidence}, {"evidence", evidence}}}});
  }
  return out;
}

std::string fit_line(const char* kind, const char* name, const char* evidence, const LogisticFit& fit) {
  std::vector<std::string> factors;
  for (const double factor : fit.factors) factors.push_back(fmt::format("{:#.5g}f", factor));
  return fmt::format("constexpr {}<{}.size()> {}{{{:#.5g}f, {{{}}}}};\n\n", kind, evidence, name, fit.bias, fmt::join(factors, ", "));
}

std::string header(const LogisticFit& joints, const LogisticFit& characters, double threshold) {
  return "// SPDX-License-Identifier: Apache-2.0\n#pragma once\n\n#include \"osteon/pipelines/confidence.h\"\n\n"
         "// Written by scripts/calibrate for the networks in models/rignet; run it again when they, or how joints are found, change.\n"
         "namespace osteon::pipelines {\n\n" +
         fit_line("Logistic", "kJointFit", "kJointEvidence", joints) +
         fit_line("Logistic", "kCharacterFit", "kCharacterEvidence", characters) +
         fmt::format("// Below this confidence a rig should not be used unseen.\nconstexpr float kLowConfidence = {:.3f}f;\n\n",
                     threshold) +
         "}  // namespace osteon::pipelines\n";
}

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw Error("{}: cannot be written", path.string());
}

metrics::PlotLine line_of(std::string name, const std::vector<metrics::ReliabilityBin>& bins) {
  metrics::PlotLine line{std::move(name), {}};
  for (const auto& bin : bins)
    if (bin.count >= kLeastShown) line.points.emplace_back(bin.predicted, bin.success);
  return line;
}

// Confidence in each case: the probability of a character times the mean of its joints', which come one after the other.
std::vector<double> products(const std::vector<Case>& cases, const std::vector<double>& character, const std::vector<double>& joints) {
  std::vector<double> out;
  auto next = joints.begin();
  for (std::size_t c = 0; c < cases.size(); ++c) {
    const auto end = next + static_cast<std::ptrdiff_t>(cases[c].joints.size());
    out.push_back(character[c] * Case::mean({next, end}));
    next = end;
  }
  return out;
}

Quality quality_as_shipped(const std::vector<Case>& known, const std::vector<Case>& unseen) {
  std::vector<double> joints, confidence, of_objects;
  for (const Case& one : known) {
    joints.insert(joints.end(), one.joint_confidence.begin(), one.joint_confidence.end());
    confidence.push_back(one.confidence);
  }
  for (const Case& one : unseen) of_objects.push_back(one.confidence);
  return quality_of(known, joints, confidence, of_objects, static_cast<double>(pipelines::kLowConfidence));
}

// Joints are judged as those of characters; whether it is one, by as many objects.
struct Fits {
  LogisticFit joints, characters;
  Quality quality;  // cross-validated; for objects that had no part in it
};

Fits fit(const std::vector<Case>& known, const std::vector<Case>& strange, const std::vector<Case>& unseen) {
  const Outcomes joints = joint_outcomes(known), characters = character_outcomes(known, strange);
  constexpr auto allowed = metrics::Factors::not_negative;  // all of it is evidence for a joint or a character
  const LogisticFit joint_fit = metrics::fit_logistic(joints, allowed), character_fit = metrics::fit_logistic(characters, allowed);
  const std::vector<double> joint_values = and_in_hands(metrics::cross_validated(joints, allowed), known);
  const std::vector<double> confidence = products(known, metrics::cross_validated(characters, allowed), joint_values);
  const std::vector<double> of_objects = products(unseen, predictions(character_fit, character_outcomes({}, unseen)),
                                                  and_in_hands(predictions(joint_fit, joint_outcomes(unseen)), unseen));
  const std::vector<double> shipped =
      products(known, predictions(character_fit, character_outcomes(known, {})), and_in_hands(predictions(joint_fit, joints), known));
  const double threshold = std::floor(1000.0 * kMargin * std::ranges::min(shipped)) / 1000.0;
  return {joint_fit, character_fit, quality_of(known, joint_values, confidence, of_objects, threshold)};
}

}  // namespace

std::string save_calibration(const std::filesystem::path& folder, const std::filesystem::path& data, const std::string& split,
                             const infer::RignetModels& models, const pipelines::RignetOptions& options) {
  const std::vector<Case> known = characters(data, split, models, options), strange = objects(1, kFitSeeds, models, options),
                          unseen = objects(1001, kHeldOutSeeds, models, options);
  if (known.empty()) throw Error("{}: no character of split '{}' has joints to learn from", data.string(), split);

  const Quality shipped = quality_as_shipped(known, unseen);
  const Fits fitted = fit(known, strange, unseen);
  write(folder / "confidence_fit.h", header(fitted.joints, fitted.characters, fitted.quality.threshold));
  write(folder / "calibration.json", nlohmann::json({{"shipped", to_json(shipped)},
                                                     {"fitted", to_json(fitted.quality)},
                                                     {"characters", to_json(known)},
                                                     {"objects", to_json(strange)},
                                                     {"held_out_objects", to_json(unseen)}})
                                         .dump(1));
  metrics::save_svg(folder / "confidence.svg",
                    {"Joints of each confidence that are right",
                     {"confidence", 0.0, 1.0},
                     {"share that is right", 0.0, 1.0},
                     {line_of("confidence", shipped.bins),
                      line_of("attention alone", metrics::reliability(attention_of(known), success_of(joint_outcomes(known)))),
                      {"as it should be", {{0.0, 0.0}, {1.0, 1.0}}, true}}});
  return to_text("as shipped, on " + split, shipped) + to_text("fitted anew on " + split + ", cross-validated", fitted.quality);
}

}  // namespace osteon::app
