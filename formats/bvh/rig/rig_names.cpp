#include "formats/bvh/rig/rig_names.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "formats/bvh/rig/rig_japanese.h"

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
    {"uarm", RigPart::kUpperArm},
    {"armupper", RigPart::kUpperArm},
    {"humerus", RigPart::kUpperArm},
    {"shldr", RigPart::kUpperArm},
    {"shldrbend", RigPart::kUpperArm},
    {"bicep", RigPart::kUpperArm},
    {"forearm", RigPart::kLowerArm},
    {"lowerarm", RigPart::kLowerArm},
    {"lowarm", RigPart::kLowerArm},
    {"loarm", RigPart::kLowerArm},
    {"farm", RigPart::kLowerArm},
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
    {"loleg", RigPart::kShin},
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
    {"pointer", RigPart::kIndex},
    {"fore", RigPart::kIndex},
    {"mid", RigPart::kMiddle},
    {"middle", RigPart::kMiddle},
    {"ring", RigPart::kRing},
    {"third", RigPart::kRing},
    {"pinky", RigPart::kLittle},
    {"little", RigPart::kLittle},
    {"pinkie", RigPart::kLittle},
};

constexpr std::array<RigPart, 5> kNumberedFingers{
    RigPart::kThumb, RigPart::kIndex, RigPart::kMiddle, RigPart::kRing, RigPart::kLittle};

// Words that make a joint a helper wherever they stand in its name.
constexpr std::string_view kHelperWords[] = {
    "twist", "roll", "end",        "nub",    "tip",  "hair",  "breast", "skirt",
    "eye",   "jaw",  "metacarpal", "carpal", "palm", "in",    "meta",   "effector",
    "ik",    "pole", "ctrl",       "helper", "hlp",  "dummy", "parent", "cancel"};
// Words around the part's name without meaning.
constexpr std::string_view kEmptyWords[] = {
    "proximal", "intermediate", "distal", "f",     "finger", "hand", "j",
    "c",        "bip",          "bone",   "joint", "def",    "org",  "jnt",
    "bn",       "mixamorig",    "cc",     "base",  "b",      "m",    "avg",
    "valve",    "biped",        "medial", "fk",    "rig",    "bind"};

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

// The digits behind "finger": "Finger0" with the phalanx as a second digit ("Finger12"), or with a
// number of its own ("finger2-1").
std::string finger_digits(const std::vector<std::string>& words) {
  for (std::size_t i = 0; i + 1 < words.size(); ++i)
    if (words[i] == "finger" && is_digit(words[i + 1][0])) return words[i + 1];
  return {};
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
  constexpr std::string_view kSeparators = "_-.: |";
  if (names.size() < 4) return {};
  std::string_view prefix = names.front();
  for (const std::string_view name : names) {
    std::size_t same = 0;
    while (same < prefix.size() && same < name.size() && prefix[same] == name[same]) ++same;
    prefix = prefix.substr(0, same);
  }
  if (!prefix.empty()) return prefix;
  std::map<std::string_view, std::size_t> counts;
  for (const std::string_view name : names)
    for (std::size_t i = 0; i + 1 < name.size(); ++i)
      if (kSeparators.find(name[i]) != name.npos) ++counts[name.substr(0, i + 1)];
  for (const auto& [begin, count] : counts)
    if (10 * count > 7 * names.size() && begin.size() > prefix.size()) prefix = begin;
  return prefix;
}

RigName read_rig_name(std::string_view text) {
  const std::string english = in_english(text);
  std::string_view name = english;
  // Behind the last ':' stands the joint, before it the scene's or the figure's name.
  if (const auto colon = name.rfind(':'); colon != name.npos) name.remove_prefix(colon + 1);
  std::vector<std::string> words = words_of(name);
  RigName result;
  for (const char c : name) {
    if (is_upper(c) || is_lower(c) || is_digit(c)) break;
    result.decoration += c != ' ';
  }
  for (auto word = words.begin(); word != words.end(); ++word) {
    if (const auto found = side_of(*word)) {
      result.side = *found;
      words.erase(word);
      break;
    }
  }
  result.decoration += std::any_of(words.begin(), words.end(),
                                   [](const std::string& word) { return is_digit(word[0]); });
  result.is_palm = contains(words, "metacarpal");
  result.finger_digits = finger_digits(words);
  for (const std::string& word : words)
    if (contains(kHelperWords, word)) {
      // VRM's thumb begins with a metacarpal, which is a bone; the other fingers' are in the palm.
      const bool thumb = contains(words, "thumb") || !result.finger_digits.empty();
      if (!thumb || word != "metacarpal") {
        result.part = RigPart::kHelper;
        return result;
      }
    }
  if (!result.finger_digits.empty()) {
    result.part = RigPart::kNumberedFinger;
    return result;
  }
  std::string all;
  std::string telling;
  int empty_words = 0;
  for (const std::string& word : words) {
    if (is_digit(word[0])) continue;
    all += word;
    if (!contains(kEmptyWords, word) && word != "metacarpal")
      telling += word;
    else
      ++empty_words;
  }
  RigName known = look_up(result.side, all);
  if (known.part == RigPart::kNone) {
    // "CC_Base_L_Hand": beside a finger's name "Hand" has no meaning, alone it is the part.
    if (telling.empty() && result.side != RigSide::kMiddle && contains(words, "hand"))
      known = {result.side, RigPart::kHand};
    else
      known = look_up(result.side, telling);
    result.decoration += empty_words;
  }
  result.side = known.side;
  result.part = known.part;
  return result;
}

void resolve_numbered_fingers(std::vector<RigName>& names) {
  bool has_thumb = false;
  // Biped writes the phalanx as a second digit, up to 2 and of a nub 3: "01" is of finger 0.
  bool are_two_digits = false;
  bool has_bare_zero = false;
  for (const RigName& name : names) {
    has_thumb = has_thumb || name.part == RigPart::kThumb;
    if (name.part != RigPart::kNumberedFinger) continue;
    const std::string& digits = name.finger_digits;
    has_bare_zero = has_bare_zero || digits == "0";
    are_two_digits = are_two_digits || (digits.size() == 2 && digits[0] == '0' && digits[1] > '3');
  }
  are_two_digits = are_two_digits && !has_bare_zero;
  const auto number_of = [&](const RigName& name) {
    return name.finger_digits[are_two_digits && name.finger_digits.size() > 1 ? 1 : 0] - '0';
  };
  int least = 9;
  int most = 0;
  for (const RigName& name : names) {
    if (name.part != RigPart::kNumberedFinger) continue;
    least = std::min(least, number_of(name));
    most = std::max(most, number_of(name));
  }
  const bool from_one = least > 0 && (most > 4 || (least == 1 && !has_thumb));
  for (RigName& name : names) {
    if (name.part != RigPart::kNumberedFinger) continue;
    const int finger = number_of(name) - (from_one ? 1 : 0);
    name.part = finger < 5 ? kNumberedFingers[static_cast<std::size_t>(finger)] : RigPart::kNone;
    if (name.is_palm && name.part != RigPart::kThumb) name.part = RigPart::kHelper;
  }
}

RigSide eye_side(std::string_view text) {
  constexpr std::string_view kEmptyEyeWords[] = {"cc",  "base", "adj", "j",    "face", "def",
                                                 "org", "mch",  "bip", "bone", "joint"};
  const std::string english = in_english(text);
  std::string_view name = english;
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
