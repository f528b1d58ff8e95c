// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ATen/ATen.h>

#include <vector>

// What the networks are trained to make small (facts/rignet of the paper's sections 4.1 to 4.3); each a scalar, differentiable.
namespace osteon::train {

// Mean binary cross-entropy of logits (N,1) against targets (N), 0 or 1.
at::Tensor attention_loss(const at::Tensor& logits, const at::Tensor& targets);

// Half the mean distance from a point to the nearest joint plus half that from a joint to the nearest point; plain Euclidean.
// points (N,3), joints (J,3). The paper's equation 10 has no factor 1/2.
at::Tensor chamfer(const at::Tensor& points, const at::Tensor& joints);

// Mean over the joints of -log of the votes' density there, where the votes are a mixture of kernels (1 + d^2 / width^2)^-3, each weighted
// with its attention in parts of all attention: points (V,3), logits (V,1) of the attention, joints (J,3), width in the unit of the points.
// Ours, in place of the paper's loss through the mean shift: the joints that are found are the modes of this very density. Votes away from
// joints cost, as the whole is 1; every joint gets about the same share, however much skin there is around it, so that a threshold on the
// share tells joints from noise; and attention learns which votes are good.
at::Tensor density_loss(const at::Tensor& points, const at::Tensor& logits, const at::Tensor& joints, double width);

// The trail of a mean shift against the joints: mean of chamfer() over its steps (the released code; the paper takes the last one).
at::Tensor trail_loss(const std::vector<at::Tensor>& trail, const at::Tensor& joints);

// Mean binary cross-entropy over all pairs plus the mean of the highest 30 %: most pairs are easy. logits (P,1), targets (P).
at::Tensor bone_loss(const at::Tensor& logits, const at::Tensor& targets);

// Mean over meshes of -log softmax at the root joint (the paper's). logits (J,1); the joints of mesh m are rows offsets[m] ..
// offsets[m+1]-1; roots[m] is the row of its root.
at::Tensor root_loss(const at::Tensor& logits, const std::vector<std::int32_t>& offsets, const std::vector<std::int32_t>& roots);

// Every joint's parent: mean over the skeletons of the mean over their joints of -log p(parent), with p a softmax over the joint's
// candidates, plus -log softmax over the joints of p(its own parent) at the root. logits (P,1): for each joint, one for each joint of its
// skeleton, itself too; the joints of skeleton m are offsets[m] .. offsets[m+1]-1. parents[j] counts within the skeleton, the root's is
// itself.
at::Tensor tree_loss(const at::Tensor& logits, const std::vector<std::int32_t>& offsets, const std::vector<std::int64_t>& parents);

// Mean cross-entropy of softmax(logits), (V,5), against weights whose rows sum to 1, each vertex counting with its share (V), the part of
// its weight that the five bones can carry. Differs: the reference drops vertices whose share is not exactly 1, 7 % by rounding alone.
at::Tensor skin_loss(const at::Tensor& logits, const at::Tensor& weights, const at::Tensor& share);

// Mean over the vertices of the L1 distance between softmax(logits) and the reference's weights. Its weight on other bones (1 - share) is
// lost whatever the network says: it counts in full.
at::Tensor skin_difference(const at::Tensor& logits, const at::Tensor& weights, const at::Tensor& share);

}  // namespace osteon::train
