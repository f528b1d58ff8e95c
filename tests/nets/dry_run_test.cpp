// SPDX-License-Identifier: Apache-2.0
#include "osteon/nets/dry_run.h"

#include <gtest/gtest.h>

#include <array>

namespace osteon::nets {
namespace {

static_assert(Ops<DryRun>);

std::int64_t trained_values(rignet::Network network) {
  std::int64_t sum = 0;
  for (const auto& [name, shape] : rignet::parameter_shapes(network)) {
    if (name.find("running_") != std::string::npos) continue;
    std::int64_t count = 1;
    for (const std::int64_t n : shape) count *= n;
    sum += count;
  }
  return sum;
}

// The counts of the released code's networks with the same layers.
TEST(RignetParameters, are_as_many_as_in_the_published_networks) {
  EXPECT_EQ(trained_values(rignet::Network::joints), 3825859);
  EXPECT_EQ(trained_values(rignet::Network::attention), 3825345);
  EXPECT_EQ(trained_values(rignet::Network::skin), 3705285);
}

TEST(RignetParameters, are_named_by_their_place) {
  const auto shapes = rignet::parameter_shapes(rignet::Network::joints);
  EXPECT_EQ(shapes.at("gcu3.geodesic.0.linear.weight"), (std::vector<std::int64_t>{256, 512}));
  EXPECT_EQ(shapes.at("head.0.linear.weight"), (std::vector<std::int64_t>{1024, 1859}));
  EXPECT_EQ(shapes.at("head.1.norm.running_var"), (std::vector<std::int64_t>{256}));
}

TEST(EdgeArrays, begin_with_the_self_loop_and_follow_the_receivers) {
  const std::array<std::uint32_t, 3> offsets{0, 1, 2};
  const std::array<std::uint32_t, 2> members{1, 0};
  EdgeArrays edges;
  edges.add(offsets, members, 0);
  edges.add(offsets, members, 2);
  EXPECT_EQ(edges.sources, (std::vector<std::int32_t>{0, 1, 1, 0, 2, 3, 3, 2}));
  EXPECT_EQ(edges.receivers, (std::vector<std::int32_t>{0, 0, 1, 1, 2, 2, 3, 3}));
  EXPECT_EQ(edges.offsets, (std::vector<std::int32_t>{0, 2, 4, 6, 8}));
}

}  // namespace
}  // namespace osteon::nets
