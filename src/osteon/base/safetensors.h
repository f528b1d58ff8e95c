// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace osteon {

enum class DType { f32, f16, i64, i32, u16, u8 };

// One named array, row-major, its bytes little-endian as in the file.
struct Array {
  DType dtype = DType::f32;
  std::vector<std::int64_t> shape;
  std::vector<std::uint8_t> bytes;

  std::int64_t count() const;  // product of the shape; 1 for a scalar
  // The values as T (float, std::int64_t, std::int32_t, std::uint16_t, std::uint8_t); f16 is widened to float.
  // Throws Error when the stored type is another one.
  template <class T>
  std::vector<T> values() const;
  template <class T>
  static Array of(std::span<const T> values, std::vector<std::int64_t> shape);
  static Array half(std::span<const float> values, std::vector<std::int64_t> shape);  // round to nearest even
};

// A safetensors file (github.com/huggingface/safetensors): weights, prepared features and checkpoints.
struct Safetensors {
  std::map<std::string, Array> arrays;
  std::map<std::string, std::string> metadata;  // "__metadata__": recipe, data provenance, git commit

  const Array& at(const std::string& name) const;  // throws Error naming what is there
};

// Both throw Error naming the file. save() writes aside and renames, so a reader never sees half a file.
Safetensors load_safetensors(const std::filesystem::path& path);
void save_safetensors(const std::filesystem::path& path, const Safetensors& content);

float half_to_float(std::uint16_t half);
std::uint16_t float_to_half(float value);  // round to nearest even; overflow gives infinity

}  // namespace osteon
