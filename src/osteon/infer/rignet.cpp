// SPDX-License-Identifier: Apache-2.0
#include "osteon/infer/rignet.h"

#include <fmt/ranges.h>

#include <array>
#include <cassert>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "osteon/base/error.h"
#include "osteon/base/parallel.h"
#include "osteon/infer/model_folder.h"
#include "osteon/infer/networks.h"
#include "osteon/infer/onednn_backend.h"
#include "osteon/nets/rignet.h"

namespace osteon::infer {

struct RignetModels::Networks {
  std::array<std::unique_ptr<NetworkRunner>, nets::rignet::kNetworks.size()> by_network;  // those that are not in the folder are empty
  std::unique_ptr<NetworkRunner> second_votes;
  std::optional<NeuroskinningModel> neuroskinning;

  bool has(nets::rignet::Network network) const { return by_network[static_cast<std::size_t>(network)] != nullptr; }
  Matrix run(nets::rignet::Network network, const NetworkInput& input) const {
    return by_network[static_cast<std::size_t>(network)]->run(input);
  }
};

namespace {

namespace fs = std::filesystem;
using nets::rignet::name_of;
using nets::rignet::Network;

fs::path file_of(const fs::path& folder, Network network) { return folder / fmt::format("{}.safetensors", name_of(network)); }
fs::path file_of_second_votes(const fs::path& folder) { return folder / "second_votes.safetensors"; }

// The large ones first, so that loading them in parallel ends evenly.
std::vector<Network> networks_in(const fs::path& folder) {
  const auto only = [&](Network paper, Network ours) { return fs::exists(file_of(folder, paper)) && !fs::exists(file_of(folder, ours)); };
  std::vector<Network> networks{Network::votes};
  if (only(Network::joints, Network::votes)) networks = {Network::joints, Network::attention};
  networks.push_back(only(Network::skin, Network::bind) ? Network::skin : Network::bind);
  if (only(Network::bones, Network::tree))
    networks.insert(networks.end(), {Network::bones, Network::root});
  else
    networks.push_back(Network::tree);
  std::vector<std::string> missing;
  for (const Network network : networks)
    if (!fs::is_regular_file(file_of(folder, network))) missing.push_back(file_of(folder, network).string());
  if (!missing.empty()) throw Error("RigNet needs {} files of weights; missing:\n  {}", networks.size(), fmt::join(missing, "\n  "));
  return networks;
}

// By oneDNN, on the CPU.
class OnednnRunner : public NetworkRunner {
 public:
  OnednnRunner(Network network, const fs::path& weights, tensor::Precision precision)
      : network_(network), backend_(load_parameters(weights, nets::rignet::parameter_shapes(network)), precision) {}
  Matrix run(const NetworkInput& input) const override { return infer::run(network_, backend_, input); }

