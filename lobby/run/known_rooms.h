// KnownRooms: what the window knows of the rooms in its list: the way to their servers, and who is
// there. Asked when the window opens, after a dance, and now and then while the list is shown: some
// time after the last answer, however long those take.
//
// Units/frames: MonoTime of this process.
// Ownership:    owns the thread that asks.
// Threads:      the drawing thread.
// Failure:      what is not answered stays unknown in the model; names that nobody has confirmed
//               for kNamesHold are forgotten.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "lobby/run/round_trips.h"
#include "lobby/screen/lobby_model.h"

namespace dance {

class KnownRooms {
 public:
  static constexpr Duration kAgain = Duration::s(10);
  static constexpr Duration kNamesHold = Duration::s(60);

  // `settings`: the session file; `has_answers` as of RoundTrips.
  KnownRooms(std::string settings, std::function<void()> has_answers)
      : settings_(std::move(settings)), round_trips_(std::move(has_answers)) {}

  // What is known is forgotten first, unless that is kept until there are answers.
  void ask(LobbyModel& model, bool keeps_facts = false);
  // Takes answers, and asks again where that is due; true where there is something new.
  bool look(LobbyModel& model, MonoTime now);

  // Into the rooms that were asked for, wherever they are in the list by now.
  static void take(LobbyModel& model, const RoundTrips::Answers& answers);
  // True where there were names too old.
  static bool forget_old_names(LobbyModel& model, MonoTime now);

 private:
  std::string settings_;
  RoundTrips round_trips_;
  MonoTime answered_;  // last
};

}  // namespace dance
