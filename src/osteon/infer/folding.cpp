// SPDX-License-Identifier: Apache-2.0
#include "osteon/infer/folding.h"

#include <cmath>

namespace osteon::infer {
namespace {

// Folding is done in double: its rounding would otherwise add to that of every product.
using Wide = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using WideVector = Eigen::VectorXd;

WideVector wide(const std::vector<float>& values) {
  return Eigen::Map<const Eigen::VectorXf>(values.data(), static_cast<Eigen::Index>(values.size())).cast<double>();
}
std::vector<float> narrow(const WideVector& values) {
  const Eigen::VectorXf floats = values.cast<float>();
  return {floats.begin(), floats.end()};
}

struct WideLayer {
  Wide weights;
  WideVector bias;
};

WideLayer linear_at(const Parameters& parameters, const nets::Path& path) {
  return {parameters.at(path / "weight").cast<double>(), parameters.at(path / "bias").row(0).transpose().cast<double>()};
}

WideLayer folded(const WideLayer& layer, const Affine& input) {
  return {layer.weights * wide(input.scale).asDiagonal(), layer.bias + layer.weights * wide(input.shift)};
}

}  // namespace

Affine normalization(const Parameters& parameters, const nets::Path& path) {
  constexpr double epsilon = 1e-5;  // PyTorch's default, with which the networks are trained
  auto figure = [&](const char* name) { return parameters.at(path / name).row(0).transpose().cast<double>().array().eval(); };
  const Eigen::ArrayXd scale = figure("weight") / (figure("running_var") + epsilon).sqrt();
  return {narrow(scale), narrow(figure("bias") - figure("running_mean") * scale)};
}

tensor::DenseLayer folded_linear(const Parameters& parameters, const nets::Path& path, const Affine& input, tensor::Activation activation) {
  const WideLayer layer = folded(linear_at(parameters, path), input);
  return {layer.weights.cast<float>(), narrow(layer.bias), activation};
}

tensor::EdgeConvolution::Weights folded_edge_convolution(const Parameters& parameters, const nets::Path& path, const Affine& input) {
  const WideLayer first = linear_at(parameters, path / 0 / "linear");
  const WideLayer second = folded(linear_at(parameters, path / 1 / "linear"), normalization(parameters, path / 0 / "norm"));
  const Affine last = normalization(parameters, path / 1 / "norm");
  const Eigen::Index width = first.weights.rows(), columns = first.weights.cols() / 2;

  // [A|B] [x_v; x_u - x_v] + b = ((A - B) x_v + b) + B x_u
  const auto receiver = first.weights.leftCols(columns), difference = first.weights.rightCols(columns);
  WideLayer ends{Wide(2 * width, columns), WideVector(2 * width)};
  ends.weights << receiver - difference, difference;
  ends.bias << first.bias, WideVector::Zero(width);
  ends = folded(ends, input);

  std::vector<float> sign;
  for (const float scale : last.scale) sign.push_back(scale < 0 ? -1.0f : 1.0f);
  return {{ends.weights.cast<float>(), narrow(ends.bias), tensor::Activation::none},
          (wide(sign).asDiagonal() * second.weights).cast<float>(),
          sign,
          narrow(second.bias)};
}

}  // namespace osteon::infer
