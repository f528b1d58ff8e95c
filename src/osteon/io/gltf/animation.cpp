// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/gltf/animation.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "osteon/base/error.h"
#include "osteon/io/gltf/accessor.h"
#include "osteon/io/gltf/import.h"

namespace osteon::io::gltf {
namespace {

constexpr std::size_t kMostTransforms = std::size_t{1} << 24;  // of all poses; a time may be any float

// A node's transform in the parts that are animated.
struct Local {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();

  Eigen::Affine3d transform() const { return Eigen::Translation3d(translation) * rotation * Eigen::Scaling(scale); }
};

Local local_of(const Element& node) {
  const Eigen::Affine3d whole = local_transform(node);
  Local local;
  local.translation = whole.translation();
  if (node.find("matrix")) {
    Eigen::Matrix3d rotation, scale;
    whole.computeRotationScaling(&rotation, &scale);
    local.rotation = Eigen::Quaterniond(rotation);
    local.scale = scale.diagonal();
  }
  if (const auto r = node.find("rotation")) local.rotation = Eigen::Quaterniond(r->numbers<4>().data()).normalized();  // x, y, z, w
  if (const auto s = node.find("scale")) local.scale = Eigen::Map<const Eigen::Vector3d>(s->numbers<3>().data());
  return local;
}

enum class Path { translation, rotation, scale };

// What one channel does to one node.
struct Track {
  std::size_t node;
  Path path;
  bool steps;                 // no interpolation
  std::vector<float> times;   // (K) seconds, ascending
  std::vector<float> values;  // (K,3), or (K,4) of rotations

  Eigen::Index width() const { return path == Path::rotation ? 4 : 3; }
  Eigen::Map<const Eigen::VectorXf> value(std::size_t key) const {
    return {values.data() + static_cast<std::ptrdiff_t>(key) * width(), width()};
  }

