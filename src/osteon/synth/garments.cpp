// SPDX-License-Identifier: Apache-2.0
#include "osteon/synth/garments.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "osteon/base/error.h"
#include "osteon/base/random.h"

namespace osteon::synth {
namespace {

constexpr float kTurn = 2.0f * std::numbers::pi_v<float>;

using Row = std::vector<Influence>;

// Shares of a point at t (0..1) along a row of joints that stand at even distances from 0 on: linear between neighbours.
Row along(const std::vector<JointId>& joints, float t) {
  const float at = std::clamp(t, 0.0f, 1.0f) * static_cast<float>(joints.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), joints.size() - 1);
  const float rest = at - static_cast<float>(i);
  Row row{{joints[i], 1.0f - rest}};
  if (rest > 0.0f) row.push_back({joints[i + 1], rest});
  return row;
}

Row mixed(const Row& a, const Row& b, float share_of_b) {
  Row row;
  for (const Influence& i : a) row.push_back({i.joint, i.weight * (1.0f - share_of_b)});
  for (const Influence& i : b) row.push_back({i.joint, i.weight * share_of_b});
  return row;
}

class Tailor {
 public:
  Tailor(const Rig& body, std::uint64_t seed) : rig_(body), random_(Random(seed).fork(77)) {}

  DressedCharacter dress() {
    const std::size_t body_vertices = rig_.mesh.positions.size(), body_joints = rig_.skeleton.size();
    const std::uint64_t choice = 1 + random_.below(7);  // at least one of the three
    if (choice & 1) add_skirt();
    if (choice & 2) add_cloak();
    if (choice & 4) add_sleeves();
    validate(rig_);
    return {std::move(rig_), body_vertices, body_joints};
  }

 private:
  std::optional<JointId> found(const std::string& name) const {
    const auto at = std::ranges::find(rig_.skeleton.names, name);
    if (at == rig_.skeleton.names.end()) return std::nullopt;
    return static_cast<JointId>(at - rig_.skeleton.names.begin());
  }
  JointId named(const std::string& name) const {
    const auto joint = found(name);
    if (!joint) throw Error("dressed: the skeleton has no joint '{}', expected a biped of the generator", name);
    return *joint;
  }
  const Vec3f& at(JointId joint) const { return rig_.skeleton.rest_positions[joint]; }

  // The farthest that the trunk and the legs reach from the vertical through `middle` at a height, in a direction of the plan.
  float reach(const Vec3f& middle, float height, float angle, float slab) const {
    float most = 0.0f;
    const Vec3f way(std::sin(angle), 0.0f, std::cos(angle));
    const float arms = std::abs(at(named("LeftArm")).x());
    for (const Vec3f& p : rig_.mesh.positions)
      if (std::abs(p.y() - height) < slab && std::abs(p.x()) < arms) most = std::max(most, (p - middle).dot(way));
    return most;
  }

  // A sheet of rows by columns; closed: its last column is joined to the first. point(r, c) -> position and weights.
  template <class Point>
  void add_sheet(int rows, int columns, bool closed, const Point& point) {
    const auto first = static_cast<std::uint32_t>(rig_.mesh.positions.size());
    for (int r = 0; r < rows; ++r)
      for (int c = 0; c < columns; ++c) {
        const auto [position, row] = point(r, c);
        rig_.mesh.positions.push_back(position);
        rig_.weights.append(row);
      }
    const auto vertex = [&](int r, int c) { return VertexId{first + static_cast<std::uint32_t>(r * columns + c % columns)}; };
    for (int r = 0; r + 1 < rows; ++r)
      for (int c = 0; c + (closed ? 0 : 1) < columns; ++c) {
        rig_.mesh.faces.push_back({vertex(r, c), vertex(r + 1, c), vertex(r + 1, c + 1)});
        rig_.mesh.faces.push_back({vertex(r, c), vertex(r + 1, c + 1), vertex(r, c + 1)});
      }
  }

  // Joints one below the other, the first a child of `parent`; the list begins with the parent.
  std::vector<JointId> chain(const std::string& name, JointId parent, const std::vector<Vec3f>& places) {
    std::vector<JointId> joints{parent};
    for (std::size_t i = 0; i < places.size(); ++i)
      joints.push_back(rig_.skeleton.add(name + "_" + std::to_string(i + 1), joints.back(), places[i]));
    return joints;
  }

