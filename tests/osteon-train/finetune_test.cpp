// SPDX-License-Identifier: Apache-2.0
#include "osteon/train/finetune.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "osteon-train/program.h"
#include "osteon/base/progress.h"
#include "osteon/infer/rignet.h"
#include "osteon/io/save.h"
#include "osteon/synth/character.h"

namespace osteon {
namespace {

namespace fs = std::filesystem;
using test::coarse;
using test::content;
using test::osteon_train;
using test::Outcome;
using testing::AllOf;
using testing::HasSubstr;

void save(const fs::path& path, Rig rig) {
  io::Asset asset;
  asset.path = path;
  asset.mesh = std::move(rig.mesh);
  io::save_glb(path, asset, rig.skeleton, rig.weights);
}

// Six bipeds, two of them in a folder below.
void save_characters(const fs::path& folder) {
  fs::create_directories(folder / "more");
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
    save(folder / (seed > 4 ? "more" : "") / fmt::format("{}.glb", seed), synth::make_character(synth::Kind::Biped, seed, coarse()));
}

constexpr const char* kNetworks[] = {"votes", "bind", "neuroskinning", "tree"};

// A triangle without a skin.
constexpr const char* kTriangle = R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}],
  "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";

// network and figure -> before, after
std::map<std::string, std::pair<double, double>> table_of(const std::string& text) {
  std::map<std::string, std::pair<double, double>> table;
  std::istringstream lines(text);
  std::string line, network, figure;
  std::getline(lines, line);  // the heading
  for (double before, after; lines >> network >> figure >> before >> after;) table[network + ' ' + figure] = {before, after};
  return table;
}

TEST(Finetune, writes_a_model_folder_and_says_what_was_gained) {
  const test::TemporaryFolder folder;
  save_characters(folder / "mine");
  const Outcome run = osteon_train(folder, "finetune mine -o tuned --steps 3 --threads 1");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.err, "") << "quiet where there is no terminal";
  EXPECT_NO_THROW(infer::RignetModels::load(folder / "tuned"));
  EXPECT_FALSE(fs::exists(folder / "tuned" / "unfinished"));
  const auto super_skeleton = [](const fs::path& models) {
    return load_safetensors(models / "neuroskinning.safetensors").metadata.at("super_skeleton");
  };
  EXPECT_EQ(super_skeleton(folder / "tuned"), super_skeleton(fs::path(OSTEON_MODELS_FOLDER) / "rignet"));
  const auto table = table_of(run.out);
  for (const char* figure :
       {"votes loss", "bind loss", "tree loss", "votes to_joints", "bind l1", "neuroskinning l1", "tree parents", "tree root"})
    EXPECT_TRUE(table.contains(figure)) << figure << " in\n" << run.out;
  for (const char* network : kNetworks) {
    const auto& [before, after] = table.at(std::string(network) + " loss");
    EXPECT_LE(after, before) << network;
    const auto metadata = load_safetensors(folder / "tuned" / fmt::format("{}.safetensors", network)).metadata;
    EXPECT_THAT(metadata.at("sources"), AllOf(HasSubstr("mine"), HasSubstr("CC0"))) << "the user's and the shipped weights'";
    EXPECT_THAT(metadata.at("recipe"), HasSubstr("finetune"));
    EXPECT_TRUE(metadata.contains("commit"));
  }
}

TEST(Finetune, refuses_folders_that_it_cannot_learn_from) {
  const test::TemporaryFolder folder;
  fs::create_directories(folder / "empty");
  save(folder / "empty.glb", synth::make_character(synth::Kind::Biped, 1, coarse()));  // beside, not in
  fs::create_directories(folder / "one");
  fs::copy(folder / "empty.glb", folder / "one" / "a.glb");
  fs::create_directories(folder / "copies");
  for (const char* name : {"a.glb", "b.glb"}) fs::copy(folder / "empty.glb", folder / "copies" / name);
  fs::create_directories(folder / "bare");
  for (const char* name : {"ball.gltf", "bowl.gltf"}) std::ofstream(folder / "bare" / name) << kTriangle;
  const auto error_of = [&](const std::string& arguments) {
    const Outcome run = osteon_train(folder, "finetune -o tuned --steps 1 " + arguments);
    EXPECT_EQ(run.code, 2) << arguments;
    EXPECT_FALSE(fs::exists(folder / "tuned")) << arguments;
    return run.err;
  };
  EXPECT_THAT(error_of("missing"), AllOf(HasSubstr("missing"), HasSubstr("not a folder")));
  EXPECT_THAT(error_of("empty"), AllOf(HasSubstr("empty"), HasSubstr("found no .glb")));
  EXPECT_THAT(error_of("one"), HasSubstr("1 of 1 characters can be used, expected two"));
  EXPECT_THAT(error_of("copies"), HasSubstr("copies of one another"));
  EXPECT_THAT(error_of("bare"), AllOf(HasSubstr("ball.gltf"), HasSubstr("bowl.gltf"), HasSubstr("skin")));
  EXPECT_THAT(error_of("one --resume"), HasSubstr("no unfinished run"));
  EXPECT_THAT(error_of("one --init-models empty"), HasSubstr("votes.safetensors: not there"));
}

