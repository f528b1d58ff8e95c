// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "osteon/base/types.h"
#include "osteon/infer/networks.h"
#include "osteon/infer/neuroskinning.h"
#include "osteon/nets/graph.h"
#include "osteon/tensor/precision.h"

namespace osteon::infer {

// For each vertex the vertices that it hears, itself not among them: of v, members[offsets[v] .. offsets[v+1]-1].
struct NeighbourView {
  std::span<const std::uint32_t> offsets, members;
};

// One mesh as the networks read it. Positions normalised: longest side 1, feet on y = 0, centred on x and z.
// ring: one-ring; geodesic: up to 10 or 15 vertices spread over the ball of geodesic radius 0.06.
nets::MeshArrays single_mesh(std::span<const Vec3f> positions, NeighbourView ring, NeighbourView geodesic);

// One skeleton's joints in the frame of the mesh, and each one's distance (>= 0) to the plane of symmetry (or to x = 0 where none is).
nets::JointArrays single_skeleton(std::span<const Vec3f> joints, std::span<const float> plane_distances);

// Where the joints are, as the vertices of a mesh see it.
struct JointVotes {
  Matrix displacement;  // (V,3) from each vertex towards a joint near it
  Matrix attention;     // (V,1) in 0..1: how well the vertex can tell where a joint is
};

// The trained networks of RigNet (nets/rignet.h), ready to run. Their outputs are the same for any number of threads; renumbering the
// vertices renumbers them and nothing else. May be used by several threads at the same time.
class RignetModels {
 public:
  // From {votes,tree,bind}.safetensors, float32 or float16. The paper's networks may be there instead: joints and attention for votes,
  // bones and root for tree, skin for bind. second_votes.safetensors, another voting network beside votes, and neuroskinning.safetensors
  // are read too where they are there. Throws one Error that names each missing file, or each parameter of a file that does not fit. Throws
  // Error where products in bf16 are asked for and this processor has none.
  static RignetModels load(const std::filesystem::path& folder, tensor::Precision precision = tensor::Precision::f32);
  // By other means than oneDNN on the CPU (torch_infer/torch_runner.h). `make_runner` may be called by several threads at once.
  static RignetModels load(const std::filesystem::path& folder, const RunnerFactory& make_runner);
  static RignetModels load();  // from where find_models("rignet") says

  ~RignetModels();
  RignetModels(RignetModels&&) noexcept;
  RignetModels& operator=(RignetModels&&) noexcept;

  int voters() const;  // how many voting networks there are, 1 or 2
  JointVotes votes(const nets::MeshArrays& mesh, const nets::VoteArrays& vote_inputs, int voter = 0) const;  // 0 <= voter < voters()

  // Whether every joint's parent comes from the tree network: then parent_probabilities() may be asked, else the two after it.
  bool finds_parents() const;

  // (J,J) row i: how likely each joint is the parent of joint i, i itself where i is the root; rows sum to 1.
  Matrix parent_probabilities(const nets::JointArrays& joints, const nets::TreeArrays& tree) const;

  // (P,1) how likely a bone joins the two joints of each pair (i, j), i < j, in the order (0,1), (0,2), ..., (1,2), ... : the mean over
  // both orders of the two. pair_features: (P,8) first joint, second joint, their distance, share of the way that is inside the shape.
  Matrix bone_probabilities(const nets::MeshArrays& mesh, const nets::JointArrays& joints, const Matrix& pair_features) const;

  Matrix root_probabilities(const nets::MeshArrays& mesh, const nets::JointArrays& joints) const;  // (J,1), sum 1

  // Whether weights come from the binding network: then bind_weights() may be asked, else skin_weights().
  bool binds() const;

  // (V,k) how much each vertex follows each of its bones, in the order of its rows in `choices`, 0 where there are fewer than k; rows sum
  // to
  // 1. Pre: every vertex has 1 to k bones.
  Matrix bind_weights(const nets::MeshArrays& mesh, const nets::BindArrays& choices, int k) const;

  // (V,5) how much each vertex follows each bone of its row in `nearest` (V,5; -1: no bone, gets 0); rows sum to 1.
  // features: (V,43) of geometry/rignet_features.h.
  using NearestBones = Eigen::Ref<const Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;
  Matrix skin_weights(const nets::MeshArrays& mesh, const Matrix& features, const NearestBones& nearest) const;

  const NeuroskinningModel* neuroskinning() const;  // null where the folder has none

 private:
  struct Networks;
  static std::unique_ptr<Networks> load_networks(const std::filesystem::path& folder, const RunnerFactory& make_runner,
                                                 tensor::Precision precision);
  explicit RignetModels(std::unique_ptr<Networks> networks);
  std::unique_ptr<Networks> networks_;
};

}  // namespace osteon::infer
