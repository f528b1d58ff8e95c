// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "osteon/base/indexed.h"
#include "osteon/base/types.h"

namespace osteon {

enum class JointId : std::uint16_t {};
template <class T>
using PerJoint = Indexed<JointId, T>;

// A joint tree in its rest pose. Invariants (see validate): at least one joint; equally many names, parents, positions and orientations;
// names not empty and unique; parents[j] < j; joint 0 is the only root; everything finite, orientations of unit length.
struct Skeleton {
  PerJoint<std::string> names;               // UTF-8
  PerJoint<std::optional<JointId>> parents;  // empty for the root
  PerJoint<Vec3f> rest_positions;            // world space, metres
  PerJoint<Quatf> rest_orientations;         // joint axes -> world axes

  std::size_t size() const { return names.size(); }
  JointId add(std::string name, std::optional<JointId> parent, const Vec3f& position, const Quatf& orientation = Quatf::Identity());
};

// Throws Error naming the first joint that breaks an invariant.
void validate(const Skeleton& skeleton);

PerJoint<std::vector<JointId>> children(const Skeleton& skeleton);  // in joint order

// Turns each joint's +y to its main child (the one with the most descendants; between several equal ones) as Blender's bones have it, with
// +z as near to world +z as that allows; a leaf takes its parent's orientation, a lone root the world's, and so does a joint between
// children that pull in opposite directions.
void orient_along_bones(Skeleton& skeleton);

// Turned about the origin, joint axes included.
Skeleton turned(Skeleton skeleton, const Eigen::Matrix3f& rotation);

// Moved by a similarity; joint axes turn with it.
Skeleton transformed(Skeleton skeleton, const Eigen::Affine3d& similarity);

// A bone: the segment from a joint to one of its children, or the point at a leaf joint (RigNet, sec. 4.3; facts 7.1).
// The skin weight of a bone belongs to its start joint.
struct Bone {
  JointId start;
  std::optional<JointId> end;  // empty for the zero-length bone at a leaf
  Segment segment;             // world space; a == b at a leaf
};

// Breadth-first from the root: one bone for each parent->child edge, and after each leaf child one leaf bone.
std::vector<Bone> bones(const Skeleton& skeleton);

}  // namespace osteon
