// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/super_skeleton.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "osteon/base/error.h"
#include "osteon/metrics/assignment.h"

namespace osteon::skin {
namespace {

constexpr float kSideCost = 0.6f, kUnspecificCost = 0.8f, kOtherKindCost = 1.6f;  // beside 0 for the joint's own kind and side
constexpr float kPlaceCost = 2.0f;                                                // of the distance, longest side 1
constexpr int kMeanRounds = 10;

// The side on which a joint without a name stands.
Side side_at(const Vec3f& p) { return p.x() > 0.02f ? Side::left : p.x() < -0.02f ? Side::right : Side::none; }

Vec3f mirrored(const Vec3f& p) { return {-p.x(), p.y(), p.z()}; }

struct Places {
  Vec3f sum = Vec3f::Zero();
  double weight = 0.0;  // of the skeletons that have it

  void add(const Vec3f& p, double w) {
    sum += static_cast<float>(w) * p;
    weight += w;
  }
  Vec3f mean() const { return weight > 0.0 ? Vec3f(sum / static_cast<float>(weight)) : sum; }
};

// How much each skeleton of a group counts: 1 / sqrt(number of them).
std::map<std::string, double> weights_of_groups(std::span<const NamedSkeleton> skeletons) {
  std::map<std::string, double> sizes;
  for (const NamedSkeleton& s : skeletons) sizes[s.group] += 1.0;
  for (auto& [group, size] : sizes) size = 1.0 / std::sqrt(size);
  return sizes;
}

// Means of places, spread out at first: the farthest from those before, then moved to the middle of what is nearest (Lloyd).
std::vector<Vec3f> clustered(const std::vector<Vec3f>& points, std::size_t count) {
  std::vector<Vec3f> centres;
  std::vector<float> distances(points.size(), 1e9f);
  for (std::size_t next = 0; centres.size() < std::min(count, points.size());) {
    centres.push_back(points[next]);
    for (std::size_t i = 0; i < points.size(); ++i) distances[i] = std::min(distances[i], (points[i] - centres.back()).norm());
    next = static_cast<std::size_t>(std::ranges::max_element(distances) - distances.begin());
    if (!(distances[next] > 0.0f)) break;
  }
  for (int round = 0; round < kMeanRounds; ++round) {
    std::vector<Places> members(centres.size());
    for (const Vec3f& p : points) {
      const auto nearest = std::ranges::min_element(centres, {}, [&](const Vec3f& c) { return (c - p).squaredNorm(); });
      members[static_cast<std::size_t>(nearest - centres.begin())].add(p, 1.0);
    }
    for (std::size_t c = 0; c < centres.size(); ++c)
      if (members[c].weight > 0.0) centres[c] = members[c].mean();
  }
  return centres;
}

float cost_of(const BoneName& name, const Vec3f& place, const Slot& slot) {
  const float distance = kPlaceCost * std::min(1.0f, (place - slot.position).norm());
  const Side side = name.side == Side::none ? side_at(place) : name.side;
  const float other_side = slot.name.side == Side::none || side == Side::none || slot.name.side == side ? 0.0f : kSideCost;
  if (slot.name.kind.empty()) return distance + kUnspecificCost + other_side;
  if (name.kind.empty()) return distance + kUnspecificCost + other_side;
  if (name.kind != slot.name.kind) return distance + kOtherKindCost + other_side;
  return distance + (name.side == slot.name.side ? 0.0f : kSideCost);
}

}  // namespace

SlotAssignment SuperSkeleton::assign(const Skeleton& skeleton, bool known) const {
  const auto rows = static_cast<Eigen::Index>(skeleton.size()), columns = static_cast<Eigen::Index>(slots_.size());
  Matrix cost(rows, columns);
  PerJoint<BoneName> names;
  for (JointId j : skeleton.names.ids()) {
    names.push_back(known ? bone_name(skeleton.names[j]) : BoneName{});
    for (Eigen::Index s = 0; s < columns; ++s)
      cost(static_cast<Eigen::Index>(index(j)), s) = cost_of(names[j], skeleton.rest_positions[j], slots_[static_cast<std::size_t>(s)]);
  }
  const auto assigned = metrics::assign(cost);
  SlotAssignment out;
  for (JointId j : skeleton.names.ids()) {
    const auto slot = assigned[index(j)];
    const auto parent = skeleton.parents[j];
    out.slot.push_back(slot ? *slot : parent ? out.slot[*parent] : 0);
    out.by_name.push_back(slot && !names[j].kind.empty() && slots_[*slot].name.kind == names[j].kind);
  }
  return out;
}

SuperSkeleton learn_super_skeleton(std::span<const NamedSkeleton> skeletons, const SuperSkeletonOptions& options) {
  const auto weights = weights_of_groups(skeletons);
  std::map<std::string, std::map<Side, Places>> kinds;
  std::map<std::string, double> support;
  for (const NamedSkeleton& s : skeletons) {
    std::map<std::string, bool> has;
    for (JointId j : s.skeleton->names.ids()) {
      const BoneName name = bone_name(s.skeleton->names[j]);
      if (name.kind.empty()) continue;
      kinds[name.kind][name.side].add(s.skeleton->rest_positions[j], weights.at(s.group));
      has[name.kind] = true;
    }
    for (const auto& [kind, yes] : has) support[kind] += weights.at(s.group);
  }

  // The kinds that most skeletons have, as far as there are slots for all of their sides.
  std::vector<std::string> ranked;
  for (const auto& [kind, count] : support)
    if (count >= options.least_support) ranked.push_back(kind);
  std::ranges::stable_sort(ranked, std::greater(), [&](const std::string& kind) { return support.at(kind); });
  std::vector<Slot> slots;
  int kind_number = 0;
  std::map<std::string, bool> kept;
  for (const std::string& kind : ranked) {
    const auto& sides = kinds.at(kind);
    if (slots.size() + sides.size() > options.slots - options.unspecific || kind_number + 1 >= static_cast<int>(options.kinds)) break;
    kept[kind] = true;
    ++kind_number;
    for (const auto& [side, places] : sides) slots.push_back({{kind, side}, places.mean(), kind_number});
  }

  // What is left, mirrored so that both sides are alike; half of the slots for each side.
  std::vector<Vec3f> others;
  for (const NamedSkeleton& s : skeletons)
    for (JointId j : s.skeleton->names.ids())
      if (!kept.contains(bone_name(s.skeleton->names[j]).kind)) {
        const Vec3f& p = s.skeleton->rest_positions[j];
        others.push_back(p.x() < 0.0f ? mirrored(p) : p);
      }
  for (const Vec3f& p : clustered(others, options.unspecific / 2)) {
    slots.push_back({{"", side_at(p)}, p, 0});
    slots.push_back({{"", opposite(side_at(p))}, mirrored(p), 0});
  }
  if (slots.empty()) slots.push_back({});
  return SuperSkeleton(std::move(slots));
}

std::string SuperSkeleton::to_json() const {
  nlohmann::json out = nlohmann::json::array();
  for (const Slot& s : slots_)
    out.push_back({s.name.kind, static_cast<int>(s.name.side), s.kind, s.position.x(), s.position.y(), s.position.z()});
  return out.dump();
}

SuperSkeleton SuperSkeleton::from_json(std::string_view text) {
  try {
    std::vector<Slot> slots;
    for (const auto& row : nlohmann::json::parse(text))
      slots.push_back({{row.at(0).get<std::string>(), static_cast<Side>(row.at(1).get<int>())},
                       {row.at(3).get<float>(), row.at(4).get<float>(), row.at(5).get<float>()},
                       row.at(2).get<int>()});
    if (slots.empty()) throw Error("the super skeleton has no slots, expected at least one");
    return SuperSkeleton(std::move(slots));
  } catch (const nlohmann::json::exception& e) {
    throw Error("the super skeleton cannot be read: {}", e.what());
  }
}

}  // namespace osteon::skin
