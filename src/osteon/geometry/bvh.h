// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "osteon/mesh/triangle_mesh.h"

namespace osteon::geometry {

struct RayHit {
  FaceId face;
  float distance;  // along the ray, in the mesh's own unit
};

struct ClosestPoint {
  FaceId face;
  Vec3f barycentric;  // weights of the face's three corners: >= 0, sum 1; exactly (1,0,0), (0,1,0) or (0,0,1) at a corner
  Vec3f position;     // on the face
  float distance;     // from the query to `position`
};

// Weights (>= 0, sum 1) of a, b, c for the point of the triangle that is closest to p. Degenerate triangles are segments or points.
// Ericson, Real-Time Collision Detection, 2005, section 5.1.5.
Vec3f closest_barycentric(const Vec3f& p, const Vec3f& a, const Vec3f& b, const Vec3f& c);

// The corners of up to four triangles, coordinate by coordinate, so that a ray is tested against all at once. Where there are fewer, the
// last is repeated.
struct TriangleBlock {
  static constexpr std::size_t kSize = 4;
  using Corner = std::array<std::array<float, kSize>, 3>;  // [axis][triangle]
  Corner a, b, c;
  std::array<FaceId, kSize> face;
  std::uint32_t count;
};

// A tree of boxes, four to a node, over the faces of a mesh: rays and closest points in about log(faces) steps. It copies what it needs:
// the mesh may go. Faces with equal answers (a shared edge) are resolved to the smallest FaceId, so answers do not depend on how the tree
// was built. Built top-down by binned surface area heuristic: Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", 2007;
// then nodes take in their largest children until they have four: Wald, Benthin, Boulos, "Getting Rid of Packets", 2008.
class Bvh {
 public:
  explicit Bvh(const TriangleMesh& mesh);  // pre: validate(mesh) holds; a mesh without faces is allowed

  // The first face that a ray meets at a distance in [0, max_distance], from either side. Pre: |direction| = 1.
  // Rays never slip through the edge between two faces: Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2013.
  std::optional<RayHit> first_hit(const Vec3f& origin, const Vec3f& direction,
                                  float max_distance = std::numeric_limits<float>::infinity()) const;

  // Whether any face lies on the segment, its ends included. Cheaper than first_hit.
  bool blocked(const Segment& segment) const;

  // Pre: the mesh has faces.
  ClosestPoint closest_point(const Vec3f& p) const;

 private:
  // The boxes of four children, coordinate by coordinate. Where there are fewer, the rest are empty: low is infinite, high negative
  // infinite.
  struct Node {
    using Bound = std::array<std::array<float, 4>, 3>;  // [axis][child]
    Bound low, high;
    std::array<std::uint32_t, 4> child;  // a node, or ~ of a block
  };
  struct Ray;
  struct Builder;

  std::vector<Node> nodes_;  // breadth first; empty when the mesh has no faces
  std::vector<TriangleBlock> blocks_;
};

}  // namespace osteon::geometry
