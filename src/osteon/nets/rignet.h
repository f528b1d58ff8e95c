// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/nets/graph.h"
#include "osteon/nets/layers.h"

// The networks of Xu, Zhou, Kalogerakis, Landreth, Singh. RigNet: Neural Rigging for Articulated Characters. SIGGRAPH 2020.
// Layer sizes are those of the released code. Differs from it throughout: no dropout (as in the same author's later MoRig), and all
// outputs are logits or plain numbers; the caller applies sigmoid or softmax.
namespace osteon::nets::rignet {

// Graph convolution unit: edge convolutions over the one-ring and the geodesic neighbours, merged by an MLP (section 3 of the paper).
template <Ops B>
typename B::Tensor gcu(B& b, const Path& path, const typename B::Tensor& x, const MeshGraph<B>& mesh, int width) {
  const auto ring = edge_conv(b, path / "ring", x, mesh.ring, width / 2);
  const auto geodesic = edge_conv(b, path / "geodesic", x, mesh.geodesic, width / 2);
  return mlp<B>(b, path / "merge", {ring, geodesic}, {width});
}

// The body that JointNet and MaskNet have in common (each has its own weights): (V,outputs).
template <Ops B>
typename B::Tensor per_vertex_net(B& b, const Path& path, const MeshGraph<B>& mesh, int outputs) {
  const auto x1 = gcu(b, path / "gcu1", mesh.positions, mesh, 64);
  const auto x2 = gcu(b, path / "gcu2", x1, mesh, 256);
  const auto x3 = gcu(b, path / "gcu3", x2, mesh, 512);
  const auto features = mlp<B>(b, path / "global", {x1, x2, x3}, {1024});
  const auto global = b.max_by(features, mesh.batch.offsets);
  const auto head = mlp<B>(b, path / "head", {{global, mesh.batch.mesh_of}, mesh.positions, x1, x2, x3}, {1024, 256});
  return b.linear(path / "out", head, outputs);
}

// Displacement of every vertex towards a joint near it, (V,3) in the unit of the positions.
// Differs: no tanh around it (the code has one, the paper none; displacements are far below 1).
template <Ops B>
typename B::Tensor joint_net(B& b, const MeshGraph<B>& mesh) {
  return per_vertex_net(b, Path(), mesh, 3);
}

// Attention of every vertex: how well it can tell where a joint is. (V,1) logits.
template <Ops B>
typename B::Tensor mask_net(B& b, const MeshGraph<B>& mesh) {
  return per_vertex_net(b, Path(), mesh, 1);
}

// One row for each mesh: three GCUs, an MLP, the largest over the vertices. (M, last of `widths`)
template <Ops B>
typename B::Tensor shape_encoder(B& b, const Path& path, const MeshGraph<B>& mesh, std::initializer_list<int> widths) {
  const auto x1 = gcu(b, path / "gcu1", mesh.positions, mesh, 64);
  const auto x2 = gcu(b, path / "gcu2", x1, mesh, 128);
  const auto x3 = gcu(b, path / "gcu3", x2, mesh, 256);
  const auto features = mlp<B>(b, path / "global", {x1, x2, x3}, widths);
  return b.max_by(features, mesh.batch.offsets);
}

template <class B>
struct JointFeatures {
  typename B::Tensor each;  // (J,128) a joint among the others of its skeleton
  typename B::Tensor all;   // (M,128) the skeleton
};

// What each joint is among the others, and what they are together. Differs: the paper has a PointNet, the code PointNet++ with random
// centres; two edge convolutions from all joints to all see the same relative positions and are deterministic.
template <Ops B>
JointFeatures<B> joint_encoder(B& b, const Path& path, const typename B::Tensor& x, const JointSet<B>& joints) {
  const auto x1 = edge_conv(b, path / "conv1", x, joints.pairs, 64);
  const auto x2 = edge_conv(b, path / "conv2", x1, joints.pairs, 128);
  const auto each = mlp<B>(b, path / "each", {x1, x2}, {128});
  const auto pooled = mlp<B>(b, path / "all", {each}, {128});
  return {each, b.max_by(pooled, joints.batch.offsets)};
}

// Whether a bone connects the pair's joints: (P,1) logits. Not symmetric in the two joints: train with random order, use the mean of
// both orders. Differs: the head also sees both joints' features, so it knows what stands between and beside them.
template <Ops B>
typename B::Tensor bone_net(B& b, const MeshGraph<B>& mesh, const JointSet<B>& joints, const JointPairs<B>& pairs) {
  const auto shape = shape_encoder(b, Path("shape"), mesh, {256, 64});
  const JointFeatures<B> joint = joint_encoder(b, Path("joints"), joints.positions, joints);
  const auto pair = mlp<B>(b, Path("pair"), {pairs.features}, {32, 64, 128, 256});
  const auto head =
      mlp<B>(b, Path("head"),
             {{shape, pairs.mesh_of}, {joint.all, pairs.mesh_of}, pair, {joint.each, pairs.first}, {joint.each, pairs.second}}, {128, 64});
  return b.linear(Path("out"), head, 1);
}

// Which joint of each mesh is the root: (J,1) logits, to be compared within a mesh (softmax, as in the paper; the code has a sigmoid).
// A joint's input is its position and its distance to the plane of symmetry (the code: |x|).
template <Ops B>
typename B::Tensor root_net(B& b, const MeshGraph<B>& mesh, const JointSet<B>& joints) {
  const auto shape = shape_encoder(b, Path("shape"), mesh, {128});
  const auto input = b.concat({joints.positions, joints.plane_distance});
  const JointFeatures<B> joint = joint_encoder(b, Path("joints"), input, joints);
  const auto head = mlp<B>(b, Path("head"), {{shape, joints.batch.mesh_of}, {joint.all, joints.batch.mesh_of}, joint.each}, {200, 64});
  return b.linear(Path("out"), head, 1);
}

constexpr int skin_bones = 5;                    // bones that a vertex can choose from
constexpr int skin_inputs = 3 + skin_bones * 8;  // see geometry/rignet_features.h

// How much each vertex follows each of its nearest bones: `features` (V,43) -> (V,5) logits for a softmax.
// The global branch is the released code's (MLP of every vertex, then max), not the paper's table (max, then MLP).
template <Ops B>
typename B::Tensor skin_net(B& b, const MeshGraph<B>& mesh, const typename B::Tensor& features) {
  const auto x0 = mlp<B>(b, Path("input"), {features}, {128, 64});
  const auto x1 = gcu(b, Path("gcu1"), x0, mesh, 512);
  const auto pooled = mlp<B>(b, Path("global"), {x1}, {512, 1024});
  const auto global = b.max_by(pooled, mesh.batch.offsets);
  const auto x2 = gcu(b, Path("gcu2"), x1, mesh, 256);
  const auto x3 = gcu(b, Path("gcu3"), x2, mesh, 256);
  const auto head = mlp<B>(b, Path("head"), {{global, mesh.batch.mesh_of}, x3}, {1024, 512});
  return b.linear(Path("out"), head, skin_bones);
}

}  // namespace osteon::nets::rignet
