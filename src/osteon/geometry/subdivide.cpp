// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/subdivide.h"

#include <algorithm>
#include <array>
#include <map>
#include <queue>
#include <vector>

namespace osteon::geometry {
namespace {

using Ends = std::pair<VertexId, VertexId>;  // the smaller id first

struct Edge {
  float squared_length;
  Ends ends;

  bool operator<(const Edge& o) const {  // of a max-heap: the top is the longest, then the one with the smaller ends
    return squared_length != o.squared_length ? squared_length < o.squared_length : ends > o.ends;
  }
};

// Knows the edges that are too long and their faces; the others, most of a large mesh, it need not look at.
class Subdivision {
 public:
  Subdivision(TriangleMesh& mesh, float longest_edge) : mesh_(mesh), squared_limit_(longest_edge * longest_edge) {
    for (FaceId f : mesh.faces.ids()) enter(f);
  }

  bool finished() const { return queue_.empty(); }

  void split_longest() {
    const auto [a, b] = queue_.top().ends;
    queue_.pop();
    const std::vector<FaceId> faces = std::move(faces_.extract({a, b}).mapped());
    const VertexId middle = mesh_.positions.push_back(0.5f * (mesh_.positions[a] + mesh_.positions[b]));
    for (FaceId f : faces) {
      Triangle near = mesh_.faces[f], far = near;
      std::replace(near.begin(), near.end(), b, middle);
      std::replace(far.begin(), far.end(), a, middle);
      leave(f, {a, b});
      mesh_.faces[f] = near;
      enter(f);
      enter(mesh_.faces.push_back(far));
    }
  }

 private:
  static std::array<Ends, 3> edges(const Triangle& t) {
    return {std::minmax(t[0], t[1]), std::minmax(t[1], t[2]), std::minmax(t[2], t[0])};
  }

  void enter(FaceId f) {
    for (const Ends& e : edges(mesh_.faces[f])) {
      const float squared_length = (mesh_.positions[e.first] - mesh_.positions[e.second]).squaredNorm();
      if (squared_length <= squared_limit_) continue;
      const auto [entry, is_new] = faces_.try_emplace(e);
      if (is_new) queue_.push({squared_length, e});
      entry->second.push_back(f);
    }
  }

  void leave(FaceId f, const Ends& split) {
    for (const Ends& e : edges(mesh_.faces[f]))
      if (const auto entry = faces_.find(e); e != split && entry != faces_.end()) std::erase(entry->second, f);
  }

  TriangleMesh& mesh_;
  float squared_limit_;
  std::map<Ends, std::vector<FaceId>> faces_;  // of each edge
  std::priority_queue<Edge> queue_;            // each edge once
};

}  // namespace

TriangleMesh subdivide(TriangleMesh mesh, const SubdivideOptions& options) {
  Subdivision work(mesh, options.longest_edge);
  while (!work.finished() && mesh.positions.size() < options.most_vertices) work.split_longest();
  return mesh;
}

}  // namespace osteon::geometry
