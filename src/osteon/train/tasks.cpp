// SPDX-License-Identifier: Apache-2.0
#include "osteon/train/tasks.h"

#include <ATen/core/grad_mode.h>
#include <torch/types.h>

#include "osteon/base/error.h"
#include "osteon/train/losses.h"
#include "osteon/train/mean_shift.h"

namespace osteon::train {
namespace {

using at::Tensor;
using nets::rignet::name_of;
using nets::rignet::Network;
using Figures = std::map<std::string, double>;

const auto kNeuroBones = static_cast<std::int64_t>(skin::BoneChoiceOptions().most);

Network network_of(Task task) {
  switch (task) {
    case Task::attention:
      return Network::attention;
    case Task::joints:
    case Task::collapse:
      return Network::joints;
    case Task::votes:
      return Network::votes;
    case Task::bones:
      return Network::bones;
    case Task::root:
      return Network::root;
    case Task::tree:
      return Network::tree;
    case Task::skin:
      return Network::skin;
    case Task::bind:
      return Network::bind;
    case Task::neuroskinning:
      return Network::neuroskinning;
    case Task::neuroskinning_2019:
      return Network::neuroskinning_2019;
  }
  throw Error("unknown task");
}

// The largest of a normalised channel over a mesh is 3 to 4: a thousand of them, all positive, drown the features of the vertex beside
// them, and two thirds of the head's channels never fire. With these figures they begin small and around zero.
void quieten_global_features(Network network, Parameters& parameters) {
  if (network == Network::bones || network == Network::root) return;  // 64 and 128 channels beside as many others: no trouble
  if (network == Network::bind || network == Network::votes || network == Network::tree) return;  // not more than 256 beside 455
  if (network == Network::neuroskinning) return;                                                  // 128 beside 832
  const char* last_norm = network == Network::skin || network == Network::neuroskinning_2019 ? "global.1.norm" : "global.0.norm";
  parameters.at(std::string(last_norm) + ".weight").fill_(0.2);
  parameters.at(std::string(last_norm) + ".bias").fill_(-0.7);
}

Tensor tensor_of(const std::vector<float>& values, std::int64_t columns, at::Device device) {
  const auto rows = static_cast<std::int64_t>(values.size()) / columns;
  Tensor out = torch::from_blob(const_cast<float*>(values.data()), {rows, columns}).clone().to(device);
  return columns == 1 ? out.squeeze(1) : out;
}

Tensor run(Network network, Model& model, const dataset::Batch& batch, const RunOptions& options) {
  return run_network(network, model[name_of(network)], batch.inputs, options);
}

Tensor rows_of_mesh(const Tensor& x, const nets::BatchArrays& batch, std::size_t mesh) {
  return x.narrow(0, batch.offsets[mesh], batch.offsets[mesh + 1] - batch.offsets[mesh]);
}

// Positions moved by the displacement, and how much each is trusted.
struct Candidates {
  Tensor points;     // (V,3)
  Tensor attention;  // (V,1) logits; undefined where the displacement is trained alone
  Tensor joints;     // (J,3) reference
};

Candidates candidates(Task task, Model& model, const dataset::Batch& batch, const RunOptions& options) {
  Tensor displacement = run(network_of(task), model, batch, options), attention;
  if (task == Task::votes) {
    attention = displacement.narrow(1, 3, 1);
    const Tensor to_middle = tensor_of(batch.inputs.votes.features, nets::vote_features, options.device).narrow(1, nets::vote_to_middle, 3);
    displacement = to_middle + nets::vote_unit * displacement.narrow(1, 0, 3);
  }
  if (task == Task::collapse) attention = run(Network::attention, model, batch, options);
  return {tensor_of(batch.inputs.mesh.positions, 3, options.device) + displacement, attention,
          tensor_of(batch.inputs.joints.positions, 3, options.device)};
}

Tensor displacement_loss(const Candidates& all, const dataset::Batch& batch) {
  const std::size_t meshes = batch.targets.root.size();
  Tensor sum = at::zeros({}, all.points.options());
  for (std::size_t m = 0; m < meshes; ++m)
    sum = sum + chamfer(rows_of_mesh(all.points, batch.inputs.mesh.batch, m), rows_of_mesh(all.joints, batch.inputs.joints.batch, m));
  return sum / static_cast<double>(meshes);
}

Tensor density_loss_of(const Candidates& all, const dataset::Batch& batch, const TaskOptions& options) {
  const std::size_t meshes = batch.targets.root.size();
  const nets::BatchArrays &vertices = batch.inputs.mesh.batch, &joints = batch.inputs.joints.batch;
  Tensor sum = at::zeros({}, all.points.options());
  for (std::size_t m = 0; m < meshes; ++m)
    sum = sum + density_loss(rows_of_mesh(all.points, vertices, m), rows_of_mesh(all.attention, vertices, m),
                             rows_of_mesh(all.joints, joints, m), options.density_width);
  return sum / static_cast<double>(meshes);
}

Tensor votes_loss(Model& model, const dataset::Batch& batch, const TaskOptions& options) {
  const Candidates all = candidates(Task::votes, model, batch, options.run);
  return displacement_loss(all, batch) + options.density_weight * density_loss_of(all, batch, options) +
         options.attention_weight * attention_loss(all.attention, tensor_of(batch.targets.attention, 1, options.run.device));
}

Tensor collapse_loss(Model& model, const dataset::Batch& batch, const TaskOptions& options) {
  const Candidates all = candidates(Task::collapse, model, batch, options.run);
  const Tensor attention = all.attention.sigmoid();
  const std::size_t meshes = batch.targets.root.size();
  Tensor loss = options.vertex_weight * displacement_loss(all, batch);
  for (std::size_t m = 0; m < meshes; ++m) {
    const auto trail = mean_shift(rows_of_mesh(all.points, batch.inputs.mesh.batch, m), rows_of_mesh(attention, batch.inputs.mesh.batch, m),
                                  model["bandwidth"].at("h"), options.mean_shift_steps);
    const Tensor collapsed = trail_loss(trail, rows_of_mesh(all.joints, batch.inputs.joints.batch, m));
    loss = loss + collapsed * (options.collapse_weight / static_cast<double>(meshes));
  }
  return loss + options.attention_weight * attention_loss(all.attention, tensor_of(batch.targets.attention, 1, options.run.device));
}

// Rows of vertices and bones (C) spread out to one row a vertex, (V,width); `rest` where a vertex has fewer bones.
Tensor spread(const Tensor& of_choices, const nets::BindArrays& choices, std::int64_t width, double rest) {
  std::vector<std::int64_t> places;
  for (std::size_t row = 0; row < choices.vertex_of.size(); ++row) {
    const std::int32_t vertex = choices.vertex_of[row];
    places.push_back(vertex * width + static_cast<std::int64_t>(row) - choices.offsets[static_cast<std::size_t>(vertex)]);
  }
  const Tensor at_places = at::tensor(places, at::kLong).to(of_choices.device());
  const auto vertices = static_cast<std::int64_t>(choices.offsets.size()) - 1;
  return at::full({vertices * width}, rest, of_choices.options()).index_copy(0, at_places, of_choices).view({vertices, width});
}

constexpr double kNoBone = -1e4;  // a logit of which the softmax leaves nothing

// One row a vertex, (V,5), (V,8), (V,10) or (V,slots).
Tensor skin_logits(Task task, const Tensor& out, const dataset::Batch& batch) {
  if (task == Task::bind) return spread(out.squeeze(1), batch.inputs.choices, geometry::kBindBones, kNoBone);
  if (task == Task::neuroskinning)
    return spread(out.squeeze(1) + tensor_of(batch.targets.log_shares, 1, out.device()), batch.inputs.neuro.choices, kNeuroBones, kNoBone);
  if (task == Task::neuroskinning_2019) return out + tensor_of(batch.targets.slots, nets::neuro_slots, out.device());
  return out;
}

Tensor skin_targets(Task task, const dataset::Batch& batch, at::Device device) {
  if (task == Task::neuroskinning) return spread(tensor_of(batch.targets.skin, 1, device), batch.inputs.neuro.choices, kNeuroBones, 0.0);
  return tensor_of(batch.targets.skin, static_cast<std::int64_t>(batch.targets.skin.size() / batch.targets.skin_share.size()), device);
}

double share(const Tensor& yes, const Tensor& of) { return yes.sum().item<double>() / std::max(1.0, of.sum().item<double>()); }

Figures attention_figures(const Tensor& logits, const Tensor& targets) {
  const Tensor found = (logits.squeeze(1) > 0.0).to(at::kFloat), right = found * targets;
  return {{"loss", attention_loss(logits, targets).item<double>()},
          {"f1", 2.0 * right.sum().item<double>() / std::max(1.0, (found.sum() + targets.sum()).item<double>())}};
}

// Mean distances both ways; their mean is the loss.
Figures distance_figures(const Tensor& points, const Tensor& joints) {
  const Tensor distance = (points.unsqueeze(1) - joints.unsqueeze(0)).square().sum(2).sqrt();
  const double to_joints = std::get<0>(distance.min(1)).mean().item<double>(),
               to_points = std::get<0>(distance.min(0)).mean().item<double>();
  return {{"loss", 0.5 * (to_joints + to_points)}, {"to_joints", to_joints}, {"to_points", to_points}};
}

Figures votes_figures(Model& model, const dataset::Batch& batch, const TaskOptions& options) {
  const Candidates all = candidates(Task::votes, model, batch, options.run);
  Figures figures = distance_figures(all.points, all.joints);
  figures["loss"] = density_loss_of(all, batch, options).item<double>();
  figures["f1"] = attention_figures(all.attention, tensor_of(batch.targets.attention, 1, options.run.device)).at("f1");
  return figures;
}

Figures collapse_figures(Model& model, const dataset::Batch& batch, const TaskOptions& options) {
  const Candidates all = candidates(Task::collapse, model, batch, options.run);
  const Tensor attention = all.attention.sigmoid();
  const Tensor points = mean_shift(all.points, attention, model["bandwidth"].at("h"), options.mean_shift_steps).back();
  const Tensor sure = (attention.squeeze(1) > 0.1 * attention.max()).nonzero().squeeze(1);
  return distance_figures(points.index_select(0, sure), all.joints);
}

// The batch holds all pairs in one order and then in the other: the mean of both probabilities decides.
Figures bone_figures(const Tensor& logits, const Tensor& targets) {
  const std::int64_t pairs = targets.size(0) / 2;
  const Tensor probability = logits.sigmoid().squeeze(1);
  const Tensor found = ((probability.narrow(0, 0, pairs) + probability.narrow(0, pairs, pairs)) > 1.0).to(at::kFloat);
  const Tensor wanted = targets.narrow(0, 0, pairs), right = found * wanted;
  return {{"loss", bone_loss(logits, targets).item<double>()},
          {"accuracy", (found == wanted).to(at::kFloat).mean().item<double>()},
          {"precision", share(right, found)},
          {"recall", share(right, wanted)}};
}

Figures root_figures(const Tensor& logits, const dataset::Batch& batch) {
  const double right = logits.squeeze(1).argmax().item<std::int64_t>() == batch.targets.root[0] ? 1.0 : 0.0;
  return {{"loss", root_loss(logits, batch.inputs.joints.batch.offsets, batch.targets.root).item<double>()}, {"accuracy", right}};
}

// The parents of all joints of one skeleton. A joint's candidates are the rows of its pairs.
Figures tree_figures(const Tensor& logits, const dataset::Batch& batch) {
  const std::int64_t joints = batch.inputs.joints.batch.rows();
  const Tensor of_joint = logits.view({joints, joints}).log_softmax(1);
  const Tensor wanted = at::tensor(batch.targets.parents, at::kLong).to(logits.device());
  return {{"loss", tree_loss(logits, batch.inputs.joints.batch.offsets, batch.targets.parents).item<double>()},
          {"parents", (of_joint.argmax(1) == wanted).to(at::kFloat).mean().item<double>()},
          {"root", of_joint.diagonal().argmax().item<std::int64_t>() == batch.targets.root[0] ? 1.0 : 0.0}};
}

Figures skin_figures(const Tensor& logits, const Tensor& weights, const Tensor& covered) {
  return {{"loss", skin_loss(logits, weights, covered).item<double>()}, {"l1", skin_difference(logits, weights, covered).item<double>()}};
}

Figures figures_of(Task task, Model& model, const dataset::Batch& batch, const TaskOptions& options) {
  const at::Device device = options.run.device;
  if (task == Task::collapse) return collapse_figures(model, batch, options);
  if (task == Task::votes) return votes_figures(model, batch, options);
  if (task == Task::joints) {
    const Candidates all = candidates(task, model, batch, options.run);
    return distance_figures(all.points, all.joints);
  }
  const Tensor out = run(network_of(task), model, batch, options.run);
  if (task == Task::attention) return attention_figures(out, tensor_of(batch.targets.attention, 1, device));
  if (task == Task::bones) return bone_figures(out, tensor_of(batch.targets.connected, 1, device));
  if (task == Task::root) return root_figures(out, batch);
  if (task == Task::tree) return tree_figures(out, batch);
  return skin_figures(skin_logits(task, out, batch), skin_targets(task, batch, device), tensor_of(batch.targets.skin_share, 1, device));
}

bool has_targets(Task task, const dataset::Example& example) { return !is_about_pairs(task) || example.character.joints() > 1; }

}  // namespace

bool is_about_pairs(Task task) { return task == Task::bones || task == Task::root || task == Task::tree; }

dataset::Parts parts_of(Task task) {
  if (task == Task::tree) return dataset::Parts::tree;
  if (is_about_pairs(task)) return dataset::Parts::pairs;
  if (task == Task::bind) return dataset::Parts::bind;
  if (task == Task::neuroskinning) return dataset::Parts::neuro;
  if (task == Task::neuroskinning_2019) return dataset::Parts::neuro_2019;
  return task == Task::skin ? dataset::Parts::skin : dataset::Parts::joints;
}

Model fresh_model(Task task, std::uint64_t seed) {
  Model model;
  const auto add = [&](Network network) {
    model[name_of(network)] = initial_parameters(nets::rignet::parameter_shapes(network), seed);
    quieten_global_features(network, model[name_of(network)]);
  };
  add(network_of(task));
  if (task == Task::collapse) {
    add(Network::attention);
    model["bandwidth"]["h"] = at::full({1}, 0.04, at::kFloat);
  }
  if (network_of(task) == Network::joints || network_of(task) == Network::votes || network_of(task) == Network::neuroskinning)
    for (const char* name : {"out.weight", "out.bias"}) model[name_of(network_of(task))].at(name).zero_();
  return model;
}

at::Tensor training_loss(Task task, Model& model, const dataset::Batch& batch, const TaskOptions& options) {
  const at::Device device = options.run.device;
  if (task == Task::collapse) return collapse_loss(model, batch, options);
  if (task == Task::votes) return votes_loss(model, batch, options);
  if (task == Task::joints) return displacement_loss(candidates(task, model, batch, options.run), batch);
  const Tensor out = run(network_of(task), model, batch, options.run);
  if (task == Task::attention) return attention_loss(out, tensor_of(batch.targets.attention, 1, device));
  if (task == Task::bones) return bone_loss(out, tensor_of(batch.targets.connected, 1, device));
  if (task == Task::root) return root_loss(out, batch.inputs.joints.batch.offsets, batch.targets.root);
  if (task == Task::tree) return tree_loss(out, batch.inputs.joints.batch.offsets, batch.targets.parents);
  const Tensor logits = skin_logits(task, out, batch), weights = skin_targets(task, batch, device);
  const Tensor share = tensor_of(batch.targets.skin_share, 1, device);
  if (task != Task::neuroskinning) return skin_loss(logits, weights, share);
  return skin_loss(logits, weights, share) + options.difference_weight * skin_difference(logits, weights, share);
}

std::map<std::string, double> validate(Task task, Model& model, std::span<const dataset::Example> examples, const TaskOptions& options) {
  const at::NoGradGuard no_grad;
  TaskOptions use = options;
  use.run.mode = Mode::use;
  Figures sum;
  double count = 0.0;
  for (const dataset::Example& example : examples) {
    if (!has_targets(task, example)) continue;
    const dataset::Example* one = &example;
    for (const auto& [name, value] : figures_of(task, model, dataset::plain_batch({&one, 1}, options.batch), use)) sum[name] += value;
    count += 1.0;
  }
  for (auto& [name, value] : sum) value /= count;
  return sum;
}

}  // namespace osteon::train
