// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cassert>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "osteon/nets/binding.h"
#include "osteon/nets/graph.h"
#include "osteon/nets/neuroskinning.h"
#include "osteon/nets/rignet.h"
#include "osteon/nets/tree.h"
#include "osteon/nets/voting.h"

namespace osteon::nets {

// A backend that computes nothing: it notes which parameters a network has, and their shapes. Loading weights is a dry run and then a
// comparison with the file.
class DryRun {
 public:
  struct Tensor {
    int width = 0;
  };
  struct Index {};

  std::map<std::string, std::vector<std::int64_t>> parameters;  // name -> shape

  Tensor tensor(std::span<const float>, int, int columns) { return {columns}; }
  Index index(std::span<const std::int32_t>) { return {}; }
  Tensor linear(const Path& path, const Tensor& x, int width) {
    note(path / "weight", {width, x.width});
    note(path / "bias", {width});
    return {width};
  }
  Tensor batch_norm(const Path& path, const Tensor& x) {
    for (const char* name : {"weight", "bias", "running_mean", "running_var"}) note(path / name, {x.width});
    return x;
  }
  Tensor relu(const Tensor& x) { return x; }
  Tensor subtract(const Tensor& x, [[maybe_unused]] const Tensor& y) {
    assert(x.width == y.width);
    return x;
  }
  Tensor concat(std::initializer_list<Tensor> all) {
    Tensor sum;
    for (const Tensor& x : all) sum.width += x.width;
    return sum;
  }
  Tensor rows(const Tensor& x, const Index&) { return x; }
  Tensor max_by(const Tensor& x, const Index&) { return x; }
  Tensor mean_of(const Tensor& x, const Index&, const Index&) { return x; }
  Tensor attend(const Tensor& x, const Index&, const Index&, [[maybe_unused]] int heads) {
    assert(x.width % heads == 0);
    return x;
  }

 private:
  void note(const Path& path, std::vector<std::int64_t> shape) {
    [[maybe_unused]] const bool is_new = parameters.emplace(path.name(), std::move(shape)).second;
    assert(is_new && "two layers have one name");
  }
};

namespace rignet {

enum class Network { joints, attention, votes, bones, root, tree, skin, bind, neuroskinning, neuroskinning_2019 };
constexpr std::array kNetworks{Network::joints, Network::attention, Network::votes, Network::bones,         Network::root,
                               Network::tree,   Network::skin,      Network::bind,  Network::neuroskinning, Network::neuroskinning_2019};

// What the networks are called in files and commands.
constexpr const char* name_of(Network network) {
  constexpr std::array<const char*, kNetworks.size()> names{"joints", "attention", "votes", "bones",         "root",
                                                            "tree",   "skin",      "bind",  "neuroskinning", "neuroskinning_2019"};
  return names[static_cast<std::size_t>(network)];
}

inline std::map<std::string, std::vector<std::int64_t>> parameter_shapes(Network network) {
  DryRun b;
  const MeshGraph<DryRun> mesh{{3}, {}, {}, {}};
  const JointSet<DryRun> joints{{3}, {1}, {}, {}};
  switch (network) {
    case Network::joints:
      joint_net(b, mesh);
      break;
    case Network::attention:
      mask_net(b, mesh);
      break;
    case Network::votes:
      vote_net(b, mesh, {{vote_features}, {}, {}, {}, {}, {}});
      break;
    case Network::bones:
      bone_net(b, mesh, joints, {{}, {}, {8}, {}});
      break;
    case Network::root:
      root_net(b, mesh, joints);
      break;
    case Network::tree:
      tree_net(b, joints, {{tree_joint_features}, {tree_pair_features}, {}});
      break;
    case Network::skin:
      skin_net(b, mesh, {skin_inputs});
      break;
    case Network::bind:
      bind_net(b, mesh, {{bind_features}, {}, {}, {}, {}, {}});
      break;
    case Network::neuroskinning:
    case Network::neuroskinning_2019: {
      const Neuro<DryRun> neuro{
          {neuro_vertex_features + neuro_slots}, {{neuro_choice_features}, {}, {}, {}, {}, {}}, {neuro_joint_features + neuro_kinds}, {}};
      if (network == Network::neuroskinning)
        neuroskinning::joint_choice_net(b, mesh, neuro);
      else
        neuroskinning::slot_net(b, mesh, neuro);
      break;
    }
  }
  return std::move(b.parameters);
}

}  // namespace rignet
}  // namespace osteon::nets
