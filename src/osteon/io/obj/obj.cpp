// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/obj/obj.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "osteon/base/error.h"
#include "osteon/io/obj/mtl.h"
#include "osteon/io/polygon.h"
#include "osteon/io/text_scanner.h"

namespace osteon::io::obj {
namespace {

constexpr std::int32_t kNone = -1;

// Indices from 0; kNone where the file gives none. Not yet checked: a face may come before its vertices.
struct Corner {
  std::int32_t vertex, coordinate, normal;
};

struct Content {
  std::vector<Vec3f> positions, normals;
  std::vector<Eigen::Vector2f> coordinates;
  std::vector<Eigen::Vector4f> colours;
  std::vector<Corner> corners;
  std::vector<std::size_t> polygon_ends;   // in corners
  std::vector<std::size_t> polygon_lines;  // of the file
  std::vector<std::uint32_t> polygon_materials, polygon_objects;
  std::vector<std::string> material_names, object_names;
  std::vector<std::string> libraries;
  std::vector<std::size_t> unreadable_lines;  // of faces
};

// Numbers names in the order in which they come.
class Names {
 public:
  std::uint32_t number(std::string name, std::vector<std::string>& all) {
    const auto [entry, is_new] = numbers_.emplace(std::move(name), static_cast<std::uint32_t>(all.size()));
    if (is_new) all.push_back(entry->first);
    return entry->second;
  }

 private:
  std::map<std::string, std::uint32_t> numbers_;
};

class Parser {
 public:
  explicit Parser(std::string_view text) : scan_(text) {}

  Content run() {
    for (; !scan_.at_end(); scan_.next_line()) statement(scan_.word());
    return std::move(content_);
  }

 private:
  void statement(std::string_view keyword) {
    if (keyword == "v")
      vertex();
    else if (keyword == "vt")
      content_.coordinates.emplace_back(coordinate());
    else if (keyword == "vn")
      content_.normals.push_back(vector());
    else if (keyword == "f" || keyword == "fo")
      face();
    else if (keyword == "usemtl")
      material_ = materials_.number(std::string(scan_.rest()), content_.material_names);
    else if (keyword == "o")
      object_ = objects_.number(std::string(scan_.rest()), content_.object_names);
    else if (keyword == "mtllib")
      content_.libraries.emplace_back(scan_.rest());
  }

  Vec3f vector() {
    const float x = scan_.number(), y = scan_.number(), z = scan_.number();
    return {x, y, z};
  }

  Eigen::Vector2f coordinate() {
    const float u = scan_.number(), v = scan_.at_line_end() ? 0.0f : scan_.number();
    return std::isfinite(u) && std::isfinite(v) ? Eigen::Vector2f(u, 1.0f - v) : Eigen::Vector2f(0.0f, 0.0f);
  }

  // x y z [w], or x y z r g b as many programs write.
  void vertex() {
    content_.positions.push_back(vector());
    if (scan_.at_line_end()) return;
    const float r = scan_.number();
    if (scan_.at_line_end()) return;
    const float g = scan_.number(), b = scan_.number();
    if (!std::isfinite(r + g + b)) return;
    content_.colours.resize(content_.positions.size(), Eigen::Vector4f::Ones());
    content_.colours.back() << r, g, b, 1.0f;
  }

  void face() {
    const std::size_t before = content_.corners.size(), line = scan_.line();
    bool readable = true;
    for (std::string_view word = scan_.word(); !word.empty() && word[0] != '#'; word = scan_.word()) readable = corner(word) && readable;
    const std::size_t count = content_.corners.size() - before;
    if (!readable || count < 3) {
      content_.corners.resize(before);
      content_.unreadable_lines.push_back(line);
      return;
    }
    content_.polygon_ends.push_back(content_.corners.size());
    content_.polygon_lines.push_back(line);
    content_.polygon_materials.push_back(material_);
    content_.polygon_objects.push_back(object_);
  }

  // v, v/vt, v//vn or v/vt/vn
  bool corner(std::string_view word) {
    Corner corner{kNone, kNone, kNone};
    const std::size_t slash = word.find('/');
    bool readable = resolve(word.substr(0, slash), content_.positions.size(), corner.vertex);
    if (slash != std::string_view::npos) {
      const std::string_view tail = word.substr(slash + 1);
      const std::size_t second = tail.find('/');
      if (second != 0 && !tail.empty())
        readable = resolve(tail.substr(0, second), content_.coordinates.size(), corner.coordinate) && readable;
      if (second != std::string_view::npos && second + 1 < tail.size())
        readable = resolve(tail.substr(second + 1), content_.normals.size(), corner.normal) && readable;
    }
    content_.corners.push_back(corner);
    return readable;
  }

  // Indices count from 1; negative ones back from the latest item.
  static bool resolve(std::string_view word, std::size_t count, std::int32_t& index) {
    const auto value = TextScanner::to_integer(word);
    if (!value || *value == 0 || std::abs(*value) > INT32_MAX) return false;
    index = static_cast<std::int32_t>(*value > 0 ? *value - 1 : static_cast<std::int64_t>(count) + *value);
    return index >= 0;
  }

  TextScanner scan_;
  Content content_;
  Names materials_, objects_;
  std::uint32_t material_ = UINT32_MAX, object_ = UINT32_MAX;  // none yet
};

// Turns the polygons into the triangles and layers of a mesh.
class MeshBuilder {
 public:
  explicit MeshBuilder(Content content) : content_(std::move(content)) {}

