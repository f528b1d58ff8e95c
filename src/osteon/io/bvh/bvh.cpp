// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/bvh/bvh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "osteon/base/error.h"
#include "osteon/io/text_scanner.h"

namespace osteon::io::bvh {
namespace {

struct Channel {
  bool turns;         // about the axis; else moves along it
  Eigen::Index axis;  // 0 x, 1 y, 2 z
};

struct Joint {
  std::string name;
  std::optional<std::size_t> parent;
  Vec3f offset = Vec3f::Zero();
  std::vector<Channel> channels;
};

class Reader {
 public:
  Reader(const std::string& file, std::string_view text) : file_(file), scanner_(text) {}

  std::vector<Joint> hierarchy() {
    expect("HIERARCHY");
    expect("ROOT");
    std::vector<Joint> joints{{std::string(scanner_.rest()), std::nullopt, Vec3f::Zero(), {}}};
    std::vector<std::size_t> open{0};
    expect("{");
    while (!open.empty()) {
      const std::string_view word = scanner_.word_on_any_line();
      if (word == "OFFSET") {
        joints[open.back()].offset = vector();
      } else if (word == "CHANNELS") {
        joints[open.back()].channels = channels();
      } else if (word == "JOINT") {
        joints.push_back({std::string(scanner_.rest()), open.back(), Vec3f::Zero(), {}});
        open.push_back(joints.size() - 1);
        expect("{");
      } else if (word == "End") {
        end_site();
      } else if (word == "}") {
        open.pop_back();
      } else {
        unexpected(word, "OFFSET, CHANNELS, JOINT, End Site or }");
      }
    }
    return joints;
  }

  // The numbers of all frames, `width` a frame, and the seconds that each lasts.
  std::pair<std::vector<float>, double> frames(std::size_t width) {
    expect("MOTION");
    expect("Frames:");
    const std::string_view count_word = scanner_.word();
    const auto count = TextScanner::to_integer(count_word);
    if (!count || *count < 0) unexpected(count_word, "the number of frames");
    expect("Frame");
    expect("Time:");
    const float seconds = scanner_.number();
    if (!(seconds > 0.0f)) throw Error("{}: line {}: the frame time is no positive number", file_, scanner_.line());
    if (static_cast<std::uint64_t>(*count) * width > scanner_.bytes_left())
      throw Error("{}: {} frames of {} numbers, but {} bytes are left", file_, *count, width, scanner_.bytes_left());
    std::vector<float> numbers(static_cast<std::size_t>(*count) * width);
    for (float& number : numbers) number = coordinate("a number for each channel of each frame");
    return {std::move(numbers), static_cast<double>(seconds)};
  }

 private:
  void expect(std::string_view wanted) {
    const std::string_view word = scanner_.word_on_any_line();
    if (word != wanted) unexpected(word, wanted);
  }
  [[noreturn]] void unexpected(std::string_view found, std::string_view expected) const {
    throw Error("{}: line {}: found '{}', expected {}", file_, scanner_.line(), found.substr(0, 40), expected);
  }
  float coordinate(std::string_view expected) {
    const std::string_view word = scanner_.word_on_any_line();
    const float value = TextScanner::to_number(word);
    if (!std::isfinite(value)) unexpected(word, expected);
    return value;
  }
  Vec3f vector() {
    Vec3f v;
    for (float& x : v) x = coordinate("three numbers of OFFSET");
    return v;
  }
  std::vector<Channel> channels() {
    const std::string_view count_word = scanner_.word();
    const auto count = TextScanner::to_integer(count_word);
    if (!count || *count < 0 || *count > 6) unexpected(count_word, "0 to 6 channels");
    std::vector<Channel> out;
    for (std::int64_t i = 0; i < *count; ++i) {
      const std::string_view word = scanner_.word();
      const bool turns = word.ends_with("rotation");
      const auto axis = std::string_view("XYZ").find(word.substr(0, 1));
      if ((!turns && !word.ends_with("position")) || word.size() != 9 || axis == std::string_view::npos)
        unexpected(word, "a channel such as Xrotation or Yposition");
      out.push_back({turns, static_cast<Eigen::Index>(axis)});
    }
    return out;
  }
  void end_site() {
    expect("Site");
    expect("{");
    expect("OFFSET");
    vector();
    expect("}");
  }

  const std::string& file_;
  TextScanner scanner_;
};

// `numbers`: those of this joint's channels.
Transform local_transform(const Joint& joint, const float* numbers) {
  Vec3f position = joint.offset;
  Quatf rotation = Quatf::Identity();
  for (const Channel& channel : joint.channels) {
    const float number = *numbers++;
    if (channel.turns)
      rotation = rotation * Quatf(Eigen::AngleAxisf(number * std::numbers::pi_v<float> / 180.0f, Vec3f(Vec3f::Unit(channel.axis))));
    else
      position[channel.axis] = number;
  }
  return Eigen::Translation3f(position) * rotation;
}

}  // namespace

Motion poses_of(const std::string& file, std::string_view text, double per_second) {
  Reader reader(file, text);
  const std::vector<Joint> joints = reader.hierarchy();
  Motion motion;
  std::size_t width = 0;
  for (const Joint& joint : joints) {
    motion.names.push_back(joint.name);
    motion.rest.push_back(joint.parent ? Transform(motion.rest[*joint.parent] * Eigen::Translation3f(joint.offset))
                                       : Transform(Eigen::Translation3f(joint.offset)));
    width += joint.channels.size();
  }
  const auto [numbers, seconds] = reader.frames(width);
  const auto step = static_cast<std::size_t>(std::clamp(std::round(1.0 / (per_second * seconds)), 1.0, 1e6));
  for (std::size_t at = 0; at + width <= numbers.size() && width > 0; at += step * width) {
    std::vector<Transform>& pose = motion.poses.emplace_back();
    const float* next = numbers.data() + at;
    for (const Joint& joint : joints) {
      const Transform local = local_transform(joint, next);
      pose.push_back(joint.parent ? Transform(pose[*joint.parent] * local) : local);
      next += joint.channels.size();
    }
  }
  return motion;
}

}  // namespace osteon::io::bvh
