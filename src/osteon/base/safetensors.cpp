// SPDX-License-Identifier: Apache-2.0
#include "osteon/base/safetensors.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "osteon/base/error.h"

namespace osteon {
namespace {

using json = nlohmann::json;

struct TypeName {
  DType type;
  const char* name;
  std::size_t size;
};
constexpr TypeName kTypes[] = {{DType::f32, "F32", 4}, {DType::f16, "F16", 2}, {DType::i64, "I64", 8},
                               {DType::i32, "I32", 4}, {DType::u16, "U16", 2}, {DType::u8, "U8", 1}};

const TypeName& type_info(DType type) {
  for (const TypeName& t : kTypes)
    if (t.type == type) return t;
  return kTypes[0];
}

template <class T>
constexpr DType dtype_of() {
  if constexpr (std::is_same_v<T, float>) return DType::f32;
  if constexpr (std::is_same_v<T, std::int64_t>) return DType::i64;
  if constexpr (std::is_same_v<T, std::int32_t>) return DType::i32;
  if constexpr (std::is_same_v<T, std::uint16_t>) return DType::u16;
  if constexpr (std::is_same_v<T, std::uint8_t>) return DType::u8;
}

// Checks one header entry against the data section and copies its bytes out.
Array read_array(const std::string& file, const std::string& name, const json& entry, std::span<const char> data) {
  Array array;
  const std::string type = entry.at("dtype");
  const auto* info = std::find_if(std::begin(kTypes), std::end(kTypes), [&](const TypeName& t) { return type == t.name; });
  if (info == std::end(kTypes)) throw Error("{}: tensor '{}' has dtype {}; expected F32, F16, I64, I32, U16 or U8", file, name, type);
  array.dtype = info->type;
  std::uint64_t count = 1;
  for (const json& extent : entry.at("shape")) {
    const auto n = extent.get<std::int64_t>();
    if (n < 0 || (n > 0 && count > data.size() / static_cast<std::uint64_t>(n)))
      throw Error("{}: tensor '{}' has an impossible shape {}", file, name, entry.at("shape").dump());
    count *= static_cast<std::uint64_t>(n);
    array.shape.push_back(n);
  }
  const auto begin = entry.at("data_offsets").at(0).get<std::uint64_t>(), end = entry.at("data_offsets").at(1).get<std::uint64_t>();
  if (begin > end || end > data.size() || end - begin != count * info->size)
    throw Error("{}: tensor '{}' has data_offsets [{}, {}], but {} values of {} bytes and {} bytes of data", file, name, begin, end, count,
                info->size, data.size());
  array.bytes.assign(data.begin() + static_cast<std::ptrdiff_t>(begin), data.begin() + static_cast<std::ptrdiff_t>(end));
  return array;
}

}  // namespace

std::int64_t Array::count() const {
  std::int64_t n = 1;
  for (std::int64_t extent : shape) n *= extent;
  return n;
}

template <class T>
std::vector<T> Array::values() const {
  std::vector<T> out(static_cast<std::size_t>(count()));
  if constexpr (std::is_same_v<T, float>)
    if (dtype == DType::f16) {
      for (std::size_t i = 0; i < out.size(); ++i) out[i] = half_to_float(static_cast<std::uint16_t>(bytes[2 * i] | bytes[2 * i + 1] << 8));
      return out;
    }
  if (dtype != dtype_of<T>()) throw Error("tensor holds {}, not {}", type_info(dtype).name, type_info(dtype_of<T>()).name);
  if (!out.empty()) std::memcpy(out.data(), bytes.data(), bytes.size());
  return out;
}
template std::vector<float> Array::values() const;
template std::vector<std::int64_t> Array::values() const;
template std::vector<std::int32_t> Array::values() const;
template std::vector<std::uint16_t> Array::values() const;
template std::vector<std::uint8_t> Array::values() const;

template <class T>
Array Array::of(std::span<const T> values, std::vector<std::int64_t> shape) {
  Array array{dtype_of<T>(), std::move(shape), std::vector<std::uint8_t>(values.size_bytes())};
  if (static_cast<std::size_t>(array.count()) != values.size())
    throw Error("{} values do not fill a tensor of {}", values.size(), array.count());
  if (!values.empty()) std::memcpy(array.bytes.data(), values.data(), values.size_bytes());
  return array;
}
template Array Array::of(std::span<const float>, std::vector<std::int64_t>);
template Array Array::of(std::span<const std::int64_t>, std::vector<std::int64_t>);
template Array Array::of(std::span<const std::int32_t>, std::vector<std::int64_t>);
template Array Array::of(std::span<const std::uint16_t>, std::vector<std::int64_t>);
template Array Array::of(std::span<const std::uint8_t>, std::vector<std::int64_t>);

Array Array::half(std::span<const float> values, std::vector<std::int64_t> shape) {
  std::vector<std::uint16_t> halves(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) halves[i] = float_to_half(values[i]);
  Array array = of<std::uint16_t>(halves, std::move(shape));
  array.dtype = DType::f16;
  return array;
}

const Array& Safetensors::at(const std::string& name) const {
  const auto found = arrays.find(name);
  if (found == arrays.end()) throw Error("no tensor '{}' among {}", name, arrays.size());
  return found->second;
}

Safetensors load_safetensors(const std::filesystem::path& path) {
  const std::string file = path.string();
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error("{}: cannot open", file);
  in.seekg(0, std::ios::end);
  std::vector<char> bytes(static_cast<std::size_t>(std::max<std::streamoff>(0, in.tellg())));
  in.seekg(0);
  if (!in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) throw Error("{}: cannot read", file);
  std::uint64_t header_size = 0;
  if (bytes.size() < 8) throw Error("{}: {} bytes; a safetensors file has at least 8", file, bytes.size());
  std::memcpy(&header_size, bytes.data(), 8);
  if (header_size > bytes.size() - 8) throw Error("{}: header of {} bytes in a file of {}", file, header_size, bytes.size());
  const auto* header_begin = bytes.data() + 8;
  const std::span<const char> data(header_begin + header_size, bytes.size() - 8 - header_size);
  try {
    Safetensors out;
    const json header = json::parse(header_begin, header_begin + header_size);
    for (const auto& [name, entry] : header.items()) {
      if (name == "__metadata__")
        out.metadata = entry.get<std::map<std::string, std::string>>();
      else
        out.arrays.emplace(name, read_array(file, name, entry, data));
    }
    return out;
  } catch (const json::exception& e) {
    throw Error("{}: malformed safetensors header: {}", file, e.what());
  }
}

void save_safetensors(const std::filesystem::path& path, const Safetensors& content) {
  json header = json::object();
  if (!content.metadata.empty()) header["__metadata__"] = content.metadata;
  std::uint64_t offset = 0;
  for (const auto& [name, array] : content.arrays) {
    header[name] = {
        {"dtype", type_info(array.dtype).name}, {"shape", array.shape}, {"data_offsets", {offset, offset + array.bytes.size()}}};
    offset += array.bytes.size();
  }
  std::string text = header.dump(-1, ' ', false, json::error_handler_t::replace);  // a path in the metadata may be no UTF-8
  text.resize((text.size() + 7) / 8 * 8, ' ');                                     // the data section starts 8-byte aligned
  const std::uint64_t header_size = text.size();
  const std::filesystem::path aside = path.string() + ".tmp";
  {
    std::ofstream out(aside, std::ios::binary);
    out.write(reinterpret_cast<const char*>(&header_size), 8);
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    for (const auto& [name, array] : content.arrays)
      out.write(reinterpret_cast<const char*>(array.bytes.data()), static_cast<std::streamsize>(array.bytes.size()));
    out.close();
    if (!out) {
      std::error_code gone;
      std::filesystem::remove(aside, gone);
      throw Error("{}: cannot be written", path.string());
    }
  }
  std::filesystem::rename(aside, path);
}

// Without branches, as weights are read by the million: the bits of a half moved to a float's places are the number times 2^-112 (the
// two biases differ by 112), subnormals included.
float half_to_float(std::uint16_t half) {
  const std::uint32_t sign = static_cast<std::uint32_t>(half & 0x8000u) << 16;
  const float magnitude = std::bit_cast<float>(static_cast<std::uint32_t>(half & 0x7fffu) << 13) * 0x1p112f;
  const std::uint32_t not_finite = (half & 0x7c00u) == 0x7c00u ? 0x7f800000u : 0u;  // the exponent of all ones stays one
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(magnitude) | not_finite | sign);
}

std::uint16_t float_to_half(float value) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
  const auto sign = static_cast<std::uint16_t>(bits >> 16 & 0x8000u);
  const std::uint32_t magnitude = bits & 0x7fffffffu;
  if (magnitude > 0x7f800000u) return sign | 0x7e00u;             // NaN
  if (magnitude >= 0x477ff000u) return sign | 0x7c00u;            // rounds to 65520 or more
  if (magnitude < 0x38800000u) {                                  // below 2^-14: subnormal, let the FPU round
    const float scaled = std::bit_cast<float>(magnitude) + 0.5f;  // 0.5 has an ulp of 2^-24
    return sign | static_cast<std::uint16_t>(std::bit_cast<std::uint32_t>(scaled) - 0x3f000000u);
  }
  const std::uint32_t rounded = magnitude + 0xfffu + (magnitude >> 13 & 1u);  // to nearest, ties to even
  return sign | static_cast<std::uint16_t>((rounded - 0x38000000u) >> 13);
}

}  // namespace osteon
