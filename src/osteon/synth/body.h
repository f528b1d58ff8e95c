// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "osteon/base/types.h"
#include "osteon/rig/skeleton.h"
#include "osteon/rig/skin_weights.h"
#include "osteon/synth/polygonize.h"

namespace osteon::synth {

// A cone with round ends: the hull of two balls, optionally flattened across its axis.
struct RoundCone {
  Segment axis;
  float radius_a, radius_b;
  Vec3f flat_direction = Vec3f::UnitX();  // unit; the section is `flatness` times as thick along it
  float flatness = 1.0f;                  // 0 < flatness <= 1
};

// Signed distance, negative inside: exact where flatness is 1, else its zero set is exact and the value is not above the true distance.
// The 2D construction of Quilez, "Distance functions", iquilezles.org, section "Round Cone".
float signed_distance(const RoundCone& cone, const Vec3f& p);

// A thing of its own beside the skin, a separate component of the mesh.
enum class Bond { Rigid, Soft };  // all of it follows its joint; or it is weighted like the skin of the limb from its joint on
struct Piece {
  JointId joint;
  Bond bond;
  TriangleMesh mesh;
};
enum class Copies { Both, One };  // on both sides, or as it is

// A character as a skeleton clothed with round cones that melt into one another, mirror-symmetric about x = 0: what stands on the left side
// (x > 0) is given once and stands on the right too; pieces of one copy may break the symmetry. World space, metres, y up, facing +z.
class Body {
 public:
  // A joint on the middle plane. The first joint is the root and has no parent.
  JointId joint(const std::string& name, std::optional<JointId> parent, const Vec3f& position);
  // A joint on the left and its twin on the right, named "Left" + name and "Right" + name; returns the left one.
  // `parent` is a joint of the middle or the left.
  JointId pair(const std::string& name, JointId parent, const Vec3f& position);
  // Clothes a joint (middle or left). A cone beside the middle plane stands on both sides even if the joint is of the middle. `blend` is
  // the width, in metres, over which the cone melts into those added before it.
  void clothe(JointId joint, const RoundCone& cone, float blend);

  // Adds a rigid piece, with Both also its mirror image on the joint's twin.
  void attach(JointId joint, const TriangleMesh& mesh, Copies copies = Copies::Both);
  // Adds a soft piece, such as the web of a wing, with Both also its mirror image. Pre: the limb from `joint` on is clothed.
  void drape(JointId joint, const TriangleMesh& mesh, Copies copies = Copies::Both);

  const Skeleton& skeleton() const { return skeleton_; }
  const std::vector<Piece>& pieces() const { return pieces_; }
  bool has_skin() const { return !parts_.empty(); }
  JointId mirrored(JointId joint) const { return twins_[joint]; }
  const Vec3f& at(JointId joint) const { return skeleton_.rest_positions[joint]; }

  // Negative inside; never above the distance to the surface in value, so that empty space can be skipped. f(x,y,z) = f(-x,y,z).
  float distance(const Vec3f& p) const;
  // The same for points within `radius` of `centre`, from the parts that matter there. Refers to this body.
  Field near(const Vec3f& centre, float radius) const;
  Eigen::AlignedBox3f box() const;  // holds the whole surface

  // Exact smooth weights of a point on the surface: the joint whose cone is nearest, shared with those up and down the same limb whose
  // cones are about as near. A joint's share falls off as (1 - (d - nearest) / width)^2: half and half at the joint between two bones,
  // nothing beyond about one radius from it. Separate limbs never share: nothing leaks between legs or fingers. Only the joints from
  // `top` on take part. Pre: one of them is clothed.
  std::vector<Influence> weights(const Vec3f& p, JointId top = JointId{0}) const;

 private:
  void add_piece(const Piece& piece, Copies copies);
  struct Part {
    JointId joint;
    RoundCone cone;
    float blend;
  };
  struct SidedPart {
    const Part* part;
    bool far;  // the twin on the other side than the point
  };
  std::vector<SidedPart> all_parts() const;
  static float blended(const std::vector<SidedPart>& parts, const Vec3f& p);
  PerJoint<float> joint_distances(const Vec3f& p) const;

  Skeleton skeleton_;
  PerJoint<JointId> twins_;
  std::vector<Part> parts_;  // of the middle and the left
  std::vector<Piece> pieces_;
  PerJoint<float> widths_;  // over which a joint's weight falls off, metres
};

}  // namespace osteon::synth
