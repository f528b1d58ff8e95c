// SPDX-License-Identifier: Apache-2.0
#include "osteon/train/networks.h"

#include "osteon/nets/binding.h"
#include "osteon/nets/neuroskinning.h"
#include "osteon/nets/rignet.h"
#include "osteon/nets/tree.h"
#include "osteon/nets/voting.h"
#include "osteon/train/device_ops.h"
#include "osteon/train/fused_ops.h"
#include "osteon/train/torch_ops.h"

namespace osteon::train {
namespace {

using nets::rignet::Network;

static_assert(nets::Ops<TorchOps> && nets::Ops<FusedOps> && nets::Ops<DeviceOps>);

template <nets::Ops B>
at::Tensor run(B& b, Network network, const NetworkInputs& inputs) {
  const nets::MeshGraph<B> mesh = nets::on_backend(b, inputs.mesh);
  switch (network) {
    case Network::joints:
      return nets::rignet::joint_net(b, mesh);
    case Network::attention:
      return nets::rignet::mask_net(b, mesh);
    case Network::votes:
      return nets::vote_net(b, mesh, nets::on_backend(b, inputs.votes));
    case Network::bones:
      return nets::rignet::bone_net(b, mesh, nets::on_backend(b, inputs.joints), nets::on_backend(b, inputs.pairs));
    case Network::root:
      return nets::rignet::root_net(b, mesh, nets::on_backend(b, inputs.joints));
    case Network::tree:
      return nets::tree_net(b, nets::on_backend(b, inputs.joints), nets::on_backend(b, inputs.tree));
    case Network::skin:
      return nets::rignet::skin_net(b, mesh, b.tensor(inputs.skin_features, inputs.mesh.batch.rows(), nets::rignet::skin_inputs));
    case Network::bind:
      return nets::bind_net(b, mesh, nets::on_backend(b, inputs.choices));
    case Network::neuroskinning:
      return nets::neuroskinning::joint_choice_net(b, mesh, nets::on_backend(b, inputs.neuro));
    case Network::neuroskinning_2019:
      return nets::neuroskinning::slot_net(b, mesh, nets::on_backend(b, inputs.neuro));
  }
  throw Error("unknown network");
}

}  // namespace

at::Tensor run_network(Network network, Parameters& parameters, const NetworkInputs& inputs, const RunOptions& options) {
  if (options.engine == Engine::fused) {
    FusedOps ops(parameters, options.mode, options.norm);
    return run(ops, network, inputs);
  }
  if (options.engine == Engine::device) {
    DeviceOps ops(parameters, options.mode, options.device, options.norm);
    return run(ops, network, inputs);
  }
  TorchOps ops(parameters, options.mode, options.device, options.norm);
  return run(ops, network, inputs);
}

}  // namespace osteon::train
