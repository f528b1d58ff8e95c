// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "osteon/base/progress.h"
#include "osteon/infer/rignet.h"
#include "osteon/pipelines/confidence.h"
#include "osteon/pipelines/rig_report.h"
#include "osteon/pipelines/rignet_options.h"
#include "osteon/pipelines/skeleton_tree.h"
#include "osteon/rig/skeleton.h"
#include "osteon/rig/skin_weights.h"

namespace osteon::pipelines {

struct RignetResult {
  Skeleton skeleton;    // world space of the mesh; the given one, unchanged, where one was given
  SkinWeights weights;  // one row per vertex of the mesh that was given, in its order
  RigReport report;
  // (J) what the joints' confidence in the report follows from; none: a hand's; empty: skeleton given
  std::vector<std::optional<JointEvidence>> joint_evidence;
  CharacterEvidence character_evidence = {};  // and the probability of a character
};

// The whole of RigNet: Xu, Zhou, Kalogerakis, Landreth, Singh. RigNet: Neural Rigging for Articulated Characters. SIGGRAPH 2020.
// mesh -> its own frame (body_frame.h) -> clean working mesh -> displacement and attention -> joints -> tree -> hands (hands.h) ->
// joints drawn to edge loops (edge_loops.h) -> skin -> weights on the mesh that was given.
// What is not the character (geometry/surroundings.h) is left out before, follows the root, and a warning counts it.
// The rig is always valid: where the networks find no joints it is a single one in the middle, with confidence 0 and a warning.
// The same for any order of vertices and faces (weights follow their vertices) and any number of threads.
// The same, turned, for a mesh turned by right angles about the up axis, or that stands on z = 0 instead of y = 0. Where it stands on
// neither (geometry/stance.h), z is up if 0.08 more of the attention points at a joint then and the confidence is 0.05 more than with y up,
// which takes twice the time to find out and may fall out otherwise for the same mesh turned. Where the mesh is its own mirror image vertex
// by vertex, so is the rig: the joints (to rounding; bit by bit where the mesh is so, with its plane at x = 0 or z = 0), the tree, the
// names (left and right), and bit by bit the weights. Where only the shape is symmetric, the weights are as a field. Two exceptions: a
// skeleton without any joint on the plane has its root on one side, and a joint without partner (a sword) leaves all weights as they are.
// Throws Error for a mesh without surface, options out of range or an invalid skeleton; Cancelled if `progress` does. Pre: validate(mesh)
// holds.
RignetResult rig_character(const TriangleMesh& mesh, const infer::RignetModels& models, const RignetOptions& options = {},
                           const Progress& progress = {});

// Joints that are given, connected by the networks.
struct ConnectedJoints {
  JointSet joints;  // in the order in which they were given
  TreeEvidence evidence;
  JointTree tree;
};

// Only the connectivity of RigNet (sec. 4.2): `joints`, in the mesh's world coordinates, become a tree. Joints within 0.01 (longest side 1)
// of being mirror images of one another are partners. Where how the mesh stands tells no up axis, y and z are both tried, and the likelier
// tree is it; the joints' frame is then the one in which it was found.
// Throws Error for a mesh without surface. Pre: validate(mesh) holds; there are joints.
ConnectedJoints connect_joints(const TriangleMesh& mesh, std::span<const Vec3f> joints, const infer::RignetModels& models,
                               const RignetOptions& options = {});

}  // namespace osteon::pipelines
