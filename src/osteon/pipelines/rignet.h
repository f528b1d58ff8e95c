// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "osteon/base/progress.h"
#include "osteon/geometry/bind_features.h"
#include "osteon/infer/rignet.h"
#include "osteon/pipelines/body_frame.h"
#include "osteon/pipelines/confidence.h"
#include "osteon/pipelines/joint_extraction.h"
#include "osteon/pipelines/rig_report.h"
#include "osteon/pipelines/skeleton_tree.h"
#include "osteon/pipelines/skin_prediction.h"
#include "osteon/rig/skeleton.h"
#include "osteon/rig/skin_weights.h"

namespace osteon::pipelines {

enum class Symmetry { automatic, off };
enum class Fingers { automatic, off };  // automatic: where hands have them (hands.h), at `detail` 0.4 and more

// Parts of the method that can be left out, to see what each is good for (docs/results.md).
struct Ablation {
  bool attention = true;             // false: every vertex's vote counts alike
  bool views = true;                 // false: the network sees the character once, as it is
  bool edge_loops = true;            // false: joints stay where the votes gather
  bool bone_network = true;          // false: the nearer two joints are, the likelier a bone joins them
  bool geodesic = true;              // false: a bone is as far from a vertex as in a straight line
  float neuroskinning = 0.5f;        // its share in the weights, beside the binding network's; 0: that one alone
  int bones = geometry::kBindBones;  // a vertex chooses from so many at most, 1..kBindBones
};

struct RignetOptions {
  std::optional<float> bandwidth = {};     // of the mean shift, kFinestBandwidth..kCoarsestBandwidth; else by `detail`
  float detail = 0.5f;                     // 0 (few joints) .. 1 (many)
  std::optional<std::size_t> joints = {};  // about this many: the bandwidth is searched, and the two above are not read
  Symmetry symmetry = Symmetry::automatic;
  Fingers fingers = Fingers::automatic;
  Up up = Up::automatic;
  std::optional<Skeleton> skeleton = {};  // use this one, in the mesh's world coordinates, and only skin it
  geometry::WorkingMeshOptions working_mesh = {};
  JointExtractionOptions extraction = {};  // its bandwidth and number of joints are not read
  TreeOptions tree = {};
  SkinPredictionOptions skin = {};  // with the number of influences
  Ablation ablation = {};
};

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
