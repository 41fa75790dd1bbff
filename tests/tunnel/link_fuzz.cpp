// Datagrams at a link, as if its server had sent them; and answers to who is in a room, which no
// link hears, where they are read.
#include "tests/fuzz_target.h"
#include "tests/tunnel/datagram_script.h"
#include "tunnel/wire/wire_room.h"

DANCE_FUZZ_TARGET(link_datagram) {
  dance::FuzzScene scene;
  scene.play({data, size}, [&](int peer, dance::wire::Bytes datagram) {
    const auto opening = dance::wire::parse_opening(datagram);
    if (opening && opening->type == dance::wire::Type::kRoomAnswer)
      (void)dance::wire::parse_room_answer(opening->body);
    auto& house = peer == 1 ? *scene.b : *scene.a;
    house.link->receive(datagram, scene.tunnel.time_in(house), scene.tunnel.time_in(house));
  });
  return 0;
}
