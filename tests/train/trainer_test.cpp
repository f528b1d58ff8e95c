// SPDX-License-Identifier: Apache-2.0
#include "osteon/train/trainer.h"

#include <unistd.h>

#include <filesystem>

#include "osteon/base/error.h"
#include "osteon/mesh/shapes.h"
#include "support/expect.h"
#include "support/numbers.h"

namespace osteon::train {
namespace {

// A capsule with three joints along it and weights that blend between their bones.
Rig capsule_rig(float length) {
  Rig rig;
  rig.mesh = shapes::capsule(0.2f, length, 12, 6);
  const Eigen::AlignedBox3f box = bounds(rig.mesh);
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const auto along = [&](float t) {
    Vec3f p = box.center();
    p[axis] = box.min()[axis] + t * box.sizes()[axis];
    return p;
  };
  rig.skeleton.add("root", std::nullopt, along(0.15f));
  rig.skeleton.add("middle", JointId{0}, along(0.5f));
  rig.skeleton.add("tip", JointId{1}, along(0.85f));
  for (const Vec3f& p : rig.mesh.positions) {
    const float t = (p[axis] - box.min()[axis]) / box.sizes()[axis];
    rig.weights.append(std::vector<Influence>{{JointId{0}, std::max(0.0f, 1.0f - 2.0f * t)},
                                              {JointId{1}, 1.0f - std::abs(2.0f * t - 1.0f)},
                                              {JointId{2}, std::max(0.0f, 2.0f * t - 1.0f)}});
  }
  return rig;
}

std::vector<dataset::Example> capsules(Task task) {
  static const std::vector<dataset::PreparedCharacter> prepared = [] {
    dataset::PrepareOptions options;
    options.working_mesh = {150, 100, 5000};
    std::vector<dataset::PreparedCharacter> characters;
    for (const float length : {0.8f, 1.2f, 2.0f})
      characters.push_back(dataset::prepare(capsule_rig(length), {std::to_string(length), "capsules", "other"}, options));
    return characters;
  }();
  return dataset::examples_of(prepared, parts_of(task));
}

TrainOptions options_for(std::int64_t steps) {
  TrainOptions options;
  options.steps = steps;
  options.report_seconds = 0.0;  // every step
  options.seed = 7;
  options.augment = dataset::AugmentOptions::none();  // of three characters: what they teach is the same in every step
  return options;
}

std::vector<double> losses(
    Task task, Trainer& trainer, const std::function<bool()>& stop = [] { return false; }) {
  std::vector<double> found;
  trainer.run(
      capsules(task), {},
      [&](const TrainReport& r) {
        if (!r.is_validation) found.push_back(r.figures.at("loss"));
      },
      stop);
  return found;
}

// The combined loss is the vertex loss times its weight, and the rest.
TEST(Trainer, the_combined_loss_counts_the_vertex_loss_as_often_as_it_is_told) {
  const auto first_loss = [](double weight) {
    TrainOptions options = options_for(1);
    options.task.vertex_weight = weight;
    Trainer trainer(Task::collapse, options, fresh_model(Task::collapse, 1));
    return losses(Task::collapse, trainer).front();
  };
  const double without = first_loss(0.0), once = first_loss(1.0), twice = first_loss(2.0);
  EXPECT_GT(without, 0.0);
  EXPECT_GT(once, without);
  EXPECT_NEAR(twice - once, once - without, 1e-5);
}

class Learning : public ::testing::TestWithParam<Task> {};

TEST_P(Learning, thirty_steps_lower_the_loss) {
  TrainOptions options = options_for(30);
  if (GetParam() == Task::votes) options.learning_rate = 2e-4;  // votes begin in the middle of the body: larger steps first lose that
  Trainer trainer(GetParam(), options, fresh_model(GetParam(), 1));
  const std::vector<double> found = losses(GetParam(), trainer);
  ASSERT_EQ(found.size(), 30u);
  EXPECT_LT(osteon::test::mean(std::span(found).last(5)), 0.95 * osteon::test::mean(std::span(found).first(5)));
}

INSTANTIATE_TEST_SUITE_P(Rignet, Learning,
                         ::testing::Values(Task::attention, Task::joints, Task::votes, Task::collapse, Task::bones, Task::root, Task::tree,
                                           Task::skin, Task::bind));

// Also where batches share what they show.
TEST(Trainer, goes_on_after_a_stop_as_if_there_had_been_none) {
  const auto file = std::filesystem::temp_directory_path() / ("osteon_resume_" + std::to_string(::getpid()) + ".safetensors");
  for (const std::size_t echo : {1, 2}) {
    TrainOptions options = options_for(echo == 1 ? 6 : 24);
    options.checkpoint = file;
    options.echo = echo;
    if (echo > 1) options.augment = {};
    Trainer whole(Task::root, options, fresh_model(Task::root, 1)), first(Task::root, options, fresh_model(Task::root, 1)),
        second(Task::root, options, fresh_model(Task::root, 99));
    const std::vector<double> expected = losses(Task::root, whole);
    std::vector<double> found = losses(Task::root, first, [&] { return first.steps() == options.steps / 2; });
    second.resume();
    for (const double loss : losses(Task::root, second)) found.push_back(loss);
    std::filesystem::remove(file);
    EXPECT_EQ(found, expected);
  }
}

TEST(Trainer, refuses_an_echo_that_does_not_divide_the_batch) {
  TrainOptions options = options_for(1);
  options.batch_size = 4;
  options.echo = 3;
  EXPECT_EQ(test::error_of([&] { Trainer(Task::root, options, fresh_model(Task::root, 1)); }),
            "echo: found 3, expected a divisor of the 4 characters of a step");
}

TEST(Trainer, refuses_the_checkpoint_of_another_task) {
  const auto file = std::filesystem::temp_directory_path() / ("osteon_task_" + std::to_string(::getpid()) + ".safetensors");
  TrainOptions options = options_for(1);
  options.checkpoint = file;
  Trainer bones(Task::bones, options, fresh_model(Task::bones, 1)), root(Task::root, options, fresh_model(Task::root, 1));
  losses(Task::bones, bones);
  EXPECT_THROW(root.resume(), Error);
  std::filesystem::remove(file);
}

TEST(Trainer, gives_the_same_losses_for_the_same_seed) {
  Trainer a(Task::bones, options_for(3), fresh_model(Task::bones, 1)), b(Task::bones, options_for(3), fresh_model(Task::bones, 1));
  EXPECT_EQ(losses(Task::bones, a), losses(Task::bones, b));
}

}  // namespace
}  // namespace osteon::train
