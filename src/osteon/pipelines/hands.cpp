// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/hands.h"

#include <algorithm>
#include <map>
#include <utility>

#include "osteon/base/parallel.h"
#include "osteon/pipelines/hand_shape.h"

namespace osteon::pipelines {
namespace {

// Lengths where the character's longest side is 1.
constexpr float kForearm = 0.22f;               // from the end of a limb back to where its surface is followed from
constexpr float kStanding = 0.06f;              // limbs that end lower stand on the ground
constexpr float kSame = 0.02f, kPaired = 0.1f;  // between what is one hand, and between a hand and the other's mirror image
constexpr float kOfFinger = 2.0f;               // a joint within so many half widths of a finger is in it
constexpr float kOfPalm = 0.6f;                 // and one so near to the line from the wrist to the fingers, in parts of it, in the palm

struct Hand {
  HandShape shape;
  std::size_t leaf;      // the joint whose limb ends in it
  bool is_pair = false;  // there is another, its mirror image; this is the left one then
};

// To the nearest point of the segment.
float distance(const Vec3f& p, const Segment& segment) {
  const Vec3f way = segment.b - segment.a;
  const float squared = way.squaredNorm();
  const float part = squared > 0.0f ? std::clamp((p - segment.a).dot(way) / squared, 0.0f, 1.0f) : 0.0f;
  return (segment.a + part * way - p).norm();
}

Vec3f knuckles(const HandShape& hand) {
  Vec3f sum = Vec3f::Zero();
  for (std::size_t k = 1; k < hand.fingers.size(); ++k) sum += hand.fingers[k].joints.front();
  return sum / static_cast<float>(hand.fingers.size() - 1);
}

HandShape mirrored(HandShape hand) {
  if (hand.wrist) hand.wrist = pipelines::mirrored(*hand.wrist);
  for (FingerShape& finger : hand.fingers) {
    finger.tip = pipelines::mirrored(finger.tip);
    for (Vec3f& p : finger.joints) p = pipelines::mirrored(p);
  }
  return hand;
}

Vec3f mean(const Vec3f& a, const Vec3f& b) { return 0.5f * (a + b); }

// Of two hands on the same side: the mean, or the one that is seen as far as its wrist, or has more fingers.
HandShape together(HandShape a, const HandShape& b) {
  const auto seen = [](const HandShape& hand) { return std::pair(hand.wrist.has_value(), hand.fingers.size()); };
  if (seen(a) != seen(b)) return seen(a) > seen(b) ? a : b;
  if (a.wrist) a.wrist = mean(*a.wrist, *b.wrist);
  for (std::size_t k = 0; k < a.fingers.size(); ++k) {
    FingerShape& finger = a.fingers[k];
    finger.tip = mean(finger.tip, b.fingers[k].tip);
    finger.wide = 0.5f * (finger.wide + b.fingers[k].wide);
    for (std::size_t i = 0; i < finger.joints.size(); ++i) finger.joints[i] = mean(finger.joints[i], b.fingers[k].joints[i]);
  }
  return a;
}

bool is_within(const Vec3f& p, const HandShape& hand) {
  if (hand.wrist) {
    const Vec3f end = knuckles(hand);
    if (distance(p, {*hand.wrist, end}) <= kOfPalm * (end - *hand.wrist).norm()) return true;
  }
  return std::ranges::any_of(hand.fingers, [&](const FingerShape& finger) {
    Vec3f outer = finger.tip;
    for (auto joint = finger.joints.rbegin(); joint != finger.joints.rend(); outer = *joint++)
      if (distance(p, {outer, *joint}) <= kOfFinger * finger.wide) return true;
    return false;
  });
}

struct LimbEnd {
  std::vector<std::size_t> leaves;
  Vec3f end, from;
};

// One for each joint that a limb is followed from and that leaves it, and side of the body (short arms may be followed from the spine), so
// that a hand counts once however many joints end in it.
std::vector<LimbEnd> limb_ends(const JointSet& joints, const JointTree& tree) {
  std::vector<bool> is_leaf(joints.size(), true);
  for (const auto& parent : tree.parents)
    if (parent) is_leaf[*parent] = false;
  std::map<std::pair<std::size_t, bool>, LimbEnd> limbs;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (!is_leaf[j] || !tree.parents[j] || joints.partner[j] == j || joints.positions[j].y() < kStanding) continue;
    std::size_t first = j;
    const auto before = [&] { return *tree.parents[first]; };
    while (tree.parents[before()] && (joints.positions[before()] - joints.positions[j]).norm() < kForearm) first = before();
    LimbEnd& limb = limbs[{first, joints.positions[j].x() < 0.0f}];
    limb.leaves.push_back(j);
    limb.from = joints.positions[before()];
  }
  std::vector<LimbEnd> out;
  for (auto& [key, limb] : limbs) {
    limb.end = Vec3f::Zero();
    for (std::size_t j : limb.leaves) limb.end += joints.positions[j] / static_cast<float>(limb.leaves.size());
    out.push_back(std::move(limb));
  }
  return out;
}

std::vector<Hand> find_hands(const JointSet& joints, const JointTree& tree, const TriangleMesh& mesh) {
  const std::vector<LimbEnd> limbs = limb_ends(joints, tree);
  std::vector<std::optional<HandShape>> found(limbs.size());
  parallel_for(limbs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) found[k] = find_hand(mesh, limbs[k].end, limbs[k].from);
  });
  std::vector<Hand> out;
  for (std::size_t k = 0; k < limbs.size(); ++k) {
    if (!found[k]) continue;
    const Vec3f place = knuckles(*found[k]);
    const auto is_same = [&](const Hand& other) { return (knuckles(other.shape) - place).norm() < kSame; };
    const auto away = [&](std::size_t leaf) { return (joints.positions[leaf] - place).squaredNorm(); };
    const std::size_t leaf = *std::ranges::min_element(limbs[k].leaves, {}, away);
    if (std::ranges::none_of(out, is_same)) out.push_back({std::move(*found[k]), leaf});
  }
  return out;
}

