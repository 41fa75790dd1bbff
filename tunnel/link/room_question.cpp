#include "tunnel/link/room_question.h"

#include <algorithm>

#include "core/net/mono_clock.h"
#include "core/net/poller.h"
#include "core/net/secure_random.h"
#include "core/net/udp_socket.h"
#include "tunnel/seal/seal_client.h"

namespace dance {
namespace {

constexpr Duration kAskRoomAgain = Duration::ms(700);

RoomGuests guests_in(const wire::RoomAnswer& answer) {
  RoomGuests guests;
  switch (answer.result) {
    case wire::RoomResult::kNotAllowed:
      guests.state = RoomGuests::State::kRefused;
      break;
    case wire::RoomResult::kNotHere:
      guests.state = RoomGuests::State::kNotHere;
      break;
    case wire::RoomResult::kKnown:
      guests.state = RoomGuests::State::kKnown;
      guests.count = answer.count;
      guests.names = answer.names;
      break;
  }
  return guests;
}

}  // namespace

std::vector<RoomGuests> ask_who_is_there(const Address& server, const LinkKey& key,
                                         std::span<const wire::RoomName> rooms, Duration patience,
                                         const std::atomic<bool>& is_ended) {
  std::vector<RoomGuests> found(rooms.size());
  auto poller = Poller::create();
  auto socket = UdpSocket::connect(server);
  auto context = key.context();
  if (!context)
    for (RoomGuests& guests : found) guests.state = RoomGuests::State::kRefused;
  if (!poller || !socket || !context || rooms.empty()) return found;
  // Each has the number of its place, from 1; without those that are answered.
  std::vector<std::size_t> open(rooms.size());
  for (std::size_t i = 0; i < open.size(); ++i) open[i] = i;
  bool is_sealed = false, is_refused = false;
  MonoTime ask_at;
  SealClient::Handlers handlers;
  handlers.on_sealed = [&](MonoTime now) {
    is_sealed = true;
    ask_at = now;
  };
  handlers.on_unsealed = [&](MonoTime) { is_sealed = false; };
  handlers.on_datagram = [&](seal::Bytes plain, MonoTime, MonoTime) {
    const auto opening = wire::parse_opening(plain);
    if (!opening || opening->type != wire::Type::kRoomAnswer) return;
    const auto answer = wire::parse_room_answer(opening->body);
    if (!answer || std::erase(open, std::size_t{answer->number} - 1) == 0) return;
    const std::size_t which = answer->number - 1;
    found[which] = guests_in(*answer);
  };
  handlers.on_trouble = [&](SealTrouble trouble, MonoTime) {
    is_refused = trouble != SealTrouble::kNoAnswer && trouble != SealTrouble::kInterrupted;
  };
  SealClient client(std::move(*context), secure_random_u64, std::move(handlers), *socket);
  (*poller)->watch(socket->fd(), [&](MonoTime now) {
    for (const UdpSocket::Datagram& datagram : socket->receive())
      client.receive(datagram.bytes, datagram.received, now);
  });
  const MonoTime given_up = mono_now() + patience;
  while (!open.empty() && !is_refused && !is_ended.load(std::memory_order_acquire)) {
    const MonoTime now = mono_now();
    if (now >= given_up) break;
    if (now >= client.next_deadline()) client.tick(now);
    if (is_sealed && now >= ask_at) {
      for (const std::size_t which : open) {
        std::array<std::uint8_t, 64> out;
        const wire::RoomQuestion question{static_cast<std::uint32_t>(which + 1), rooms[which]};
        client.send({}, {out.data(), wire::build(question, out)});
      }
      ask_at = now + kAskRoomAgain;
    }
    socket->flush();
    (*poller)->run_once(Duration::ms(10));
  }
  if (is_refused)
    for (const std::size_t which : open) found[which].state = RoomGuests::State::kRefused;
  (*poller)->unwatch(socket->fd());
  client.close();
  socket->flush();
  return found;
}

}  // namespace dance
