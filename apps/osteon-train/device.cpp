// SPDX-License-Identifier: Apache-2.0
#include "device.h"

#include <ATen/Context.h>

#include <algorithm>

#include "osteon/base/error.h"

namespace osteon::app {

void choose_device(const std::string& name, train::RunOptions& run) {
  const bool is_numbered = name.starts_with("cuda:") && name.size() > 5 && name.size() < 8;
  const bool is_cuda =
      name == "cuda" || (is_numbered && std::all_of(name.begin() + 5, name.end(), [](char c) { return c >= '0' && c <= '9'; }));
  if (name != "cpu" && !is_cuda) throw Error("--device: found {}, expected cpu, cuda or cuda:N", name);
  if (is_cuda && !at::hasCUDA()) throw Error("--device: found {}, but this LibTorch finds no GPU", name);
  run.device = at::Device(name);
  run.engine = is_cuda ? train::Engine::device : train::Engine::fused;
  if (is_cuda) at::globalContext().setAllowTF32CuBLAS(true);  // as exact as bf16 with f32 sums needs to be here
}

}  // namespace osteon::app
