// Writes the seeds of the fuzz target: what really passes in handshakes and sessions.
//
// make_seal_corpus FOLDER
#include <cstdio>
#include <fstream>

#include "tests/tunnel/seal/sealed_street.h"

namespace {

void add(std::vector<std::uint8_t>& seed, std::uint8_t how, std::vector<std::uint8_t> bytes) {
  if (bytes.size() % 2 == 1) bytes.push_back(0);
  seed.push_back(how);
  seed.push_back(static_cast<std::uint8_t>(bytes.size() / 2));
  seed.insert(seed.end(), bytes.begin(), bytes.end());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "make_seal_corpus FOLDER\n");
    return 2;
  }
  const dance::GuestKey alice = dance::key_of("alice");
  dance::SealedStreet street({alice});
  auto& house = street.add_house("alice", alice.own);
  auto& wrong = street.add_house("alice", dance::PrivateKey::make());
  street.run(dance::Duration::ms(20));
  street.say(house, "a datagram");
  house.client->close();
  street.run(dance::Duration::ms(5));
  int number = 0;
  std::vector<std::uint8_t> all;
  for (const auto& passed : street.sent) {
    const int how = passed.to_server ? (passed.peer == wrong.address ? 5 : 0)
                                     : (passed.peer == wrong.address ? 129 : 64);
    std::vector<std::uint8_t> seed;
    add(seed, static_cast<std::uint8_t>(how), passed.bytes);
    all.insert(all.end(), seed.begin(), seed.end());
    std::ofstream(std::string(argv[1]) + "/" + std::to_string(number++), std::ios::binary)
        .write(reinterpret_cast<const char*>(seed.data()), static_cast<long>(seed.size()));
  }
  std::ofstream(std::string(argv[1]) + "/all", std::ios::binary)
      .write(reinterpret_cast<const char*>(all.data()), static_cast<long>(all.size()));
  return 0;
}
