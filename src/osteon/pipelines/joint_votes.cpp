// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/joint_votes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "osteon/geometry/vote_features.h"
#include "osteon/geometry/working_mesh.h"

namespace osteon::pipelines {
namespace {

constexpr float kJointsAtThousand = 13.4f, kJointsExponent = 0.41f;  // of the regression of log joints on log triangles
constexpr float kTurn = 0.15f;     // radians about the vertical, within what the networks were trained with
constexpr float kStretch = 1.06f;  // of the height of the turned views, and its inverse

struct View {
  Eigen::Matrix3f of_character;
  bool from_behind;
};

std::array<View, 4> views() {
  const auto turned = [](float angle, float height) {
    return Eigen::Matrix3f(Eigen::AngleAxisf(angle, Vec3f::UnitY()).toRotationMatrix() * Vec3f(1.0f, height, 1.0f).asDiagonal());
  };
  const Eigen::Matrix3f mirror = Vec3f(-1.0f, 1.0f, 1.0f).asDiagonal(), about = Vec3f(-1.0f, 1.0f, -1.0f).asDiagonal();
  return {{{Eigen::Matrix3f::Identity(), false},
           {mirror, false},
           {about * turned(kTurn, kStretch), true},
           {about * mirror * turned(kTurn, 1.0f / kStretch), true}}};
}

geometry::VoteFeatures seen(geometry::VoteFeatures features, const Eigen::Matrix3f& view, float scale) {
  const Eigen::Matrix3f of_normals = view.inverse().transpose();
  for (Vec3f& n : features.normals) n = (of_normals * n).normalized();
  for (Vec3f& way : features.to_middle) way = scale * (view * way);
  for (float& thickness : features.thicknesses) thickness *= scale;
  return features;
}

}  // namespace

float expected_joints(std::size_t triangles, float detail) {
  constexpr float kLeast = 300.0f, kMost = 10000.0f;  // outside there were next to no characters to learn from
  const float size = std::clamp(static_cast<float>(triangles), kLeast, kMost);
  return kJointsAtThousand * std::pow(size / 1000.0f, kJointsExponent) * std::pow(16.0f, detail - 0.5f);
}

JointCandidates joint_votes(const TriangleMesh& mesh, const nets::MeshArrays& graph, const geometry::Regions& regions,
                            const infer::RignetModels& models, float joints) {
  const geometry::VoteFeatures features = geometry::vote_features(mesh);
  JointCandidates out;
  for (const auto& [view, from_behind] : views()) {
    TriangleMesh shown = mesh;
    for (Vec3f& p : shown.positions) p = view * p;
    const geometry::Normalization frame = geometry::normalization_of(shown);
    nets::MeshArrays arrays = graph;
    arrays.positions.clear();
    for (Vec3f& p : shown.positions) {
      p = frame.apply(p);
      arrays.positions.insert(arrays.positions.end(), p.begin(), p.end());
    }
    nets::VoteArrays inputs;
    inputs.add(geometry::vote_rows(shown.positions.raw(), seen(features, view, frame.scale), joints), regions.seeds, regions.region_of, 0);
    const infer::JointVotes votes = models.votes(arrays, inputs, from_behind ? models.voters() - 1 : 0);
    const Eigen::Matrix3f back = view.inverse();
    for (Eigen::Index v = 0; v < votes.attention.rows(); ++v) {
      const Vec3f q = shown.positions.raw()[static_cast<std::size_t>(v)] + votes.displacement.row(v).transpose();
      out.positions.push_back(back * frame.undo(q));
      out.attention.push_back(votes.attention(v, 0));
    }
  }
  return out;
}

}  // namespace osteon::pipelines
