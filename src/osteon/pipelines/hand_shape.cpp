// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/hand_shape.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <span>

#include "osteon/geometry/branches.h"
#include "osteon/geometry/surface_graph.h"

namespace osteon::pipelines {
namespace {

constexpr float kCrop = 0.32f;                            // the part of the surface around the end of the limb that is looked at
constexpr float kStart = 0.06f;                           // how deep the part of the surface is that the way starts from
constexpr float kHand = 0.2f;                             // from the longest fingertip to where the last finger leaves the hand, at most
constexpr float kLeast = 0.012f, kMost = 0.12f;           // length of a finger, from its web
constexpr float kShortest = 0.4f;                         // of the hand's median finger
constexpr float kThinEach = 1.8f, kThin = 4.2f;           // length in parts of the half width: of each finger, of the median
constexpr float kRoundEach = 0.5f, kRound = 0.65f;        // narrow in parts of wide: feathers are flat
constexpr float kGround = 0.03f;                          // fingertips are higher; toes are not
constexpr std::size_t kVerticesEach = 8, kVertices = 20;  // of each finger, of the median: fewer are no loops for three joints
constexpr int kSections = 24;                             // of a finger
constexpr std::size_t kLeastSections = 6;

// Places of the joints of each finger, from the hand outwards.
constexpr std::array<std::array<float, 3>, 5> kJoints{
    {{2.20f, 1.42f, 0.68f}, {1.24f, 0.76f, 0.40f}, {1.18f, 0.72f, 0.37f}, {1.21f, 0.75f, 0.40f}, {1.28f, 0.79f, 0.42f}}};

// Of the wrist, from the thumb's web, in parts of the median finger: where the narrowest section may be, the steps in which it is looked
// for, and how far before it the joint is.
constexpr float kWristFirst = 0.6f, kWristLast = 2.2f, kWristStep = 0.1f, kBeforeNarrowest = 0.1f;
constexpr float kAlike = 0.7f;  // of the longest median finger: of such hands the nearest is that of the limb
constexpr float kPalm = 4.0f;   // from the knuckles to the wrist at most; farther the surface is the body's, on which a hand lies

// The middle line of a finger. Places: 0 at the tip, 1 at the web.
struct Axis {
  std::vector<float> places;
  std::vector<Vec3f> middles;                       // the tip first
  Vec3f inwards;                                    // per place, towards the hand
  float length = 0.0f, wide = 0.0f, narrow = 0.0f;  // half widths
  float web = 0.0f;                                 // how far along the surface it begins
  std::size_t vertices = 0;
  std::size_t straight = 0;  // the place from which it is continued: the last before the web widens it

  Vec3f at(float place) const {
    if (place >= places.back()) return middles[straight] + (place - places[straight]) * inwards;
    const auto after = static_cast<std::size_t>(std::ranges::upper_bound(places, place) - places.begin());
    const float part = (place - places[after - 1]) / (places[after] - places[after - 1]);
    return middles[after - 1] + part * (middles[after] - middles[after - 1]);
  }
};

TriangleMesh around(const TriangleMesh& mesh, const Vec3f& middle) {
  const auto near = [&](VertexId v) { return (mesh.positions[v] - middle).squaredNorm() <= kCrop * kCrop; };
  PerVertex<std::optional<VertexId>> number(mesh.positions.size());
  TriangleMesh out;
  for (const Triangle& face : mesh.faces) {
    if (!std::ranges::all_of(face, near)) continue;
    for (VertexId v : face)
      if (!number[v]) number[v] = out.positions.push_back(mesh.positions[v]);
    out.faces.push_back({*number[face[0]], *number[face[1]], *number[face[2]]});
  }
  return out;
}

// Along the surface, in each of its pieces from the part that is nearest to a point: so the sections of fingers are straight across.
std::vector<float> distances_from(const Vec3f& point, const TriangleMesh& mesh) {
  const Components pieces = connected_components(mesh);
  std::vector<std::optional<VertexId>> nearest(pieces.count);
  const auto distance = [&](VertexId v) { return (mesh.positions[v] - point).norm(); };
  for (VertexId v : mesh.positions.ids())
    if (auto& best = nearest[pieces.of[v]]; !best || distance(v) < distance(*best)) best = v;
  std::vector<float> start(mesh.positions.size(), std::numeric_limits<float>::infinity());
  for (VertexId v : mesh.positions.ids())
    if (distance(v) <= distance(*nearest[pieces.of[v]]) + kStart) start[index(v)] = distance(v);
  return geometry::shortest_paths(geometry::surface_graph(mesh), std::move(start));
}

// Where the surface of branches has one distance from the body.
struct Section {
  Vec3f middle;
  float wide, narrow;  // half widths, as of an ellipse
};

class Sections {
 public:
  Sections(const TriangleMesh& mesh, std::span<const float> distance, std::span<const geometry::Branch* const> branches)
      : mesh_(mesh), distance_(distance), own_(mesh.positions.size(), false) {
    for (const geometry::Branch* branch : branches)
      for (VertexId v : branch->vertices) own_[index(v)] = true;
    for (const Triangle& face : mesh.faces)
      if (std::ranges::any_of(face, [&](VertexId v) { return own_[index(v)]; })) faces_.push_back(face);
  }

