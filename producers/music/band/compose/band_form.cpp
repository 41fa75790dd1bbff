#include "producers/music/band/compose/band_form.h"

#include <array>
#include <span>

#include "core/base/random.h"

namespace dance {
namespace {

struct PlannedPart {
  BandPartKind kind;
  int bars;
  bool ends_in_break;
};

using Kind = BandPartKind;

// About three minutes at the usual tempo.
constexpr std::array kLong{
    PlannedPart{Kind::kIntro, 8, true},    PlannedPart{Kind::kVerse, 16, false},
    PlannedPart{Kind::kRiff, 8, false},    PlannedPart{Kind::kVerse, 16, true},
    PlannedPart{Kind::kChorus, 16, false}, PlannedPart{Kind::kRiff, 8, true},
    PlannedPart{Kind::kChorus, 16, false}, PlannedPart{Kind::kSolo, 16, false},
    PlannedPart{Kind::kRiff, 8, true},     PlannedPart{Kind::kChorus, 16, false},
    PlannedPart{Kind::kEnding, 4, false}};
constexpr std::array kMiddle{
    PlannedPart{Kind::kIntro, 4, false},  PlannedPart{Kind::kVerse, 16, true},
    PlannedPart{Kind::kChorus, 8, false}, PlannedPart{Kind::kRiff, 8, false},
    PlannedPart{Kind::kVerse, 16, true},  PlannedPart{Kind::kChorus, 8, false},
    PlannedPart{Kind::kSolo, 16, true},   PlannedPart{Kind::kChorus, 16, false},
    PlannedPart{Kind::kEnding, 4, false}};
constexpr std::array kShort{
    PlannedPart{Kind::kIntro, 4, true},  PlannedPart{Kind::kVerse, 16, false},
    PlannedPart{Kind::kChorus, 8, true}, PlannedPart{Kind::kVerse, 16, false},
    PlannedPart{Kind::kSolo, 8, true},   PlannedPart{Kind::kChorus, 16, false},
    PlannedPart{Kind::kEnding, 4, false}};

std::span<const PlannedPart> plan_of(BandStyle style) {
  switch (style) {
    case BandStyle::kSalsa:
    case BandStyle::kSwing:
    case BandStyle::kMerengue:
      return kLong;
    case BandStyle::kBachata:
    case BandStyle::kChaCha:
    case BandStyle::kTango:
    case BandStyle::kWaltz:
      return kMiddle;
    case BandStyle::kCumbia:
      return kShort;
  }
  return kMiddle;
}

}  // namespace

std::vector<BandPart> band_form(BandStyle style, std::uint32_t seed) {
  Random random(seed ^ 0x666f726dU);
  std::vector<BandPart> form;
  std::array<int, 6> rounds{};
  int bar = 0;
  for (const PlannedPart& planned : plan_of(style)) {
    const bool may_vary = planned.kind == Kind::kSolo || planned.kind == Kind::kRiff;
    const int longer = may_vary && random.below(3) == 0 ? 8 : 0;
    const bool breaks = planned.ends_in_break && random.below(4) != 0;
    int& round = rounds[static_cast<std::size_t>(planned.kind)];
    form.push_back({planned.kind, bar, planned.bars + longer, round++, breaks});
    bar += planned.bars + longer;
  }
  return form;
}

}  // namespace dance
