// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/pack.h"

#include <algorithm>
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
constexpr float kSteps = 65535.0f;       // so many on a mesh's longest side
constexpr std::int64_t kPoseNumbers = 12;
constexpr float kHalfTurn = 32767.0f;  // orientations' numbers, -1 .. 1, are stored as u16 of so many a unit

std::int64_t length(std::size_t n) { return static_cast<std::int64_t>(n); }

Array of_points(std::span<const Vec3f> points) {
  std::vector<float> flat;
  for (const Vec3f& p : points) flat.insert(flat.end(), {p.x(), p.y(), p.z()});
  return Array::of<float>(flat, {length(points.size()), 3});
}

// Numbers that are small for most characters: u8 where all of them fit, else u16.
Array of_numbers(const std::vector<std::uint16_t>& numbers) {
  const std::vector<std::int64_t> shape{length(numbers.size())};
  if (std::ranges::any_of(numbers, [](std::uint16_t n) { return n > 255; })) return Array::of<std::uint16_t>(numbers, shape);
  return Array::of<std::uint8_t>(std::vector<std::uint8_t>(numbers.begin(), numbers.end()), shape);
}

// Positions lie on a lattice: origin + step (i, j, k), with i, j and k stored as u16.
struct Lattice {
  Vec3f origin;
  float step;
};

Lattice lattice_of(const TriangleMesh& mesh) {
  const Eigen::AlignedBox3f box = bounds(mesh);
  return {box.min(), box.sizes().maxCoeff() / kSteps};
}

