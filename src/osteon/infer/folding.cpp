// SPDX-License-Identifier: Apache-2.0
#include "osteon/infer/folding.h"

#include <cmath>

namespace osteon::infer {
namespace {

using Vector = Eigen::VectorXd;  // biases are sums, so in double

Eigen::Map<const Eigen::VectorXf> vector(const std::vector<float>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}
std::vector<float> narrow(const Vector& values) {
  const Eigen::VectorXf floats = values.cast<float>();
  return {floats.begin(), floats.end()};
}

struct Layer {
  Matrix weights;
  Vector bias;
};

Layer linear_at(const Parameters& parameters, const nets::Path& path) {
  return {parameters.at(path / "weight"), parameters.at(path / "bias").row(0).transpose().cast<double>()};
}

Layer folded(Layer layer, const Affine& input) {
  const Vector shift = vector(input.shift).cast<double>();
  const auto scale = vector(input.scale).transpose().array();
  for (Eigen::Index r = 0; r < layer.weights.rows(); ++r) {
    auto row = layer.weights.row(r);
    layer.bias[r] += row.cast<double>().dot(shift);
    row.array() *= scale;
  }
  return layer;
}

}  // namespace

Affine normalization(const Parameters& parameters, const nets::Path& path) {
  auto figure = [&](const char* name) { return parameters.at(path / name).row(0).transpose().cast<double>().array().eval(); };
  const Eigen::ArrayXd scale = figure("weight") / (figure("running_var") + nets::norm_epsilon).sqrt();
  return {narrow(scale), narrow(figure("bias") - figure("running_mean") * scale)};
}

tensor::DenseLayer folded_linear(const Parameters& parameters, const nets::Path& path, const Affine& input, tensor::Activation activation,
                                 tensor::Precision precision) {
  Layer layer = folded(linear_at(parameters, path), input);
  return {std::move(layer.weights), narrow(layer.bias), activation, precision};
}

tensor::EdgeConvolution::Weights folded_edge_convolution(const Parameters& parameters, const nets::Path& path, const Affine& input,
                                                         tensor::Precision precision) {
  const Layer first = linear_at(parameters, path / 0 / "linear");
  Layer second = folded(linear_at(parameters, path / 1 / "linear"), normalization(parameters, path / 0 / "norm"));
  const Affine last = normalization(parameters, path / 1 / "norm");
  const Eigen::Index width = first.weights.rows(), columns = first.weights.cols() / 2;

  // [A|B] [x_v; x_u - x_v] + b = ((A - B) x_v + b) + B x_u
  const auto receiver = first.weights.leftCols(columns), difference = first.weights.rightCols(columns);
  Layer ends{Matrix(2 * width, columns), Vector(2 * width)};
  ends.weights << receiver - difference, difference;
  ends.bias << first.bias, Vector::Zero(width);
  ends = folded(ends, input);

  std::vector<float> sign;
  for (Eigen::Index r = 0; r < width; ++r) {
    sign.push_back(last.scale[static_cast<std::size_t>(r)] < 0 ? -1.0f : 1.0f);
    second.weights.row(r) *= sign.back();
  }
  return {{std::move(ends.weights), narrow(ends.bias), tensor::Activation::none, precision},
          std::move(second.weights),
          sign,
          narrow(second.bias)};
}

}  // namespace osteon::infer
