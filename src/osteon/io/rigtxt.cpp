// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/rigtxt.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <set>

#include "osteon/base/error.h"
#include "osteon/io/obj/obj.h"
#include "osteon/io/text_scanner.h"

namespace osteon::io {
namespace {

struct RawRig {
  struct Joint {
    std::string name;
    Vec3f position;
    std::optional<std::size_t> parent;
  };
  std::vector<Joint> joints;  // in the file's order
  std::map<std::string, std::size_t> numbers;
  std::optional<std::size_t> root;
  std::map<std::size_t, std::vector<Scene::Influence>> rows;  // vertex -> influences of `joints`
};

class Parser {
 public:
  Parser(std::string_view text, std::vector<std::string>& repairs) : text_(text), repairs_(repairs) {}

  // Joints first, as the other lines name them and blocks come in any order.
  RawRig run() {
    each_line([&](TextScanner& scan, std::string_view keyword) {
      if (keyword == "joints" || keyword == "joint") joint(scan);
    });
    if (rig_.joints.empty()) throw Error("no joints");
    each_line([&](TextScanner& scan, std::string_view keyword) {
      if (keyword == "root")
        root(scan);
      else if (keyword == "hier")
        hierarchy(scan);
      else if (keyword == "skin")
        skin(scan);
    });
    return std::move(rig_);
  }

 private:
  template <class Body>
  void each_line(Body body) {
    for (TextScanner scan(text_); !scan.at_end(); scan.next_line()) body(scan, scan.word());
  }

  void joint(TextScanner& scan) {
    const std::string name(scan.word());
    const float x = scan.number(), y = scan.number(), z = scan.number();
    if (name.empty() || !(std::abs(x) + std::abs(y) + std::abs(z) <= kLargestCoordinate))
      throw Error("line {}: expected joints NAME X Y Z", scan.line());
    if (!rig_.numbers.emplace(name, rig_.joints.size()).second) throw Error("line {}: joint '{}' is there twice", scan.line(), name);
    rig_.joints.push_back({name, {x, y, z}, std::nullopt});
  }

  std::size_t number_of(TextScanner& scan, std::string_view name) const {
    const auto found = rig_.numbers.find(std::string(name));
    if (found == rig_.numbers.end()) throw Error("line {}: there is no joint '{}'", scan.line(), name);
    return found->second;
  }

  void root(TextScanner& scan) {
    const std::size_t joint = number_of(scan, scan.word());
    if (rig_.root && *rig_.root != joint) throw Error("line {}: a second root", scan.line());
    rig_.root = joint;
  }

  void hierarchy(TextScanner& scan) {
    const std::size_t parent = number_of(scan, scan.word()), child = number_of(scan, scan.word());
    auto& known = rig_.joints[child].parent;
    if (known && *known != parent) throw Error("line {}: joint '{}' has two parents", scan.line(), rig_.joints[child].name);
    known = parent;
  }

  void skin(TextScanner& scan) {
    const std::size_t line = scan.line();
    const auto vertex = TextScanner::to_integer(scan.word());
    if (!vertex || *vertex < 0) throw Error("line {}: expected skin VERTEX JOINT WEIGHT ...", line);
    auto& row = rig_.rows[static_cast<std::size_t>(*vertex)];
    if (!row.empty()) repairs_.push_back(fmt::format("line {}: vertex {} has two skin lines; added up", line, *vertex));
    for (std::string_view name = scan.word(); !name.empty(); name = scan.word()) {
      const std::size_t joint = number_of(scan, name);
      const float weight = scan.number();
      if (!std::isfinite(weight)) throw Error("line {}: joint '{}' has no weight", line, name);
      row.push_back({static_cast<std::uint32_t>(joint), weight});
    }
  }

  std::string_view text_;
  std::vector<std::string>& repairs_;
  RawRig rig_;
};

RawRig parse(std::string_view text, std::vector<std::string>& repairs) { return Parser(text, repairs).run(); }

struct OrderedSkeleton {
  Skeleton skeleton;
  std::vector<std::optional<JointId>> joint_of;  // file's number -> joint
};

// From the root down, children in the file's order.
OrderedSkeleton ordered(const RawRig& raw) {
  std::vector<std::vector<std::size_t>> children(raw.joints.size());
  std::vector<std::size_t> roots;
  for (std::size_t j = 0; j < raw.joints.size(); ++j)
    if (raw.joints[j].parent)
      children[*raw.joints[j].parent].push_back(j);
    else
      roots.push_back(j);
  if (roots.size() != 1) throw Error("{} joints without a parent, expected 1", roots.size());
  if (raw.root && *raw.root != roots[0]) throw Error("the root '{}' has a parent", raw.joints[*raw.root].name);
  if (raw.joints.size() > 65535) throw Error("{} joints, expected at most 65535", raw.joints.size());
  OrderedSkeleton out{{}, std::vector<std::optional<JointId>>(raw.joints.size())};
  std::vector<std::size_t> pending{roots[0]};
  while (!pending.empty()) {
    const std::size_t j = pending.back();
    pending.pop_back();
    const auto& joint = raw.joints[j];
    out.joint_of[j] = out.skeleton.add(joint.name, joint.parent ? out.joint_of[*joint.parent] : std::nullopt, joint.position);
    pending.insert(pending.end(), children[j].rbegin(), children[j].rend());
  }
  if (out.skeleton.size() != raw.joints.size()) throw Error("{} joints are not below the root", raw.joints.size() - out.skeleton.size());
  orient_along_bones(out.skeleton);
  return out;
}

SkinWeights weights_of(const RawRig& raw, const OrderedSkeleton& ordered, std::size_t vertices, std::vector<std::string>& repairs) {
  SkinWeights weights;
  std::size_t bare = 0;
  for (std::size_t v = 0; v < vertices; ++v) {
    std::vector<Influence> row;
    if (const auto found = raw.rows.find(v); found != raw.rows.end())
      for (const auto& [joint, weight] : found->second)
        if (weight > 0.0f) row.push_back({*ordered.joint_of[joint], weight});
    if (row.empty()) {
      row.push_back({JointId{0}, 1.0f});
      ++bare;
    }
    weights.append(row);
  }
  if (bare > 0) repairs.push_back(fmt::format("{} vertices have no weight; bound to the root", bare));
  if (!raw.rows.empty() && raw.rows.rbegin()->first >= vertices)
    repairs.push_back(fmt::format("skin lines up to vertex {}, but the mesh has {}; dropped", raw.rows.rbegin()->first, vertices));
  return weights;
}

std::vector<std::string> names_without_blanks(const Skeleton& skeleton) {
  std::vector<std::string> names;
  std::set<std::string> taken;
  for (std::string name : skeleton.names) {
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return c <= ' ' || c == '\\'; }, '_');
    std::string candidate = name;
    for (int n = 1; !taken.insert(candidate).second; ++n) candidate = fmt::format("{}_{}", name, n);
    names.push_back(candidate);
  }
  return names;
}

