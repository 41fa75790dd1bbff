#include "viewer/dance_panel/removal_desk.h"

namespace dance {

// By the clock: no two wishes of this house have one number.
void RemovalDesk::remove(const GuestId& guest, MonoTime now) {
  guest_ = guest;
  const std::int32_t fresh =
      static_cast<std::int32_t>((now.since_zero_us() / 1000) & 0x7fff'fffe) | 1;
  number_ = fresh == number_ ? fresh ^ 2 : fresh;
  stage_ = Stage::kAsking;
  verdict_ = RemovalVerdict::kAsked;
  asked_ = changed_ = now;
  said_ = MonoTime();
}

void RemovalDesk::follow(const std::optional<DanceBoard::HeardLink>& link, DanceBoard& board,
                         MonoTime now) {
  if (stage_ == Stage::kNone || stage_ == Stage::kUnheard) return;
  if (link && link->link.removal == number_) {
    if (stage_ != Stage::kHeard || verdict_ != link->link.verdict) changed_ = now;
    stage_ = Stage::kHeard;
    verdict_ = link->link.verdict;
    return;
  }
  if (stage_ != Stage::kAsking) return;
  if (now - asked_ > kGivesUp) {
    stage_ = Stage::kUnheard;
    changed_ = now;
    return;
  }
  if (said_.is_set() && now - said_ < kAgain) return;
  said_ = now;
  board.ask(guest_, number_);
}

std::string RemovalDesk::words(const ShownNames& names, const Texts& texts, MonoTime now) const {
  if (stage_ == Stage::kNone || now - changed_ > kWordsHold) return {};
  if (stage_ == Stage::kUnheard) return texts[Text::kDanceRemoveUnheard];
  const std::string_view name = shown_name(names, guest_, texts);
  switch (verdict_) {
    case RemovalVerdict::kAsked:
      return texts.say(Text::kDanceRemoveAsked, {name});
    case RemovalVerdict::kDone:
      return texts.say(Text::kDanceRemoveDone, {name});
    case RemovalVerdict::kNotAllowed:
      return texts[Text::kDanceRemoveNot];
    case RemovalVerdict::kNoSuchGuest:
      return texts.say(Text::kDanceRemoveGone, {name});
    case RemovalVerdict::kPassedOn:
      return texts.say(Text::kDanceRemovePassed, {name});
    case RemovalVerdict::kTooMany:
      return texts[Text::kDanceRemoveMany];
    case RemovalVerdict::kNoAnswer:
      return texts[Text::kDanceRemoveSilent];
    case RemovalVerdict::kOwnGuest:
      return texts.say(Text::kDanceRemoveOwn, {name});
  }
  return {};
}

}  // namespace dance
