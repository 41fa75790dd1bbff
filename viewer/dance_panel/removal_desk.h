// RemovalDesk: what became of a guest whom the host of this house wants removed: asked until the
// link has heard it, and told in words.
//
// Units/frames: MonoTime of the house's clock.
// Ownership:    plain value.
// Threads:      the drawing thread.
// Failure:      where no link hears it, words() says so.
#pragma once

#include <string>

#include "viewer/dance_panel/dance_board.h"
#include "viewer/words/shown_name.h"

namespace dance {

class RemovalDesk {
 public:
  static constexpr Duration kAgain = Duration::ms(200);
  static constexpr Duration kGivesUp = Duration::s(2);
  static constexpr Duration kWordsHold = Duration::s(8);

  void remove(const GuestId& guest, MonoTime now);
  // Once a picture, with what the link told last.
  void follow(const std::optional<DanceBoard::HeardLink>& link, DanceBoard& board, MonoTime now);
  // "" where there is nothing to say.
  std::string words(const ShownNames& names, const Texts& texts, MonoTime now) const;

 private:
  enum class Stage : std::uint8_t { kNone, kAsking, kHeard, kUnheard };

  GuestId guest_;
  std::int32_t number_ = 0;
  Stage stage_ = Stage::kNone;
  RemovalVerdict verdict_ = RemovalVerdict::kAsked;
  MonoTime asked_, said_, changed_;
};

}  // namespace dance
