// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/mirrored_skin.h"

#include <algorithm>
#include <limits>
#include <map>
#include <vector>

#include "osteon/geometry/bvh.h"

namespace osteon::pipelines {
namespace {

constexpr float kSameJoint = 0.01f, kSamePlace = 1e-4f, kOnSurface = 0.02f;

// The joints nearest to a place: several where they are stacked.
std::vector<JointId> nearest(const Vec3f& place, const PerJoint<Vec3f>& positions) {
  float least = kSameJoint;
  for (const Vec3f& p : positions) least = std::min(least, (p - place).norm());
  std::vector<JointId> out;
  for (JointId j : positions.ids())
    if (const float d = (positions[j] - place).norm(); d < kSameJoint && d <= least + kSamePlace) out.push_back(j);
  return out;
}

bool parents_are_partners(const Skeleton& skeleton, const PerJoint<JointId>& partner, JointId a, JointId b) {
  const auto &mine = skeleton.parents[a], &theirs = skeleton.parents[b];
  return mine && theirs ? partner[*mine] == *theirs : a == b;
}

using Row = std::vector<Influence>;

// The mean of two rows, largest first.
Row mean(std::span<const Influence> a, const Row& b) {
  std::map<JointId, float> sums;
  for (const Influence& i : a) sums[i.joint] += 0.5f * i.weight;
  for (const Influence& i : b) sums[i.joint] += 0.5f * i.weight;
  Row row;
  for (const auto& [joint, weight] : sums) row.push_back({joint, weight});
  std::ranges::stable_sort(row, std::greater(), &Influence::weight);
  return row;
}

// Keeps the `most` largest, and of equal ones all or none, if that leaves any.
void cut(Row& row, std::size_t most) {
  if (row.size() <= most) return;
  std::size_t end = most;
  while (end > 0 && row[end - 1].weight == row[most].weight) --end;
  row.resize(end > 0 ? end : most);
}

Row exchanged(std::span<const Influence> row, const PerJoint<JointId>& partner) {
  Row out;
  for (const Influence& i : row) out.push_back({partner[i.joint], i.weight});
  return out;
}

}  // namespace

std::optional<PerJoint<JointId>> mirror_partners(const Skeleton& skeleton, const PerJoint<Vec3f>& positions, const Plane& plane) {
  PerJoint<JointId> partner;
  for (JointId j : positions.ids()) {
    std::vector<JointId> found = nearest(plane.mirror(positions[j]), positions);
    std::erase_if(found, [&](JointId other) { return std::ranges::find(partner, other) != partner.end(); });
    if (found.empty()) return std::nullopt;
    // Of stacked joints the one that hangs on the partner of this one's parent.
    const auto alike = std::ranges::find_if(found, [&](JointId other) { return parents_are_partners(skeleton, partner, j, other); });
    partner.push_back(alike != found.end() ? *alike : found.front());
  }
  for (JointId j : partner.ids()) {
    const bool has_root = !skeleton.parents[j] || !skeleton.parents[partner[j]];
    if (partner[partner[j]] != j || (!has_root && !parents_are_partners(skeleton, partner, j, partner[j]))) return std::nullopt;
  }
  return partner;
}

Matrix mean_with_image(const Matrix& weights, const TriangleMesh& mesh, const Plane& plane, const PerJoint<JointId>& partner) {
  const geometry::Bvh surface(mesh);
  Matrix out = weights;
  for (VertexId v : mesh.positions.ids()) {
    const geometry::ClosestPoint image = surface.closest_point(plane.mirror(mesh.positions[v]));
    if (image.distance > kOnSurface) continue;
    const auto row = static_cast<Eigen::Index>(index(v));
    for (JointId j : partner.ids()) {
      const auto theirs = static_cast<Eigen::Index>(index(partner[j]));
      float there = 0.0f;
      for (std::size_t k = 0; k < 3; ++k)
        there +=
            image.barycentric[static_cast<Eigen::Index>(k)] * weights(static_cast<Eigen::Index>(index(mesh.faces[image.face][k])), theirs);
      float& here = out(row, static_cast<Eigen::Index>(index(j)));
      here = 0.5f * (here + there);
    }
  }
  return out;
}

SkinWeights mirrored_exactly(const SkinWeights& weights, const PerVertex<VertexId>& from_original,
                             const PerVertex<VertexId>& vertex_partner, const PerJoint<JointId>& joint_partner,
                             std::size_t max_influences) {
  PerVertex<std::optional<VertexId>> someone(vertex_partner.size());  // a vertex of the original that stands for each clean one
  for (VertexId v : from_original.ids())
    if (!someone[from_original[v]]) someone[from_original[v]] = v;
  SkinWeights out;
  for (VertexId v : from_original.ids()) {
    const VertexId here = from_original[v], there = vertex_partner[here];
    // The same sums for both: those of the vertex with the smaller number.
    const VertexId first = std::min(here, there), second = std::max(here, there);
    Row row = mean(weights[*someone[first]], exchanged(weights[*someone[second]], joint_partner));
    cut(row, max_influences);
    out.append(here == first ? row : exchanged(row, joint_partner));
  }
  return out;
}

}  // namespace osteon::pipelines
