// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/assemble.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "osteon/base/error.h"
#include "osteon/io/joint_tree.h"
#include "osteon/io/upright.h"

namespace osteon::io {
namespace {

constexpr std::size_t kMostVertices = std::size_t{1} << 25;  // of all instances; a small file can name one mesh many times

double size_of(const Scene::Mesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Vec3f& p : mesh.positions) box.extend(p);
  return mesh.positions.empty() ? 0.0 : static_cast<double>(std::max(box.diagonal().norm(), box.max().cwiseAbs().maxCoeff()));
}

// The one transform that all joints of a skin in its bind pose apply; empty if they differ by more than 1e-5 of the mesh's size.
std::optional<Eigen::Affine3d> common_transform(const std::vector<Eigen::Affine3d>& joints, const Scene::Mesh& mesh) {
  if (joints.empty()) return std::nullopt;
  const double size = std::max(size_of(mesh), 1e-30);
  const double length = std::max(joints[0].linear().norm(), 1e-30);
  for (const Eigen::Affine3d& m : joints) {
    if (((m.linear() - joints[0].linear()).cwiseAbs().maxCoeff()) > 1e-5 * length) return std::nullopt;
    if ((m.translation() - joints[0].translation()).cwiseAbs().maxCoeff() > 1e-5 * length * size) return std::nullopt;
  }
  Eigen::Affine3d common = joints[0];
  // Rounding of the file's matrices must not move vertices that stand where they should.
  if ((common.linear() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-5 &&
      common.translation().cwiseAbs().maxCoeff() < 1e-5 * size)
    common.setIdentity();
  return common;
}

class Assembler {
 public:
  Assembler(const Scene& scene, Asset& asset) : scene_(scene), asset_(asset) {}

  std::vector<PlacedInstance> run() {
    if (const auto joints = joint_tree(scene_, asset_.rig_repairs)) tree_ = *joints;
    skinned_ = std::any_of(scene_.instances.begin(), scene_.instances.end(), [](const Scene::Instance& i) { return i.skin.has_value(); });
    std::vector<PlacedInstance> placed;
    for (const Scene::Instance& instance : scene_.instances) placed.push_back(place(instance));
    if (asset_.mesh.positions.empty()) throw Error("no vertices");
    if (asset_.mesh.faces.empty())
      throw Error("{} vertices, but no faces{}{}", asset_.mesh.positions.size(), asset_.repairs.empty() ? "" : ": ",
                  fmt::join(asset_.repairs, "; "));
    report();
    if (!tree_.skeleton.names.empty()) {
      if (skinned_) asset_.weights = std::move(weights_);
      asset_.skeleton = std::move(tree_.skeleton);
    }
    return placed;
  }

 private:
  PlacedInstance place(const Scene::Instance& instance) {
    const Scene::Mesh& mesh = scene_.meshes[instance.mesh];
    PlacedInstance placed{instance, asset_.mesh.positions.size(), asset_.mesh.faces.size(), std::nullopt, {}};
    if (placed.first_vertex + mesh.positions.size() > kMostVertices || asset_.mesh.faces.size() + mesh.faces.size() > 2 * kMostVertices)
      throw Error("more than {} vertices or {} faces in all", kMostVertices, 2 * kMostVertices);
    const bool follows_skin = instance.skin && !mesh.influence_offsets.empty();
    if (instance.skin && !follows_skin)
      asset_.repairs.push_back(fmt::format("mesh {} has a skin but no weights; placed by its node", name_of(instance)));
    if (follows_skin)
      place_skinned(instance, mesh, placed);
    else
      place_rigid(instance, mesh, placed);
    const bool mirrored = placed.to_world && placed.to_world->linear().determinant() < 0.0;
    append_faces(mesh, placed.first_vertex, mirrored);
    return placed;
  }

  // As artists know it, or by number.
  std::string name_of(const Scene::Instance& instance) const {
    const std::string& name = scene_.nodes[instance.node].name;
    return name.empty() ? std::to_string(instance.mesh) : fmt::format("'{}'", name);
  }

  void place_rigid(const Scene::Instance& instance, const Scene::Mesh& mesh, PlacedInstance& placed) {
    placed.to_world = scene_.nodes[instance.node].world;
    append_positions(mesh, *placed.to_world);
    if (!skinned_) return;
    const auto follows = nearest_joint(instance.node);
    if (!follows && !mesh.positions.empty())
      asset_.rig_repairs.push_back(fmt::format("mesh {} is not skinned and under no joint; bound to the root", name_of(instance)));
    const Influence whole{follows.value_or(JointId{0}), 1.0f};
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) weights_.append({&whole, 1});
  }

  void place_skinned(const Scene::Instance& instance, const Scene::Mesh& mesh, PlacedInstance& placed) {
    const Scene::Skin& skin = scene_.skins[*instance.skin];
    if (skin.joints.empty()) throw Error("skin {} has no joints", *instance.skin);
    std::vector<Eigen::Affine3d> to_world;
    for (std::size_t j = 0; j < skin.joints.size(); ++j) to_world.push_back(scene_.nodes[skin.joints[j]].world * skin.inverse_binds[j]);
    append_weights(mesh, skin);
    placed.to_world = common_transform(to_world, mesh);
    if (placed.to_world) {
      append_positions(mesh, *placed.to_world);
      return;
    }
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
      append_position(blended_transform(mesh, v, to_world) * mesh.positions[v].cast<double>());
    placed.joint_to_world = std::move(to_world);
  }

  void append_positions(const Scene::Mesh& mesh, const Eigen::Affine3d& to_world) {
    if (to_world.matrix().isIdentity(0.0)) {
      auto& all = asset_.mesh.positions.raw();
      all.insert(all.end(), mesh.positions.begin(), mesh.positions.end());
      return;
    }
    asset_.mesh.positions.reserve(asset_.mesh.positions.size() + mesh.positions.size());
    for (const Vec3f& p : mesh.positions) append_position(to_world * p.cast<double>());
  }

  void append_position(const Eigen::Vector3d& p) {
    const bool sane = p.cwiseAbs().maxCoeff() <= static_cast<double>(kLargestCoordinate);
    if (!sane) ++misplaced_;
    asset_.mesh.positions.push_back(sane ? Vec3f(p.cast<float>()) : Vec3f(Vec3f::Zero()));
  }

  void append_faces(const Scene::Mesh& mesh, std::size_t first_vertex, bool mirrored) {
    asset_.mesh.faces.reserve(asset_.mesh.faces.size() + mesh.faces.size());
    for (const Triangle& face : mesh.faces) {
      const auto vertex = [&](std::size_t k) { return static_cast<VertexId>(index(face[k]) + first_vertex); };
      asset_.mesh.faces.push_back({vertex(0), vertex(mirrored ? 2 : 1), vertex(mirrored ? 1 : 2)});
    }
  }

  void append_weights(const Scene::Mesh& mesh, const Scene::Skin& skin) {
    std::vector<Influence> row;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      row.clear();
      for (std::uint32_t i = mesh.influence_offsets[v]; i < mesh.influence_offsets[v + 1]; ++i) {
        const auto [joint, weight] = mesh.influences[i];
        if (joint < skin.joints.size())
          row.push_back({*tree_.joint_of_node[skin.joints[joint]], weight});
        else
          ++unknown_joints_;
      }
      if (row.empty()) {
        row.push_back({JointId{0}, 1.0f});
        ++weightless_;
      }
      weights_.append(row);
    }
  }

