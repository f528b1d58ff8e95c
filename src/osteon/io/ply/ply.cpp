// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/ply/ply.h"

#include <algorithm>
#include <cstring>

#include "osteon/base/error.h"
#include "osteon/io/ply/header.h"
#include "osteon/io/polygon.h"
#include "osteon/io/text_scanner.h"

namespace osteon::io::ply {
namespace {

// Values of the elements one after the other, in either format. Ended: the file is over; what it then returns is zero.
class Values {
 public:
  Values(const Header& header, std::string_view text) : format_(header.format), text_(text.substr(header.size)), scan_(text_) {}

  bool ended() const { return ended_; }
  std::size_t bytes_left() const { return format_ == Header::Format::ascii ? scan_.bytes_left() : text_.size() - at_; }

  double next(Type type) {
    if (format_ == Header::Format::ascii) {
      const std::string_view word = scan_.word_on_any_line();
      if (word.empty()) ended_ = true;
      return static_cast<double>(TextScanner::to_number(word));
    }
    switch (type) {
      case Type::i8:
        return static_cast<double>(binary<std::int8_t>());
      case Type::u8:
        return static_cast<double>(binary<std::uint8_t>());
      case Type::i16:
        return static_cast<double>(binary<std::int16_t>());
      case Type::u16:
        return static_cast<double>(binary<std::uint16_t>());
      case Type::i32:
        return static_cast<double>(binary<std::int32_t>());
      case Type::u32:
        return static_cast<double>(binary<std::uint32_t>());
      case Type::f32:
        return static_cast<double>(binary<float>());
      case Type::f64:
        return binary<double>();
    }
    return 0.0;
  }

  // An index or a length: floats would round beyond 2^24.
  std::int64_t next_integer(Type type) {
    if (format_ == Header::Format::ascii) {
      const std::string_view word = scan_.word_on_any_line();
      if (word.empty()) ended_ = true;
      return TextScanner::to_integer(word).value_or(-1);
    }
    const double value = next(type);
    return value >= -1.0 && value <= 4294967295.0 ? static_cast<std::int64_t>(value) : -1;
  }

 private:
  template <class T>
  T binary() {
    if (text_.size() - at_ < sizeof(T)) {
      ended_ = true;
      at_ = text_.size();
      return T{};
    }
    char bytes[sizeof(T)];
    std::memcpy(bytes, text_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    if (format_ == Header::Format::big_endian) std::reverse(bytes, bytes + sizeof(T));
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
  }

  Header::Format format_;
  std::string_view text_;
  std::size_t at_ = 0;
  TextScanner scan_;
  bool ended_ = false;
};

float linear_from_srgb(double value) {
  const double c = std::clamp(value, 0.0, 1.0);
  return static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
}

class Reader {
 public:
  Reader(const Header& header, std::string_view text) : header_(header), values_(header, text) {}

  Scene::Mesh run(std::vector<std::string>& repairs) {
    for (const Element& element : header_.elements) {
      if (element.name == "vertex")
        read_vertices(element);
      else if (element.name == "face")
        read_faces(element, "vertex_indices", "vertex_index");
      else if (element.name == "tristrips")
        read_faces(element, "vertex_indices", "vertex_indices");
      else
        skip(element);
    }
    add_polygons();
    finish_layers();
    if (values_.ended())
      repairs.push_back(fmt::format("the file ends early; read {} vertices and {} faces", mesh_.positions.size(), mesh_.faces.size()));
    if (dropped_ > 0)
      repairs.push_back(fmt::format("dropped {} faces with an index beyond the {} vertices", dropped_, mesh_.positions.size()));
    return std::move(mesh_);
  }

 private:
  // How many items can be there at all: the header may promise more than memory holds.
  std::size_t plausible_count(const Element& element) const { return std::min(element.count, values_.bytes_left()); }

  void skip(const Element& element) {
    if (element.properties.empty()) return;
    for (std::size_t i = 0; i < element.count && !values_.ended(); ++i)
      for (const Property& p : element.properties) skip(p);
  }

