// SPDX-License-Identifier: Apache-2.0
// Training one network, as users run it.
#include "osteon-train/program.h"
#include "osteon/base/safetensors.h"
#include "osteon/dataset/pack.h"

namespace osteon {
namespace {

namespace fs = std::filesystem;
using test::osteon_train;
using testing::AllOf;
using testing::HasSubstr;

class Training : public testing::Test {
 protected:
  void SetUp() override {
    static const std::vector<dataset::PreparedCharacter> characters = test::prepared_bipeds(2);
    dataset::save_characters(folder_ / "train.safetensors", characters, {{"sources", "[]"}});
    std::ofstream(folder_ / "words.txt") << "words";
  }

  test::Outcome train(const std::string& arguments) const {
    return osteon_train(folder_, "rignet.tree --data train.safetensors --threads 1 --out tree.safetensors " + arguments);
  }

  // Ends with 2 and says `why`, and all files are as before.
  void expect_refused(const std::string& arguments, const std::string& why) const {
    const auto before = files_of(folder_);
    const auto run = train(arguments);
    EXPECT_EQ(run.code, 2) << arguments;
    EXPECT_THAT(run.err, AllOf(HasSubstr("error: "), HasSubstr(why))) << arguments;
    EXPECT_TRUE(files_of(folder_) == before) << arguments;
  }

  test::TemporaryFolder folder_;
};

TEST_F(Training, overwrites_no_input_and_no_other_output) {
  for (const char* option : {"--checkpoint", "--log"}) {
    expect_refused(fmt::format("--steps 1 {} train.safetensors", option), "train.safetensors would be overwritten");
    expect_refused(fmt::format("--steps 1 {} ./tree.safetensors", option), "tree.safetensors would be overwritten");
    expect_refused(fmt::format("--steps 1 {} missing/file", option), "there is no folder missing");
    expect_refused(fmt::format("--steps 1 {} .", option), "is a folder");
    expect_refused(fmt::format("--steps 1 {} /proc/file", option), "cannot be written");
  }
  expect_refused("--steps 1 --log state --checkpoint state", "would be overwritten");
  expect_refused("--steps 1 --log words.txt", "words.txt: is there already and no log");
  expect_refused("--steps 1 --checkpoint words.txt", "words.txt: is there already: go on from it with --resume");
  expect_refused("--steps 1 --checkpoint words.txt --resume", "words.txt: ");
  expect_refused("--steps 1 --resume", "--resume requires --checkpoint");
}

TEST_F(Training, refuses_numbers_out_of_range) {
  for (const char* option :
       {"--batch 0", "--batch -1", "--lr nan", "--lr 0", "--warm-up 1", "--momentum 2", "--clip -1", "--weight-decay nan", "--bend -1",
        "--proportion nan", "--articulate nan", "--shares nan", "--neighbours -1", "--seed -1", "--minutes nan"}) {
    const std::string text(option);
    const std::size_t space = text.find(' ');
    expect_refused("--steps 1 " + text, fmt::format("{}: found {}, expected", text.substr(0, space), text.substr(space + 1)));
  }
  expect_refused("--steps 1 --shares 0", "--shares: found no number above 0");
  expect_refused("--steps 1 --device tpu", "--device: found tpu, expected cpu, cuda or cuda:N");
  expect_refused("", "training needs an end");
}

TEST_F(Training, that_goes_astray_leaves_the_weights_of_before) {
  std::ofstream(folder_ / "tree.safetensors") << "good weights";
  expect_refused("--steps 2 --lr 1e30 --validate-seconds 0", "no longer finite");
}

TEST_F(Training, that_is_stopped_says_so_and_can_be_gone_on_with) {
  const auto stopped = train(
      "--steps 1000000 --report-seconds 0 --log log --checkpoint state & until [ -s log ]; do sleep 0.1; done; "
      "kill -TERM $!; wait $!");
  EXPECT_EQ(stopped.code, 130);
  EXPECT_THAT(test::content(folder_ / "err.txt"), AllOf(HasSubstr("stopped after"), HasSubstr("--resume goes on")));
  EXPECT_TRUE(fs::exists(folder_ / "tree.safetensors"));
  EXPECT_EQ(train("--steps 1 --checkpoint state --resume").code, 0) << "more steps than that are done";
}

}  // namespace
}  // namespace osteon
