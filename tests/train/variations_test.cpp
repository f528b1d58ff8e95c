// SPDX-License-Identifier: Apache-2.0
#include "osteon/train/variations.h"

#include <atomic>

#include "osteon/base/parallel.h"
#include "support/expect.h"

namespace osteon::train {
namespace {

// A share of a batch: one character named after its stream. Counts how many are made.
struct Named {
  std::shared_ptr<std::atomic<int>> made = std::make_shared<std::atomic<int>>(0);
  Variations::Characters operator()(std::uint64_t stream) const {
    ++*made;
    auto one = std::make_shared<dataset::Example>();
    one->character.info.id = std::to_string(stream);
    return {one};
  }
};

std::vector<std::string> names(const Variations::Characters& characters) {
  std::vector<std::string> out;
  for (const auto& c : characters) out.push_back(c->character.info.id);
  return out;
}

using Names = std::vector<std::string>;

TEST(Variations, are_new_in_every_step_without_an_echo) {
  Variations variations(Named{}, 1);
  EXPECT_EQ(names(variations.of(0)), Names{"0"});
  EXPECT_EQ(names(variations.of(40)), Names{"40"});
}

TEST(Variations, are_shown_again_a_stride_later_until_the_echo_ends) {
  constexpr std::uint64_t stride = Variations::kEchoStride;
  Variations variations(Named{}, 3);
  EXPECT_EQ(names(variations.of(2)), (Names{"6", "7", "8"}));  // nothing was shown a stride before: all new
  EXPECT_EQ(names(variations.of(2 + stride)), (Names{std::to_string(3 * (2 + stride)), "6", std::to_string(3 * (2 + stride) + 2)}));
  EXPECT_EQ(names(variations.of(2 + 2 * stride)), (Names{std::to_string(3 * (2 + 2 * stride)), std::to_string(3 * (2 + stride)), "6"}));
  EXPECT_THAT(names(variations.of(2 + 3 * stride)), testing::Not(testing::Contains("6")));
}

TEST(Variations, of_a_run_that_goes_on_later_are_the_same) {
  Variations whole(Named{}, 4), later(Named{}, 4);
  for (std::uint64_t step = 0; step < 100; ++step) {
    const Names expected = names(whole.of(step));
    if (step >= 57) EXPECT_EQ(names(later.of(step)), expected);
  }
}

TEST(Variations, are_made_once_by_any_number_of_threads) {
  const int before = threads();
  for (const int n : {1, 4}) {
    set_threads(n);
    const Named named;
    Variations variations(named, 4);
    std::vector<Names> found(128);
    parallel_for(found.size(), 1, [&](std::size_t step, std::size_t) { found[step] = names(variations.of(step)); });
    // One a step, and those that the first steps have for want of earlier ones. (A thread may lag behind: what was dropped is made again.)
    const int least = 128 + static_cast<int>((1 + 2 + 3) * Variations::kEchoStride);
    if (n == 1) EXPECT_EQ(*named.made, least);
    EXPECT_GE(*named.made, least);
    Variations again(Named{}, 4);
    for (std::uint64_t step = 0; step < found.size(); ++step) EXPECT_EQ(found[step], names(again.of(step)));
  }
  set_threads(before);
}

TEST(Variations, are_let_go_after_they_were_shown_for_the_last_time) {
  constexpr std::uint64_t stride = Variations::kEchoStride;
  Variations variations(Named{}, 2);
  const std::weak_ptr<const dataset::Example> first = variations.of(0).front();
  EXPECT_FALSE(first.expired());
  variations.of(stride);
  EXPECT_TRUE(first.expired());
}

TEST(Variations, throw_what_making_them_threw) {
  Variations variations([](std::uint64_t) -> Variations::Characters { throw Error("a bad character"); }, 2);
  EXPECT_EQ(test::error_of([&] { variations.of(0); }), "a bad character");
}

}  // namespace
}  // namespace osteon::train