  // None where fewer than three faces are cut.
  std::optional<Section> at(float level) const {
    std::vector<std::pair<Vec3f, float>> cuts;  // middle and length
    for (const Triangle& face : faces_)
      if (const auto cut = cut_of(face, level)) cuts.push_back(*cut);
    const float length = std::accumulate(cuts.begin(), cuts.end(), 0.0f, [](float sum, const auto& cut) { return sum + cut.second; });
    if (cuts.size() < 3 || !(length > 0.0f)) return std::nullopt;
    Vec3f middle = Vec3f::Zero();
    for (const auto& [p, part] : cuts) middle += part / length * p;
    Eigen::Matrix3f spread = Eigen::Matrix3f::Zero();
    for (const auto& [p, part] : cuts) spread += part / length * (p - middle) * (p - middle).transpose();
    const Vec3f variances = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f>(spread, Eigen::EigenvaluesOnly).eigenvalues().cwiseMax(0.0f);
    return Section{middle, std::sqrt(2.0f * variances[2]), std::sqrt(2.0f * variances[1])};
  }

 private:
  std::optional<std::pair<Vec3f, float>> cut_of(const Triangle& face, float level) const {
    const auto beyond = [&](VertexId v) { return distance_[index(v)] >= level; };
    const auto count = std::ranges::count_if(face, beyond);
    if (count == 0 || count == 3) return std::nullopt;
    if (std::ranges::any_of(face, [&](VertexId v) { return beyond(v) && !own_[index(v)]; })) return std::nullopt;
    const std::size_t odd =
        static_cast<std::size_t>(std::ranges::find_if(face, [&](VertexId v) { return beyond(v) == (count == 1); }) - face.begin());
    const auto crossing = [&](VertexId other) {
      const float a = distance_[index(face[odd])], b = distance_[index(other)];
      return Vec3f(mesh_.positions[face[odd]] + (level - a) / (b - a) * (mesh_.positions[other] - mesh_.positions[face[odd]]));
    };
    const Vec3f p = crossing(face[(odd + 1) % 3]), q = crossing(face[(odd + 2) % 3]);
    return std::pair(Vec3f(0.5f * (p + q)), (p - q).norm());
  }

