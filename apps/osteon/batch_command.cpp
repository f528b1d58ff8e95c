// SPDX-License-Identifier: Apache-2.0
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "../interrupt.h"
#include "../progress_bar.h"
#include "commands.h"
#include "osteon/base/parallel.h"
#include "osteon/base/progress.h"
#include "osteon/io/bytes.h"
#include "rig_job.h"
#include "rig_report.h"

namespace osteon::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

struct BatchArguments {
  fs::path input, output;
  bool again = false, previews = false;
  RigOptions options;
};

// One character of the folder, and what becomes of it.
struct Job {
  fs::path input, name;  // name: of the output beside the folder's, without extension
  std::string settings;  // what the result depends on, beside the program
  Json earlier;          // the report of an earlier run, if there is one
  Json report;           // what is, or will be, in the report's file
};

constexpr std::array kExtensions{".glb", ".gltf", ".obj", ".ply", ".stl", ".fbx", ".dae", ".3ds", ".vrm"};

bool is_character(const fs::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::ranges::find(kExtensions, extension) != kExtensions.end();
}

bool is_within(const fs::path& file, const fs::path& folder) {
  const fs::path relative = fs::weakly_canonical(file).lexically_relative(fs::weakly_canonical(folder));
  return !relative.empty() && *relative.begin() != "..";
}

// All characters below the folder, in the order of their names, but not what an earlier run wrote.
std::vector<fs::path> characters_in(const BatchArguments& arguments) {
  if (!fs::is_directory(arguments.input)) throw Error("{}: expected a folder of characters", arguments.input.string());
  std::vector<fs::path> files;
  std::error_code no_file;  // a link that leads nowhere stops no other
  for (const auto& entry : fs::recursive_directory_iterator(arguments.input, fs::directory_options::skip_permission_denied))
    if (entry.is_regular_file(no_file) && is_character(entry.path()) && !is_within(entry.path(), arguments.output))
      files.push_back(entry.path());
  if (files.empty()) throw Error("{}: found no characters, expected files {}", arguments.input.string(), fmt::join(kExtensions, ", "));
  std::ranges::sort(files);
  return files;
}

std::string state_of(const fs::path& file) {
  return fmt::format("{} bytes, changed {}", fs::file_size(file), fs::last_write_time(file).time_since_epoch().count());
}

// Of what a rig follows from beside the character and the options: with other weights, or another skeleton, it is rigged again. What is
// missing is told when it is loaded.
std::string state_of_models(const RigOptions& options) {
  std::set<fs::path> files;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(options.models.weights(), missing))
    if (entry.path().extension() == ".safetensors") files.insert(entry.path());
  if (options.skeleton && fs::exists(*options.skeleton, missing)) files.insert(*options.skeleton);
  std::string states;
  for (const fs::path& file : files) states += fmt::format("; {} {}", file.filename().string(), state_of(file));
  return states;
}

// hero.obj becomes hero.glb; where hero.fbx lies beside it, hero.obj.glb and hero.fbx.glb.
std::vector<Job> jobs_of(const BatchArguments& arguments, const std::string& settings) {
  std::vector<Job> jobs;
  std::map<fs::path, int> of_name;
  // By the names alone: fs::relative follows links, and the results of a folder of links would go to where these point.
  const auto below = [&](const fs::path& file) { return file.lexically_relative(arguments.input); };
  const auto bare = [&](const fs::path& file) { return below(file).replace_extension(); };
  const std::vector<fs::path> files = characters_in(arguments);
  for (const fs::path& file : files) ++of_name[bare(file)];
  for (const fs::path& file : files) {
    const fs::path name = of_name[bare(file)] > 1 ? below(file) : bare(file);
    if (name.empty() || name.is_absolute() || *name.begin() == "..")
      throw Error("{}: expected a file below {}", file.string(), arguments.input.string());
    jobs.push_back({file, name, fmt::format("{}; {}", settings, state_of(file)), {}, {}});
  }
  return jobs;
}

fs::path output_of(const BatchArguments& arguments, const Job& job, const char* extension) {
  return arguments.output / (job.name.string() + extension);
}

// What a run that was killed left of these results: files on their way, named RESULT.PROCESS.tmp (io::write_file). Nothing else in the
// folder is ours to remove.
void remove_leftovers(const BatchArguments& arguments, const std::vector<Job>& jobs) {
  std::set<fs::path> results, folders{arguments.output};
  for (const Job& job : jobs)
    for (const char* extension : {".glb", ".png", ".json"}) {
      const fs::path result = output_of(arguments, job, extension);
      results.insert(result);
      folders.insert(result.parent_path());
    }
  results.insert(arguments.output / "summary.csv");
  static const std::regex on_its_way(R"((.*)\.[0-9]+\.tmp)");
  for (const fs::path& folder : folders) {
    if (!fs::is_directory(folder)) continue;
    std::vector<fs::path> left;
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      std::smatch parts;
      if (entry.is_regular_file() && std::regex_match(name, parts, on_its_way) && results.contains(folder / parts[1].str()))
        left.push_back(entry.path());
    }
    for (const fs::path& file : left) fs::remove(file);
  }
}

