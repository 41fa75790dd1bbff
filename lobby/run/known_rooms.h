// KnownRooms: what the window knows of the rooms in its list: the way to their servers, and who is
// there. Asked when the window opens, after a dance, and now and then while the list is shown.
//
// Units/frames: MonoTime of this process.
// Ownership:    owns the thread that asks.
// Threads:      the drawing thread.
// Failure:      what is not answered stays unknown in the model.
#pragma once

#include <string>

#include "lobby/run/round_trips.h"
#include "lobby/screen/lobby_model.h"

namespace dance {

class KnownRooms {
 public:
  // `settings`: the session file; `has_answers` as of RoundTrips.
  KnownRooms(std::string settings, std::function<void()> has_answers)
      : settings_(std::move(settings)), round_trips_(std::move(has_answers)) {}

  // What is known is forgotten first, unless that is kept until there are answers.
  void ask(LobbyModel& model, bool keeps_facts = false);
  // Takes answers, and asks again where that is due; true where there is something new.
  bool look(LobbyModel& model, MonoTime now);

 private:
  static void take(LobbyModel& model, const RoundTrips::Answers& answers);

  std::string settings_;
  RoundTrips round_trips_;
  MonoTime asked_;
};

}  // namespace dance
