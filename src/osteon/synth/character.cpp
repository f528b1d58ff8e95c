// SPDX-License-Identifier: Apache-2.0
#include "osteon/synth/character.h"

#include "osteon/base/error.h"
#include "osteon/base/parallel.h"
#include "osteon/base/random.h"
#include "osteon/synth/creatures.h"
#include "osteon/synth/polygonize.h"

namespace osteon::synth {
namespace {

struct KindInfo {
  Kind kind;
  std::string_view name;
  Body (*make)(Random&);
};
constexpr std::array<KindInfo, 5> kInfos{{{Kind::Biped, "biped", make_biped},
                                          {Kind::Quadruped, "quadruped", make_quadruped},
                                          {Kind::Bird, "bird", make_bird},
                                          {Kind::Fish, "fish", make_fish},
                                          {Kind::ManyLegged, "many-legged", make_many_legged}}};

const KindInfo& info(Kind kind) { return kInfos[static_cast<std::size_t>(kind)]; }

SkinWeights weights_of(const TriangleMesh& mesh, const Body& body) {
  std::vector<std::vector<Influence>> rows(mesh.positions.size());
  parallel_for(rows.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) rows[v] = body.weights(mesh.positions.raw()[v]);
  });
  SkinWeights weights;
  for (const auto& row : rows) weights.append(row);
  return weights;
}

void stand_on_ground(Rig& rig) {
  const Vec3f down(0, bounds(rig.mesh).min().y(), 0);
  for (Vec3f& p : rig.mesh.positions) p -= down;
  for (Vec3f& p : rig.skeleton.rest_positions) p -= down;
}

}  // namespace

std::string_view name(Kind kind) { return info(kind).name; }

Kind kind_of(std::string_view name) {
  std::string known;
  for (const KindInfo& i : kInfos) {
    if (i.name == name) return i.kind;
    known += known.empty() ? "" : ", ";
    known += i.name;
  }
  throw Error("'{}' is no kind of character; expected one of {}", name, known);
}

Rig make_character(Kind kind, std::uint64_t seed, const CharacterOptions& options) {
  if (options.cells < 16 || options.cells > 2048) throw Error("{} cells along the character; expected 16 to 2048", options.cells);
  Random random(seed);
  const Body body = info(kind).make(random);
  const Eigen::AlignedBox3f box = body.box();
  Rig rig;
  rig.mesh = polygonize([&](const Vec3f& centre, float radius) { return body.near(centre, radius); }, box,
                        box.sizes().maxCoeff() / static_cast<float>(options.cells));
  rig.skeleton = body.skeleton();
  rig.weights = weights_of(rig.mesh, body);
  stand_on_ground(rig);
  orient_along_bones(rig.skeleton);
  return rig;
}

}  // namespace osteon::synth