TEST(Finetune, says_what_is_wrong_before_it_begins) {
  const test::TemporaryFolder folder;
  save_characters(folder / "mine");
  std::ofstream(folder / "words.txt") << "words";
  for (const char* wrong :
       {"--with words.txt", "--log words.txt", "--log missing/log", "--device tpu", "--val-share nan", "--minutes nan"}) {
    const Outcome run = osteon_train(folder, fmt::format("finetune mine -o tuned {}", wrong));
    EXPECT_EQ(run.code, 2) << wrong;
    EXPECT_FALSE(fs::exists(folder / "tuned")) << wrong;
  }
}

TEST(Finetune, begins_anew_where_it_was_stopped_at_once_and_keeps_what_it_did_not_make) {
  const test::TemporaryFolder folder;
  save_characters(folder / "mine");
  fs::create_directories(folder / "tuned/unfinished");
  std::ofstream(folder / "tuned/unfinished/mine.txt") << "words";
  EXPECT_THAT(osteon_train(folder, "finetune mine -o tuned --steps 1").err, HasSubstr("is not empty"));
  EXPECT_TRUE(fs::exists(folder / "tuned/unfinished/mine.txt"));
  fs::rename(folder / "tuned/unfinished/mine.txt", folder / "tuned/unfinished/val.safetensors.tmp");
  EXPECT_EQ(osteon_train(folder, "finetune mine -o tuned --steps 1 --threads 1").code, 0);
}

TEST(Finetune, goes_on_with_the_same_options_alone) {
  const test::TemporaryFolder folder;
  save_characters(folder / "mine");
  const std::string arguments = "finetune mine -o tuned --threads 1 --log log --steps ";
  const Outcome stopped = osteon_train(folder, arguments + "1000000 & until [ -s log ]; do sleep 0.1; done; kill -TERM $!; wait $!");
  EXPECT_EQ(stopped.code, 130);
  EXPECT_THAT(osteon_train(folder, arguments + "5 --resume").err, AllOf(HasSubstr("was begun with"), HasSubstr("--steps 1000000")));
}

TEST(Finetune, reads_names_of_windows_and_leaves_out_those_that_are_no_text) {
  const test::TemporaryFolder folder;
  save_characters(folder / "mine");
  fs::rename(folder / "mine/1.glb", folder / "mine/1.GLB");
  fs::rename(folder / "mine/2.glb", folder / "mine/caf\xe9.glb");
  const Outcome run = osteon_train(folder, "finetune mine -o tuned --steps 1 --threads 1");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("not in UTF-8"));
  EXPECT_THAT(load_safetensors(folder / "tuned/votes.safetensors").metadata.at("sources"), HasSubstr("\"characters\":5"));
}

TEST(Curves, draw_a_line_for_each_log) {
  const test::TemporaryFolder folder;
  for (const char* name : {"first", "second"})
    std::ofstream(folder / fmt::format("{}.log", name)) << R"({"step":1,"seconds":1,"kind":"training","loss":3.0}
{"step":10,"seconds":9,"kind":"validation","loss":2.0,"l1":0.5}
{"step":20,"seconds":19,"kind":"validation","loss":1.5,"l1":0.4}
)";
  ASSERT_EQ(osteon_train(folder, "curves first.log second.log -o curves.svg --figure l1").code, 0);
  EXPECT_THAT(content(folder / "curves.svg"),
              AllOf(HasSubstr("<svg"), HasSubstr("first"), HasSubstr("second"), HasSubstr("validation l1")));
  const Outcome none = osteon_train(folder, "curves first.log -o none.svg --figure f1");
  EXPECT_EQ(none.code, 2);
  EXPECT_THAT(none.err, AllOf(HasSubstr("first.log"), HasSubstr("f1")));
  std::ofstream(folder / "bad.log") << "nonsense\n";
  EXPECT_THAT(osteon_train(folder, "curves bad.log -o none.svg").err, AllOf(HasSubstr("bad.log"), HasSubstr("line 1")));
  std::ofstream(folder / "bad.log") << R"({"step":1,"kind":"validation","loss":"much"})";
  EXPECT_THAT(osteon_train(folder, "curves bad.log -o none.svg").err, AllOf(HasSubstr("bad.log"), HasSubstr("line 1")));
  std::ofstream(folder / "first.log", std::ios::app) << R"({"step":30,"kind":"validation","loss":null,"l1":null})";
  EXPECT_EQ(osteon_train(folder, "curves first.log -o curves.svg").code, 0) << "of a loss that was not finite";
}

