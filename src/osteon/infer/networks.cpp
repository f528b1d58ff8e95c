// SPDX-License-Identifier: Apache-2.0
#include "osteon/infer/networks.h"

#include <cassert>

#include "osteon/infer/loops_backend.h"
#include "osteon/infer/onednn_backend.h"
#include "osteon/nets/binding.h"
#include "osteon/nets/neuroskinning.h"
#include "osteon/nets/rignet.h"
#include "osteon/nets/tree.h"
#include "osteon/nets/voting.h"

namespace osteon::infer {
namespace {

namespace rignet = nets::rignet;
using nets::on_backend;
using rignet::Network;

template <class Backend>
typename Backend::Tensor output(Network network, Backend& b, const NetworkInput& input) {
  const auto mesh = on_backend(b, input.mesh);
  switch (network) {
    case Network::joints:
      return rignet::joint_net(b, mesh);
    case Network::attention:
      return rignet::mask_net(b, mesh);
    case Network::votes:
      return nets::vote_net(b, mesh, on_backend(b, *input.votes));
    case Network::bones:
      return rignet::bone_net(b, mesh, on_backend(b, *input.joints), on_backend(b, *input.pairs));
    case Network::root:
      return rignet::root_net(b, mesh, on_backend(b, *input.joints));
    case Network::tree:
      return nets::tree_net(b, on_backend(b, *input.joints), on_backend(b, *input.tree));
    case Network::skin:
      return rignet::skin_net(b, mesh, b.tensor(input.skin_features, input.mesh.batch.rows(), rignet::skin_inputs));
    case Network::bind:
      return nets::bind_net(b, mesh, on_backend(b, *input.choices));
    case Network::neuroskinning:
      return nets::neuroskinning::joint_choice_net(b, mesh, on_backend(b, *input.neuro));
    case Network::neuroskinning_2019:
      return nets::neuroskinning::slot_net(b, mesh, on_backend(b, *input.neuro));
  }
  assert(false && "no such network");
  return {};
}

}  // namespace

template <class Backend>
Matrix run(Network network, Backend& backend, const NetworkInput& input) {
  return backend.matrix(output(network, backend, input));
}

template Matrix run(Network, Loops&, const NetworkInput&);
template Matrix run(Network, Onednn&, const NetworkInput&);

}  // namespace osteon::infer