// Its partner, or that of the nearest joint above it that has one (what a hand holds has none).
std::size_t image_of(std::size_t joint, const JointSet& joints, const JointTree& tree) {
  while (!joints.partner[joint] && tree.parents[joint]) joint = *tree.parents[joint];
  return joints.partner[joint].value_or(joint);
}

Hand on_the_left(Hand hand, const JointSet& joints, const JointTree& tree) {
  if (knuckles(hand.shape).x() >= 0.0f) return hand;
  return {mirrored(std::move(hand.shape)), image_of(hand.leaf, joints, tree), hand.is_pair};
}

std::vector<Hand> paired(std::vector<Hand> hands, const JointSet& joints, const JointTree& tree, bool is_image) {
  std::vector<Hand> out;
  while (!hands.empty()) {
    Hand hand = std::move(hands.back());
    hands.pop_back();
    const Vec3f image = pipelines::mirrored(knuckles(hand.shape));
    const auto other = std::ranges::find_if(hands, [&](const Hand& h) { return (knuckles(h.shape) - image).norm() < kPaired; });
    hand.is_pair = is_image || other != hands.end();
    if (hand.is_pair) hand = on_the_left(std::move(hand), joints, tree);
    if (other != hands.end()) {
      hand.shape = together(std::move(hand.shape), on_the_left(std::move(*other), joints, tree).shape);
      hands.erase(other);
    }
    out.push_back(std::move(hand));
  }
  return out;
}

class Builder {
 public:
  Builder(const JointSet& joints, const JointTree& tree, const std::vector<Hand>& hands)
      : old_(joints), tree_(tree), hands_(hands), hand_of_(joints.size()), number_(joints.size()) {
    for (std::size_t j = 0; j < joints.size(); ++j) hand_of_[j] = hand_with(j);
    keep_the_others();
    for (std::size_t h = 0; h < hands.size(); ++h) add(h);
  }

  SkeletonDraft run() && { return std::move(out_); }

 private:
  // A joint on both sides of the body, and those of the right hand; of no pair: itself.
  struct Sides {
    std::size_t left, right;
  };

  // The first joint of its limb: the next is of the body, on the plane or the root.
  std::size_t limb_of(std::size_t j) const {
    const auto is_of_body = [&](std::size_t k) { return k == tree_.root || old_.partner[k] == k; };
    while (tree_.parents[j] && !is_of_body(*tree_.parents[j])) j = *tree_.parents[j];
    return j;
  }

  // The hand that the joint is within. It is of the hand's limb and on its side: a hand that hangs down may be near the legs.
  std::optional<std::size_t> hand_with(std::size_t j) const {
    if (j == tree_.root || old_.partner[j] == j) return std::nullopt;
    const Vec3f p = old_.positions[j];
    for (std::size_t h = 0; h < hands_.size(); ++h) {
      const auto& [shape, leaf, is_pair] = hands_[h];
      const auto is_in = [&](const Vec3f& place) { return place.x() * knuckles(shape).x() >= 0.0f && is_within(place, shape); };
      const std::size_t limb = limb_of(j);
      if (limb == limb_of(leaf) && is_in(p)) return h;
      if (is_pair && limb == limb_of(image_of(leaf, old_, tree_)) && is_in(pipelines::mirrored(p))) return h;
    }
    return std::nullopt;
  }

