// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "osteon/pipelines/skeleton_tree.h"

namespace osteon::pipelines {

// Lengths where the character's longest side is 1.
struct EdgeLoopOptions {
  float reach = 0.02f;  // how far along its limb a joint is unsure before the loops are seen (standard deviation)
  float trust = 2.0f;   // power to which the loops speak
  float loop = 0.006f;  // width of the kernel that tells loops apart,
  float limb = 0.03f;   // and of the one that tells how densely the limb is modelled there (standard deviations)
  float faint = 12.0f;  // vertices per length that count as there everywhere: a limb of a few vertices says little
  float radius = 0.1f;  // vertices farther from the limb's axis belong to something else
  float shortest_bone = 0.04f;
};

// Where a body bends, artists put edge loops closer together, and the joint among them: in the training characters a limb has a quarter
// to a third more vertices there than 0.03 away. Reducing the mesh for the networks takes these loops away first, as a straight limb is
// flat along itself. So every joint with a parent and a child straight on, both bones at least `shortest_bone` long, moves along its limb
// to the mean of
//   exp(-s^2 / 2 reach^2) (n_loop(s) / n_limb(s))^trust,   n_h the density of vertices along the axis, smoothed over h,
// and never past the middle of its bones. On an evenly triangulated mesh hardly anything moves. Mirror partners count the vertices of both
// sides and stay mirror images; joints on the plane stay on it. Ours, from no paper.
// `vertices`: of the mesh before it was reduced, no two in one place, in the normalised frame. Pre: as of connect(); `tree` is of `joints`.
JointSet drawn_to_edge_loops(const JointSet& joints, const JointTree& tree, std::span<const Vec3f> vertices,
                             const EdgeLoopOptions& options = {});

}  // namespace osteon::pipelines
