#include "formats/body/look_names.h"

#include <algorithm>

namespace dance {
namespace {

enum class Part { kLegs, kHair, kSleeves, kSkin, kHairColour };
constexpr std::size_t kPartCount = 5;

struct Word {
  std::string_view name;
  Part part;
  std::uint8_t value;
};

constexpr std::array<Word, 22> kWords{{
    {"trousers", Part::kLegs, static_cast<std::uint8_t>(Legwear::kTrousers)},
    {"flared", Part::kLegs, static_cast<std::uint8_t>(Legwear::kFlared)},
    {"dress", Part::kLegs, static_cast<std::uint8_t>(Legwear::kSkirt)},
    {"crop", Part::kHair, static_cast<std::uint8_t>(Hair::kShort)},
    {"bob", Part::kHair, static_cast<std::uint8_t>(Hair::kBob)},
    {"bun", Part::kHair, static_cast<std::uint8_t>(Hair::kBun)},
    {"tail", Part::kHair, static_cast<std::uint8_t>(Hair::kPonytail)},
    {"bare", Part::kSleeves, static_cast<std::uint8_t>(Sleeves::kNone)},
    {"tee", Part::kSleeves, static_cast<std::uint8_t>(Sleeves::kShort)},
    {"long", Part::kSleeves, static_cast<std::uint8_t>(Sleeves::kLong)},
    // Short, because the longest look must fit into kMaxGuestIdLength.
    {"s1", Part::kSkin, 0},
    {"s2", Part::kSkin, 1},
    {"s3", Part::kSkin, 2},
    {"s4", Part::kSkin, 3},
    {"s5", Part::kSkin, 4},
    {"s6", Part::kSkin, 5},
    {"h1", Part::kHairColour, 0},
    {"h2", Part::kHairColour, 1},
    {"h3", Part::kHairColour, 2},
    {"h4", Part::kHairColour, 3},
    {"h5", Part::kHairColour, 4},
    {"h6", Part::kHairColour, 5},
}};
static_assert(kSkinColours.size() == 6 && kHairColours.size() == 6);

// Trousers where a look had a dress: of a colour that goes with every top.
constexpr std::uint32_t kPlainTrousers = 0x2b3042;
constexpr float kDressShade = 0.8f;

using Choice = std::array<std::optional<std::uint8_t>, kPartCount>;

const Word* find_word(std::string_view name) {
  for (const Word& word : kWords)
    if (word.name == name) return &word;
  return nullptr;
}

std::optional<Choice> read_words(std::string_view name) {
  Choice choice;
  if (name.empty() || name == kMannequinName) return choice;
  while (true) {
    const std::size_t dash = name.find('-');
    const Word* word = find_word(name.substr(0, dash));
    if (word == nullptr || choice[static_cast<std::size_t>(word->part)]) return std::nullopt;
    choice[static_cast<std::size_t>(word->part)] = word->value;
    if (dash == std::string_view::npos) return choice;
    name.remove_prefix(dash + 1);
  }
}

std::string words_of(Part part) {
  std::string text;
  for (const Word& word : kWords)
    if (word.part == part) text += (text.empty() ? "" : ", ") + std::string(word.name);
  return text;
}

}  // namespace

std::optional<GuestLook> named_look(const GuestId& guest, std::string_view name,
                                    const std::array<float, 3>& colour_rgb) {
  const auto choice = read_words(name);
  if (!choice) return std::nullopt;
  GuestLook look = look_of(guest);
  const bool had_dress = look.legwear == Legwear::kSkirt;
  const auto [legs, hair, sleeves, skin, hair_colour] = *choice;
  if (legs) look.legwear = static_cast<Legwear>(*legs);
  if (hair) look.hair_style = static_cast<Hair>(*hair);
  if (sleeves) look.sleeves = static_cast<Sleeves>(*sleeves);
  if (skin) look.skin = linear_from_srgb(kSkinColours[*skin]);
  if (hair_colour) look.hair = linear_from_srgb(kHairColours[*hair_colour]);
  if (colour_rgb != std::array<float, 3>{1.0f, 1.0f, 1.0f}) {
    look.top = {colour_rgb[0], colour_rgb[1], colour_rgb[2]};
    look.tag = 0.75f * look.top + Eigen::Vector3f::Constant(0.25f);
  }
  if (look.legwear == Legwear::kSkirt)
    look.legs = kDressShade * look.top;
  else if (had_dress)
    look.legs = linear_from_srgb(kPlainTrousers);
  return look;
}

std::string name_of_look(const GuestLook& look) {
  const auto index_in = [](const auto& palette, const Eigen::Vector3f& colour) {
    const auto at = std::ranges::find_if(
        palette, [&](std::uint32_t rgb) { return linear_from_srgb(rgb).isApprox(colour, 1e-3f); });
    return static_cast<std::uint8_t>(at - palette.begin());
  };
  const std::array<std::uint8_t, kPartCount> values{
      static_cast<std::uint8_t>(look.legwear), static_cast<std::uint8_t>(look.hair_style),
      static_cast<std::uint8_t>(look.sleeves), index_in(kSkinColours, look.skin),
      index_in(kHairColours, look.hair)};
  std::string name;
  for (std::size_t part = 0; part < kPartCount; ++part)
    for (const Word& word : kWords)
      if (static_cast<std::size_t>(word.part) == part && word.value == values[part])
        name += (name.empty() ? "" : "-") + std::string(word.name);
  return name;
}

bool is_look_name(std::string_view name) { return read_words(name).has_value(); }

std::string look_names() {
  return "legs: " + words_of(Part::kLegs) + "; hair: " + words_of(Part::kHair) +
         "; sleeves: " + words_of(Part::kSleeves) +
         "; skin, from light to dark: " + words_of(Part::kSkin) +
         "; colour of the hair, from black to grey: " + words_of(Part::kHairColour);
}

}  // namespace dance