  void apply(double time, Local& local) const {
    const auto next = static_cast<std::size_t>(std::ranges::upper_bound(times, static_cast<float>(time)) - times.begin());
    const std::size_t before = next == 0 ? 0 : next - 1, after = std::min(next, times.size() - 1);
    const double span = static_cast<double>(times[after]) - static_cast<double>(times[before]);
    const double t = steps || span <= 0.0 ? 0.0 : std::clamp((time - static_cast<double>(times[before])) / span, 0.0, 1.0);
    const Eigen::VectorXd a = value(before).cast<double>(), b = value(after).cast<double>();
    if (path == Path::rotation) {
      const Eigen::Quaterniond from(a[3], a[0], a[1], a[2]), to(b[3], b[0], b[1], b[2]);
      local.rotation = from.normalized().slerp(t, to.normalized());
    } else {
      (path == Path::scale ? local.scale : local.translation) = a + t * (b - a);
    }
  }
};

std::optional<Path> path_of(const Element& target) {
  const std::string& name = target.at("path").text();
  if (name == "translation") return Path::translation;
  if (name == "rotation") return Path::rotation;
  if (name == "scale") return Path::scale;
  return std::nullopt;  // morph weights
}

// Of a cubic spline's (in, value, out) for each key, the value.
std::vector<float> without_tangents(const std::vector<float>& values, std::size_t width) {
  std::vector<float> out;
  for (std::size_t at = width; at + 2 * width <= values.size(); at += 3 * width)
    out.insert(out.end(), values.begin() + static_cast<std::ptrdiff_t>(at), values.begin() + static_cast<std::ptrdiff_t>(at + width));
  return out;
}

std::optional<Track> track_of(const Document& document, const Element& channel, const std::vector<Element>& samplers) {
  const Element target = channel.at("target");
  const auto node = target.find("node");
  const auto path = path_of(target);
  if (!node || !path) return std::nullopt;
  const Element& sampler = samplers[channel.at("sampler").index(samplers.size(), "samplers")];
  const std::size_t accessors = document.count("accessors");
  const Accessor input(document, sampler.at("input").index(accessors, "accessors"));
  const Accessor output(document, sampler.at("output").index(accessors, "accessors"));
  const std::string interpolation = sampler.text_or("interpolation", "LINEAR");
  Track track{node->index(document.count("nodes"), "nodes"), *path, interpolation == "STEP", input.floats(), output.floats()};
  const auto width = static_cast<std::size_t>(track.width());
  if (interpolation == "CUBICSPLINE") track.values = without_tangents(track.values, width);
  if (track.times.empty() || output.components() != width || track.values.size() != track.times.size() * width)
    throw Error("{}: {} times and {} values of {}, expected as many, of {}", sampler.where(), track.times.size(), output.count(),
                output.components(), width);
  if (!std::ranges::is_sorted(track.times)) throw Error("{}: times are not ascending", sampler.where());
  return track;
}

// Parents before children.
std::vector<std::size_t> order_of(const Scene& scene) {
  std::vector<std::size_t> order, way;
  std::vector<bool> listed(scene.nodes.size());
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    for (std::optional<std::size_t> up = n; up && !listed[*up]; up = scene.nodes[*up].parent) {
      listed[*up] = true;
      way.push_back(*up);
    }
    order.insert(order.end(), way.rbegin(), way.rend());
    way.clear();
  }
  return order;
}

std::vector<Transform> world_transforms(const Scene& scene, const std::vector<std::size_t>& order, const std::vector<Local>& locals) {
  std::vector<Eigen::Affine3d> world(order.size());
  for (const std::size_t n : order) {
    const auto parent = scene.nodes[n].parent;
    world[n] = parent ? world[*parent] * locals[n].transform() : locals[n].transform();
  }
  std::vector<Transform> out;
  for (const Eigen::Affine3d& w : world) out.push_back(w.cast<float>());
  return out;
}

// The first and the last of all times, in seconds. Pre: there are tracks.
std::pair<double, double> span_of(const std::vector<Track>& tracks) {
  float first = tracks[0].times.front(), last = first;
  for (const Track& track : tracks) {
    first = std::min(first, track.times.front());
    last = std::max(last, track.times.back());
  }
  return {first, last};
}

std::vector<Track> tracks_of(const Document& document, const Element& animation) {
  const std::vector<Element> samplers = animation.at("samplers").items();
  std::vector<Track> tracks;
  for (const Element& channel : animation.at("channels").items())
    if (auto track = track_of(document, channel, samplers)) tracks.push_back(std::move(*track));
  return tracks;
}

}  // namespace

Motion poses_of(const Document& document, double per_second) {
  std::vector<std::string> repairs;
  const Scene scene = import_scene(document, repairs).scene;
  const std::vector<std::size_t> order = order_of(scene);
  Motion motion;
  std::vector<Local> rest;
  for (const Element& node : document.all("nodes")) {
    rest.push_back(local_of(node));
    motion.names.push_back(node.text_or("name", ""));
  }
  motion.rest = world_transforms(scene, order, rest);
  for (const Element& animation : document.all("animations")) {
    const std::vector<Track> tracks = tracks_of(document, animation);
    if (tracks.empty()) continue;
    const auto [first, last] = span_of(tracks);
    const double count = std::floor((last - first) * per_second) + 1.0;
    if (!((static_cast<double>(motion.poses.size()) + count) * static_cast<double>(rest.size()) < static_cast<double>(kMostTransforms)))
      throw Error("{}: lasts {} s, too long to be read", animation.where(), last - first);
    for (double k = 0.0; k < count; k += 1.0) {
      std::vector<Local> locals = rest;
      for (const Track& track : tracks) track.apply(first + k / per_second, locals[track.node]);
      motion.poses.push_back(world_transforms(scene, order, locals));
    }
  }
  return motion;
}

}  // namespace osteon::io::gltf
