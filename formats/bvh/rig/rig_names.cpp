#include "formats/bvh/rig/rig_names.h"

#include <algorithm>
#include <array>
#include <optional>

namespace dance {
namespace {

struct Word {
  std::string_view text;
  RigPart part;
};

// Names without side, separators and trailing numbers, lower case. Middle of the body first.
constexpr Word kMiddleWords[] = {
    {"hips", RigPart::kHips},          {"hip", RigPart::kHips},
    {"pelvis", RigPart::kHips},        {"spine", RigPart::kSpine},
    {"abdomen", RigPart::kSpine},      {"ab", RigPart::kSpine},
    {"abdomenlower", RigPart::kSpine}, {"abdomenupper", RigPart::kSpine},
    {"belly", RigPart::kSpine},        {"waist", RigPart::kSpine},
    {"torso", RigPart::kSpine},        {"lowerback", RigPart::kSpine},
    {"upperback", RigPart::kSpine},    {"chest", RigPart::kSpine},
    {"chestlower", RigPart::kSpine},   {"chestupper", RigPart::kSpine},
    {"upperchest", RigPart::kSpine},   {"thorax", RigPart::kSpine},
    {"ribcage", RigPart::kSpine},      {"spineupper", RigPart::kSpine},
    {"spinelower", RigPart::kSpine},   {"neck", RigPart::kNeck},
    {"lowerneck", RigPart::kNeck},     {"upperneck", RigPart::kNeck},
    {"necklower", RigPart::kNeck},     {"neckupper", RigPart::kNeck},
    {"head", RigPart::kHead},          {"skull", RigPart::kHead},
};

constexpr Word kSideWords[] = {
    {"clavicle", RigPart::kCollar},
    {"collar", RigPart::kCollar},
    {"collarbone", RigPart::kCollar},
    {"shoulderblade", RigPart::kHelper},
    {"scapula", RigPart::kHelper},
    {"shoulder", RigPart::kShoulder},
    {"arm", RigPart::kArm},
    {"upperarm", RigPart::kUpperArm},
    {"uparm", RigPart::kUpperArm},
    {"armupper", RigPart::kUpperArm},
    {"humerus", RigPart::kUpperArm},
    {"shldr", RigPart::kUpperArm},
    {"shldrbend", RigPart::kUpperArm},
    {"bicep", RigPart::kUpperArm},
    {"forearm", RigPart::kLowerArm},
    {"lowerarm", RigPart::kLowerArm},
    {"lowarm", RigPart::kLowerArm},
    {"armlower", RigPart::kLowerArm},
    {"elbow", RigPart::kLowerArm},
    {"radius", RigPart::kLowerArm},
    {"ulna", RigPart::kLowerArm},
    {"forearmbend", RigPart::kLowerArm},
    {"wrist", RigPart::kWrist},
    {"hand", RigPart::kHand},
    {"thigh", RigPart::kThigh},
    {"upleg", RigPart::kThigh},
    {"upperleg", RigPart::kThigh},
    {"legupper", RigPart::kThigh},
    {"femur", RigPart::kThigh},
    {"thighbend", RigPart::kThigh},
    {"hip", RigPart::kHip},
    {"hipjoint", RigPart::kHelper},
    {"leg", RigPart::kLeg},
    {"shin", RigPart::kShin},
    {"calf", RigPart::kShin},
    {"lowerleg", RigPart::kShin},
    {"lowleg", RigPart::kShin},
    {"leglower", RigPart::kShin},
    {"knee", RigPart::kShin},
    {"tibia", RigPart::kShin},
    {"foot", RigPart::kFoot},
    {"ankle", RigPart::kAnkle},
    {"toe", RigPart::kToes},
    {"toes", RigPart::kToes},
    {"toebase", RigPart::kToes},
    {"ball", RigPart::kToes},
    {"thumb", RigPart::kThumb},
    {"index", RigPart::kIndex},
    {"mid", RigPart::kMiddle},
    {"middle", RigPart::kMiddle},
    {"ring", RigPart::kRing},
    {"pinky", RigPart::kLittle},
    {"little", RigPart::kLittle},
    {"pinkie", RigPart::kLittle},
};

constexpr std::array<RigPart, 5> kNumberedFingers{
    RigPart::kThumb, RigPart::kIndex, RigPart::kMiddle, RigPart::kRing, RigPart::kLittle};

// Words that make a joint a helper wherever they stand in its name.
constexpr std::string_view kHelperWords[] = {"twist",      "roll",   "end",   "nub", "tip",
                                             "hair",       "breast", "skirt", "eye", "jaw",
                                             "metacarpal", "carpal", "palm",  "in",  "effector"};
// Words around the part's name without meaning.
constexpr std::string_view kEmptyWords[] = {
    "proximal", "intermediate", "distal", "f",     "finger", "hand", "j",
    "c",        "bip",          "bone",   "joint", "def",    "org",  "jnt",
    "bn",       "mixamorig",    "cc",     "base",  "b",      "m",    "avg"};

constexpr bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
constexpr bool is_lower(char c) { return c >= 'a' && c <= 'z'; }
constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool contains(const auto& list, std::string_view word) {
  return std::find(std::begin(list), std::end(list), word) != std::end(list);
}

// "LeftUpLeg" → left up leg; "LHipJoint" → l hip joint; "upper_arm.L" → upper arm l;
// "spine.001" → spine 001.
std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words;
  char previous = ' ';
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    const char following = i + 1 < name.size() ? name[i + 1] : ' ';
    if (is_upper(c) || is_lower(c) || is_digit(c)) {
      const bool begins = (is_upper(c) && is_lower(previous)) ||
                          (is_upper(c) && is_upper(previous) && is_lower(following)) ||
                          (is_digit(c) != is_digit(previous));
      const bool after_gap = !is_upper(previous) && !is_lower(previous) && !is_digit(previous);
      if (words.empty() || begins || after_gap) words.emplace_back();
      words.back() += is_upper(c) ? static_cast<char>(c + 32) : c;
    }
    previous = c;
  }
  return words;
}

