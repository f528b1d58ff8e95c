// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/gltf/references.h"

#include <algorithm>
#include <cassert>
#include <string_view>

namespace osteon::io::gltf {
namespace {

// Calls body with each item of an array member, if the member is there.
template <class Body>
void each(Json& object, const char* key, Body body) {
  if (!object.is_object()) return;
  const auto list = object.find(key);
  if (list == object.end() || !list->is_structured()) return;
  for (Json& item : *list) body(item);
}

template <class Body>
void member(Json& object, const char* key, Body body) {
  if (!object.is_object()) return;
  if (const auto found = object.find(key); found != object.end()) body(*found);
}

using Visit = std::function<void(Json& index)>;

void visit_nodes(Json& json, const Visit& visit) {
  each(json, "scenes", [&](Json& scene) { each(scene, "nodes", visit); });
  each(json, "nodes", [&](Json& node) { each(node, "children", visit); });
  each(json, "skins", [&](Json& skin) {
    each(skin, "joints", visit);
    member(skin, "skeleton", visit);
  });
  each(json, "animations", [&](Json& animation) {
    each(animation, "channels", [&](Json& channel) { member(channel, "target", [&](Json& target) { member(target, "node", visit); }); });
  });
}

void visit_accessors(Json& json, const Visit& visit) {
  each(json, "meshes", [&](Json& mesh) {
    each(mesh, "primitives", [&](Json& primitive) {
      each(primitive, "attributes", visit);
      member(primitive, "indices", visit);
      each(primitive, "targets", [&](Json& target) {
        if (target.is_structured()) std::for_each(target.begin(), target.end(), visit);
      });
    });
  });
  each(json, "skins", [&](Json& skin) { member(skin, "inverseBindMatrices", visit); });
  each(json, "animations", [&](Json& animation) {
    each(animation, "samplers", [&](Json& sampler) {
      member(sampler, "input", visit);
      member(sampler, "output", visit);
    });
  });
}

void visit_buffer_views(Json& json, const Visit& visit) {
  each(json, "accessors", [&](Json& accessor) {
    member(accessor, "bufferView", visit);
    member(accessor, "sparse", [&](Json& sparse) {
      member(sparse, "indices", [&](Json& part) { member(part, "bufferView", visit); });
      member(sparse, "values", [&](Json& part) { member(part, "bufferView", visit); });
    });
  });
  each(json, "images", [&](Json& image) { member(image, "bufferView", visit); });
}

// Every index of `kind` anywhere in the core of the document.
void visit_references(Json& json, Kind kind, const Visit& visit) {
  switch (kind) {
    case Kind::nodes:
      return visit_nodes(json, visit);
    case Kind::meshes:
      return each(json, "nodes", [&](Json& node) { member(node, "mesh", visit); });
    case Kind::skins:
      return each(json, "nodes", [&](Json& node) { member(node, "skin", visit); });
    case Kind::accessors:
      return visit_accessors(json, visit);
    case Kind::buffer_views:
      return visit_buffer_views(json, visit);
  }
}

void erase_marked(Json& object, const char* key, const Json& mark) {
  const auto list = object.find(key);
  if (list == object.end() || !list->is_array()) return;
  Json kept = Json::array();
  for (Json& item : *list)
    if (item != mark) kept.push_back(std::move(item));
  if (kept.empty())
    object.erase(key);  // empty arrays are not allowed
  else
    *list = std::move(kept);
}

}  // namespace

const char* key_of(Kind kind) {
  switch (kind) {
    case Kind::nodes:
      return "nodes";
    case Kind::meshes:
      return "meshes";
    case Kind::skins:
      return "skins";
    case Kind::accessors:
      return "accessors";
    case Kind::buffer_views:
      return "bufferViews";
  }
  return "";
}

bool references_are_known(const Document& document) {
  constexpr std::string_view kKnown[] = {"KHR_materials_",      "KHR_texture_",          "EXT_texture_", "MSFT_texture_dds",
                                         "KHR_lights_punctual", "KHR_mesh_quantization", "KHR_xmp",      "MSFT_packing_",
                                         "FB_ngon_encoding",    "VRMC_materials_"};
  for (const Element& used : document.all("extensionsUsed"))
    if (std::none_of(std::begin(kKnown), std::end(kKnown), [&](std::string_view known) { return used.text().starts_with(known); }))
      return false;
  return true;
}

std::vector<bool> used_items(const Document& document, Kind kind) {
  std::vector<bool> used(document.count(key_of(kind)));
  Json& json = const_cast<Json&>(document.json);  // the visitor below changes nothing
  visit_references(json, kind, [&](Json& index) {
    if (index.is_number() && index.get<double>() >= 0.0 && index.get<double>() < static_cast<double>(used.size()))
      used[index.get<std::size_t>()] = true;
  });
  return used;
}

void remove_items(Document& document, Kind kind, const std::vector<bool>& remove) {
  if (std::none_of(remove.begin(), remove.end(), [](bool r) { return r; })) return;
  Json& items = document.json[key_of(kind)];
  assert(remove.size() == items.size());
  std::vector<std::size_t> renumbered(items.size());
  Json kept = Json::array();
  for (std::size_t i = 0; i < items.size(); ++i) {
    renumbered[i] = kept.size();
    if (!remove[i]) kept.push_back(std::move(items[i]));
  }
  if (kept.empty())
    document.json.erase(key_of(kind));
  else
    items = std::move(kept);
  visit_references(document.json, kind, [&](Json& index) {
    if (!index.is_number() || !(index.get<double>() >= 0.0) || index.get<double>() >= static_cast<double>(remove.size())) return;
    const auto old = index.get<std::size_t>();
    if (remove[old])
      index = nullptr;
    else if (renumbered[old] != old)
      index = renumbered[old];
  });
  if (kind != Kind::nodes) return;  // items of other kinds are removed only when nothing refers to them
  each(document.json, "scenes", [](Json& scene) { erase_marked(scene, "nodes", nullptr); });
  each(document.json, "nodes", [](Json& node) { erase_marked(node, "children", nullptr); });
}

void repack_buffer(Document& document) {
  Bytes packed;
  const Bytes& buffer = document.buffers.at(0);
  for (Json& view : document.json.at("bufferViews")) {
    const std::size_t begin = view.value("byteOffset", std::size_t{0}), length = view.at("byteLength").get<std::size_t>();
    if (begin > buffer.size() || length > buffer.size() - begin) continue;  // broken, and nothing that we read
    packed.resize(packed.size() + (begin - packed.size()) % 4);             // an accessor's own offset may rely on the view's remainder
    view["byteOffset"] = packed.size();
    packed.insert(packed.end(), buffer.begin() + static_cast<std::ptrdiff_t>(begin),
                  buffer.begin() + static_cast<std::ptrdiff_t>(begin + length));
  }
  document.buffers[0] = std::move(packed);
  document.json["buffers"][0]["byteLength"] = document.buffers[0].size();
}

}  // namespace osteon::io::gltf
