// What a program of ours says when something is wrong, as a banner that a dancer understands.
//
// Units/frames: none.
// Ownership:    plain values.
// Threads:      any.
// Failure:      a line that says nothing of the kind is none.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>

#include "lobby/screen/lobby_model.h"

namespace dance {

struct ChildTrouble {
  LobbyBanner banner;
  bool is_fatal = false;  // there is no dance with it
};

// Of a line of `dance join`, or of a program that it runs.
std::optional<ChildTrouble> trouble_in(std::string_view line, const LobbySettings& settings);
// The house dances: alone, as soon as it is open; in a room when the server has let it in.
bool says_it_is_in(std::string_view line, bool is_alone);
// Of a house that does not get to dance: the newest trouble that it told of, if any.
LobbyBanner start_error_of(const std::deque<std::string>& lines, const LobbySettings& settings);
// Of a program that has ended: what its last line says, where that is known, else that it ended.
LobbyBanner end_error_of(const std::deque<std::string>& lines, const LobbySettings& settings);

}  // namespace dance
