// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "osteon/rig/rig.h"
#include "osteon/skin/islands.h"
#include "osteon/skin/transfer.h"
#include "osteon/skin/weight_rows.h"

// Skin weights for any mesh and any skeleton, by geometry alone.
namespace osteon::skin {

enum class Method {
  rigid,       // the nearest bone by way of the body
  geovoxel,    // geodesic voxel binding: Dionne, de Lasa 2013
  heat,        // bone heat: Baran, Popovic 2007
  biharmonic,  // after bounded biharmonic weights: Jacobson and others 2011
  transfer,    // from another rigged mesh: Abdrashitov and others 2023
};

enum class Islands {
  rigid,   // small parts follow one joint each
  deform,  // they bend like everything else
};

struct BindOptions {
  Method method = Method::geovoxel;
  int resolution = 256;  // of the lattice, along the longest side
  FalloffOptions falloff;
  std::optional<int> smooth = {};         // rounds; else 1 for geovoxel and biharmonic, none for the others
  std::optional<float> prune_share = {};  // weights below this share of a vertex's largest go; else 0.05
  std::size_t max_influences = 4;         // per vertex
  Islands islands = Islands::rigid;
  IslandOptions island = {.largest = 0.7f, .second = 0.7f};  // geometry alone is less sure of small parts than networks are
  std::optional<Rig> from = {};                              // for Method::transfer: the other mesh, in the same space
  TransferOptions transfer;
  // Joints that keep the weights which they have in `before`; what is left is shared by the others.
  std::vector<JointId> locked = {};
  std::optional<SkinWeights> before = {};  // one row per vertex; there if `locked` is not empty
};

struct Binding {
  SkinWeights weights;               // one row per vertex of the mesh that was given, in its order
  std::size_t rigid_islands = 0;     // how many
  std::vector<std::string> notes;    // what the user should know
  std::vector<std::string> repairs;  // what was wrong with the mesh and was mended in the working copy
};

// Weights for every vertex of `mesh`, whatever it is like: open, non-manifold, in pieces, with faces that look inwards. The same for any
// number of threads and any order of vertices and faces. Throws Error for a mesh without any face that has an area, and for
// Method::transfer where the other skeleton has joints of which neither they nor any above them are in this one. Pre: validate(mesh) and
// validate(skeleton) hold, in one space.
Binding bind(const TriangleMesh& mesh, const Skeleton& skeleton, const BindOptions& options = {});

// The joints of `to` that stand for those of `from`: by name, or that of the nearest joint above. Throws Error naming a joint without any.
PerJoint<JointId> joints_by_name(const Skeleton& from, const Skeleton& to);

// `weights` but for the locked joints, which have the weights of `before`.
SkinWeights with_locked(const SkinWeights& weights, const SkinWeights& before, std::span<const JointId> locked, std::size_t most);

}  // namespace osteon::skin
