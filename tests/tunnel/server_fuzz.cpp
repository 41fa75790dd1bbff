// Datagrams at a server: of its two links, and of strangers.
#include "tests/tunnel/datagram_script.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  dance::FuzzScene scene;
  scene.play({data, size}, [&](int peer, dance::wire::Bytes datagram) {
    const auto from = peer == 0 ? scene.a->address
                      : peer == 1
                          ? scene.b->address
                          : dance::Address::loopback(static_cast<std::uint16_t>(6000 + peer));
    scene.tunnel.inject(from, datagram);
  });
  return 0;
}
