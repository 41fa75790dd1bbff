#include "lobby/run/known_rooms.h"

#include <algorithm>

#include "core/net/mono_clock.h"

namespace dance {
namespace {

void take_guests(RoomFact& room, const RoundTrips::Answer& answer) {
  using State = RoomGuests::State;
  const RoomGuests& guests = answer.guests;
  // What was told before stands until there is something new, or the server is silent.
  if (guests.state == State::kUnanswered && answer.server == RoundTrips::Answer::Server::kAnswers)
    return;
  room.who = guests.state == State::kKnown     ? RoomFact::Who::kKnown
             : guests.state == State::kNoKey   ? RoomFact::Who::kNoKey
             : guests.state == State::kRefused ? RoomFact::Who::kRefused
                                               : RoomFact::Who::kUnknown;
  room.told = answer.told;
  room.guest_count = guests.count;
  room.guests.clear();
  for (const GuestId& guest : guests.names) room.guests.emplace_back(guest.view());
}

}  // namespace

void KnownRooms::ask(LobbyModel& model, bool keeps_facts) {
  const auto& known = model.settings.window.rooms;
  if (!keeps_facts || model.rooms.size() != known.size())
    model.rooms.assign(known.size(), RoomFact());
  answered_ = mono_now();
  const auto guest = GuestId::parse(model.settings.name);
  round_trips_.ask({known, guest.value_or(GuestId()), settings_});
}

bool KnownRooms::look(LobbyModel& model, MonoTime now) {
  const bool is_busy = round_trips_.is_busy();  // before it is seen what there is
  const RoundTrips::Answers* answers = round_trips_.take();
  if (answers != nullptr) take(model, *answers);
  const bool has_forgotten = forget_old_names(model, now);
  if (is_busy)
    answered_ = now;
  else if (model.screen == LobbyScreen::kDance && !model.is_going_in && now - answered_ > kAgain)
    ask(model, true);
  return answers != nullptr || has_forgotten;
}

void KnownRooms::take(LobbyModel& model, const RoundTrips::Answers& answers) {
  using Server = RoundTrips::Answer::Server;
  const auto& known = model.settings.window.rooms;
  if (model.rooms.size() != known.size()) model.rooms.assign(known.size(), RoomFact());
  for (const RoundTrips::Answer& answer : answers.rooms) {
    const auto at = std::ranges::find(known, answer.room);
    // It is not asked yet, or was forgotten meanwhile.
    if (answer.server == Server::kAsking || at == known.end()) continue;
    RoomFact& room = model.rooms[static_cast<std::size_t>(at - known.begin())];
    room.state =
        answer.server == Server::kAnswers ? RoomFact::State::kAnswers : RoomFact::State::kSilent;
    room.round_trip = answer.round_trip;
    take_guests(room, answer);
  }
}

bool KnownRooms::forget_old_names(LobbyModel& model, MonoTime now) {
  bool has_forgotten = false;
  for (RoomFact& room : model.rooms) {
    if (room.who == RoomFact::Who::kUnknown || now - room.told <= kNamesHold) continue;
    room.who = RoomFact::Who::kUnknown;
    room.guest_count = 0;
    room.guests.clear();
    has_forgotten = true;
  }
  return has_forgotten;
}

}  // namespace dance