Array of_lattice_points(std::span<const Vec3f> points, const Lattice& lattice) {
  std::vector<std::uint16_t> flat;
  for (const Vec3f& p : points)
    for (const float steps : Vec3f((p - lattice.origin) / lattice.step))
      flat.push_back(static_cast<std::uint16_t>(std::clamp(std::round(steps), 0.0f, kSteps)));
  return Array::of<std::uint16_t>(flat, {length(points.size()), 3});
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

// x, y, z, w of each joint's axes, in 1/32767.
Array of_orientations(const Skeleton& skeleton) {
  std::vector<std::uint16_t> flat;
  for (const Quatf& q : skeleton.rest_orientations)
    for (const float x : q.coeffs()) flat.push_back(static_cast<std::uint16_t>(std::lround((x + 1.0f) * kHalfTurn)));
  return Array::of<std::uint16_t>(flat, {length(skeleton.size()), 4});
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
  arrays[prefix + "influences"] = of_numbers(counts);
  arrays[prefix + "influence_joints"] = of_numbers(joints);
  arrays[prefix + "influence_weights"] = Array::of<std::uint16_t>(values, {length(values.size())});
}

// (P,J,12) of P poses, half precision: of each joint its linear map, row after row, and where it goes.
Array of_poses(std::span<const Articulation> poses, std::size_t joints) {
  std::vector<float> flat;
  for (const Articulation& pose : poses)
    for (JointId j : pose.joints.ids()) {
      for (const auto& row : pose.linear[j].rowwise()) flat.insert(flat.end(), row.begin(), row.end());
      flat.insert(flat.end(), pose.joints[j].begin(), pose.joints[j].end());
    }
  return Array::half(flat, {length(poses.size()), length(joints), kPoseNumbers});
}

void add_character(Arrays& arrays, const PreparedCharacter& c) {
  if (c.vertices() > 65535) throw Error("{}: has {} working vertices; at most 65535 can be packed", c.info.id, c.vertices());
  const std::string prefix = c.info.id + "/";
  arrays[prefix + "positions"] = of_lattice_points(c.mesh.positions.raw(), lattice_of(c.mesh));
  arrays[prefix + "faces"] = of_faces(c.mesh);
  arrays[prefix + "joints"] = of_points(c.skeleton.rest_positions.raw());
  arrays[prefix + "parents"] = of_parents(c.skeleton);
  arrays[prefix + "orientations"] = of_orientations(c.skeleton);
  arrays[prefix + "tolerances"] = Array::of<float>(c.tolerances.raw(), {length(c.joints())});
  arrays[prefix + "attention"] = Array::of<std::uint8_t>(c.attention, {length(c.attention.size())});
  add_weights(arrays, prefix, c.weights);
  if (!c.poses.empty()) arrays[prefix + "poses"] = of_poses(c.poses, c.joints());
}

json description(const PreparedCharacter& c) {
  const Vec3f& pivot = c.normalization.pivot;
  const Lattice lattice = lattice_of(c.mesh);
  return {{"id", c.info.id},
          {"group", c.info.group},
          {"category", c.info.category},
          {"notes", c.notes},
          {"joint_names", c.skeleton.names.raw()},
          {"scale", c.normalization.scale},
          {"pivot", {pivot.x(), pivot.y(), pivot.z()}},
          {"origin", {lattice.origin.x(), lattice.origin.y(), lattice.origin.z()}},
          {"step", lattice.step}};
}

// The arrays of one character, with checks that name it.
class Reader {
 public:
  Reader(const Safetensors& file, std::string id) : file_(file), id_(std::move(id)) {}

  template <class T>
  std::vector<T> values(const char* name) const {
    return file_.at(id_ + "/" + name).values<T>();
  }
  bool has(const char* name) const { return file_.arrays.contains(id_ + "/" + name); }
  bool is(const char* name, DType type) const { return file_.at(id_ + "/" + name).dtype == type; }
  // u8 or u16
  std::vector<std::uint16_t> numbers(const char* name) const {
    if (!is(name, DType::u8)) return values<std::uint16_t>(name);
    const auto small = values<std::uint8_t>(name);
    return {small.begin(), small.end()};
  }
  std::int64_t columns(const char* name) const {
    const Array& array = file_.at(id_ + "/" + name);
    if (array.shape.size() != 2) throw Error("{}/{} has {} dimensions; expected 2", id_, name, array.shape.size());
    return array.shape[1];
  }
  std::vector<Vec3f> points(const char* name) const { return triples<float>(name); }
  std::vector<Vec3f> lattice_points(const char* name, const Lattice& lattice) const {
    std::vector<Vec3f> out = triples<std::uint16_t>(name);
    for (Vec3f& p : out) p = lattice.origin + lattice.step * p;
    return out;
  }
  void expect(bool holds, const char* what) const {
    if (!holds) throw Error("{}: {}", id_, what);
  }

 private:
  template <class T>
  std::vector<Vec3f> triples(const char* name) const {
    if (columns(name) != 3) throw Error("{}/{} has {} columns; expected 3", id_, name, columns(name));
    const auto flat = values<T>(name);
    std::vector<Vec3f> out;
    for (std::size_t i = 0; i + 2 < flat.size(); i += 3)
      out.emplace_back(static_cast<float>(flat[i]), static_cast<float>(flat[i + 1]), static_cast<float>(flat[i + 2]));
    return out;
  }

  const Safetensors& file_;
  std::string id_;
};

Vec3f read_vector(const json& numbers, const Reader& reader, const char* what) {
  const auto v = numbers.get<std::vector<float>>();
  reader.expect(v.size() == 3, what);
  return {v[0], v[1], v[2]};
}

std::vector<Vec3f> read_positions(const Reader& reader, const json& about) {
  if (reader.is("positions", DType::f32)) return reader.points("positions");  // of before
  return reader.lattice_points("positions",
                               {read_vector(about.at("origin"), reader, "origin does not have three numbers"), about.at("step")});
}

TriangleMesh read_mesh(const Reader& reader, const json& about) {
  TriangleMesh mesh{PerVertex<Vec3f>(read_positions(reader, about)), {}};
  reader.expect(reader.columns("faces") == 3, "faces do not have three columns");
  const auto flat = reader.values<std::uint16_t>("faces");
  for (std::size_t i = 0; i + 2 < flat.size(); i += 3)
    mesh.faces.push_back({VertexId{flat[i]}, VertexId{flat[i + 1]}, VertexId{flat[i + 2]}});
  validate(mesh);
  return mesh;
}

// Files of before hold none.
void read_orientations(const Reader& reader, Skeleton& skeleton) {
  if (!reader.has("orientations")) return;
  const auto numbers = reader.values<std::uint16_t>("orientations");
  reader.expect(numbers.size() == 4 * skeleton.size(), "orientations do not fit the joints");
  for (JointId j : skeleton.names.ids()) {
    Quatf& q = skeleton.rest_orientations[j];
    for (std::size_t k = 0; k < 4; ++k)
      q.coeffs()[static_cast<Eigen::Index>(k)] = static_cast<float>(numbers[4 * index(j) + k]) / kHalfTurn - 1.0f;
    q.normalize();
  }
}

Skeleton read_skeleton(const Reader& reader, const json& names) {
  Skeleton skeleton;
  const auto positions = reader.points("joints");
  const auto parents = reader.values<std::uint16_t>("parents");
  reader.expect(positions.size() == parents.size() && positions.size() == names.size(), "joints, parents and names differ in number");
  for (std::size_t j = 0; j < positions.size(); ++j)
    skeleton.add(names[j].get<std::string>(), parents[j] == kNoParent ? std::nullopt : std::optional(JointId{parents[j]}), positions[j]);
  read_orientations(reader, skeleton);
  validate(skeleton);
  return skeleton;
}

SkinWeights read_weights(const Reader& reader) {
  const auto counts = reader.numbers("influences"), joints = reader.numbers("influence_joints");
  const auto values = reader.values<std::uint16_t>("influence_weights");
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

// Files of before hold them.
void read_nearest(const Reader& reader, PreparedCharacter& c) {
  if (!reader.has("nearest_bones")) return;
  const auto bones = reader.values<std::uint16_t>("nearest_bones");
  const auto distances = reader.values<float>("nearest_distances");
  const auto rows = static_cast<Eigen::Index>(c.vertices()), columns = static_cast<Eigen::Index>(reader.columns("nearest_bones"));
  const auto count = static_cast<std::size_t>(rows * columns);
  reader.expect(bones.size() == count && distances.size() == count, "nearest bones do not fit the mesh");
  c.nearest_bones.resize(rows, columns);
  std::copy(bones.begin(), bones.end(), c.nearest_bones.data());
  c.nearest_distances = Eigen::Map<const Matrix>(distances.data(), rows, columns);
}

// Characters without motion, and files of before, hold none.
std::vector<Articulation> read_poses(const Reader& reader, std::size_t joints) {
  if (!reader.has("poses")) return {};
  const auto flat = reader.values<float>("poses");
  constexpr auto width = static_cast<std::size_t>(kPoseNumbers);
  reader.expect(flat.size() % (joints * width) == 0, "poses do not fit the joints");
  std::vector<Articulation> poses(flat.size() / (joints * width));
  const float* next = flat.data();
  for (Articulation& pose : poses)
    for (std::size_t j = 0; j < joints; ++j, next += width) {
      pose.linear.push_back(Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(next));
      pose.joints.push_back(Eigen::Map<const Vec3f>(next + 9));
    }
  return poses;
}

PreparedCharacter read_character(const Safetensors& file, const json& about) {
  PreparedCharacter c;
  c.info = {about.at("id"), about.at("group"), about.at("category")};
  c.notes = about.at("notes").get<std::vector<std::string>>();
  const Reader reader(file, c.info.id);
  c.normalization = {about.at("scale").get<float>(), read_vector(about.at("pivot"), reader, "pivot does not have three numbers")};
  c.mesh = read_mesh(reader, about);
  c.skeleton = read_skeleton(reader, about.at("joint_names"));
  c.weights = read_weights(reader);
  validate(c.weights, c.vertices(), c.joints());
  c.attention = reader.values<std::uint8_t>("attention");
  c.tolerances = PerJoint<float>(reader.values<float>("tolerances"));
  reader.expect(c.attention.size() == c.vertices() && c.tolerances.size() == c.joints(), "attention or tolerances do not fit");
  c.poses = read_poses(reader, c.joints());
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
