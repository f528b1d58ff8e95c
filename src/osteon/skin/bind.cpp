// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/bind.h"

#include <algorithm>
#include <cassert>
#include <map>

#include "osteon/base/error.h"
#include "osteon/geometry/body_lattice.h"
#include "osteon/geometry/cleanup.h"
#include "osteon/geometry/neighbourhoods.h"
#include "osteon/geometry/shift_to_origin.h"
#include "osteon/mesh/shapes.h"
#include "osteon/skin/biharmonic.h"
#include "osteon/skin/binding_bones.h"
#include "osteon/skin/heat.h"

namespace osteon::skin {
namespace {

constexpr int kBiharmonicResolution = 40;
constexpr std::size_t kBiharmonicNodes = 6000;

// Near the origin: elsewhere coordinates may be coarser than the lattice's cells.
struct Body {
  Vec3f shift;  // from the mesh that was given
  geometry::CleanMesh clean;
  Skeleton skeleton;
  std::vector<Bone> bones;
  BoneDistances distances;
};

Body measured(const TriangleMesh& mesh, const Skeleton& skeleton, int resolution) {
  Body out{Vec3f::Zero(), geometry::clean(mesh), skeleton, {}, {}};
  if (out.clean.mesh.faces.empty()) throw Error("the mesh has no face with an area: there is nothing to bind");
  out.shift = geometry::shift_to_origin(out.clean.mesh);
  out.clean.mesh = shapes::shifted(std::move(out.clean.mesh), out.shift);
  out.skeleton = transformed(std::move(out.skeleton), Eigen::Affine3d(Eigen::Translation3d(out.shift.cast<double>())));
  geometry::BodyLattice body(out.clean.mesh, {.resolution = resolution});
  out.bones = binding_bones(out.skeleton, body);
  out.distances = bone_distances(body, out.bones);
  lengthen_past_ends(out.distances, out.clean.mesh.positions, out.bones, out.skeleton);
  return out;
}

WeightRows raw_weights(const Body& body, const BindOptions& options, std::vector<std::string>& notes) {
  const TriangleMesh& mesh = body.clean.mesh;
  switch (options.method) {
    case Method::rigid:
      return nearest_weights(body.distances, body.bones);
    case Method::geovoxel:
      return falloff_weights(body.distances, body.bones, bounds(mesh).sizes().maxCoeff(), options.falloff);
    case Method::heat:
      return heat_weights(mesh, body.distances, body.bones);
    case Method::biharmonic: {
      const geometry::BodyLattice coarse(mesh, {.resolution = kBiharmonicResolution, .most_nodes = kBiharmonicNodes});
      return biharmonic_weights(coarse, body.distances, body.bones);
    }
    case Method::transfer: {
      assert(options.from);
      Rig from = *options.from;
      from.mesh = shapes::shifted(std::move(from.mesh), body.shift);
      Transfer transfer = transferred_weights(mesh, from, joints_by_name(from.skeleton, body.skeleton), options.transfer);
      notes.push_back(fmt::format("{} vertices took the weights of the reference, {} were inpainted", transfer.taken, transfer.inpainted));
      return std::move(transfer.rows);
    }
  }
  return {};
}

int rounds(const BindOptions& options) {
  return options.smooth.value_or(options.method == Method::geovoxel || options.method == Method::biharmonic ? 1 : 0);
}

}  // namespace

PerJoint<JointId> joints_by_name(const Skeleton& from, const Skeleton& to) {
  std::map<std::string, JointId> by_name;
  for (JointId j : to.names.ids()) by_name[to.names[j]] = j;
  PerJoint<JointId> out(from.size());
  for (JointId j : from.names.ids()) {
    std::optional<JointId> at = j;
    while (at && !by_name.contains(from.names[*at])) at = from.parents[*at];
    if (!at) throw Error("joint '{}' of the reference: neither it nor any joint above it is in the skeleton", from.names[j]);
    out[j] = by_name[from.names[*at]];
  }
  return out;
}

SkinWeights with_locked(const SkinWeights& weights, const SkinWeights& before, std::span<const JointId> locked, std::size_t most) {
  assert(weights.size() == before.size());
  const auto is_locked = [&](const Influence& i) { return std::ranges::find(locked, i.joint) != locked.end(); };
  SkinWeights out;
  for (VertexId v : ids<VertexId>(weights.size())) {
    WeightRow kept, others;
    float held = 0.0f, free = 0.0f;
    for (const Influence& i : before[v])
      if (is_locked(i)) {
        kept.push_back(i);
        held += i.weight;
      }
    for (const Influence& i : weights[v])
      if (!is_locked(i) && kept.size() + others.size() < most) {
        others.push_back(i);
        free += i.weight;
      }
    if (others.empty() && held < 1.0f && kept.empty()) others.assign(weights[v].begin(), weights[v].end());
    for (Influence& i : others)
      if (free > 0.0f) i.weight *= (1.0f - std::min(1.0f, held)) / free;
    kept.insert(kept.end(), others.begin(), others.end());
    out.append(kept);
  }
  return out;
}

Binding bind(const TriangleMesh& mesh, const Skeleton& skeleton, const BindOptions& options) {
  Binding out;
  const Body body = measured(mesh, skeleton, options.resolution);
  out.repairs = body.clean.repairs;
  WeightRows rows = raw_weights(body, options, out.notes);
  if (options.islands == Islands::rigid && options.method != Method::transfer)
    out.rigid_islands = make_islands_rigid(rows, body.clean.mesh, body.skeleton, options.island);
  if (rounds(options) > 0) rows = smoothed(std::move(rows), geometry::one_ring(body.clean.mesh), rounds(options));
  prune(rows, options.prune_share.value_or(0.05f), options.max_influences);
  out.weights = to_skin_weights(rows, body.clean.from_original);
  if (!options.locked.empty()) out.weights = with_locked(out.weights, options.before.value(), options.locked, options.max_influences);
  return out;
}

}  // namespace osteon::skin
