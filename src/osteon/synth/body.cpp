// SPDX-License-Identifier: Apache-2.0
#include "osteon/synth/body.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace osteon::synth {
namespace {

constexpr int kReach = 3;         // joints up and down the tree that a vertex may share
constexpr float kFalloff = 0.5f;  // width of a joint's weight, in radii of its cone: the blend reaches one radius along the bone

Vec3f mirror(const Vec3f& p) { return {-p.x(), p.y(), p.z()}; }

// min(a, b) rounded off where they differ by less than `width`. The quadratic form of Quilez, "Smooth minimum", iquilezles.org.
float smooth_min(float a, float b, float width) {
  const float overlap = std::max(width - std::abs(a - b), 0.0f);
  return std::min(a, b) - overlap * overlap / (4.0f * width);
}

// Stretches space along the flat direction so that the flattened cone becomes round.
Vec3f unflattened(const RoundCone& cone, const Vec3f& p) {
  return p + cone.flat_direction * (cone.flat_direction.dot(p) * (1.0f / cone.flatness - 1.0f));
}

float round_distance(const Vec3f& p, const Vec3f& a, const Vec3f& b, float ra, float rb) {
  const Vec3f ab = b - a, ap = p - a;
  const float length = ab.norm();
  if (length <= std::abs(ra - rb)) return ra > rb ? ap.norm() - ra : (p - b).norm() - rb;  // one ball holds the other
  const float slope = (ra - rb) / length, lean = std::sqrt(1.0f - slope * slope);
  const float along = ap.dot(ab) / length;
  const float across = std::sqrt(std::max(ap.squaredNorm() - along * along, 0.0f));
  const float k = along - across * slope / lean;  // foot of the perpendicular to the slanted side
  if (k <= 0.0f) return ap.norm() - ra;
  if (k >= length) return (p - b).norm() - rb;
  return across * lean + along * slope - ra;
}

TriangleMesh mirrored_mesh(TriangleMesh mesh) {
  for (Vec3f& p : mesh.positions) p = mirror(p);
  for (Triangle& face : mesh.faces) std::swap(face[1], face[2]);
  return mesh;
}

bool off_middle(const RoundCone& cone) { return cone.axis.a.x() != 0.0f || cone.axis.b.x() != 0.0f; }

// Whether `below` hangs on `above` within a few joints, or is it.
bool descends(const Skeleton& skeleton, JointId below, JointId above) {
  std::optional<JointId> at = below;
  for (int steps = 0; at && steps <= kReach; ++steps, at = skeleton.parents[*at])
    if (*at == above) return true;
  return false;
}

}  // namespace

float signed_distance(const RoundCone& cone, const Vec3f& p) {
  assert(cone.flatness > 0.0f && cone.flatness <= 1.0f);
  const Vec3f a = unflattened(cone, cone.axis.a), b = unflattened(cone, cone.axis.b);
  return cone.flatness * round_distance(unflattened(cone, p), a, b, cone.radius_a, cone.radius_b);
}

JointId Body::joint(const std::string& name, std::optional<JointId> parent, const Vec3f& position) {
  assert(position.x() == 0.0f);
  const JointId added = skeleton_.add(name, parent, position);
  twins_.push_back(added);
  widths_.push_back(0.0f);
  return added;
}

JointId Body::pair(const std::string& name, JointId parent, const Vec3f& position) {
  assert(position.x() > 0.0f);
  const JointId left = skeleton_.add("Left" + name, parent, position);
  const JointId right = skeleton_.add("Right" + name, twins_[parent], mirror(position));
  twins_.push_back(right);
  twins_.push_back(left);
  widths_.resize(skeleton_.size());
  return left;
}

void Body::clothe(JointId joint, const RoundCone& cone, float blend) {
  assert(blend > 0.0f);
  parts_.push_back({joint, cone, blend});
  const float width = kFalloff * 0.5f * (cone.radius_a + cone.radius_b) * cone.flatness;
  widths_[joint] = widths_[twins_[joint]] = std::max(widths_[joint], width);
}

void Body::attach(JointId joint, const TriangleMesh& mesh, Copies copies) { add_piece({joint, Bond::Rigid, mesh}, copies); }

