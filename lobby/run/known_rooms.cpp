#include "lobby/run/known_rooms.h"

#include "core/net/mono_clock.h"

namespace dance {
namespace {

constexpr Duration kAskRoomsAgain = Duration::s(10);

}  // namespace

void KnownRooms::ask(LobbyModel& model, bool keeps_facts) {
  asked_ = mono_now();
  const auto& known = model.settings.window.rooms;
  if (!keeps_facts || model.rooms.size() != known.size())
    model.rooms.assign(known.size(), RoomFact());
  const auto guest = GuestId::parse(model.settings.name);
  round_trips_.ask({known, guest.value_or(GuestId()), settings_});
}

bool KnownRooms::look(LobbyModel& model, MonoTime now) {
  const RoundTrips::Answers* answers = round_trips_.take();
  if (answers != nullptr) take(model, *answers);
  if (model.screen == LobbyScreen::kDance && !model.is_going_in && now - asked_ > kAskRoomsAgain)
    ask(model, true);
  return answers != nullptr;
}

void KnownRooms::take(LobbyModel& model, const RoundTrips::Answers& answers) {
  if (answers.count != model.rooms.size()) return;  // one was forgotten meanwhile
  for (std::size_t i = 0; i < answers.count; ++i) {
    RoomFact& room = model.rooms[i];
    room.state = answers.answered[i] ? RoomFact::State::kAnswers : RoomFact::State::kSilent;
    room.round_trip = answers.round_trips[i];
    const RoomGuests& guests = answers.guests[i];
    // What was told before stands until there is something new, or the server is silent.
    if (guests.state == RoomGuests::State::kUnanswered && answers.answered[i]) continue;
    room.who = guests.state == RoomGuests::State::kKnown        ? RoomFact::Who::kKnown
               : guests.state == RoomGuests::State::kNotAllowed ? RoomFact::Who::kNoKey
                                                                : RoomFact::Who::kUnknown;
    room.guest_count = guests.count;
    room.guests.clear();
    for (const GuestId& guest : guests.names) room.guests.emplace_back(guest.view());
  }
}

}  // namespace dance