  std::optional<JointId> nearest_joint(std::size_t node) const {
    for (std::optional<std::size_t> n = node; n; n = scene_.nodes[*n].parent)
      if (tree_.joint_of_node[*n]) return tree_.joint_of_node[*n];
    return std::nullopt;
  }

  void report() {
    const auto tell = [](std::vector<std::string>& repairs, std::size_t count, std::string_view what) {
      if (count > 0) repairs.push_back(fmt::format("{} {}", count, what));
    };
    tell(asset_.repairs, misplaced_, "vertices are not finite in world space; moved to the origin");
    tell(asset_.rig_repairs, unknown_joints_, "weights name joints that their skin does not have; dropped");
    tell(asset_.rig_repairs, weightless_, "vertices of skinned meshes have no weight; bound to the root");
  }

  const Scene& scene_;
  Asset& asset_;
  JointTree tree_;
  SkinWeights weights_;
  bool skinned_ = false;
  std::size_t misplaced_ = 0, unknown_joints_ = 0, weightless_ = 0;
};

}  // namespace

Eigen::Affine3d import_transform(const Scene& scene, const LoadOptions& options) {
  Eigen::Affine3d transform(Eigen::Scaling(options.scale ? static_cast<double>(*options.scale) : scene.metres_per_unit));
  transform.rotate(turn_to_y_up(options.up.value_or(scene.up)).cast<double>());
  return transform;
}

void to_our_world(Scene& scene, const LoadOptions& options) {
  const Eigen::Affine3d import = import_transform(scene, options);
  for (Scene::Node& node : scene.nodes) node.world = import * node.world;
}

Eigen::Matrix3d normal_matrix(const Eigen::Affine3d& transform) {
  const Eigen::Matrix3d m = transform.linear();
  Eigen::Matrix3d cofactors;
  for (int c = 0; c < 3; ++c) cofactors.col(c) = m.col((c + 1) % 3).cross(m.col((c + 2) % 3));
  return m.determinant() < 0.0 ? Eigen::Matrix3d(-cofactors) : cofactors;
}

Eigen::Affine3d blended_transform(const Scene::Mesh& mesh, std::size_t vertex, std::span<const Eigen::Affine3d> joint_to_world) {
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
  double total = 0.0;
  for (std::uint32_t i = mesh.influence_offsets[vertex]; i < mesh.influence_offsets[vertex + 1]; ++i) {
    const auto [joint, weight] = mesh.influences[i];
    if (joint >= joint_to_world.size()) continue;
    sum += static_cast<double>(weight) * joint_to_world[joint].matrix();
    total += static_cast<double>(weight);
  }
  return total > 0.0 ? Eigen::Affine3d(sum / total) : joint_to_world[0];
}

std::vector<PlacedInstance> assemble(Scene& scene, const LoadOptions& options, Asset& asset) {
  to_our_world(scene, options);
  asset.up = options.up.value_or(scene.up);
  return Assembler(scene, asset).run();
}

}  // namespace osteon::io