std::string text_in(const Json& report, const char* key) {
  const auto found = report.find(key);
  return found != report.end() && found->is_string() ? found->get<std::string>() : std::string();
}

void read_earlier(const BatchArguments& arguments, Job& job) {
  std::ifstream file(output_of(arguments, job, ".json"));
  if (Json report = Json::parse(file, nullptr, false); report.is_object()) job.earlier = std::move(report);
}

// A report is written last, so what it tells of is whole. Failures are tried again: a disk may have been full.
bool is_done(const BatchArguments& arguments, Job& job) {
  if (text_in(job.earlier, "settings") != job.settings) return false;
  const std::string status = text_in(job.earlier, "status");
  const bool done = status == "refused" || (status == "rigged" && fs::exists(output_of(arguments, job, ".glb")));
  if (done) job.report = job.earlier;
  return done;
}

// What an earlier run wrote, as its report tells, and this one did not write anew: a folder of GLBs never holds one that is refused now.
void remove_earlier(const BatchArguments& arguments, const Job& job, const RigOutputs& written) {
  if (text_in(job.earlier, "status") != "rigged") return;
  const bool had_picture = text_in(job.earlier, "settings").find(" --previews ") != std::string::npos;
  if (written.glb.empty()) fs::remove(output_of(arguments, job, ".glb"));
  if (had_picture && !written.preview) fs::remove(output_of(arguments, job, ".png"));
}

// What is asked for must not cost anybody a character: no result may lie where a file of the input is, under whatever name.
void check_outputs(const BatchArguments& arguments, const std::vector<Job>& jobs) {
  std::set<fs::path> taken;
  for (const Job& job : jobs) taken.insert(fs::canonical(job.input));
  if (arguments.options.skeleton) taken.insert(fs::weakly_canonical(*arguments.options.skeleton));
  for (const Job& job : jobs)
    for (const char* extension : {".glb", ".png", ".json"})
      if (const fs::path place = fs::weakly_canonical(output_of(arguments, job, extension)); !taken.insert(place).second)
        throw Error("{}: the result of {} would overwrite it; choose another folder with -o", place.string(), job.input.string());
}

void rig_job(const BatchArguments& arguments, const infer::RignetModels& models, Job& job) {
  const auto start = Clock::now();
  Json warnings = Json::array(), seen = Json::object();
  const char* status = "rigged";
  std::string why;
  RigOutputs outputs{output_of(arguments, job, ".glb"), {}, {}};
  if (arguments.previews) outputs.preview = output_of(arguments, job, ".png");
  try {
    fs::create_directories(outputs.glb.parent_path());
    rig_file(
        job.input, outputs, arguments.options, models, [&](const std::string& message) { warnings.push_back(message); },
        [&](const pipelines::RigReport& report, const std::vector<std::string>& changes) { seen = to_json(report, changes); });
  } catch (const Refused& e) {
    status = "refused";
    why = e.what();
  } catch (const std::bad_alloc&) {
    status = "failed";
    why = "not enough memory";
  } catch (const std::exception& e) {
    status = "failed";
    why = e.what();
  }
  if (status != std::string_view("rigged")) outputs = {};
  remove_earlier(arguments, job, outputs);
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  job.report = {{"osteon", OSTEON_VERSION}, {"input", job.input.string()}, {"status", status},    {"why", why},
                {"seconds", seconds},       {"settings", job.settings},    {"messages", warnings}};
  job.report.update(seen);
  save_json(output_of(arguments, job, ".json"), job.report);
}

// Files side by side, each on one core: nothing waits but for the last ones.
void rig_all(const BatchArguments& arguments, std::vector<Job*>& jobs) {
  if (jobs.empty()) return;
  const infer::RignetModels models = arguments.options.models.load();
  ProgressBar progress;
  std::mutex mutex;
  std::size_t done = 0;
  catch_interrupts();
  parallel_for(jobs.size(), 1, [&](std::size_t begin, std::size_t) {
    if (interrupted != 0) return;
    rig_job(arguments, models, *jobs[begin]);
    const std::lock_guard lock(mutex);
    ++done;
    progress.show("rigging", static_cast<double>(done) / static_cast<double>(jobs.size()),
                  fmt::format("{}/{}  {}", done, jobs.size(), jobs[begin]->name.string()));
  });
}

std::string csv_row(const Json& report) {
  const auto number = [&](const char* key) { return report.contains(key) && report[key].is_number() ? report[key].dump() : ""; };
  const auto text = [&](const char* key) {
    std::string quoted = report.value(key, "");
    for (std::size_t at = 0; (at = quoted.find('"', at)) != std::string::npos; at += 2) quoted.insert(at, 1, '"');
    return '"' + quoted + '"';
  };
  return fmt::format("{},{},{},{},{},{},{}\n", text("input"), text("status"), number("vertices"), number("joints"), number("confidence"),
                     number("seconds"), text("why"));
}

