// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/bone_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <optional>
#include <set>
#include <vector>

namespace osteon::skin {
namespace {

constexpr int kLargestNumber = 4;

bool is_upper(char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; }
bool is_lower(char c) { return std::islower(static_cast<unsigned char>(c)) != 0; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

// Lower-case words and numbers: "LeftUpLeg_02" -> left, up, leg, 02. Capitals that follow one another are a word, but for the last before
// a small letter: "LEye" -> l, eye.
std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words(1);
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    const bool is_letter = std::isalpha(static_cast<unsigned char>(c)) != 0;
    const char before = i > 0 ? name[i - 1] : ' ', after = i + 1 < name.size() ? name[i + 1] : ' ';
    const bool starts = !is_letter    ? is_digit(c) != is_digit(before)
                        : is_upper(c) ? !is_upper(before) || is_lower(after)
                                      : is_digit(before);
    if (starts || (!is_letter && !is_digit(c))) words.emplace_back();
    if (is_letter || is_digit(c)) words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  std::erase(words, std::string());
  return words;
}

std::optional<Side> side_of(const std::string& word) {
  if (word == "l" || word == "left") return Side::left;
  if (word == "r" || word == "right") return Side::right;
  return std::nullopt;
}

// Words that tell the tool, not the part.
bool says_nothing(const std::string& word) {
  static const std::set<std::string> empty{"bip", "mixamorig", "armature", "char", "def", "c",  "bone", "joint",
                                           "jnt", "bn",        "cc",       "base", "rig", "sk", "skel", "m"};
  return empty.contains(word);
}

// Parts of the body by the words for them, once words are joined: the longest that begins the name counts.
const std::map<std::string, std::string>& parts() {
  static const std::map<std::string, std::string> all{
      {"hips", "hips"},         {"pelvis", "hips"},       {"hip", "hips"},          {"abdomen", "abdomen"}, {"belly", "abdomen"},
      {"stomach", "abdomen"},   {"spine", "spine"},       {"back", "spine"},        {"torso", "torso"},     {"chest", "chest"},
      {"thorax", "chest"},      {"ribcage", "chest"},     {"body", "body"},         {"neck", "neck"},       {"head", "head"},
      {"jaw", "jaw"},           {"mjaw", "jaw"},          {"chin", "jaw"},          {"mouth", "mouth"},     {"eye", "eye"},
      {"ear", "ear"},           {"clavicle", "clavicle"}, {"clav", "clavicle"},     {"collar", "clavicle"}, {"shoulder", "clavicle"},
      {"upperarm", "upperarm"}, {"uparm", "upperarm"},    {"arm", "upperarm"},      {"forearm", "forearm"}, {"lowerarm", "forearm"},
      {"lowarm", "forearm"},    {"elbow", "forearm"},     {"hand", "hand"},         {"wrist", "hand"},      {"palm", "hand"},
      {"fist", "hand"},         {"thigh", "thigh"},       {"upleg", "thigh"},       {"upperleg", "thigh"},  {"calf", "calf"},
      {"shin", "calf"},         {"lowerleg", "calf"},     {"lowleg", "calf"},       {"knee", "calf"},       {"foot", "foot"},
      {"ankle", "foot"},        {"toe", "toe"},           {"toes", "toe"},          {"ball", "toe"},        {"toebase", "toe"},
      {"thumb", "thumb"},       {"handthumb", "thumb"},   {"fngthumb", "thumb"},    {"index", "index"},     {"handindex", "index"},
      {"fngindex", "index"},    {"middle", "middle"},     {"handmiddle", "middle"}, {"fngmid", "middle"},   {"ring", "ring"},
      {"handring", "ring"},     {"fngring", "ring"},      {"pinky", "pinky"},       {"handpinky", "pinky"}, {"fngpinky", "pinky"},
      {"little", "pinky"},      {"tail", "tail"},         {"wing", "wing"},         {"root", "root"},       {"leg", "leg"}};
  return all;
}

struct Words {
  std::string text;  // those that tell the part, joined
  int number = -1;
  bool is_twist = false, is_end = false, is_control = false;
};

Words sorted_out(const std::vector<std::string>& words, Side& side) {
  static const std::set<std::string> twists{"twist", "roll"}, ends{"end", "nub", "tip", "leaf"},
      controls{"ik", "ctrl", "control", "pole", "target", "pt"};
  Words out;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word == "bip" && i + 1 < words.size() && is_digit(words[i + 1][0])) {
      ++i;  // Bip01 is the whole rig
    } else if (const auto found = side_of(word)) {
      side = *found;
    } else if (is_digit(word[0])) {
      out.number = word.size() > 6 ? kLargestNumber : std::stoi(word);
    } else if (twists.contains(word)) {
      out.is_twist = true;
    } else if (ends.contains(word)) {
      out.is_end = true;
    } else if (controls.contains(word)) {
      out.is_control = true;
    } else if (word.size() == 1 && word[0] >= 'a' && word[0] <= 'd' && !out.text.empty()) {
      out.number = word[0] - 'a' + 1;  // spineB
    } else if (!says_nothing(word)) {
      out.text += word;
    }
  }
  return out;
}

// Biped's fingers are numbered: "Finger21" is the second joint of the third.
std::optional<std::string> numbered_finger(const Words& words) {
  constexpr std::array fingers{"thumb", "index", "middle", "ring", "pinky"};
  if (words.text != "finger" || words.number < 0) return std::nullopt;
  const int finger = words.number < 10 ? words.number : words.number / 10, joint = words.number < 10 ? 0 : words.number % 10;
  if (finger > 4) return std::nullopt;
  return std::string(fingers[static_cast<std::size_t>(finger)]) + '.' + std::to_string(joint + 1);
}

}  // namespace

Side opposite(Side side) { return side == Side::none ? side : side == Side::left ? Side::right : Side::left; }

BoneName bone_name(std::string_view joint) {
  if (const auto colon = joint.rfind(':'); colon != std::string_view::npos) joint.remove_prefix(colon + 1);
  BoneName out;
  Words words = sorted_out(words_of(joint), out.side);
  if (words.is_control) {
    out.kind = "control";
    return out;
  }
  if (const auto finger = numbered_finger(words)) {
    out.kind = *finger;
    return out;
  }
  const auto part = parts().find(words.text);
  out.kind = part == parts().end() ? words.text : part->second;
  if (out.side != Side::none && words.text == "hip") out.kind = "thigh";
  if (out.side != Side::none && words.text == "leg" && words.number < 0) out.kind = "calf";  // beside "UpLeg"
  if (out.kind.empty()) return out;
  if (words.number > 0) out.kind += '.' + std::to_string(std::min(words.number, kLargestNumber));
  if (words.is_twist) out.kind += ".twist";
  if (words.is_end) out.kind += ".end";
  return out;
}

}  // namespace osteon::skin
