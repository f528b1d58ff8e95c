// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "osteon/base/types.h"
#include "osteon/nets/graph.h"
#include "osteon/tensor/precision.h"

namespace osteon::infer {

// A trained network of NeuroSkinning (nets/neuroskinning.h), ready to run. Its outputs are the same for any number of threads; renumbering
// the vertices renumbers them and nothing else. May be used by several threads at the same time.
class NeuroskinningModel {
 public:
  // From neuroskinning.safetensors, ours, or neuroskinning_2019.safetensors, the paper's, float32 or float16. Throws Error where neither is
  // in the folder, where parameters do not fit, or where the file has no super skeleton in its metadata.
  static NeuroskinningModel load(const std::filesystem::path& folder, tensor::Precision precision = tensor::Precision::f32);
  static NeuroskinningModel load();  // from where find_models("rignet") says

  ~NeuroskinningModel();
  NeuroskinningModel(NeuroskinningModel&&) noexcept;
  NeuroskinningModel& operator=(NeuroskinningModel&&) noexcept;

  // The slots that it was trained with: skin::SuperSkeleton::from_json.
  const std::string& super_skeleton() const;
  bool has_slots() const;  // it is the paper's

  // Ours: (C,1), to be added to the logarithm of the geometric share; the paper's: (V,neuro_slots) logits.
  Matrix operator()(const nets::MeshArrays& mesh, const nets::NeuroArrays& neuro) const;

 private:
  struct Loaded;
  explicit NeuroskinningModel(std::unique_ptr<Loaded> loaded);
  std::unique_ptr<Loaded> loaded_;
};

}  // namespace osteon::infer
