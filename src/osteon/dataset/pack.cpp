// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/pack.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "osteon/base/error.h"
#include "osteon/base/parallel.h"
#include "osteon/base/safetensors.h"

namespace osteon::dataset {
namespace {

using json = nlohmann::json;
using Arrays = std::map<std::string, Array>;

constexpr std::uint16_t kNoParent = 65535;
constexpr float kWeightUnit = 65535.0f;  // weights are stored as u16 of 1/65535

std::int64_t length(std::size_t n) { return static_cast<std::int64_t>(n); }

Array of_points(std::span<const Vec3f> points) {
  std::vector<float> flat;
  for (const Vec3f& p : points) flat.insert(flat.end(), {p.x(), p.y(), p.z()});
  return Array::of<float>(flat, {length(points.size()), 3});
}

Array of_faces(const TriangleMesh& mesh) {
  std::vector<std::uint16_t> flat;
  for (const Triangle& face : mesh.faces)
    for (VertexId v : face) flat.push_back(static_cast<std::uint16_t>(v));
  return Array::of<std::uint16_t>(flat, {length(mesh.faces.size()), 3});
}

Array of_parents(const Skeleton& skeleton) {
  std::vector<std::uint16_t> flat;
  for (const auto& parent : skeleton.parents) flat.push_back(parent ? static_cast<std::uint16_t>(*parent) : kNoParent);
  return Array::of<std::uint16_t>(flat, {length(flat.size())});
}

// "influences" (V): how many each vertex has; "influence_joints" and "influence_weights": all of them, row after row.
void add_weights(Arrays& arrays, const std::string& prefix, const SkinWeights& weights) {
  std::vector<std::uint16_t> counts, joints, values;
  for (VertexId v : ids<VertexId>(weights.size())) {
    counts.push_back(static_cast<std::uint16_t>(weights[v].size()));
    for (const Influence& i : weights[v]) {
      joints.push_back(static_cast<std::uint16_t>(i.joint));
      values.push_back(static_cast<std::uint16_t>(std::lround(i.weight * kWeightUnit)));
    }
  }
  arrays[prefix + "influences"] = Array::of<std::uint16_t>(counts, {length(counts.size())});
  arrays[prefix + "influence_joints"] = Array::of<std::uint16_t>(joints, {length(joints.size())});
  arrays[prefix + "influence_weights"] = Array::of<std::uint16_t>(values, {length(values.size())});
}

void add_nearest(Arrays& arrays, const std::string& prefix, const PreparedCharacter& c) {
  std::vector<std::uint16_t> bones;
  for (Eigen::Index i = 0; i < c.nearest_bones.size(); ++i) bones.push_back(static_cast<std::uint16_t>(c.nearest_bones.data()[i]));
  const std::vector<std::int64_t> shape{c.nearest_bones.rows(), c.nearest_bones.cols()};
  arrays[prefix + "nearest_bones"] = Array::of<std::uint16_t>(bones, shape);
  arrays[prefix + "nearest_distances"] =
      Array::half(std::span(c.nearest_distances.data(), static_cast<std::size_t>(c.nearest_distances.size())), shape);
}

void add_character(Arrays& arrays, const PreparedCharacter& c) {
  if (c.vertices() > 65535) throw Error("{}: has {} working vertices; at most 65535 can be packed", c.info.id, c.vertices());
  const std::string prefix = c.info.id + "/";
  arrays[prefix + "positions"] = of_points(c.mesh.positions.raw());
  arrays[prefix + "faces"] = of_faces(c.mesh);
  arrays[prefix + "joints"] = of_points(c.skeleton.rest_positions.raw());
  arrays[prefix + "parents"] = of_parents(c.skeleton);
  arrays[prefix + "tolerances"] = Array::of<float>(c.tolerances.raw(), {length(c.joints())});
  arrays[prefix + "attention"] = Array::of<std::uint8_t>(c.attention, {length(c.attention.size())});
  add_weights(arrays, prefix, c.weights);
  add_nearest(arrays, prefix, c);
}

json description(const PreparedCharacter& c) {
  const Vec3f& pivot = c.normalization.pivot;
  return {{"id", c.info.id},
          {"group", c.info.group},
          {"category", c.info.category},
          {"notes", c.notes},
          {"joint_names", c.skeleton.names.raw()},
          {"scale", c.normalization.scale},
          {"pivot", {pivot.x(), pivot.y(), pivot.z()}}};
}

// The arrays of one character, with checks that name it.
class Reader {
 public:
  Reader(const Safetensors& file, std::string id) : file_(file), id_(std::move(id)) {}

  template <class T>
  std::vector<T> values(const char* name) const {
    return file_.at(id_ + "/" + name).values<T>();
  }
  std::int64_t columns(const char* name) const {
    const Array& array = file_.at(id_ + "/" + name);
    if (array.shape.size() != 2) throw Error("{}/{} has {} dimensions; expected 2", id_, name, array.shape.size());
    return array.shape[1];
  }
  std::vector<Vec3f> points(const char* name) const {
    if (columns(name) != 3) throw Error("{}/{} has {} columns; expected 3", id_, name, columns(name));
    const auto flat = values<float>(name);
    std::vector<Vec3f> out;
    for (std::size_t i = 0; i + 2 < flat.size(); i += 3) out.emplace_back(flat[i], flat[i + 1], flat[i + 2]);
    return out;
  }
  void expect(bool holds, const char* what) const {
    if (!holds) throw Error("{}: {}", id_, what);
  }

