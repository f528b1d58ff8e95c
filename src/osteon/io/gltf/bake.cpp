// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/gltf/bake.h"

#include "osteon/base/error.h"
#include "osteon/io/assemble.h"

namespace osteon::io::gltf {
namespace {

Eigen::Vector3d direction(const Eigen::Vector3d& v) {
  const double length = v.norm();
  return length > 0.0 && std::isfinite(length) ? Eigen::Vector3d(v / length) : Eigen::Vector3d::UnitY();
}

Eigen::Vector3d at(const std::vector<float>& values, std::size_t offset) {
  return Eigen::Map<const Eigen::Vector3f>(values.data() + offset).cast<double>();
}

void put(std::vector<float>& values, std::size_t offset, const Eigen::Vector3d& v) {
  Eigen::Map<Eigen::Vector3f>(values.data() + offset) = v.cast<float>();
}

}  // namespace

Baker::Baker(const Document& document, Writer& writer, const PlacedInstance& placed, const Scene::Mesh& mesh)
    : document_(document), writer_(writer), placed_(placed), mesh_(mesh) {}

Eigen::Affine3d Baker::transform(std::size_t vertex) const {
  return placed_.to_world ? *placed_.to_world : blended_transform(mesh_, vertex, placed_.joint_to_world);
}

std::vector<float> Baker::read(const Json& accessor, std::size_t components, std::size_t count) const {
  const std::size_t index =
      Element(accessor, document_.path.filename().string() + ": attribute").index(document_.count("accessors"), "accessors");
  const Accessor source(document_, index);
  if (source.components() != components || source.count() != count)
    throw Error("{}: {} elements of {} values, expected {} of {}", source.where(), source.count(), source.components(), count, components);
  return source.floats();
}

void Baker::replace(Json& attributes, const char* name, const std::string& rule, const Rewrite& rewrite) {
  const auto key = std::make_pair(attributes.at(name).get<std::size_t>(), rule);
  auto found = done_.find(key);
  if (found == done_.end()) found = done_.emplace(key, rewrite()).first;
  attributes[name] = found->second;
}

std::size_t Baker::bake_normals(const Json& accessor, const MeshLayout::Block& block) {
  std::vector<float> values = read(accessor, 3, block.count);
  for (std::size_t v = 0; v < block.count; ++v)
    put(values, 3 * v, direction(normal_matrix(transform(block.first + v)) * at(values, 3 * v)));
  return writer_.vectors(values, 3, Target::vertices);
}

std::size_t Baker::bake_tangents(const Json& accessor, const MeshLayout::Block& block) {
  std::vector<float> values = read(accessor, 4, block.count);
  for (std::size_t v = 0; v < block.count; ++v) {
    const Eigen::Affine3d m = transform(block.first + v);
    put(values, 4 * v, direction(m.linear() * at(values, 4 * v)));
    const float side = values[4 * v + 3] < 0.0f ? -1.0f : 1.0f;
    values[4 * v + 3] = m.linear().determinant() < 0.0 ? -side : side;
  }
  return writer_.vectors(values, 4, Target::vertices);
}

// Differences of positions or tangents: the linear part alone.
std::size_t Baker::bake_directions(const Json& accessor, const MeshLayout::Block& block, bool bounds) {
  std::vector<float> values = read(accessor, 3, block.count);
  for (std::size_t v = 0; v < block.count; ++v) put(values, 3 * v, transform(block.first + v).linear() * at(values, 3 * v));
  if (!bounds) return writer_.vectors(values, 3, Target::vertices);
  return writer_.positions({reinterpret_cast<const Vec3f*>(values.data()), block.count});
}

std::size_t Baker::bake_normal_changes(const Json& change, const Json& normals, const MeshLayout::Block& block) {
  std::vector<float> values = read(change, 3, block.count);
  const std::vector<float> base = read(normals, 3, block.count);
  for (std::size_t v = 0; v < block.count; ++v) {
    const Eigen::Matrix3d m = normal_matrix(transform(block.first + v));
    put(values, 3 * v, direction(m * (at(base, 3 * v) + at(values, 3 * v))) - direction(m * at(base, 3 * v)));
  }
  return writer_.vectors(values, 3, Target::vertices);
}

void Baker::repair(Json& primitive, const MeshLayout::Block& block) {
  replace(primitive.at("attributes"), "POSITION", "POSITION",
          [&] { return writer_.positions(std::span(mesh_.positions).subspan(block.first, block.count)); });
}

void Baker::bake(Json& primitive, const MeshLayout::Block& block, std::span<const Vec3f> positions) {
  Json& attributes = primitive.at("attributes");
  const Json old = attributes;
  replace(attributes, "POSITION", "POSITION", [&] { return writer_.positions(positions); });
  if (old.contains("NORMAL")) replace(attributes, "NORMAL", "NORMAL", [&] { return bake_normals(old.at("NORMAL"), block); });
  if (old.contains("TANGENT")) replace(attributes, "TANGENT", "TANGENT", [&] { return bake_tangents(old.at("TANGENT"), block); });
  if (!primitive.contains("targets")) return;
  for (Json& target : primitive.at("targets")) {
    const Json change = target;
    if (change.contains("POSITION"))
      replace(target, "POSITION", "change of POSITION", [&] { return bake_directions(change.at("POSITION"), block, true); });
    if (change.contains("TANGENT"))
      replace(target, "TANGENT", "change of TANGENT", [&] { return bake_directions(change.at("TANGENT"), block, false); });
    if (change.contains("NORMAL") && old.contains("NORMAL"))
      replace(target, "NORMAL", "change of NORMAL", [&] { return bake_normal_changes(change.at("NORMAL"), old.at("NORMAL"), block); });
  }
}

}  // namespace osteon::io::gltf