class FinetuneData : public testing::Test {
 protected:
  static train::FinetuneData data() {
    static const std::vector<dataset::PreparedCharacter> characters = test::prepared_bipeds(6);
    return {{characters.begin(), characters.end() - 2}, {characters.end() - 2, characters.end()}, {}};
  }
  train::FinetuneOptions options(const std::string& name) const {
    train::FinetuneOptions out;
    out.init = fs::path(OSTEON_MODELS_FOLDER) / "rignet";
    out.output = folder_ / name;
    out.checkpoints = folder_ / (name + "-checkpoints");
    out.steps = 4;
    out.report_seconds = 0.0;
    fs::create_directories(out.output);
    fs::create_directories(out.checkpoints);
    return out;
  }
  test::TemporaryFolder folder_;
};

TEST_F(FinetuneData, figures_are_those_of_a_fresh_validation_of_the_files) {
  const auto results = train::finetune(
      data(), options("a"), [](const auto&, const auto&) {}, [] { return false; });
  ASSERT_EQ(results.size(), std::size(kNetworks));
  const auto validation = dataset::examples_of(data().validation, train::parts_of(train::Task::bind));
  const auto fresh = [&](const fs::path& folder) {
    train::Model model;
    model["bind"] = train::load_weights(folder / "bind.safetensors", nets::rignet::Network::bind);
    train::TaskOptions task;
    task.batch.parts = train::parts_of(train::Task::bind);
    return train::validate(train::Task::bind, model, validation, task);
  };
  EXPECT_EQ(results[1].name, "bind");
  EXPECT_EQ(results[1].before, fresh(options("a").init));
  EXPECT_EQ(results[1].after, fresh(options("a").output));
}

TEST_F(FinetuneData, stopped_and_gone_on_with_gives_the_same_bytes) {
  const auto quiet = [](const auto&, const auto&) {};
  train::finetune(data(), options("whole"), quiet, [] { return false; });
  for (bool finished = false; !finished;) {  // every run is stopped after three steps
    int steps = 0;
    try {
      train::finetune(data(), options("parts"), quiet, [&] { return ++steps > 3; });
      finished = true;
    } catch (const Cancelled&) {
    }
  }
  for (const char* network : kNetworks) {
    const auto whole = load_safetensors(folder_ / "whole" / fmt::format("{}.safetensors", network)),
               parts = load_safetensors(folder_ / "parts" / fmt::format("{}.safetensors", network));
    for (const auto& [name, array] : whole.arrays) EXPECT_EQ(array.bytes, parts.at(name).bytes) << network << ' ' << name;
  }
}

TEST_F(FinetuneData, what_the_start_lacks_is_not_tuned) {
  train::FinetuneOptions three = options("three");
  const fs::path init = folder_ / "init";
  fs::create_directories(init);
  for (const char* name : {"votes", "bind", "tree"})
    fs::copy(three.init / fmt::format("{}.safetensors", name), init / fmt::format("{}.safetensors", name));
  three.init = init;
  const auto results = train::finetune(
      data(), three, [](const auto&, const auto&) {}, [] { return false; });
  ASSERT_EQ(results.size(), 3u);
  EXPECT_FALSE(fs::exists(three.output / "neuroskinning.safetensors"));
}

TEST_F(FinetuneData, weights_without_the_joints_that_they_read_are_refused) {
  train::FinetuneOptions bare = options("bare");
  const fs::path init = folder_ / "nameless";
  fs::copy(bare.init, init);
  Safetensors content = load_safetensors(init / "neuroskinning.safetensors");
  content.metadata.erase("super_skeleton");
  save_safetensors(init / "neuroskinning.safetensors", content);
  bare.init = init;
  bare.steps = 1;
  const auto tune = [&] {
    train::finetune(
        data(), bare, [](const auto&, const auto&) {}, [] { return false; });
  };
  EXPECT_THAT(tune, testing::ThrowsMessage<Error>(AllOf(HasSubstr("neuroskinning.safetensors"), HasSubstr("super skeleton"))));
}

TEST_F(FinetuneData, general_characters_are_shown_too) {
  auto with = data();
  with.general = {with.own.back()};
  with.own.pop_back();
  std::vector<double> losses;
  train::finetune(
      with, options("general"), [&](const std::string&, const train::TrainReport& r) { losses.push_back(r.figures.at("loss")); },
      [] { return false; });
  EXPECT_GE(losses.size(), 12u);
}

}  // namespace
}  // namespace osteon
