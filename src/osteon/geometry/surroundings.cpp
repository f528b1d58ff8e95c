// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/surroundings.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "osteon/geometry/cleanup.h"

namespace osteon::geometry {
namespace {

constexpr double kBody = 0.95, kStrays = 0.01;  // of the area
constexpr float kFar = 0.5f;                    // of the body's diagonal
constexpr int kLayers = 3;
constexpr float kSunk = 0.05f, kThickness = 0.15f, kLowest = 0.2f;  // of the height of what stands on the ground
constexpr float kWider = 1.1f;                                      // than its lowest fifth

struct Part {
  Eigen::AlignedBox3f box;
  double area = 0;
  bool is_character = true;
};

class Parts {
 public:
  explicit Parts(const TriangleMesh& mesh) : mesh_(mesh), components_(connected_components(mesh)), parts_(components_.count) {
    for (VertexId v : mesh.positions.ids()) parts_[components_.of[v]].box.extend(mesh.positions[v]);
    for (FaceId f : mesh.faces.ids()) parts_[components_.of[mesh.faces[f][0]]].area += static_cast<double>(area_vector(mesh, f).norm());
  }

  bool is_character(VertexId v) const { return parts_[components_.of[v]].is_character; }

  void leave_strays(std::span<const Vec3f> joints) {
    const double all = total();
    Eigen::AlignedBox3f body = body_box(kBody * all);
    for (const Vec3f& p : joints) body.extend(p);
    const float far = kFar * body.diagonal().norm();
    const auto is_stray = [&](const Part& p) { return p.box.exteriorDistance(body) > far; };
    double strays = 0;
    for (const Part& p : parts_)
      if (is_stray(p)) strays += p.area;
    if (strays >= kStrays * all) return;  // so all stays where the areas are too small for a float
    for (Part& p : parts_) p.is_character = !is_stray(p);
  }

  // Returns whether there was one.
  bool leave_ground() {
    for (const Eigen::Index axis : {1, 2})
      if (Part* widest = widest_at_foot(axis); widest && is_ground(*widest, axis)) {
        widest->is_character = false;
        return true;
      }
    return false;
  }

 private:
  double total() const {
    return std::accumulate(parts_.begin(), parts_.end(), 0.0, [](double sum, const Part& p) { return sum + p.area; });
  }

  // Of the largest parts that have so much area together.
  Eigen::AlignedBox3f body_box(double area) const {
    std::vector<const Part*> order;
    for (const Part& p : parts_) order.push_back(&p);
    std::ranges::sort(order, std::ranges::greater{}, &Part::area);
    Eigen::AlignedBox3f box;
    for (const Part* p : order) {
      if (area <= 0) break;
      box.extend(p->box);
      area -= p->area;
    }
    return box;
  }

  Eigen::AlignedBox3f box_without(const Part* left_out) const {
    Eigen::AlignedBox3f box;
    for (const Part& p : parts_)
      if (p.is_character && &p != left_out) box.extend(p.box);
    return box;
  }

  // Of the flat parts at the low end of the axis that with the largest box seen along it.
  Part* widest_at_foot(Eigen::Index axis) {
    const Eigen::AlignedBox3f all = box_without(nullptr);
    const float height = all.sizes()[axis];
    const auto width = [axis](const Part& p) { return p.box.sizes()[(axis + 1) % 3] * p.box.sizes()[(axis + 2) % 3]; };
    Part* widest = nullptr;
    for (Part& p : parts_)
      if (p.is_character && p.box.min()[axis] <= all.min()[axis] + kSunk * height && p.box.sizes()[axis] <= kThickness * height &&
          (!widest || width(p) > width(*widest)))
        widest = &p;
    return widest;
  }

  bool is_ground(const Part& part, Eigen::Index axis) const {
    const Eigen::AlignedBox3f rest = box_without(&part);
    if (rest.isEmpty()) return false;
    const float height = rest.sizes()[axis], foot = rest.min()[axis];
    if (part.box.max()[axis] > foot + kSunk * height || part.box.sizes()[axis] > kThickness * height) return false;
    const Eigen::AlignedBox3f lowest = box_below(foot + kLowest * height, part, axis);
    for (const Eigen::Index side : {(axis + 1) % 3, (axis + 2) % 3}) {
      if (part.box.min()[side] > lowest.min()[side] || part.box.max()[side] < lowest.max()[side]) return false;
      if (part.box.sizes()[side] < kWider * lowest.sizes()[side]) return false;
    }
    return true;
  }

  // Of the character's vertices that lie lower.
  Eigen::AlignedBox3f box_below(float level, const Part& left_out, Eigen::Index axis) const {
    Eigen::AlignedBox3f box;
    for (VertexId v : mesh_.positions.ids()) {
      const Part& part = parts_[components_.of[v]];
      if (part.is_character && &part != &left_out && mesh_.positions[v][axis] <= level) box.extend(mesh_.positions[v]);
    }
    return box;
  }

  const TriangleMesh& mesh_;
  Components components_;
  std::vector<Part> parts_;
};

}  // namespace

Surroundings surroundings(const TriangleMesh& mesh, std::span<const Vec3f> joints) {
  Surroundings out{PerVertex<bool>(mesh.positions.size())};
  const CleanMesh clean = geometry::clean(mesh);  // parts are not cut along texture seams
  if (clean.mesh.faces.empty()) return out;
  Parts parts(clean.mesh);
  parts.leave_strays(joints);
  for (int layer = 0; layer < kLayers && parts.leave_ground();) ++layer;
  for (VertexId v : mesh.positions.ids()) {
    out.has[v] = !parts.is_character(clean.from_original[v]);
    out.vertices += out.has[v] ? 1 : 0;
  }
  return out;
}

TriangleMesh without(const TriangleMesh& mesh, const PerVertex<bool>& left_out) {
  TriangleMesh out;
  PerVertex<VertexId> renumbered(mesh.positions.size());
  for (VertexId v : mesh.positions.ids())
    if (!left_out[v]) renumbered[v] = out.positions.push_back(mesh.positions[v]);
  for (const auto& [a, b, c] : mesh.faces)
    if (!left_out[a] && !left_out[b] && !left_out[c]) out.faces.push_back({renumbered[a], renumbered[b], renumbered[c]});
  return out;
}

}  // namespace osteon::geometry
