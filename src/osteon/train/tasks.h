// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <string>

#include "osteon/dataset/batch.h"
#include "osteon/train/model.h"
#include "osteon/train/networks.h"

// What each network is trained to do, and how well it does it.
namespace osteon::train {

enum class Task {
  attention,  // rignet.attention
  joints,     // rignet.joints: displacement alone, by chamfer(vertex + displacement, joints)
  collapse,   // rignet.joints --combined: displacement, attention and bandwidth together, through the mean shift
  votes,      // rignet.votes: displacement and attention of one network, by the density of its votes
  bones,
  root,
  tree,  // both in one network: every joint's parent
  skin,
  bind,
  neuroskinning,
  neuroskinning_2019,
};

struct TaskOptions {
  RunOptions run;
  dataset::BatchOptions batch;
  int mean_shift_steps = 15;
  double vertex_weight = 1.0;      // combined: of chamfer(q, joints), what the paper calls the vertex loss
  double collapse_weight = 2.0;    // of the trail against chamfer(q, joints): the released code's
  double attention_weight = 0.1;   // of the attention's own cross-entropy in the combined loss: the code's option
  double density_weight = 0.05;    // votes: of the density at the joints, against chamfer(q, joints)
  double density_width = 0.03;     // of its kernel; longest side = 1
  double difference_weight = 1.0;  // neuroskinning: of the L1 distance of the weights, against their cross-entropy
};

// Whether it learns which joints belong together: characters with a single joint have nothing to show.
bool is_about_pairs(Task task);

// What the task reads of a character.
dataset::Parts parts_of(Task task);

// A fresh model with the parts that the task trains; the displacement starts at zero, as in the released code,
// and what our NeuroSkinning network adds to the geometric shares.
Model fresh_model(Task task, std::uint64_t seed);

at::Tensor training_loss(Task task, Model& model, const dataset::Batch& batch, const TaskOptions& options);

// Named figures, each a mean over the characters; "loss" is what to choose by (smaller is better).
//   attention   loss, f1 (of label 1 at probability 0.5)
//   joints      loss, to_joints (mean over vertices of the distance to the nearest joint), to_points
//   votes       loss (of the density), to_joints and to_points of all votes, f1 of the attention
//   collapse    the same of the shifted points that have attention above 0.1 of the mesh's largest
//   bones       loss, accuracy, precision and recall of the pairs with probability over 0.5 (mean of both orders)
//   root        loss, accuracy
//   tree        loss, parents (how often the likeliest parent is right), root (how often the likeliest root is)
//   skin, bind, neuroskinning, neuroskinning_2019  loss, l1 (mean over vertices of the summed differences to the reference weights)
std::map<std::string, double> validate(Task task, Model& model, std::span<const dataset::Example> examples, const TaskOptions& options);

}  // namespace osteon::train