  void keep_the_others() {
    for (std::size_t j = 0; j < old_.size(); ++j) {
      if (hand_of_[j]) continue;
      number_[j] = out_.joints.size();
      out_.joints.positions.push_back(old_.positions[j]);
      out_.from.emplace_back(j);
      out_.part.emplace_back();
    }
    out_.joints.frame = old_.frame;
    out_.tree.root = *number_[tree_.root];
    out_.tree.likelihood = tree_.likelihood;
    for (const auto& j : out_.from) {
      const auto partner = old_.partner[*j], parent = tree_.parents[*j];
      out_.joints.partner.push_back(partner ? number_[*partner] : std::nullopt);
      out_.tree.parents.push_back(parent ? number_[*parent] : std::nullopt);  // none yet where it hangs on a hand
    }
  }

  // What the hand hangs on: what the first of the limb's joints within it hung on; where there is none, the nearest of the limb.
  std::size_t arm_of(std::size_t hand) const {
    const Vec3f place = hands_[hand].shape.wrist.value_or(knuckles(hands_[hand].shape));
    const auto away = [&](std::size_t j) { return (old_.positions[j] - place).squaredNorm(); };
    std::optional<std::size_t> within;
    std::size_t nearest = tree_.root;
    for (std::optional<std::size_t> j = hands_[hand].leaf; j; j = tree_.parents[*j]) {
      if (hand_of_[*j]) within = tree_.parents[*j];
      if (number_[*j] && away(*j) < away(nearest)) nearest = *j;
    }
    return *number_[within.value_or(nearest)];
  }

  void add(std::size_t h) {
    const HandShape& shape = hands_[h].shape;
    const std::size_t arm = arm_of(h);
    Sides palm{arm, out_.joints.partner[arm].value_or(arm)};
    if (shape.wrist) palm = add_joint(*shape.wrist, palm, HandPart::wrist, hands_[h].is_pair);
    hang_on(palm, h);
    for (std::size_t k = 0; k < shape.fingers.size(); ++k) {
      Sides last = palm;
      for (const Vec3f& p : shape.fingers[k].joints)
        last = add_joint(p, last, static_cast<HandPart>(static_cast<std::size_t>(HandPart::thumb) + k), hands_[h].is_pair);
    }
  }

  // What hung on joints within the hand (a sword) hangs on it.
  void hang_on(const Sides& palm, std::size_t hand) {
    for (std::size_t k = 0; k < out_.from.size(); ++k) {
      if (!out_.from[k] || !tree_.parents[*out_.from[k]]) continue;
      const std::size_t parent = *tree_.parents[*out_.from[k]];
      if (hand_of_[parent] == hand) out_.tree.parents[k] = old_.positions[parent].x() >= 0.0f ? palm.left : palm.right;
    }
  }

  Sides add_joint(const Vec3f& p, const Sides& parent, HandPart part, bool is_pair) {
    const std::size_t next = out_.joints.size();
    push(p, parent.left, part, is_pair ? std::optional(next + 1) : std::nullopt);
    if (!is_pair) return {next, next};
    push(pipelines::mirrored(p), parent.right, part, next);
    return {next, next + 1};
  }

  void push(const Vec3f& p, std::size_t parent, HandPart part, std::optional<std::size_t> partner) {
    out_.joints.positions.push_back(p);
    out_.joints.partner.push_back(partner);
    out_.tree.parents.emplace_back(parent);
    out_.from.emplace_back();
    out_.part.emplace_back(part);
  }

  const JointSet& old_;
  const JointTree& tree_;
  const std::vector<Hand>& hands_;
  std::vector<std::optional<std::size_t>> hand_of_;  // of each joint before: the hand that takes its place
  std::vector<std::optional<std::size_t>> number_;   // or its number now
  SkeletonDraft out_;
};

}  // namespace

SkeletonDraft with_hands(const JointSet& joints, const JointTree& tree, const TriangleMesh& mesh, bool is_image) {
  TriangleMesh seen = mesh;
  for (Vec3f& p : seen.positions) p = joints.frame.to(p);
  std::vector<Hand> hands = find_hands(joints, tree, seen);
  const bool is_symmetric = std::ranges::any_of(joints.partner, [](const auto& partner) { return partner.has_value(); });
  if (is_symmetric) hands = paired(std::move(hands), joints, tree, is_image);
  return Builder(joints, tree, hands).run();
}

}  // namespace osteon::pipelines