  void skip(const Property& property) {
    const std::int64_t count = property.count_type ? values_.next_integer(*property.count_type) : 1;
    for (std::int64_t k = 0; k < count && !values_.ended(); ++k) values_.next(property.type);
  }

  void read_vertices(const Element& element) {
    const auto column = [&](std::initializer_list<const char*> names) -> std::optional<std::size_t> {
      for (const char* name : names)
        if (const auto p = element.find(name); p && !element.properties[*p].count_type) return p;
      return std::nullopt;
    };
    const std::array xyz{column({"x"}), column({"y"}), column({"z"})}, normal{column({"nx"}), column({"ny"}), column({"nz"})};
    const std::array uv{column({"s", "u", "texture_u"}), column({"t", "v", "texture_v"})};
    const std::array rgb{column({"red", "diffuse_red"}), column({"green", "diffuse_green"}), column({"blue", "diffuse_blue"})};
    if (!xyz[0] || !xyz[1] || !xyz[2]) throw Error("the vertices have no x, y and z");
    std::vector<double> row(element.properties.size());
    mesh_.positions.reserve(plausible_count(element));
    for (std::size_t i = 0; i < element.count; ++i) {
      for (std::size_t p = 0; p < row.size(); ++p) {
        if (element.properties[p].count_type)
          skip(element.properties[p]);
        else
          row[p] = values_.next(element.properties[p].type);
      }
      if (values_.ended()) return;
      const auto at = [&](const std::optional<std::size_t>& p) { return static_cast<float>(row[*p]); };
      mesh_.positions.emplace_back(at(xyz[0]), at(xyz[1]), at(xyz[2]));
      if (normal[0] && normal[1] && normal[2]) mesh_.normals.values.emplace_back(at(normal[0]), at(normal[1]), at(normal[2]));
      if (uv[0] && uv[1]) mesh_.texture_coordinates.values.emplace_back(at(uv[0]), 1.0f - at(uv[1]));
      if (rgb[0] && rgb[1] && rgb[2]) {
        const Type type = element.properties[*rgb[0]].type;
        const double full = type == Type::f32 || type == Type::f64 ? 1.0 : type == Type::u16 ? 65535.0 : 255.0;
        mesh_.colours.emplace_back(linear_from_srgb(row[*rgb[0]] / full), linear_from_srgb(row[*rgb[1]] / full),
                                   linear_from_srgb(row[*rgb[2]] / full), 1.0f);
      }
    }
  }

  // Faces may stand before their vertices: they are cut into triangles when all is read.
  void read_faces(const Element& element, std::string_view name, std::string_view other_name) {
    const auto found = element.find(name) ? element.find(name) : element.find(other_name);
    if (!found || !element.properties[*found].count_type) throw Error("the element '{}' has no list of vertex indices", element.name);
    const auto coordinates = element.find("texcoord");
    for (std::size_t i = 0; i < element.count && !values_.ended(); ++i) {
      const std::size_t before = indices_.size();
      std::vector<float> corners;
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        const Property& property = element.properties[p];
        if (p == *found)
          read_indices(property);
        else if (p == coordinates && property.count_type)
          corners = read_list(property);
        else
          skip(property);
      }
      if (values_.ended()) {
        indices_.resize(before);
        return;
      }
      if (element.name == "tristrips")
        add_strip(before);
      else
        add_outline(before, corners);
    }
  }

  void read_indices(const Property& property) {
    const std::int64_t count = values_.next_integer(*property.count_type);
    for (std::int64_t k = 0; k < count && !values_.ended(); ++k) indices_.push_back(values_.next_integer(property.type));
  }

  std::vector<float> read_list(const Property& property) {
    std::vector<float> out;
    const std::int64_t count = values_.next_integer(*property.count_type);
    for (std::int64_t k = 0; k < count && !values_.ended(); ++k) out.push_back(static_cast<float>(values_.next(property.type)));
    return out;
  }

