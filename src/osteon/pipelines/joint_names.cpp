// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/joint_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace osteon::pipelines {
namespace {

enum class Side { middle, left, right };
constexpr float kMiddle = 0.02f, kArmLength = 0.15f, kDownwards = 0.05f;

class Namer {
 public:
  Namer(const Skeleton& skeleton, const PerJoint<std::optional<JointId>>& partner, const PerJoint<std::optional<HandPart>>& part)
      : s_(skeleton),
        part_(part),
        kids_(children(skeleton)),
        sides_(skeleton.size()),
        descendants_(skeleton.size()),
        names_(skeleton.size()),
        chains_(skeleton.size()) {
    for (JointId j : s_.names.ids()) sides_[j] = side_of(j, partner[j]);
    for (std::size_t i = s_.size(); i-- > 1;) descendants_[*s_.parents[JointId(i)]] += descendants_[JointId(i)] + 1;
    for (const Vec3f& p : s_.rest_positions) box_.extend(p);
    spine_ = find_spine();
  }

  PerJoint<std::string> run() {
    names_[JointId{0}] = "root";
    for (JointId j : s_.names.ids())  // parents come first
      for (JointId kid : kids_[j])
        if (j == JointId{0} || kid != continuation(j)) name_chain(kid);
    return names_;
  }

 private:
  Side side_of(JointId j, std::optional<JointId> partner) const {
    const float x = s_.rest_positions[j].x() - (partner ? 0.0f : s_.rest_positions[JointId{0}].x());
    if (partner == j || (!partner && std::abs(x) <= kMiddle)) return Side::middle;
    return x > 0.0f ? Side::left : Side::right;
  }

  // The child that goes on with the joint's chain: of the same side, with the most below it, then the farthest.
  std::optional<JointId> continuation(JointId j) const {
    std::optional<JointId> best;
    const auto rank = [&](JointId k) { return std::tuple(descendants_[k], (s_.rest_positions[k] - s_.rest_positions[j]).squaredNorm()); };
    for (JointId kid : kids_[j])
      if (sides_[kid] == sides_[j] && part_at(kid) == part_at(j) && (!best || rank(kid) > rank(*best))) best = kid;
    return best;
  }

  std::optional<HandPart> part_at(JointId j) const { return part_.empty() ? std::nullopt : part_[j]; }

  JointId tip(JointId j) const {
    while (const auto next = continuation(j)) j = *next;
    return j;
  }

  // From the root to the end of a chain that leaves it.
  Vec3f course(JointId first) const { return s_.rest_positions[tip(first)] - s_.rest_positions[*s_.parents[first]]; }

  static bool backwards(const Vec3f& course) { return -course.z() > std::abs(course.y()); }

  std::optional<JointId> find_spine() const {
    std::optional<JointId> best;
    for (JointId kid : kids_[JointId{0}]) {
      const Vec3f c = course(kid);
      if (sides_[kid] != Side::middle || backwards(c) || c.y() < -kDownwards) continue;
      if (!best || descendants_[kid] > descendants_[*best]) best = kid;
    }
    return best;
  }

  std::string kind(JointId first) const {
    const JointId parent = *s_.parents[first];
    const Vec3f end = s_.rest_positions[tip(first)];
    const std::string side = sides_[first] == Side::left ? "left" : sides_[first] == Side::right ? "right" : "centre";
    if (const auto part = part_at(first)) return fmt::format("{}_{}", side, kHandPartNames[static_cast<std::size_t>(*part)]);
    if (sides_[first] == Side::middle && sides_[parent] == Side::middle)
      return first == spine_ ? "spine" : backwards(course(first)) ? "tail" : "centre";
    if (sides_[parent] != Side::middle && parent != JointId{0}) return (chains_[parent].empty() ? side : chains_[parent]) + "_branch";
    const float height = box_.max().y() - box_.min().y();
    if (end.y() <= box_.min().y() + 0.25f * height && end.y() < s_.rest_positions[parent].y() - kDownwards) return side + "_leg";
    const bool is_upper = s_.rest_positions[parent].y() >= box_.min().y() + 0.5f * height;
    return side + (is_upper && course(first).norm() >= kArmLength ? "_arm" : "_limb");
  }

  void name_chain(JointId first) {
    const std::string base = kind(first);
    const int ordinal = ++used_[base];
    const std::string chain = ordinal == 1 ? base : fmt::format("{}{}", base, ordinal);
    int number = 0;
    for (std::optional<JointId> j = first; j; j = continuation(*j)) {
      names_[*j] = part_at(*j) == HandPart::wrist ? chain : fmt::format("{}_{}", chain, ++number);
      chains_[*j] = chain;
    }
  }

  const Skeleton& s_;
  const PerJoint<std::optional<HandPart>>& part_;
  PerJoint<std::vector<JointId>> kids_;
  PerJoint<Side> sides_;
  PerJoint<int> descendants_;
  PerJoint<std::string> names_, chains_;
  Eigen::AlignedBox3f box_;
  std::optional<JointId> spine_;
  std::map<std::string, int> used_;
};

}  // namespace

PerJoint<std::string> joint_names(const Skeleton& skeleton, const PerJoint<std::optional<JointId>>& partner,
                                  const PerJoint<std::optional<HandPart>>& part) {
  return Namer(skeleton, partner, part).run();
}

}  // namespace osteon::pipelines
