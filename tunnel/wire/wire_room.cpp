#include "tunnel/wire/wire_room.h"

namespace dance::wire {
namespace {

void begin_of_room(Type type, std::uint32_t number, ByteWriter& out) {
  out.u8(static_cast<std::uint8_t>(type));
  out.u8(kRoomForm);
  out.u32(number);
}

}  // namespace

std::size_t build(const RoomQuestion& question, std::span<std::uint8_t> buffer) {
  ByteWriter out(buffer);
  begin_of_room(Type::kRoomQuestion, question.number, out);
  out.short_text(question.room.view());
  return out.ok() ? out.size() : 0;
}

std::optional<RoomQuestion> parse_room_question(Bytes body) {
  ByteReader in(body);
  const std::uint8_t form = in.u8();
  RoomQuestion question;
  question.number = in.u32();
  const auto room = RoomName::parse(in.text(in.u8()));
  if (!in.is_exhausted() || form != kRoomForm || question.number == 0 || !room) return std::nullopt;
  question.room = *room;
  return question;
}

std::size_t build(const RoomAnswer& answer, std::span<std::uint8_t> buffer) {
  ByteWriter out(buffer);
  begin_of_room(Type::kRoomAnswer, answer.number, out);
  out.u8(static_cast<std::uint8_t>(answer.result));
  out.u8(answer.count);
  out.u8(static_cast<std::uint8_t>(answer.names.size()));
  for (const GuestId& name : answer.names) out.short_text(name.view());
  return out.ok() ? out.size() : 0;
}

std::optional<RoomAnswer> parse_room_answer(Bytes body) {
  ByteReader in(body);
  const std::uint8_t form = in.u8();
  RoomAnswer answer;
  answer.number = in.u32();
  answer.result = static_cast<RoomResult>(in.u8());
  answer.count = in.u8();
  const std::size_t names = in.u8();
  if (names > kMostNamesTold || names > answer.count || answer.count > kMaxGuestsPerRoom)
    return std::nullopt;
  for (std::size_t i = 0; i < names; ++i) {
    const auto name = GuestId::parse(in.text(in.u8()));
    if (!name || answer.names.contains(*name)) return std::nullopt;
    (void)answer.names.try_push(*name);
  }
  const bool is_result =
      answer.result >= RoomResult::kKnown && answer.result <= RoomResult::kNotHere;
  const bool tells = answer.result == RoomResult::kKnown || answer.count == 0;
  if (!in.is_exhausted() || form != kRoomForm || answer.number == 0 || !is_result || !tells)
    return std::nullopt;
  return answer;
}

}  // namespace dance::wire