void Body::drape(JointId joint, const TriangleMesh& mesh, Copies copies) { add_piece({joint, Bond::Soft, mesh}, copies); }

void Body::add_piece(const Piece& piece, Copies copies) {
  pieces_.push_back(piece);
  if (copies == Copies::Both) pieces_.push_back({twins_[piece.joint], piece.bond, mirrored_mesh(piece.mesh)});
}

std::vector<Body::SidedPart> Body::all_parts() const {
  std::vector<SidedPart> all;
  for (const Part& part : parts_) {
    all.push_back({&part, false});
    if (off_middle(part.cone)) all.push_back({&part, true});
  }
  return all;
}

float Body::blended(const std::vector<SidedPart>& parts, const Vec3f& p) {
  const Vec3f near_side(std::abs(p.x()), p.y(), p.z()), far_side = mirror(near_side);
  float d = std::numeric_limits<float>::max();
  for (const SidedPart& s : parts) d = smooth_min(d, signed_distance(s.part->cone, s.far ? far_side : near_side), s.part->blend);
  return d;
}

float Body::distance(const Vec3f& p) const { return blended(all_parts(), p); }

// Two parts melt where their distances differ by less than the blend, so one that is further than the nearest by the largest blend, at
// every point of the ball, changes nothing: distances change by at most `radius` within it.
Field Body::near(const Vec3f& centre, float radius) const {
  const Vec3f near_side(std::abs(centre.x()), centre.y(), centre.z()), far_side = mirror(near_side);
  std::vector<SidedPart> parts = all_parts();
  std::vector<float> distances;
  float nearest = std::numeric_limits<float>::max(), largest_blend = 0.0f;
  for (const SidedPart& s : parts) {
    distances.push_back(signed_distance(s.part->cone, s.far ? far_side : near_side));
    nearest = std::min(nearest, distances.back());
    largest_blend = std::max(largest_blend, s.part->blend);
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (distances[i] <= nearest + 2.0f * radius + largest_blend) parts[kept++] = parts[i];
  parts.resize(kept);
  return [parts = std::move(parts)](const Vec3f& p) { return blended(parts, p); };
}

Eigen::AlignedBox3f Body::box() const {
  Eigen::AlignedBox3f box;
  for (const Part& part : parts_) {
    const Vec3f reach = Vec3f::Constant(std::max(part.cone.radius_a, part.cone.radius_b) + part.blend);
    for (const Vec3f& end : {part.cone.axis.a, part.cone.axis.b})
      for (const Vec3f& p : {end, mirror(end)}) box.extend(Eigen::AlignedBox3f(p - reach, p + reach));
  }
  return box;
}

PerJoint<float> Body::joint_distances(const Vec3f& p) const {
  PerJoint<float> distances(skeleton_.size(), std::numeric_limits<float>::infinity());
  for (const Part& part : parts_) {
    float& left = distances[part.joint];
    left = std::min(left, signed_distance(part.cone, p));
    if (!off_middle(part.cone)) continue;
    float& right = distances[twins_[part.joint]];
    right = std::min(right, signed_distance(part.cone, mirror(p)));
  }
  return distances;
}

std::vector<Influence> Body::weights(const Vec3f& p, JointId top) const {
  PerJoint<float> distances = joint_distances(p);
  PerJoint<char> below(skeleton_.size(), 0);
  for (JointId j : skeleton_.names.ids()) {
    below[j] = j == top || (skeleton_.parents[j] && below[*skeleton_.parents[j]]);
    if (!below[j]) distances[j] = std::numeric_limits<float>::infinity();
  }
  const auto nearest = static_cast<JointId>(std::min_element(distances.begin(), distances.end()) - distances.begin());
  std::vector<Influence> row;
  for (JointId j : skeleton_.names.ids()) {
    const bool related = descends(skeleton_, j, nearest) || descends(skeleton_, nearest, j);
    const float width = std::max(widths_[j], widths_[nearest]);
    if (!related || !(width > 0.0f)) continue;
    const float share = std::max(1.0f - (distances[j] - distances[nearest]) / width, 0.0f);
    if (share > 0.0f) row.push_back({j, share * share});
  }
  return row;
}

}  // namespace osteon::synth
