// SPDX-License-Identifier: Apache-2.0
#include "osteon/synth/objects.h"

#include <gtest/gtest.h>

namespace osteon::synth {
namespace {

TEST(MakeObject, gives_valid_meshes_of_about_one_metre) {
  for (std::size_t kind = 0; kind < kObjects.size(); ++kind)
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
      SCOPED_TRACE(kObjects[kind]);
      const TriangleMesh mesh = make_object(kind, seed);
      validate(mesh);
      EXPECT_GT(surface_area(mesh), 0.05);
      EXPECT_GT(bounds(mesh).sizes().maxCoeff(), 0.3f);
      EXPECT_LT(bounds(mesh).sizes().maxCoeff(), 2.5f);
    }
}

TEST(MakeObject, gives_the_same_for_the_same_seed_and_another_for_another) {
  for (std::size_t kind = 0; kind < kObjects.size(); ++kind) {
    SCOPED_TRACE(kObjects[kind]);
    EXPECT_EQ(make_object(kind, 5).positions, make_object(kind, 5).positions);
    EXPECT_NE(make_object(kind, 5).positions, make_object(kind, 6).positions);
  }
}

}  // namespace
}  // namespace osteon::synth