std::filesystem::path obj_beside(const std::filesystem::path& rig) {
  const std::string stem = rig.stem().string();
  for (const std::string_view suffix : {"", "_rig", ".rig"}) {
    if (!stem.ends_with(suffix)) continue;
    const auto candidate = rig.parent_path() / (stem.substr(0, stem.size() - suffix.size()) + ".obj");
    if (std::filesystem::exists(candidate)) return candidate;
  }
  return {};
}

}  // namespace

RigText load_rigtxt(const std::filesystem::path& path, std::size_t vertices, std::vector<std::string>& repairs) {
  const Bytes bytes = read_file(path);
  try {
    const RawRig raw = parse(text_of(bytes), repairs);
    OrderedSkeleton skeleton = ordered(raw);
    std::optional<SkinWeights> weights;
    if (!raw.rows.empty()) weights = weights_of(raw, skeleton, vertices, repairs);
    return {std::move(skeleton.skeleton), std::move(weights)};
  } catch (const Error& e) {
    throw Error("{}: {}", path.filename().string(), e.what());
  }
}

void save_rigtxt(const std::filesystem::path& path, const Skeleton& skeleton, const SkinWeights& weights) {
  const std::vector<std::string> names = names_without_blanks(skeleton);
  std::string text;
  const auto out = std::back_inserter(text);
  for (const JointId j : ids<JointId>(skeleton.size())) {
    const Vec3f& p = skeleton.rest_positions[j];
    fmt::format_to(out, "joints {} {} {} {}\n", names[index(j)], p.x(), p.y(), p.z());  // shortest text that reads back the same
  }
  fmt::format_to(out, "root {}\n", names[0]);
  for (std::size_t v = 0; v < weights.size(); ++v) {
    fmt::format_to(out, "skin {}", v);
    for (const auto& [joint, weight] : weights[static_cast<VertexId>(v)]) fmt::format_to(out, " {} {}", names[index(joint)], weight);
    text += '\n';
  }
  for (const JointId j : ids<JointId>(skeleton.size()))
    if (skeleton.parents[j]) fmt::format_to(out, "hier {} {}\n", names[index(*skeleton.parents[j])], names[index(j)]);
  const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  write_file(path, {&bytes, 1});
}

Scene rigtxt::import(const File& file) {
  const RawRig raw = parse(file.text(), file.repairs);
  const OrderedSkeleton joints = ordered(raw);
  Scene scene;
  const std::filesystem::path obj = obj_beside(file.path);
  if (!obj.empty()) scene = obj::import({obj, read_file(obj), file.repairs});
  const std::size_t first = scene.nodes.size();
  Scene::Skin skin;
  const Skeleton& skeleton = joints.skeleton;
  for (const JointId j : ids<JointId>(skeleton.size())) {
    const Eigen::Affine3d world =
        Eigen::Translation3d(skeleton.rest_positions[j].cast<double>()) * skeleton.rest_orientations[j].cast<double>();
    const auto parent = skeleton.parents[j];
    scene.nodes.push_back({skeleton.names[j], parent ? std::optional(first + index(*parent)) : std::nullopt, world});
    skin.joints.push_back(first + index(j));
    skin.inverse_binds.push_back(world.inverse());
  }
  if (!obj.empty() && !raw.rows.empty()) {
    Scene::Mesh& mesh = scene.meshes[0];
    const SkinWeights weights = weights_of(raw, joints, mesh.positions.size(), file.repairs);
    mesh.influence_offsets = {0};
    for (std::size_t v = 0; v < weights.size(); ++v) {
      for (const auto& [joint, weight] : weights[static_cast<VertexId>(v)])
        mesh.influences.push_back({static_cast<std::uint32_t>(index(joint)), weight});
      mesh.influence_offsets.push_back(static_cast<std::uint32_t>(mesh.influences.size()));
    }
    scene.instances[0].skin = 0;
  }
  scene.skins.push_back(std::move(skin));
  return scene;
}

}  // namespace osteon::io
