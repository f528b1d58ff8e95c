// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

namespace osteon::nets {

// The name of a parameter, made where it is used: Path("joints") / "gcu1" / 0 is "joints.gcu1.0". An empty path adds no dot.
class Path {
 public:
  Path() = default;
  explicit Path(std::string_view name) : name_(name) {}

  Path operator/(std::string_view part) const { return Path(name_.empty() ? std::string(part) : name_ + '.' + std::string(part)); }
  Path operator/(int part) const { return *this / std::to_string(part); }
  const std::string& name() const { return name_; }

 private:
  std::string name_;
};

// PyTorch's default is 1e-5. A channel that is nearly always zero has next to no variance; on the rare mesh where it is not, it then
// explodes by a factor of hundreds (seen in training), and with this one by thirty.
constexpr double norm_epsilon = 1e-3;

// What a network is written over: a backend that holds the parameters by path and runs the operations.
//   Tensor  (N,C) floats, rows are vertices, edges, joints, pairs or meshes; cheap to copy (a handle)
//   Index   (N) 32-bit row numbers; cheap to copy
// linear      y = x W^T + b; parameters path.weight (n,C), path.bias (n)
// batch_norm  y = weight (x - mean) / sqrt(var + norm_epsilon) + bias per column; parameters path.weight, path.bias, path.running_mean,
//             path.running_var, each (C). Use: the running figures; training: those of the batch
// concat      the columns of all, side by side
// rows        y[k] = x[index[k]]
// max_by      y[s] = max of the rows offsets[s] .. offsets[s+1]-1 of x, column by column; every segment has a row
// mean_of     y[v] = mean of the rows sources[offsets[v]] .. sources[offsets[v+1]-1] of x; every segment has a row
// attend      the same sum weighted, in each of `heads` equal blocks of the columns by itself: with the softmax, over the segment, of the
//             dot products x[v] . x[sources[e]]. As many segments as rows
// A backend may have faster exact members for composites: see layers.h.
template <class B>
concept Ops = requires(B b, const Path& path, const typename B::Tensor& x, const typename B::Index& index, int n,
                       std::span<const float> values, std::span<const std::int32_t> numbers,
                       std::initializer_list<typename B::Tensor> several) {
  { b.tensor(values, n, n) } -> std::same_as<typename B::Tensor>;  // values, rows, columns; row-major
  { b.index(numbers) } -> std::same_as<typename B::Index>;
  { b.linear(path, x, n) } -> std::same_as<typename B::Tensor>;
  { b.batch_norm(path, x) } -> std::same_as<typename B::Tensor>;
  { b.relu(x) } -> std::same_as<typename B::Tensor>;
  { b.subtract(x, x) } -> std::same_as<typename B::Tensor>;
  { b.concat(several) } -> std::same_as<typename B::Tensor>;
  { b.rows(x, index) } -> std::same_as<typename B::Tensor>;
  { b.max_by(x, index) } -> std::same_as<typename B::Tensor>;
  { b.mean_of(x, index, index) } -> std::same_as<typename B::Tensor>;    // x, offsets, sources
  { b.attend(x, index, index, n) } -> std::same_as<typename B::Tensor>;  // x, offsets, sources, heads
};

}  // namespace osteon::nets