std::optional<RigSide> side_of(std::string_view word) {
  if (word == "l" || word == "left" || word == "lft" || word == "lt") return RigSide::kLeft;
  if (word == "r" || word == "right" || word == "rgt" || word == "rt") return RigSide::kRight;
  return std::nullopt;
}

template <std::size_t kCount>
RigPart find_part(const Word (&table)[kCount], std::string_view text) {
  for (const Word& word : table)
    if (word.text == text) return word.part;
  return RigPart::kNone;
}

// A side word glued to the part: "lfemur", "leftupleg", "handleft".
RigName read_glued(std::string_view text) {
  struct Affix {
    std::string_view text;
    RigSide side;
  };
  constexpr Affix kAffixes[] = {{"left", RigSide::kLeft},
                                {"right", RigSide::kRight},
                                {"l", RigSide::kLeft},
                                {"r", RigSide::kRight}};
  for (const Affix& affix : kAffixes) {
    if (text.size() <= affix.text.size()) continue;
    const RigPart behind = text.starts_with(affix.text)
                               ? find_part(kSideWords, text.substr(affix.text.size()))
                               : RigPart::kNone;
    if (behind != RigPart::kNone) return {affix.side, behind};
    if (affix.text.size() == 1 || !text.ends_with(affix.text)) continue;
    const RigPart before = find_part(kSideWords, text.substr(0, text.size() - affix.text.size()));
    if (before != RigPart::kNone) return {affix.side, before};
  }
  return {};
}

// "Finger0" to "Finger4" with the phalanx as a second digit: "Finger12".
RigPart numbered_finger(const std::vector<std::string>& words) {
  for (std::size_t i = 0; i + 1 < words.size(); ++i)
    if (words[i] == "finger" && words[i + 1][0] >= '0' && words[i + 1][0] <= '4')
      return kNumberedFingers[static_cast<std::size_t>(words[i + 1][0] - '0')];
  return RigPart::kNone;
}

RigName look_up(RigSide side, const std::string& text) {
  if (text.empty()) return {};
  if (side != RigSide::kMiddle) return {side, find_part(kSideWords, text)};
  const RigPart middle = find_part(kMiddleWords, text);
  if (middle != RigPart::kNone) return {RigSide::kMiddle, middle};
  return read_glued(text);
}

}  // namespace

std::string_view common_prefix(const std::vector<std::string_view>& names) {
  if (names.size() < 4) return {};
  std::string_view prefix = names.front();
  for (const std::string_view name : names) {
    std::size_t same = 0;
    while (same < prefix.size() && same < name.size() && prefix[same] == name[same]) ++same;
    prefix = prefix.substr(0, same);
  }
  return prefix;
}

RigName read_rig_name(std::string_view name) {
  // Behind the last ':' stands the joint, before it the scene's or the figure's name.
  if (const auto colon = name.rfind(':'); colon != name.npos) name.remove_prefix(colon + 1);
  std::vector<std::string> words = words_of(name);
  RigSide side = RigSide::kMiddle;
  for (auto word = words.begin(); word != words.end(); ++word) {
    if (const auto found = side_of(*word)) {
      side = *found;
      words.erase(word);
      break;
    }
  }
  for (const std::string& word : words)
    if (contains(kHelperWords, word)) {
      // VRM's thumb begins with a metacarpal, which is a bone; the other fingers' are in the palm.
      const bool thumb = contains(words, "thumb");
      if (!thumb || word != "metacarpal") return {side, RigPart::kHelper};
    }
  if (const RigPart finger = numbered_finger(words); finger != RigPart::kNone)
    return {side, finger};
  std::string all;
  std::string telling;
  for (const std::string& word : words) {
    if (is_digit(word[0])) continue;
    all += word;
    if (!contains(kEmptyWords, word) && word != "metacarpal") telling += word;
  }
  const RigName whole = look_up(side, all);
  if (whole.part != RigPart::kNone) return whole;
  // "CC_Base_L_Hand": beside a finger the hand tells nothing, alone it is the part.
  if (telling.empty() && side != RigSide::kMiddle && contains(words, "hand"))
    return {side, RigPart::kHand};
  return look_up(side, telling);
}

RigSide eye_side(std::string_view name) {
  constexpr std::string_view kEmptyEyeWords[] = {"cc",  "base", "adj", "j",    "face", "def",
                                                 "org", "mch",  "bip", "bone", "joint"};
  if (const auto colon = name.rfind(':'); colon != name.npos) name.remove_prefix(colon + 1);
  RigSide side = RigSide::kMiddle;
  bool is_eye = false;
  for (const std::string& word : words_of(name)) {
    if (const auto found = side_of(word)) {
      side = *found;
    } else if (word == "eye" || word == "eyeball") {
      is_eye = true;
    } else if (!is_digit(word[0]) && !contains(kEmptyEyeWords, word)) {
      return RigSide::kMiddle;
    }
  }
  return is_eye ? side : RigSide::kMiddle;
}

}  // namespace dance
