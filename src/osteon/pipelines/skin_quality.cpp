// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/skin_quality.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "osteon/geometry/body_lattice.h"
#include "osteon/geometry/mirror_pairs.h"
#include "osteon/geometry/shift_to_origin.h"
#include "osteon/geometry/symmetry.h"
#include "osteon/geometry/working_mesh.h"
#include "osteon/mesh/shapes.h"
#include "osteon/pipelines/mirrored_skin.h"
#include "osteon/skin/binding_bones.h"
#include "osteon/skin/bone_distances.h"

namespace osteon::pipelines {
namespace {

constexpr int kResolution = 128;
constexpr float kReach = 0.2f;

double weight_of(std::span<const Influence> row, JointId joint) {
  const auto found = std::ranges::find(row, joint, &Influence::joint);
  return found == row.end() ? 0.0 : static_cast<double>(found->weight);
}

// `partner` gives the joint of `b` that is compared with one of `a`.
template <class Partner>
double half_l1(std::span<const Influence> a, std::span<const Influence> b, const Partner& partner) {
  double sum = 0.0, shared = 0.0;
  for (const Influence& i : a) {
    const double other = weight_of(b, partner(i.joint));
    sum += std::abs(static_cast<double>(i.weight) - other);
    shared += other;
  }
  return 0.5 * (sum + std::max(0.0, 1.0 - shared));
}

void measure_distances(const Rig& rig, const geometry::CleanMesh& clean, SkinQuality& quality) {
  const Vec3f shift = geometry::shift_to_origin(clean.mesh);
  geometry::BodyLattice body(shapes::shifted(clean.mesh, shift), {.resolution = kResolution});
  const std::vector<Bone> bones =
      skin::binding_bones(transformed(rig.skeleton, Eigen::Affine3d(Eigen::Translation3d(shift.cast<double>()))), body);
  const skin::BoneDistances distances = skin::bone_distances(body, bones);
  const float reach = kReach * bounds(clean.mesh).sizes().maxCoeff();
  for (VertexId v : rig.mesh.positions.ids()) {
    const auto near = distances.of(clean.from_original[v]);
    quality.coverage += near.front().distance <= reach;
    for (const Influence& i : rig.weights[v])
      if (std::ranges::none_of(near, [&](const skin::BoneDistance& d) { return bones[d.bone].start == i.joint; }))
        quality.leak += static_cast<double>(i.weight);
  }
  quality.coverage /= static_cast<double>(rig.mesh.positions.size());
  quality.leak /= static_cast<double>(rig.mesh.positions.size());
}

double roughness(const Rig& rig) {
  double sum = 0.0;
  for (const Triangle& face : rig.mesh.faces)
    for (std::size_t k = 0; k < 3; ++k) sum += half_l1(rig.weights[face[k]], rig.weights[face[(k + 1) % 3]], [](JointId j) { return j; });
  return rig.mesh.faces.empty() ? 0.0 : sum / static_cast<double>(3 * rig.mesh.faces.size());
}

double asymmetry(const Rig& rig, const MirrorMap& mirror) {
  PerVertex<std::optional<VertexId>> original(mirror.vertex_partner.size());
  for (VertexId v : mirror.from_original.ids())
    if (!original[mirror.from_original[v]]) original[mirror.from_original[v]] = v;
  double sum = 0.0;
  for (VertexId v : mirror.from_original.ids()) {
    const VertexId image = *original[mirror.vertex_partner[mirror.from_original[v]]];
    sum += half_l1(rig.weights[v], rig.weights[image], [&](JointId j) { return mirror.joint_partner[j]; });
  }
  return sum / static_cast<double>(mirror.from_original.size());
}

}  // namespace

std::optional<MirrorMap> mirror_map(const TriangleMesh& mesh, const Skeleton& skeleton) {
  const geometry::CleanMesh clean = geometry::clean(mesh);
  if (clean.mesh.faces.empty()) return std::nullopt;
  const geometry::Normalization frame = geometry::normalization_of(clean.mesh);
  TriangleMesh normalised = clean.mesh;
  for (Vec3f& p : normalised.positions) p = frame.apply(p);
  const auto plane = geometry::symmetry_plane(normalised);
  if (!plane) return std::nullopt;
  const auto pairs = geometry::mirror_pairs(normalised, *plane);
  if (!pairs) return std::nullopt;
  PerJoint<Vec3f> joints = skeleton.rest_positions;
  for (Vec3f& p : joints) p = frame.apply(p);
  const auto partners = mirror_partners(skeleton, joints, pairs->plane);
  if (!partners) return std::nullopt;
  return MirrorMap{clean.from_original, pairs->partner, *partners};
}

SkinQuality skin_quality(const Rig& rig) {
  SkinQuality out;
  for (VertexId v : rig.mesh.positions.ids()) {
    double sum = 0.0;
    for (const Influence& i : rig.weights[v]) sum += static_cast<double>(i.weight);
    out.unweighted += rig.weights[v].empty();
    out.largest_sum_error = std::max(out.largest_sum_error, std::abs(sum - 1.0));
  }
  const geometry::CleanMesh clean = geometry::clean(rig.mesh);
  if (!clean.mesh.faces.empty()) measure_distances(rig, clean, out);
  out.roughness = roughness(rig);
  if (const auto mirror = mirror_map(rig.mesh, rig.skeleton)) out.asymmetry = asymmetry(rig, *mirror);
  out.deformation = skin::deformation_score(rig);
  return out;
}

}  // namespace osteon::pipelines
