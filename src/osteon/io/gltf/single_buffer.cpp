// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/gltf/single_buffer.h"

#include "osteon/base/error.h"
#include "osteon/io/gltf/writer.h"

namespace osteon::io::gltf {

std::string image_type(std::span<const std::uint8_t> bytes) {
  const std::string_view text = text_of(bytes);
  if (text.starts_with("\x89PNG")) return "image/png";
  if (text.starts_with("\xFF\xD8\xFF")) return "image/jpeg";
  if (text.starts_with("RIFF") && text.substr(0, 12).ends_with("WEBP")) return "image/webp";
  if (text.starts_with("\xABKTX 20")) return "image/ktx2";
  if (text.starts_with("DDS ")) return "image/vnd-ms.dds";
  return "";
}

void join_buffers(Document& document, std::vector<std::string>& changes) {
  if (document.buffers.size() > 1) {
    std::vector<std::size_t> begins;
    Bytes joined;
    for (const Bytes& buffer : document.buffers) {
      joined.resize((joined.size() + 3) / 4 * 4);
      begins.push_back(joined.size());
      joined.insert(joined.end(), buffer.begin(), buffer.end());
    }
    for (std::size_t v = 0; v < document.count("bufferViews"); ++v) {
      Json& view = document.json["bufferViews"][v];
      const std::size_t buffer = document.at("bufferViews", v).at("buffer").index(begins.size(), "buffers");
      if (buffer > 0) view["byteOffset"] = document.at("bufferViews", v).integer_or("byteOffset", 0) + begins[buffer];
      view["buffer"] = 0;
    }
    document.buffers = {std::move(joined)};
    document.json["buffers"] = Json::array({document.json["buffers"][0]});
  }
  if (!document.buffers.empty()) {
    document.json["buffers"][0].erase("uri");
    document.json["buffers"][0]["byteLength"] = document.buffers[0].size();
  }
  for (std::size_t i = 0; i < document.count("images"); ++i) {
    const Element image = document.at("images", i);
    const auto uri = image.find("uri");
    if (!uri) continue;
    try {
      const Bytes bytes = fetch(document, uri->text(), uri->where());
      const std::string type = image_type(bytes);
      if (type.empty()) throw Error("{}: not an image", uri->where());
      const std::size_t view = Writer(document).image(bytes);
      Json& json = document.json["images"][i];
      json.erase("uri");
      json["bufferView"] = view;
      if (!json.contains("mimeType")) json["mimeType"] = type;
    } catch (const Error& e) {
      changes.push_back(fmt::format("{}; the image stays a reference", e.what()));
    }
  }
}

}  // namespace osteon::io::gltf