 private:
  Network network_;
  mutable Onednn backend_;  // packs weights when it first needs them, guarded by itself
};

// Runs the network on a single vertex, so that its weights are packed before the first mesh comes.
void pack_weights(const NetworkRunner& network) {
  const Vec3f origin = Vec3f::Zero();
  const float on_the_plane = 0;
  const std::uint32_t no_neighbours[] = {0, 0};
  const nets::MeshArrays mesh = single_mesh({&origin, 1}, {no_neighbours, {}}, {no_neighbours, {}});
  const nets::JointArrays joints = single_skeleton({&origin, 1}, {&on_the_plane, 1});
  const nets::PairArrays pairs{{0}, {0}, std::vector<float>(8), {0}};
  const std::vector<float> features(nets::rignet::skin_inputs);
  const nets::BindArrays choices{std::vector<float>(nets::bind_features), {0, 1}, {0}, {0}, {0, 1}, {0}};
  nets::VoteArrays of_votes;
  const std::uint32_t one[] = {0};
  of_votes.add(std::vector<float>(nets::vote_features), one, one, 0);
  nets::TreeArrays of_tree;
  of_tree.add(std::vector<float>(nets::tree_joint_features), std::vector<float>(nets::tree_pair_features));
  network.run({mesh, &joints, &pairs, features, &choices, &of_votes, &of_tree});
}

void add_edges(nets::EdgeArrays& edges, NeighbourView neighbours) { edges.add(neighbours.offsets, neighbours.members, 0); }

std::vector<float> coordinates(std::span<const Vec3f> points) {
  std::vector<float> out;
  out.reserve(3 * points.size());
  for (const Vec3f& p : points) out.insert(out.end(), p.begin(), p.end());
  return out;
}

// Every pair of the skeleton's joints as (i, j), i < j, and then as (j, i).
nets::PairArrays pairs_in_both_orders(std::int32_t joints, const Matrix& features) {
  nets::PairArrays out;
  for (std::int32_t i = 0; i < joints; ++i) {
    for (std::int32_t j = i + 1; j < joints; ++j) {
      out.first.push_back(i);
      out.second.push_back(j);
    }
  }
  const std::vector<std::int32_t> smaller = out.first;
  out.first.insert(out.first.end(), out.second.begin(), out.second.end());
  out.second.insert(out.second.end(), smaller.begin(), smaller.end());
  out.mesh_of.assign(out.first.size(), 0);

  Matrix both(2 * features.rows(), features.cols());
  Matrix reversed = features;
  reversed.leftCols(3) = features.middleCols(3, 3);
  reversed.middleCols(3, 3) = features.leftCols(3);
  both << features, reversed;
  out.features.assign(both.data(), both.data() + both.size());
  return out;
}

Matrix sigmoid(const Matrix& logits) { return (1.0f / (1.0f + (-logits.array()).exp())).matrix(); }

// softmax over the bones that there are
Matrix masked_softmax(const Matrix& logits, const RignetModels::NearestBones& nearest) {
  Matrix out = Matrix::Zero(logits.rows(), logits.cols());
  for (Eigen::Index v = 0; v < logits.rows(); ++v) {
    float largest = -std::numeric_limits<float>::infinity(), sum = 0;
    for (Eigen::Index k = 0; k < logits.cols(); ++k)
      if (nearest(v, k) >= 0) largest = std::max(largest, logits(v, k));
    for (Eigen::Index k = 0; k < logits.cols(); ++k)
      if (nearest(v, k) >= 0) sum += out(v, k) = std::exp(logits(v, k) - largest);
    assert(sum > 0 && "a vertex without a bone");
    out.row(v) /= sum;
  }
  return out;
}

}  // namespace

nets::MeshArrays single_mesh(std::span<const Vec3f> positions, NeighbourView ring, NeighbourView geodesic) {
  assert(ring.offsets.size() == positions.size() + 1 && geodesic.offsets.size() == positions.size() + 1);
  nets::MeshArrays out;
  out.positions = coordinates(positions);
  add_edges(out.ring, ring);
  add_edges(out.geodesic, geodesic);
  out.batch.add(positions.size());
  return out;
}

nets::JointArrays single_skeleton(std::span<const Vec3f> joints, std::span<const float> plane_distances) {
  assert(joints.size() == plane_distances.size());
  nets::JointArrays out;
  out.positions = coordinates(joints);
  out.plane_distance.assign(plane_distances.begin(), plane_distances.end());
  out.pairs.add_complete(static_cast<std::int32_t>(joints.size()), 0);
  out.batch.add(joints.size());
  return out;
}

RignetModels RignetModels::load() { return load(find_models("rignet")); }

RignetModels RignetModels::load(const fs::path& folder, tensor::Precision precision) {
  if (precision == tensor::Precision::bf16 && !tensor::has_bf16())
    throw Error("this processor does not multiply bf16 (AVX512-BF16 or AMX), expected --precision f32");
  const auto make_runner = [&](Network network, const fs::path& weights) {
    return std::make_unique<OnednnRunner>(network, weights, precision);
  };
  return RignetModels(load_networks(folder, make_runner, precision));
}

RignetModels RignetModels::load(const fs::path& folder, const RunnerFactory& make_runner) {
  return RignetModels(load_networks(folder, make_runner, tensor::Precision::f32));
}

std::unique_ptr<RignetModels::Networks> RignetModels::load_networks(const fs::path& folder, const RunnerFactory& make_runner,
                                                                    tensor::Precision precision) {
  const std::vector<Network> present = networks_in(folder);
  auto networks = std::make_unique<Networks>();
  const auto packed = [&](Network network, const fs::path& weights) {
    auto runner = make_runner(network, weights);
    pack_weights(*runner);
    return runner;
  };
  std::vector<std::function<void()>> loads;
  if (present.front() == Network::votes && fs::exists(file_of_second_votes(folder)))
    loads.emplace_back([&] { networks->second_votes = packed(Network::votes, file_of_second_votes(folder)); });
  for (const Network network : present)
    loads.emplace_back(
        [&, network] { networks->by_network[static_cast<std::size_t>(network)] = packed(network, file_of(folder, network)); });
  if (fs::exists(file_of(folder, Network::neuroskinning)))
    loads.emplace_back([&] { networks->neuroskinning = NeuroskinningModel::load(folder, precision); });
  parallel_for(loads.size(), 1, [&](std::size_t i, std::size_t) { loads[i](); });
  return networks;
}

const NeuroskinningModel* RignetModels::neuroskinning() const { return networks_->neuroskinning ? &*networks_->neuroskinning : nullptr; }

RignetModels::RignetModels(std::unique_ptr<Networks> networks) : networks_(std::move(networks)) {}
RignetModels::~RignetModels() = default;
RignetModels::RignetModels(RignetModels&&) noexcept = default;
RignetModels& RignetModels::operator=(RignetModels&&) noexcept = default;

int RignetModels::voters() const { return networks_->second_votes ? 2 : 1; }

JointVotes RignetModels::votes(const nets::MeshArrays& mesh, const nets::VoteArrays& vote_inputs, int voter) const {
  assert(voter >= 0 && voter < voters());
  const auto output = [&](Network network) { return networks_->run(network, {mesh}); };
  if (!networks_->has(Network::votes)) return {output(Network::joints), sigmoid(output(Network::attention))};
  const NetworkInput input{.mesh = mesh, .votes = &vote_inputs};
  const Matrix both = voter == 0 ? networks_->run(Network::votes, input) : networks_->second_votes->run(input);
  const Eigen::Map<const Matrix> features(vote_inputs.features.data(), both.rows(), nets::vote_features);
  return {features.middleCols(nets::vote_to_middle, 3) + nets::vote_unit * both.leftCols(3), sigmoid(both.rightCols(1))};
}

bool RignetModels::finds_parents() const { return networks_->has(Network::tree); }

Matrix RignetModels::parent_probabilities(const nets::JointArrays& joints, const nets::TreeArrays& tree) const {
  const Matrix logits = networks_->run(Network::tree, {.mesh = {}, .joints = &joints, .tree = &tree});
  Matrix out = Eigen::Map<const Matrix>(logits.data(), joints.batch.rows(), joints.batch.rows());
  for (auto row : out.rowwise()) {
    row = (row.array() - row.maxCoeff()).exp().matrix();
    row /= row.sum();
  }
  return out;
}

Matrix RignetModels::bone_probabilities(const nets::MeshArrays& mesh, const nets::JointArrays& joints, const Matrix& pair_features) const {
  const std::int32_t count = joints.batch.rows();
  const Eigen::Index pair_count = Eigen::Index{count} * (count - 1) / 2;
  assert(pair_features.rows() == pair_count);
  if (pair_count == 0) return Matrix(0, 1);
  const nets::PairArrays pairs = pairs_in_both_orders(count, pair_features);
  const Matrix both = sigmoid(networks_->run(Network::bones, {mesh, &joints, &pairs}));
  return 0.5f * (both.topRows(pair_count) + both.bottomRows(pair_count));
}

Matrix RignetModels::root_probabilities(const nets::MeshArrays& mesh, const nets::JointArrays& joints) const {
  const Matrix logits = networks_->run(Network::root, {mesh, &joints});
  const Matrix shares = (logits.array() - logits.maxCoeff()).exp().matrix();
  return shares / shares.sum();
}

bool RignetModels::binds() const { return networks_->has(Network::bind); }

Matrix RignetModels::bind_weights(const nets::MeshArrays& mesh, const nets::BindArrays& choices, int k) const {
  const Matrix logits = networks_->run(Network::bind, {.mesh = mesh, .choices = &choices});
  Matrix out = Matrix::Zero(mesh.batch.rows(), k);
  for (Eigen::Index v = 0; v < out.rows(); ++v) {
    const Eigen::Index first = choices.offsets[static_cast<std::size_t>(v)];
    const Eigen::Index count = choices.offsets[static_cast<std::size_t>(v) + 1] - first;
    assert(count > 0 && count <= k);
    const Eigen::ArrayXf own = logits.col(0).segment(first, count).array();
    const Eigen::ArrayXf shares = (own - own.maxCoeff()).exp();
    out.row(v).head(count) = (shares / shares.sum()).matrix().transpose();
  }
  return out;
}

Matrix RignetModels::skin_weights(const nets::MeshArrays& mesh, const Matrix& features, const NearestBones& nearest) const {
  assert(nearest.rows() == features.rows() && nearest.cols() == nets::rignet::skin_bones);
  const std::span<const float> numbers(features.data(), static_cast<std::size_t>(features.size()));
  return masked_softmax(networks_->run(Network::skin, {mesh, nullptr, nullptr, numbers}), nearest);
}

}  // namespace osteon::infer
