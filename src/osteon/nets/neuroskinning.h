// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/nets/graph.h"
#include "osteon/nets/layers.h"

// Liu, Zheng, Tang, Yuan, Fan, Zhou. NeuroSkinning: Automatic Skin Binding for Production Characters with Deep Graph Networks. ACM TOG
// 38(4), 2019. Written from the paper; what it leaves open is chosen thus: a vertex hears itself too (after sampling many have no
// neighbour); activations are ReLU with a batch normalisation behind them, as in our other networks; linear layers have a bias; no dropout.
namespace osteon::nets::neuroskinning {

// Graph attention unit (sec. 4.2) over one-ring and pooled neighbours: multi-head attention by plain dot products of the projected
// features, softmax over the neighbourhood alone (the paper's equation 2 multiplies by the adjacency instead, which would let
// non-neighbours in with exp 0); heads side by side; beside them their mean over the nearest vertices; beside these the input. As columns
// that are not put together: a layer that reads them need not copy them.
template <Ops B>
Input<B> graph_unit(B& b, const Path& path, const Input<B>& x, const MeshGraph<B>& mesh, const Edges<B>& nearest, int hidden, int heads) {
  const auto projected = linear(b, path / "project", x, heads * hidden);
  const auto heard = b.attend(projected, mesh.ring.offsets, mesh.ring.sources, heads);
  const auto own = relu_norm(b, path / "norm", heard);
  const auto pooled = b.mean_of(own, nearest.offsets, nearest.sources);
  Input<B> out{own, pooled};
  out.insert(out.end(), x.begin(), x.end());
  return out;
}

// The three units (figure 4) over what each vertex is, and beside them the global branch, which leaves after the first and ends in the
// largest of each channel over the mesh. `hidden`: of the first unit; the others have 64.
template <Ops B>
Input<B> units(B& b, const typename B::Tensor& x0, const MeshGraph<B>& mesh, const Neuro<B>& neuro, int hidden,
               std::initializer_list<int> of_global) {
  const Input<B> x1 = graph_unit<B>(b, Path("unit1"), {x0}, mesh, neuro.nearest[0], hidden, 4);
  const auto pooled = mlp<B>(b, Path("global"), x1, of_global);
  const auto global = b.max_by(pooled, mesh.batch.offsets);
  const Input<B> x2 = graph_unit<B>(b, Path("unit2"), x1, mesh, neuro.nearest[1], 64, 2);
  Input<B> x3 = graph_unit<B>(b, Path("unit3"), x2, mesh, neuro.nearest[2], 64, 2);
  x3.emplace_back(global, mesh.batch.mesh_of);
  return x3;
}

// The paper's network with its sizes: a logit for each slot of the super skeleton, (V,neuro_slots), for a softmax over the slots that the
// skeleton has. The global branch leaves after the first unit (figure 4).
template <Ops B>
typename B::Tensor slot_net(B& b, const MeshGraph<B>& mesh, const Neuro<B>& neuro) {
  const auto x0 = mlp<B>(b, Path("input"), {neuro.features}, {128, 64});
  const Input<B> seen = units<B>(b, x0, mesh, neuro, 64, {512, 1024});
  const auto head = mlp<B>(b, Path("head"), seen, {1024, 512});
  return b.linear(Path("out"), head, neuro_slots);
}

// Ours, with the paper's units. A slot's output layer learns from the few characters that have the slot, and absolute coordinates tell the
// artist, not the limb (RigNet's authors measured L1 0.57 on skeletons of all kinds). Here one small network judges every joint near a
// vertex: by how it lies to the vertex, by way of the body (geometry/bind_features.h), by what geodesic voxel binding says, and by what the
// joint is: its kind of slot and its place in the skeleton. Units start from what a vertex sees of its joints. The output is to be added to
// the logarithm of the geometric share, so that a network that knows nothing gives geodesic voxel binding. (C,1)
template <Ops B>
typename B::Tensor joint_choice_net(B& b, const MeshGraph<B>& mesh, const Neuro<B>& neuro) {
  const BindChoices<B>& choices = neuro.choices;
  const auto joint = mlp<B>(b, Path("joint"), {neuro.joints}, {64, 32});
  const auto pair = mlp<B>(b, Path("pair"), {choices.features, {joint, choices.bone_of}}, {128, 64});
  const auto vertex = b.max_by(pair, choices.offsets);  // what a vertex sees of its joints
  const auto sorted = b.rows(pair, choices.by_bone);
  const auto seen = b.max_by(sorted, choices.bone_offsets);  // what a joint sees of its vertices
  const auto whole = mlp<B>(b, Path("whole"), {joint, seen}, {64});
  const Input<B> around = units<B>(b, vertex, mesh, neuro, 32, {64, 128});
  const auto of_vertex = mlp<B>(b, Path("vertex"), around, {128});
  const auto head = mlp<B>(b, Path("head"), {pair, choices.features, {whole, choices.bone_of}, {of_vertex, choices.vertex_of}}, {128, 128});
  return b.linear(Path("out"), head, 1);
}

}  // namespace osteon::nets::neuroskinning
