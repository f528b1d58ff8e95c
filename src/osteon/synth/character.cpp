// SPDX-License-Identifier: Apache-2.0
#include "osteon/synth/character.h"

#include <algorithm>
#include <cmath>

#include "osteon/base/error.h"
#include "osteon/base/parallel.h"
#include "osteon/base/random.h"
#include "osteon/geometry/decimate.h"
#include "osteon/mesh/shapes.h"
#include "osteon/synth/creatures.h"
#include "osteon/synth/polygonize.h"

namespace osteon::synth {
namespace {

struct KindInfo {
  Kind kind;
  std::string_view name;
  Body (*make)(Random&);
};
constexpr std::array<KindInfo, kKinds.size()> kInfos{{{Kind::Biped, "biped", make_biped},
                                                      {Kind::Quadruped, "quadruped", make_quadruped},
                                                      {Kind::Bird, "bird", make_bird},
                                                      {Kind::Fish, "fish", make_fish},
                                                      {Kind::Serpent, "serpent", make_serpent},
                                                      {Kind::Insect, "insect", make_insect},
                                                      {Kind::Spider, "spider", make_spider},
                                                      {Kind::ManyLegged, "many-legged", make_many_legged},
                                                      {Kind::ManyArmed, "many-armed", make_many_armed},
                                                      {Kind::Winged, "winged", make_winged},
                                                      {Kind::TailedBiped, "tailed-biped", make_tailed_biped},
                                                      {Kind::Robot, "robot", make_robot},
                                                      {Kind::Blob, "blob", make_blob},
                                                      {Kind::BlockyAnimal, "blocky-animal", make_blocky_animal},
                                                      {Kind::BlockyHumanoid, "blocky-humanoid", make_blocky_humanoid}}};

const KindInfo& info(Kind kind) { return kInfos[static_cast<std::size_t>(kind)]; }

// Adds a mesh as a further component, with the row of weights that `row_of` gives for each vertex.
template <class RowOf>
void add(Rig& rig, const TriangleMesh& mesh, RowOf&& row_of) {
  std::vector<std::vector<Influence>> rows(mesh.positions.size());
  parallel_for(rows.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) rows[v] = row_of(mesh.positions.raw()[v]);
  });
  for (const auto& row : rows) rig.weights.append(row);
  rig.mesh = rig.mesh.positions.empty() ? mesh : shapes::merged(rig.mesh, mesh);
}

bool is_faceted(Finish finish, Random& random) { return finish == Finish::BySeed ? random.uniform() < 0.4f : finish == Finish::Faceted; }

// Of a faceted skin, more for bodies of many parts.
std::size_t vertices_wanted(Random& random, std::size_t joints) {
  return std::max(static_cast<std::size_t>(300.0f * std::pow(8.0f, random.uniform())), 20 * joints);
}

TriangleMesh smooth_skin(const Body& body, int cells) {
  const Eigen::AlignedBox3f box = body.box();
  return polygonize([&](const Vec3f& centre, float radius) { return body.near(centre, radius); }, box,
                    box.sizes().maxCoeff() / static_cast<float>(cells));
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
  Random random = Random(seed).fork(static_cast<std::uint64_t>(kind) + 1);
  Random style = random.fork(1);
  const Body body = info(kind).make(random);
  Rig rig;
  rig.skeleton = body.skeleton();
  if (body.has_skin()) {
    TriangleMesh skin = smooth_skin(body, options.cells);
    if (is_faceted(options.finish, style))
      skin = geometry::decimate(skin, {.target_vertices = vertices_wanted(style, body.skeleton().size())}).mesh;
    add(rig, skin, [&](const Vec3f& p) { return body.weights(p); });
  }
  for (const Piece& piece : body.pieces())
    add(rig, piece.mesh, [&](const Vec3f& p) {
      return piece.bond == Bond::Soft ? body.weights(p, piece.joint) : std::vector<Influence>{{piece.joint, 1.0f}};
    });
  stand_on_ground(rig);
  orient_along_bones(rig.skeleton);
  return rig;
}

}  // namespace osteon::synth
