// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "osteon/rig/rig.h"

namespace osteon::synth {

enum class Kind {
  Biped,
  Quadruped,
  Bird,
  Fish,
  Serpent,
  Insect,
  Spider,
  ManyLegged,
  ManyArmed,
  Winged,
  TailedBiped,
  Robot,
  Blob,
  BlockyAnimal,
  BlockyHumanoid
};
constexpr std::array<Kind, 15> kKinds{Kind::Biped,       Kind::Quadruped, Kind::Bird,       Kind::Fish,         Kind::Serpent,
                                      Kind::Insect,      Kind::Spider,    Kind::ManyLegged, Kind::ManyArmed,    Kind::Winged,
                                      Kind::TailedBiped, Kind::Robot,     Kind::Blob,       Kind::BlockyAnimal, Kind::BlockyHumanoid};
std::string_view name(Kind kind);     // "biped", "many-legged", ...: the words of its name in small letters
Kind kind_of(std::string_view name);  // throws Error that lists the names

enum class Finish { BySeed, Smooth, Faceted };  // of the skin: many small faces, or few large ones as of low-poly models

struct CharacterOptions {
  int cells = 256;  // of the polygonisation along the longest side; vertices grow with its square (256: about 40 thousand)
  Finish finish = Finish::BySeed;
};

// A character of random proportions with its exact rig, standing on y = 0, facing +z: a closed skin in one piece, or the rigid parts of a
// robot or a blocky figure, and pieces of their own (eyes, horns, what it wears); joints where the body bends, each +y along its bone, as
// one of many artists would place them; leaf joints named "...End" bind nothing. All but what it wears is mirror-symmetric. Weights follow
// from the construction. The same seed gives the same character.
Rig make_character(Kind kind, std::uint64_t seed, const CharacterOptions& options = {});

}  // namespace osteon::synth