void save_summary(const fs::path& path, const std::vector<Job>& jobs) {
  std::string csv = "file,status,vertices,joints,confidence,seconds,why\n";
  for (const Job& job : jobs)
    if (job.report.is_object()) csv += csv_row(job.report);
  io::write_file(path, std::array{std::span(reinterpret_cast<const std::uint8_t*>(csv.data()), csv.size())});
}

void print_summary(const BatchArguments& arguments, const std::vector<Job>& jobs, std::size_t before, double seconds) {
  std::map<std::string, std::size_t> counts;
  std::size_t widest = 4;
  for (const Job& job : jobs) widest = std::max(widest, job.name.string().size());
  fmt::print("{:<{}}  {:<8} {:>9} {:>7} {:>11} {:>8}\n", "file", widest, "status", "vertices", "joints", "confidence", "seconds");
  for (const Job& job : jobs) {
    if (!job.report.is_object()) continue;
    const std::string status = job.report.value("status", "");
    ++counts[status];
    fmt::print("{:<{}}  {:<8} ", job.name.string(), widest, status);
    if (status == "rigged")
      fmt::print("{:>9} {:>7} {:>11.2f} {:>8.2f}\n", job.report.value("vertices", 0), job.report.value("joints", 0),
                 job.report.value("confidence", 0.0), job.report.value("seconds", 0.0));
    else
      fmt::print("{}\n", job.report.value("why", ""));
  }
  fmt::print("{} of {} files: {} rigged, {} refused, {} failed, {} of these before; {:.1f} s. Table: {}\n",
             counts["rigged"] + counts["refused"] + counts["failed"], jobs.size(), counts["rigged"], counts["refused"], counts["failed"],
             before, seconds, (arguments.output / "summary.csv").string());
}

void batch(BatchArguments arguments, const std::string& settings) {
  const auto start = Clock::now();
  for (fs::path* folder : {&arguments.input, &arguments.output}) {
    *folder = folder->lexically_normal();
    if (!folder->has_filename()) *folder = folder->parent_path();  // a slash at the end
  }
  std::error_code missing;
  if (fs::equivalent(arguments.input, arguments.output, missing))
    throw Error("{}: the results would lie among the characters; choose another folder with -o", arguments.output.string());
  std::vector<Job> jobs = jobs_of(arguments, settings + state_of_models(arguments.options));
  std::vector<Job*> open;
  for (Job& job : jobs) {
    read_earlier(arguments, job);
    if (arguments.again || !is_done(arguments, job)) open.push_back(&job);
  }
  check_outputs(arguments, jobs);
  fs::create_directories(arguments.output);
  remove_leftovers(arguments, jobs);
  rig_all(arguments, open);
  save_summary(arguments.output / "summary.csv", jobs);
  print_summary(arguments, jobs, jobs.size() - open.size(), std::chrono::duration<double>(Clock::now() - start).count());
  const auto ended_as = [&](const char* status) {
    return std::ranges::count_if(jobs, [&](const Job& job) { return job.report.is_object() && job.report.value("status", "") == status; });
  };
  if (interrupted != 0) throw Cancelled();
  if (const auto failed = ended_as("failed"); failed > 0)
    throw Error("{} of {} files could not be rigged (see above)", failed, jobs.size());
  if (const auto refused = ended_as("refused"); refused > 0)
    throw Refused("{} of {} files were refused (see above, and --min-confidence)", refused, jobs.size());
}

// The command's options as they stand, without the folders: a file that was rigged with others is rigged again.
std::string settings_of(const CLI::App& command) {
  std::string settings = "osteon " OSTEON_VERSION;
  for (const CLI::Option* option : command.get_options({}))
    if (option->count() > 0 && option->get_name() != "input" && !option->check_name("--output") && !option->check_name("--again"))
      settings += fmt::format(" {} {}", option->get_name(), fmt::join(option->results(), " "));
  return settings;
}

}  // namespace

void add_batch_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("batch", "Rig all characters of a folder, and go on where an earlier run stopped");
  auto arguments = std::make_shared<BatchArguments>();
  command->add_option("input", arguments->input, "The folder; folders in it are looked through too")->required()->type_name("FOLDER");
  command
      ->add_option("-o,--output", arguments->output,
                   "Folder of the results: for each character a GLB and a report (JSON) under its name; summary.csv")
      ->required()
      ->type_name("FOLDER");
  command->add_flag("--previews", arguments->previews, "Also draw a picture of each (PNG)");
  command->add_flag("--again", arguments->again, "Also those that are done");
  arguments->options.add_to(*command);
  command->callback([arguments, command] { batch(*arguments, settings_of(*command)); });
}

}  // namespace osteon::app
