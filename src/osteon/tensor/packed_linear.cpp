// SPDX-License-Identifier: Apache-2.0
#include "osteon/tensor/packed_linear.h"

#include <omp.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <oneapi/dnnl/dnnl.hpp>

#include "osteon/tensor/tensor.h"

namespace osteon::tensor {
namespace {

using dnnl::memory;

constexpr std::size_t tail_rows = 16;  // the only height beside the tile's: both give the same bits on AVX-512, AVX2 and SSE4.1

// oneDNN asks OpenMP how many threads the calling thread may use, when a primitive is made and when it runs.
class OneThread {
 public:
  OneThread() : before_(omp_get_max_threads()) { omp_set_num_threads(1); }
  ~OneThread() { omp_set_num_threads(before_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int before_;
};

const dnnl::engine& engine() {
  static const dnnl::engine cpu(dnnl::engine::kind::cpu, 0);
  return cpu;
}

dnnl::stream& stream() {
  thread_local dnnl::stream in_order(engine());
  return in_order;
}

memory::dim dim(std::size_t n) { return static_cast<memory::dim>(n); }

memory::desc dense(std::size_t rows, std::size_t columns, memory::data_type type = memory::data_type::f32) {
  return {{dim(rows), dim(columns)}, type, memory::format_tag::ab};
}

// Narrow layers take longer to convert than to multiply, and the narrow ones at both ends of a network read and write positions.
Precision worth_it(std::size_t inputs, std::size_t outputs, Precision precision) {
  return inputs >= 64 && outputs >= 32 ? precision : Precision::f32;
}

memory::data_type type_of(Precision precision) { return precision == Precision::bf16 ? memory::data_type::bf16 : memory::data_type::f32; }

// Small products cost about a microsecond to start, so they take more rows at a time; the tile stays within the second-level cache.
std::size_t rows_per_tile(std::size_t inputs, std::size_t outputs) { return std::max(inputs, outputs) <= 128 ? 128 : 64; }

dnnl::matmul::primitive_desc describe(std::size_t rows, std::size_t inputs, std::size_t outputs, const memory::desc& weights,
                                      Activation activation) {
  dnnl::primitive_attr attributes;
  attributes.set_scratchpad_mode(dnnl::scratchpad_mode::user);  // the library's own scratchpad belongs to the creating thread
  if (activation == Activation::relu) {
    dnnl::post_ops after;
    after.append_eltwise(1.0f, dnnl::algorithm::eltwise_relu, 0.0f, 0.0f);
    attributes.set_post_ops(after);
  }
  return {dnnl::matmul::desc(dense(rows, inputs, weights.data_type()), weights, dense(1, outputs), dense(rows, outputs)), attributes,
          engine()};
}

// A product of one height.
struct Product {
  dnnl::matmul::primitive_desc description;
  dnnl::matmul primitive;
  std::size_t rows;
  std::size_t scratch_floats;

  Product(std::size_t height, std::size_t inputs, std::size_t outputs, const memory::desc& weights, Activation activation)
      : description(describe(height, inputs, outputs, weights, activation)),
        primitive(description),
        rows(height),
        scratch_floats((description.scratchpad_desc().get_size() + sizeof(float) - 1) / sizeof(float)) {}
};

}  // namespace

bool has_bf16() {
  const auto isa = dnnl::get_effective_cpu_isa();
  return isa == dnnl::cpu_isa::avx512_core_bf16 || isa == dnnl::cpu_isa::avx512_core_amx;
}

float* thread_scratch(int slot, std::size_t count) {
  struct Slot {
    std::shared_ptr<float[]> floats;
    std::size_t size = 0;
  };
  thread_local std::array<Slot, 10> slots;
  Slot& s = slots.at(static_cast<std::size_t>(slot));
  if (s.size < count) s = {aligned_floats(count), count};
  return s.floats.get();
}

struct PackedLinear::Kernels {
  std::size_t inputs, outputs;
  Precision precision;
  Product tile, tail;
  memory weights, bias;