  const TriangleMesh& mesh_;
  std::span<const float> distance_;
  std::vector<bool> own_;
  std::vector<Triangle> faces_;
};

float median(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

// The direction, per place, of the middles between 0.3 and 0.9 (least squares).
std::optional<Vec3f> inwards(const Axis& axis) {
  float n = 0.0f, place = 0.0f, squares = 0.0f;
  Vec3f middle = Vec3f::Zero(), products = Vec3f::Zero();
  for (std::size_t k = 1; k < axis.places.size(); ++k) {
    const float t = axis.places[k];
    if (t < 0.3f || t > 0.9f) continue;
    n += 1.0f;
    place += t;
    squares += t * t;
    middle += axis.middles[k];
    products += t * axis.middles[k];
  }
  const float spread = n * squares - place * place;
  if (n < 3.0f || !(spread > 0.0f)) return std::nullopt;
  return Vec3f((n * products - place * middle) / spread);
}

std::optional<Axis> axis_of(const geometry::Branch& branch, const TriangleMesh& mesh, std::span<const float> distance) {
  Axis axis;
  axis.length = branch.length();
  axis.web = branch.base;
  axis.vertices = branch.vertices.size();
  if (axis.vertices < kVerticesEach || axis.length < kLeast || axis.length > kMost) return std::nullopt;
  axis.places.push_back(0.0f);
  axis.middles.push_back(mesh.positions[branch.tip]);
  std::vector<float> wide, narrow;
  const std::array only{&branch};
  const Sections sections(mesh, distance, only);
  for (int k = 0; k < kSections; ++k) {
    const float place = 0.06f + 0.04f * static_cast<float>(k);
    const auto section = sections.at(branch.top - place * axis.length);
    if (!section) continue;
    axis.places.push_back(place);
    axis.middles.push_back(section->middle);
    wide.push_back(section->wide);
    narrow.push_back(section->narrow);
  }
  const auto direction = inwards(axis);
  if (wide.size() < kLeastSections || !direction) return std::nullopt;
  axis.inwards = *direction;
  axis.wide = median(std::move(wide));
  axis.narrow = median(std::move(narrow));
  while (axis.straight + 1 < axis.places.size() && axis.places[axis.straight + 1] < 0.87f) ++axis.straight;
  if (axis.length < kThinEach * axis.wide || axis.narrow < kRoundEach * axis.wide) return std::nullopt;
  return axis;
}

float median_of(const std::vector<Axis>& fingers, float (*value)(const Axis&)) {
  std::vector<float> values;
  for (const Axis& finger : fingers) values.push_back(value(finger));
  return median(std::move(values));
}

// The thumb leaves the hand first; the others follow as they stand beside it. Empty where that is no hand.
std::vector<Axis> fingers_of(std::vector<Axis> fingers) {
  if (fingers.empty()) return {};
  const float length = median_of(fingers, [](const Axis& f) { return f.length; });
  std::erase_if(fingers, [&](const Axis& f) { return f.length < kShortest * length; });
  if (fingers.size() < 4 || fingers.size() > kJoints.size()) return {};
  if (median_of(fingers, [](const Axis& f) { return static_cast<float>(f.vertices); }) < static_cast<float>(kVertices)) return {};
  if (median_of(fingers, [](const Axis& f) { return f.length / f.wide; }) < kThin) return {};
  if (median_of(fingers, [](const Axis& f) { return f.narrow / f.wide; }) < kRound) return {};
  if (std::ranges::any_of(fingers, [](const Axis& f) { return f.middles.front().y() < kGround; })) return {};
  std::ranges::iter_swap(fingers.begin(), std::ranges::min_element(fingers, {}, &Axis::web));
  const Vec3f thumb = fingers.front().at(1.0f);
  std::ranges::sort(fingers.begin() + 1, fingers.end(), {}, [&](const Axis& f) { return (f.at(1.0f) - thumb).norm(); });
  return fingers;
}

// A part of the surface that begins within `kHand` of its farthest point, the largest such: all its branches, and those that end freely.
struct Bunch {
  std::vector<const geometry::Branch*> all, ends;
};

std::vector<Bunch> bunches(const std::vector<geometry::Branch>& list) {
  std::vector<float> begins(list.size(), -1.0f);  // where the last of its children meet; none: it ends freely
  for (const auto& b : list)
    if (b.parent) begins[*b.parent] = b.base;
  const auto fits = [&](std::size_t b) { return begins[b] < 0.0f || list[b].top - begins[b] <= kHand; };
  std::map<std::size_t, Bunch> found;
  for (std::size_t branch = 0; branch < list.size(); ++branch) {
    if (!fits(branch)) continue;
    std::size_t bunch = branch;
    while (list[bunch].parent && fits(*list[bunch].parent)) bunch = *list[bunch].parent;
    found[bunch].all.push_back(&list[branch]);
    if (begins[branch] < 0.0f) found[bunch].ends.push_back(&list[branch]);
  }
  std::vector<Bunch> out;
  for (auto& [first, bunch] : found) out.push_back(std::move(bunch));
  return out;
}

// In the middle of where the fingers leave the hand, without the thumb.
Vec3f knuckles_of(const std::vector<Axis>& fingers) {
  Vec3f sum = Vec3f::Zero();
  for (std::size_t k = 1; k < fingers.size(); ++k) sum += fingers[k].at(1.0f);
  return sum / static_cast<float>(fingers.size() - 1);
}

struct Found {
  HandShape shape;
  float length;  // of the median finger
  float away;    // from the end of the limb
};

std::optional<Vec3f> wrist_of(const Bunch& bunch, const std::vector<Axis>& fingers, const TriangleMesh& mesh,
                              std::span<const float> distance) {
  const float length = median_of(fingers, [](const Axis& f) { return f.length; });
  const Sections sections(mesh, distance, bunch.all);
  const auto at = [&](float way) { return sections.at(fingers.front().web - way * length); };
  std::optional<float> narrowest;
  float least = std::numeric_limits<float>::infinity();
  for (int k = 0; kWristFirst + kWristStep * static_cast<float>(k) <= kWristLast; ++k) {
    const float way = kWristFirst + kWristStep * static_cast<float>(k);
    const auto section = at(way);
    if (!section) break;
    if (section->wide * section->narrow >= least) continue;
    least = section->wide * section->narrow;
    narrowest = way;
  }
  if (!narrowest) return std::nullopt;
  const auto section = at(*narrowest - kBeforeNarrowest);
  if (!section) return std::nullopt;
  return (section->middle - knuckles_of(fingers)).norm() <= kPalm * length ? std::optional(section->middle) : std::nullopt;
}

HandShape shape_of(const std::vector<Axis>& fingers) {
  HandShape hand;
  for (std::size_t k = 0; k < fingers.size(); ++k) {
    FingerShape& finger = hand.fingers.emplace_back(FingerShape{fingers[k].middles.front(), {}, fingers[k].wide});
    for (float place : kJoints[k]) finger.joints.push_back(fingers[k].at(place));
  }
  return hand;
}

}  // namespace

std::optional<HandShape> find_hand(const TriangleMesh& mesh, const Vec3f& end, const Vec3f& from) {
  const TriangleMesh part = around(mesh, end);
  if (part.faces.empty()) return std::nullopt;
  const std::vector<float> distance = distances_from(from, part);
  const std::vector<geometry::Branch> branches = geometry::branches(geometry::one_ring(part), distance, kLeast);
  std::vector<Found> hands;
  for (const Bunch& bunch : bunches(branches)) {
    if (bunch.ends.size() < 4) continue;
    std::vector<Axis> axes;
    for (const geometry::Branch* branch : bunch.ends)
      if (auto axis = axis_of(*branch, part, distance)) axes.push_back(std::move(*axis));
    const std::vector<Axis> fingers = fingers_of(std::move(axes));
    if (fingers.empty()) continue;
    Found& hand = hands.emplace_back(
        Found{shape_of(fingers), median_of(fingers, [](const Axis& f) { return f.length; }), (knuckles_of(fingers) - end).norm()});
    hand.shape.wrist = wrist_of(bunch, fingers, part, distance);
  }
  if (hands.empty()) return std::nullopt;
  const float longest = std::ranges::max(hands, {}, &Found::length).length;
  std::erase_if(hands, [&](const Found& hand) { return hand.length < kAlike * longest; });
  return std::ranges::min(hands, {}, &Found::away).shape;
}

}  // namespace osteon::pipelines