 private:
  const Safetensors& file_;
  std::string id_;
};

TriangleMesh read_mesh(const Reader& reader) {
  TriangleMesh mesh{PerVertex<Vec3f>(reader.points("positions")), {}};
  reader.expect(reader.columns("faces") == 3, "faces do not have three columns");
  const auto flat = reader.values<std::uint16_t>("faces");
  for (std::size_t i = 0; i + 2 < flat.size(); i += 3)
    mesh.faces.push_back({VertexId{flat[i]}, VertexId{flat[i + 1]}, VertexId{flat[i + 2]}});
  validate(mesh);
  return mesh;
}

Skeleton read_skeleton(const Reader& reader, const json& names) {
  Skeleton skeleton;
  const auto positions = reader.points("joints");
  const auto parents = reader.values<std::uint16_t>("parents");
  reader.expect(positions.size() == parents.size() && positions.size() == names.size(), "joints, parents and names differ in number");
  for (std::size_t j = 0; j < positions.size(); ++j)
    skeleton.add(names[j].get<std::string>(), parents[j] == kNoParent ? std::nullopt : std::optional(JointId{parents[j]}), positions[j]);
  validate(skeleton);
  return skeleton;
}

SkinWeights read_weights(const Reader& reader) {
  const auto counts = reader.values<std::uint16_t>("influences");
  const auto joints = reader.values<std::uint16_t>("influence_joints"), values = reader.values<std::uint16_t>("influence_weights");
  SkinWeights weights;
  std::vector<Influence> row;
  std::size_t next = 0;
  for (std::uint16_t count : counts) {
    reader.expect(next + count <= joints.size() && joints.size() == values.size(), "influences are cut off");
    row.clear();
    for (; row.size() < count; ++next) row.push_back({JointId{joints[next]}, static_cast<float>(values[next]) / kWeightUnit});
    weights.append(row);
  }
  return weights;
}

void read_nearest(const Reader& reader, PreparedCharacter& c) {
  const auto bones = reader.values<std::uint16_t>("nearest_bones");
  const auto distances = reader.values<float>("nearest_distances");
  const auto rows = static_cast<Eigen::Index>(c.vertices()), columns = static_cast<Eigen::Index>(reader.columns("nearest_bones"));
  const auto count = static_cast<std::size_t>(rows * columns);
  reader.expect(bones.size() == count && distances.size() == count, "nearest bones do not fit the mesh");
  c.nearest_bones.resize(rows, columns);
  std::copy(bones.begin(), bones.end(), c.nearest_bones.data());
  c.nearest_distances = Eigen::Map<const Matrix>(distances.data(), rows, columns);
}

PreparedCharacter read_character(const Safetensors& file, const json& about) {
  PreparedCharacter c;
  c.info = {about.at("id"), about.at("group"), about.at("category")};
  c.notes = about.at("notes").get<std::vector<std::string>>();
  const auto pivot = about.at("pivot").get<std::vector<float>>();
  const Reader reader(file, c.info.id);
  reader.expect(pivot.size() == 3, "pivot does not have three numbers");
  c.normalization = {about.at("scale").get<float>(), {pivot[0], pivot[1], pivot[2]}};
  c.mesh = read_mesh(reader);
  c.skeleton = read_skeleton(reader, about.at("joint_names"));
  c.weights = read_weights(reader);
  validate(c.weights, c.vertices(), c.joints());
  c.attention = reader.values<std::uint8_t>("attention");
  c.tolerances = PerJoint<float>(reader.values<float>("tolerances"));
  reader.expect(c.attention.size() == c.vertices() && c.tolerances.size() == c.joints(), "attention or tolerances do not fit");
  read_nearest(reader, c);
  derive_inputs(c);
  return c;
}

}  // namespace

void save_characters(const std::filesystem::path& path, std::span<const PreparedCharacter> characters,
                     const std::map<std::string, std::string>& metadata) {
  Safetensors file{{}, metadata};
  json about = json::array();
  for (const PreparedCharacter& c : characters) {
    add_character(file.arrays, c);
    about.push_back(description(c));
  }
  file.metadata["characters"] = about.dump();
  save_safetensors(path, file);
}

std::vector<PreparedCharacter> load_characters(const std::filesystem::path& path) {
  const Safetensors file = load_safetensors(path);
  const auto listed = file.metadata.find("characters");
  if (listed == file.metadata.end()) throw Error("{}: holds no prepared characters", path.string());
  try {
    const json about = json::parse(listed->second);
    std::vector<PreparedCharacter> out(about.size());
    parallel_for(out.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) out[i] = read_character(file, about[i]);
    });
    return out;
  } catch (const json::exception& e) {
    throw Error("{}: list of characters: {}", path.string(), e.what());
  } catch (const Error& e) {
    throw Error("{}: {}", path.string(), e.what());
  }
}

}  // namespace osteon::dataset