  Kernels(const Matrix& w, std::span<const float> b, Activation activation, Precision wanted)
      : inputs(static_cast<std::size_t>(w.cols())),
        outputs(static_cast<std::size_t>(w.rows())),
        precision(worth_it(inputs, outputs, wanted)),
        tile(rows_per_tile(inputs, outputs), inputs, outputs, {{dim(inputs), dim(outputs)}, type_of(precision), memory::format_tag::any},
             activation),
        tail(tail_rows, inputs, outputs, tile.description.weights_desc(), activation),
        weights(tile.description.weights_desc(), engine()),
        bias(dense(1, outputs), engine()) {
    assert(b.empty() || b.size() == outputs);
    auto* shift = static_cast<float*>(bias.get_data_handle());
    std::fill_n(shift, outputs, 0.0f);
    std::copy(b.begin(), b.end(), shift);
    const memory::desc transposed({dim(inputs), dim(outputs)}, memory::data_type::f32, memory::format_tag::ba);
    memory plain(transposed, engine(), const_cast<float*>(w.data()));
    dnnl::reorder(plain, weights).execute(stream(), plain, weights);
    stream().wait();
  }

  void run(const Product& product, const float* in, float* out) const {
    const void* from = in;
    if (precision == Precision::bf16) {
      auto* rounded = reinterpret_cast<std::uint16_t*>(thread_scratch(8, (product.rows * inputs + 1) / 2));
      to_bf16(in, product.rows * inputs, rounded);
      from = rounded;
    }
    const memory source(product.description.src_desc(), engine(), const_cast<void*>(from));
    const memory destination(product.description.dst_desc(), engine(), out);
    const memory scratch(product.description.scratchpad_desc(), engine(), thread_scratch(0, product.scratch_floats));
    product.primitive.execute(stream(), {{DNNL_ARG_SRC, source},
                                         {DNNL_ARG_WEIGHTS, weights},
                                         {DNNL_ARG_BIAS, bias},
                                         {DNNL_ARG_DST, destination},
                                         {DNNL_ARG_SCRATCHPAD, scratch}});
  }

  // Fewer rows than the tail product has: through storage that has them all.
  void run_padded(const float* in, std::size_t rows, float* out) const {
    float* padded_in = thread_scratch(1, tail_rows * inputs);
    float* padded_out = thread_scratch(2, tail_rows * outputs);
    std::copy_n(in, rows * inputs, padded_in);
    std::fill_n(padded_in + rows * inputs, (tail_rows - rows) * inputs, 0.0f);
    run(tail, padded_in, padded_out);
    std::copy_n(padded_out, rows * outputs, out);
  }
};

PackedLinear::PackedLinear(const Matrix& weights, std::span<const float> bias, Activation activation, Precision precision) {
  assert(precision == Precision::f32 || has_bf16());
  const OneThread scope;
  kernels_ = std::make_unique<Kernels>(weights, bias, activation, precision);
}
PackedLinear::~PackedLinear() = default;
PackedLinear::PackedLinear(PackedLinear&&) noexcept = default;
PackedLinear& PackedLinear::operator=(PackedLinear&&) noexcept = default;

std::size_t PackedLinear::inputs() const { return kernels_->inputs; }
std::size_t PackedLinear::outputs() const { return kernels_->outputs; }
std::size_t PackedLinear::tile_rows() const { return kernels_->tile.rows; }

void PackedLinear::operator()(const float* in, std::size_t rows, float* out) const {
  const OneThread scope;
  const Kernels& k = *kernels_;
  std::size_t done = 0;
  for (; done + k.tile.rows <= rows; done += k.tile.rows) k.run(k.tile, in + done * k.inputs, out + done * k.outputs);
  for (; done + tail_rows <= rows; done += tail_rows) k.run(k.tail, in + done * k.inputs, out + done * k.outputs);
  if (done < rows) k.run_padded(in + done * k.inputs, rows - done, out + done * k.outputs);
}

}  // namespace osteon::tensor
