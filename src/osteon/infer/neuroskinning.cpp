// SPDX-License-Identifier: Apache-2.0
#include "osteon/infer/neuroskinning.h"

#include "osteon/base/error.h"
#include "osteon/infer/model_folder.h"
#include "osteon/infer/networks.h"
#include "osteon/infer/onednn_backend.h"
#include "osteon/infer/rignet.h"

namespace osteon::infer {

using nets::rignet::Network;
namespace fs = std::filesystem;

struct NeuroskinningModel::Loaded {
  Network network;
  std::string super_skeleton;
  std::unique_ptr<Onednn> backend;
};

namespace {

// Runs the network on a single vertex with a single joint, so that its weights are packed before the first mesh comes.
void pack_weights(const NeuroskinningModel& model) {
  const Vec3f origin = Vec3f::Zero();
  const std::uint32_t no_neighbours[] = {0, 0};
  nets::NeuroArrays neuro;
  neuro.features.resize(nets::neuro_vertex_features + nets::neuro_slots);
  neuro.choices = {std::vector<float>(nets::neuro_choice_features), {0, 1}, {0}, {0}, {0, 1}, {0}};
  neuro.joints.resize(nets::neuro_joint_features + nets::neuro_kinds);
  neuro.add_nearest(no_neighbours, {}, 0);
  model(single_mesh({&origin, 1}, {no_neighbours, {}}, {no_neighbours, {}}), neuro);
}

}  // namespace

NeuroskinningModel NeuroskinningModel::load() { return load(find_models("rignet")); }

NeuroskinningModel NeuroskinningModel::load(const fs::path& folder, tensor::Precision precision) {
  if (precision == tensor::Precision::bf16 && !tensor::has_bf16())
    throw Error("this processor does not multiply bf16 (AVX512-BF16 or AMX), expected --precision f32");
  const auto file_of = [&](Network network) { return folder / (std::string(nets::rignet::name_of(network)) + ".safetensors"); };
  Network network = Network::neuroskinning;
  if (!fs::exists(file_of(network)) && fs::exists(file_of(Network::neuroskinning_2019))) network = Network::neuroskinning_2019;
  if (!fs::is_regular_file(file_of(network))) throw Error("NeuroSkinning needs a file of weights; missing: {}", file_of(network).string());
  const Safetensors content = load_safetensors(file_of(network));
  const auto super = content.metadata.find("super_skeleton");
  if (super == content.metadata.end()) throw Error("{}: has no super skeleton in its metadata", file_of(network).string());
  Parameters parameters(content, nets::rignet::parameter_shapes(network), file_of(network).string());
  NeuroskinningModel model(
      std::make_unique<Loaded>(Loaded{network, super->second, std::make_unique<Onednn>(std::move(parameters), precision)}));
  pack_weights(model);
  return model;
}

NeuroskinningModel::NeuroskinningModel(std::unique_ptr<Loaded> loaded) : loaded_(std::move(loaded)) {}
NeuroskinningModel::~NeuroskinningModel() = default;
NeuroskinningModel::NeuroskinningModel(NeuroskinningModel&&) noexcept = default;
NeuroskinningModel& NeuroskinningModel::operator=(NeuroskinningModel&&) noexcept = default;

const std::string& NeuroskinningModel::super_skeleton() const { return loaded_->super_skeleton; }

bool NeuroskinningModel::has_slots() const { return loaded_->network == Network::neuroskinning_2019; }

Matrix NeuroskinningModel::operator()(const nets::MeshArrays& mesh, const nets::NeuroArrays& neuro) const {
  return run(loaded_->network, *loaded_->backend, {.mesh = mesh, .neuro = &neuro});
}

}  // namespace osteon::infer
