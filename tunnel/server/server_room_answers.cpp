#include "tunnel/server/server_room_answers.h"

namespace dance {
namespace {

// With one key: a window that knows 32 rooms here asks of all of them every ten seconds.
constexpr double kQuestionsPerSecond = 8.0;
constexpr double kQuestionBurst = 64.0;

}  // namespace

ServerRoomAnswers::ServerRoomAnswers(ServerContext& server, const ServerAdmission& admission)
    : server_(server), admission_(admission) {
  questions_.fill(TokenBucket(kQuestionsPerSecond, kQuestionBurst));
}

void ServerRoomAnswers::on_question(PeerId from, const Access& access, wire::Bytes body,
                                    MonoTime now) {
  const std::size_t place = std::hash<std::string_view>()(access.name.view()) % questions_.size();
  if (!questions_[place].take(1.0, now)) return server_.reject(ServerReject::kSessionRate);
  const auto question = wire::parse_room_question(body);
  if (!question) return server_.reject(ServerReject::kMalformed);
  const wire::RoomAnswer answer = answer_to(*question, access, now);
  if (answer.result == wire::RoomResult::kNotAllowed) server_.reject(ServerReject::kNotAllowed);
  std::array<std::uint8_t, wire::kMaxPlain> out;
  server_.send(from, {out.data(), wire::build(answer, out)});
}

wire::RoomAnswer ServerRoomAnswers::answer_to(const wire::RoomQuestion& question,
                                              const Access& access, MonoTime now) const {
  wire::RoomAnswer answer;
  answer.number = question.number;
  // No link has the token 0. One that shares a key with the room is told from others by the names
  // of its guests, which it does not say here.
  constexpr std::uint64_t kNoLink = 0;
  const FixedList<GuestId, 1> no_guests;
  if (!access.may_enter(question.room) ||
      server_.bans.refused_until(question.room, kNoLink, access, no_guests, now)) {
    answer.result = wire::RoomResult::kNotAllowed;
    return answer;
  }
  const auto index = admission_.find_room(question.room);
  if (!index) {
    if (server_.cluster != nullptr) answer.result = wire::RoomResult::kNotHere;
    return answer;
  }
  const ServerRoom& room = server_.rooms[*index];
  // A part of the guests would count as all of them.
  if (room.settled_at.is_set() && now < room.settled_at) {
    answer.result = wire::RoomResult::kNotHere;
    return answer;
  }
  for (const ServerGuest& guest : room.guests) {
    if (!guest.in_use) continue;
    ++answer.count;
    (void)answer.names.try_push(guest.id);  // of more their number
  }
  return answer;
}

}  // namespace dance