  void add_skirt() {
    constexpr int rows = 10, columns = 28, chains = 8;
    const JointId hips = named("Hips"), left = named("LeftUpLeg"), right = named("RightUpLeg");
    const float knee = 0.5f * at(left).y(), waist = at(hips).y() + 0.2f * (at(hips).y() - knee);
    const float hem = waist - random_.uniform(0.8f, 1.8f) * (waist - knee);
    const float flare = random_.uniform(0.15f, 0.5f) * (waist - hem);
    const Vec3f middle(0.0f, 0.0f, at(hips).z());
    const auto place = [&](float t, float angle) -> Vec3f {
      const float out = 1.06f * reach(middle, waist, angle, 0.08f * waist) + 0.02f * waist + flare * std::sqrt(t);
      return {middle.x() + out * std::sin(angle), waist + t * (hem - waist), middle.z() + out * std::cos(angle)};
    };
    const bool has_joints = random_.uniform() < 0.6f;
    std::vector<std::vector<JointId>> hung;
    for (int k = 0; has_joints && k < chains; ++k) {
      const float angle = kTurn * static_cast<float>(k) / chains;
      hung.push_back(chain("Skirt" + std::to_string(k + 1), hips, {place(0.25f, angle), place(0.6f, angle)}));
    }
    add_sheet(rows, columns, true, [&](int r, int c) {
      const float t = static_cast<float>(r) / (rows - 1), turn = static_cast<float>(c) / columns;
      const Vec3f p = place(t, kTurn * turn);
      if (has_joints) {
        const float k = turn * chains;
        const auto before = static_cast<std::size_t>(k);
        return std::pair(p, mixed(along(hung[before % chains], t), along(hung[(before + 1) % chains], t), k - static_cast<float>(before)));
      }
      const float width = std::abs(at(left).x() - at(right).x());
      const float to_left = std::clamp(0.5f + p.x() / std::max(width, 1e-3f), 0.0f, 1.0f);
      return std::pair(p, mixed({{hips, 1.0f}}, {{left, to_left}, {right, 1.0f - to_left}}, 0.85f * std::min(1.0f, 1.5f * t)));
    });
  }

  void add_cloak() {
    constexpr int rows = 12, columns = 11, chains = 3, links = 3;
    const JointId left = named("LeftArm"), hips = named("Hips");
    JointId chest = *rig_.skeleton.parents[left];
    while (rig_.skeleton.names[chest].starts_with("Left")) chest = *rig_.skeleton.parents[chest];
    const float top = at(left).y(), bottom = random_.uniform(0.05f, 0.6f) * at(hips).y(), half = 1.1f * std::abs(at(left).x());
    const float back = reach({0.0f, 0.0f, 0.0f}, 0.5f * (top + at(hips).y()), 0.5f * kTurn, 0.3f * (top - at(hips).y())) + 0.02f * top;
    const float spread = random_.uniform(1.0f, 1.6f), sway = random_.uniform(0.0f, 0.15f) * top;
    const auto place = [&](float t, float u) -> Vec3f {  // u: -1 .. 1 from right to left
      return {u * half * (1.0f + (spread - 1.0f) * t), top + t * (bottom - top), -back - sway * t + 0.35f * half * u * u * (1.0f - t)};
    };
    std::vector<std::vector<JointId>> hung;
    for (int k = 0; k < chains; ++k) {
      std::vector<Vec3f> places;
      for (int i = 0; i < links; ++i) places.push_back(place((static_cast<float>(i) + 0.3f) / links, static_cast<float>(k - 1) * 0.7f));
      hung.push_back(chain("Cloak" + std::to_string(k + 1), chest, places));
    }
    add_sheet(rows, columns, false, [&](int r, int c) {
      const float t = static_cast<float>(r) / (rows - 1), u = 2.0f * static_cast<float>(c) / (columns - 1) - 1.0f;
      const float k = std::clamp(u / 0.7f + 1.0f, 0.0f, 2.0f);
      const auto before = std::min<std::size_t>(static_cast<std::size_t>(k), 1);
      return std::pair(place(t, u), mixed(along(hung[before], t), along(hung[before + 1], t), k - static_cast<float>(before)));
    });
  }

  void add_sleeves() {
    constexpr int rows = 9, columns = 14;
    const float width = random_.uniform(1.6f, 3.2f);
    const bool has_joint = random_.uniform() < 0.5f;
    for (const std::string side : {"Left", "Right"}) {
      const JointId arm = named(side + "Arm"), hand = named(side + "Hand"), forearm = found(side + "ForeArm").value_or(arm);
      const Vec3f a = at(arm), c = at(hand), b = forearm == arm ? Vec3f(0.5f * (a + c)) : at(forearm);
      const float thick = 0.14f * ((b - a).norm() + (c - b).norm());
      std::optional<JointId> hanging;
      if (has_joint) hanging = rig_.skeleton.add(side + "Sleeve", forearm, b + 0.7f * (c - b) - Vec3f(0.0f, 0.5f * width * thick, 0.0f));
      const Vec3f way = (c - a).normalized(), across = way.cross(Vec3f::UnitZ()).normalized(), depth = way.cross(across);
      add_sheet(rows, columns, true, [&](int r, int k) {
        const float t = static_cast<float>(r) / (rows - 1), angle = kTurn * static_cast<float>(k) / columns;
        const Vec3f middle = t < 0.5f ? Vec3f(a + 2.0f * t * (b - a)) : Vec3f(b + (2.0f * t - 1.0f) * (c - b));
        const float radius = thick * (1.0f + (width - 1.0f) * t * t);
        Vec3f p = middle + radius * (std::cos(angle) * across + std::sin(angle) * depth);
        const float below = std::max(0.0f, (middle.y() - p.y()) / radius);
        p.y() -= 0.5f * (width - 1.0f) * thick * t * t * below;
        const Row limb = mixed({{arm, 1.0f}}, {{forearm, 1.0f}}, std::clamp((t - 0.35f) / 0.3f, 0.0f, 1.0f));
        return std::pair(p, hanging ? mixed(limb, {{*hanging, 1.0f}}, below * std::clamp((t - 0.6f) / 0.4f, 0.0f, 1.0f)) : limb);
      });
    }
  }

  Rig rig_;
  Random random_;
};

}  // namespace

DressedCharacter dressed(const Rig& biped, std::uint64_t seed) { return Tailor(biped, seed).dress(); }

}  // namespace osteon::synth
