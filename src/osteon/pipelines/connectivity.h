// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/infer/rignet.h"
#include "osteon/pipelines/body.h"
#include "osteon/pipelines/skeleton_tree.h"

namespace osteon::pipelines {

// What the networks say of which joint is the parent of which: by the tree network (nets/tree.h), or by BoneNet and RootNet where the
// models are the paper's (sec. 4.2). `joints`: in the frame of `body`. Pre: there are joints.
TreeEvidence tree_evidence(const JointSet& joints, const Body& body, const infer::RignetModels& models, const Ablation& ablation);

}  // namespace osteon::pipelines