  void add_outline(std::size_t before, const std::vector<float>& coordinates) {
    const bool fits = coordinates.size() == 2 * (indices_.size() - before);
    for (std::size_t k = before; k < indices_.size(); ++k) {
      const std::size_t c = 2 * (k - before);
      if (fits && std::isfinite(coordinates[c]) && std::isfinite(coordinates[c + 1])) {
        corner_coordinates_.resize(indices_.size(), Eigen::Vector2f::Zero());
        corner_coordinates_[k] = {coordinates[c], 1.0f - coordinates[c + 1]};
      }
    }
    outline_ends_.push_back(indices_.size());
  }

  // Stanford's strips: every triangle turns the other way, -1 starts anew.
  void add_strip(std::size_t before) {
    const std::vector<std::int64_t> strip(indices_.begin() + static_cast<std::ptrdiff_t>(before), indices_.end());
    indices_.resize(before);
    bool flipped = false;
    for (std::size_t i = 2; i < strip.size(); ++i) {
      const std::int64_t a = strip[i - 2], b = strip[i - 1], c = strip[i];
      if (c < 0) {
        flipped = false;
        continue;
      }
      if (a < 0 || b < 0) continue;
      indices_.insert(indices_.end(), {flipped ? b : a, flipped ? a : b, c});
      outline_ends_.push_back(indices_.size());
      flipped = !flipped;
    }
  }

  void add_polygons() {
    std::vector<Vec3f> points;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::size_t begin = 0;
    for (const std::size_t end : outline_ends_) {
      const std::span<const std::int64_t> outline(indices_.data() + begin, end - begin);
      const auto first_corner = static_cast<std::uint32_t>(begin);
      begin = end;
      if (outline.size() < 3 || std::any_of(outline.begin(), outline.end(),
                                            [&](std::int64_t i) { return static_cast<std::uint64_t>(i) >= mesh_.positions.size(); })) {
        ++dropped_;
        continue;
      }
      points.clear();
      for (const std::int64_t i : outline) points.push_back(mesh_.positions[static_cast<std::size_t>(i)]);
      triangles.clear();
      triangulate(points, triangles);
      for (const auto& [a, b, c] : triangles) {
        mesh_.faces.push_back({static_cast<VertexId>(outline[a]), static_cast<VertexId>(outline[b]), static_cast<VertexId>(outline[c])});
        if (!corner_coordinates_.empty())
          mesh_.texture_coordinates.corners.push_back({first_corner + a, first_corner + b, first_corner + c});
      }
    }
  }

  // Layers of the vertices have the faces' own corners.
  void finish_layers() {
    std::vector<std::array<std::uint32_t, 3>> corners;
    for (const auto& [a, b, c] : mesh_.faces)
      corners.push_back({static_cast<std::uint32_t>(index(a)), static_cast<std::uint32_t>(index(b)), static_cast<std::uint32_t>(index(c))});
    if (!mesh_.normals.values.empty()) mesh_.normals.corners = corners;
    if (!corner_coordinates_.empty()) {
      corner_coordinates_.resize(indices_.size(), Eigen::Vector2f::Zero());
      mesh_.texture_coordinates.values = std::move(corner_coordinates_);
    } else if (!mesh_.texture_coordinates.values.empty()) {
      mesh_.texture_coordinates.corners = std::move(corners);
    }
  }

  const Header& header_;
  Values values_;
  Scene::Mesh mesh_;
  std::vector<std::int64_t> indices_;
  std::vector<std::size_t> outline_ends_;
  std::vector<Eigen::Vector2f> corner_coordinates_;  // one for each of indices_, or none
  std::size_t dropped_ = 0;
};

}  // namespace

Scene import(const File& file) {
  const Header header = parse_header(file.text());
  return scene_of(Reader(header, file.text()).run(file.repairs));
}

}  // namespace osteon::io::ply