  Scene::Mesh build(std::vector<std::string>& repairs) {
    mesh_.normals.values = std::move(content_.normals);
    mesh_.texture_coordinates.values = std::move(content_.coordinates);
    mesh_.faces.reserve(content_.corners.size() - 2 * content_.polygon_ends.size());
    std::size_t begin = 0;
    for (std::size_t p = 0; p < content_.polygon_ends.size(); ++p) {
      const auto corners = std::span<const Corner>(content_.corners).subspan(begin, content_.polygon_ends[p] - begin);
      if (is_in_range(corners, content_.polygon_lines[p])) add_polygon(corners, p);
      begin = content_.polygon_ends[p];
    }
    complete(mesh_.normals, Vec3f(Vec3f::Zero()));  // zero: a normal to be computed
    complete(mesh_.texture_coordinates, Eigen::Vector2f(0.0f, 0.0f));
    mesh_.positions = std::move(content_.positions);
    if (!content_.colours.empty()) content_.colours.resize(mesh_.positions.size(), Eigen::Vector4f::Ones());
    mesh_.colours = std::move(content_.colours);
    mesh_.objects = std::move(content_.object_names);
    if (const auto& lines = content_.unreadable_lines; !lines.empty())
      repairs.push_back(fmt::format("dropped {} faces that are malformed, the first in line {}", lines.size(), lines.front()));
    if (out_of_range_ > 0)
      repairs.push_back(fmt::format("dropped {} faces with an index beyond the {} vertices, the first in line {} with {}", out_of_range_,
                                    mesh_.positions.size(), first_line_, first_index_));
    return std::move(mesh_);
  }

 private:
  bool is_in_range(std::span<const Corner> corners, std::size_t line) {
    for (const Corner& c : corners)
      if (static_cast<std::size_t>(c.vertex) >= content_.positions.size()) {
        if (out_of_range_++ == 0) {
          first_line_ = line;
          first_index_ = static_cast<std::size_t>(c.vertex) + 1;
        }
        return false;
      }
    return true;
  }

  void add_polygon(std::span<const Corner> corners, std::size_t polygon) {
    points_.clear();
    for (const Corner& c : corners) points_.push_back(content_.positions[static_cast<std::size_t>(c.vertex)]);
    triangles_.clear();
    triangulate(points_, triangles_);
    for (const auto& [a, b, c] : triangles_) {
      const auto vertex = [&](std::uint32_t k) { return static_cast<VertexId>(corners[k].vertex); };
      mesh_.faces.push_back({vertex(a), vertex(b), vertex(c)});
      if (!content_.material_names.empty()) mesh_.face_materials.push_back(content_.polygon_materials[polygon]);
      if (!content_.object_names.empty()) mesh_.face_objects.push_back(content_.polygon_objects[polygon]);
      add_corners(mesh_.normals, corners[a].normal, corners[b].normal, corners[c].normal);
      add_corners(mesh_.texture_coordinates, corners[a].coordinate, corners[b].coordinate, corners[c].coordinate);
    }
  }

  template <class T>
  static void add_corners(Scene::Layer<T>& layer, std::int32_t a, std::int32_t b, std::int32_t c) {
    if (layer.values.empty()) return;
    const auto place = [&](std::int32_t i) {  // kNone, too, becomes one past the last
      return static_cast<std::uint32_t>(std::min(static_cast<std::size_t>(static_cast<std::uint32_t>(i)), layer.values.size()));
    };
    layer.corners.push_back({place(a), place(b), place(c)});
  }

  template <class T>
  static void complete(Scene::Layer<T>& layer, const T& none) {
    if (!layer.values.empty()) layer.values.push_back(none);
  }

  Content content_;
  Scene::Mesh mesh_;
  std::vector<Vec3f> points_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::size_t out_of_range_ = 0, first_line_ = 0, first_index_ = 0;  // line and index: of the first such face
};

// Materials by the names that faces use; faces before the first `usemtl` get a plain one.
std::vector<Scene::Material> materials_of(const File& file, const Content& content) {
  std::map<std::string, Scene::Material> known;
  for (const std::string& library : content.libraries) read_mtl(file.path.parent_path(), library, known, file.repairs);
  std::vector<Scene::Material> materials;
  for (const std::string& name : content.material_names) {
    const auto found = known.find(name);
    materials.push_back(found != known.end() ? found->second : Scene::Material::plain(name));
  }
  return materials;
}

// Gives faces before the first name the number after the last. Returns whether there were any.
bool number_first_faces(std::vector<std::uint32_t>& numbers, std::size_t count) {
  const auto first = std::ranges::count(numbers, UINT32_MAX);
  std::ranges::replace(numbers, UINT32_MAX, static_cast<std::uint32_t>(count));
  return first > 0;
}

void name_first_faces(Scene::Mesh& mesh, std::vector<Scene::Material>& materials) {
  if (number_first_faces(mesh.face_objects, mesh.objects.size())) mesh.objects.emplace_back();
  if (number_first_faces(mesh.face_materials, materials.size())) materials.push_back(Scene::Material::plain());
}

}  // namespace

Scene import(const File& file) {
  Content content = Parser(file.text()).run();
  if (content.positions.empty()) throw Error("no vertices");
  std::vector<Scene::Material> materials = materials_of(file, content);
  Scene::Mesh mesh = MeshBuilder(std::move(content)).build(file.repairs);
  name_first_faces(mesh, materials);
  return scene_of(std::move(mesh), std::move(materials));
}

}  // namespace osteon::io::obj
