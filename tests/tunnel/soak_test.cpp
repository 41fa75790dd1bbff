// Hours of dancing in minutes: houses that come, go, are cut off and come back at random, clocks
// that run apart, lines that change, a server that is started anew; and nothing grows, drifts or
// gets stuck. DANCE_SOAK_MINUTES says how long it lasts in the dancers' time; an hour where it is
// not set, which lets every 16-bit number go round.
#include <gtest/gtest.h>
#include <malloc.h>

#include <cstdlib>

#include "tests/tunnel/simulated_tunnel.h"

namespace dance {
namespace {

constexpr std::int64_t kFrameEach_ms = 16;

class Soak : public ::testing::Test {
 protected:
  struct Dancer {
    SimulatedTunnel::House* house = nullptr;
    GuestId name;
    Duration drift_per_ms;
    MonoTime next_event;
    MonoTime comes_back;  // set: cut off, or away, until then
    std::vector<MonoTime> captured = std::vector<MonoTime>(8192);  // server's clock, by sequence
    std::vector<std::uint32_t> newest;                             // heard of each other dancer
  };

  void add(const char* name, Duration ahead, Duration drift_per_ms) {
    Dancer& dancer = dancers.emplace_back();
    dancer.name = guest(name);
    dancer.house = &tunnel.add_house("salsa", {name}, ahead);
    dancer.house->next_sequence = 0xffff'fff0u - static_cast<std::uint32_t>(dancers.size()) * 1000;
    dancer.drift_per_ms = drift_per_ms;
    dancer.next_event = tunnel.now() + Duration::s(5);
    dancer.newest.assign(8, 0);
  }

  Duration between(std::int64_t least_ms, std::int64_t most_ms) {
    return Duration::ms(
        least_ms + static_cast<std::int64_t>(random.next_u64() %
                                             static_cast<std::uint64_t>(most_ms - least_ms + 1)));
  }

  void each_ms() {
    const MonoTime now = tunnel.now();
    for (Dancer& dancer : dancers) {
      dancer.house->clock_ahead += dancer.drift_per_ms;
      if (dancer.comes_back.is_set() && now >= dancer.comes_back) come_back(dancer);
      if (now >= dancer.next_event) happen(dancer);
      const bool is_dancing = dancer.house->is_running;
      if (is_dancing && now.since_zero_us() / 1000 % kFrameEach_ms == 0) {
        dancer.captured[dancer.house->next_sequence % dancer.captured.size()] =
            now - Duration::ms(10);
        tunnel.dance(*dancer.house, dancer.name);
        ++danced;
      }
    }
    if (now >= next_server_start) {
      if (next_server_start.is_set()) {
        tunnel.stop_server();
        tunnel.start_server();
        ++server_starts;
      }
      next_server_start = now + between(240'000, 480'000);
    }
    if (now.since_zero_us() / 1000 % 100 == 0) hear();
  }

  void come_back(Dancer& dancer) {
    dancer.comes_back = MonoTime();
    dancer.house->is_cut = false;
    if (dancer.house->is_running) return;
    hear();
    // A new program has seen nothing yet.
    std::fill(dancer.newest.begin(), dancer.newest.end(), 0);
    tunnel.start_link(*dancer.house, "salsa", {std::string(dancer.name.view())});
  }

  void happen(Dancer& dancer) {
    dancer.next_event = tunnel.now() + between(5'000, 60'000);
    if (dancer.comes_back.is_set()) return;
    dancer.comes_back = tunnel.now() + between(200, 8'000);
    switch (random.next_u64() % 5) {
      case 0:
        dancer.house->is_cut = true;
        break;
      case 1:
        dancer.house->link->send_goodbye();
        dancer.house->is_running = false;
        break;
      case 2:
        dancer.house->is_running = false;  // killed
        break;
      default:
        dancer.house->up = between(2, 80);
        dancer.house->down = between(2, 80);
        break;
    }
  }

  // What has been heard since the last time: in order, and of the moment at which it was danced.
  void hear() {
    for (Dancer& listener : dancers) {
      for (const auto& heard : listener.house->poses) {
        const auto sender = std::find_if(dancers.begin(), dancers.end(),
                                         [&](const Dancer& d) { return d.name == heard.guest; });
        ASSERT_NE(sender, dancers.end());
        const auto place = static_cast<std::size_t>(sender - dancers.begin());
        std::uint32_t& newest = listener.newest[place];
        if (newest != 0) {
          EXPECT_GT(static_cast<std::int32_t>(heard.pose.sequence - newest), 0)
              << "never an older one after a newer one";
        }
        newest = heard.pose.sequence;
        const MonoTime danced_at = sender->captured[heard.pose.sequence % sender->captured.size()];
        const Duration error = heard.pose.capture_time - (danced_at + listener.house->clock_ahead);
        worst_error = std::max(worst_error, std::max(error, -error));
        ++heard_poses;
      }
      auto& house = *listener.house;
      house.poses.clear();
      house.poses.shrink_to_fit();
      house.skeletons = {};
      house.hands = {};
      house.events = {};
    }
  }

  Random random{20'260'401};
  SimulatedTunnel tunnel;
  std::vector<Dancer> dancers;
  MonoTime next_server_start;
  std::uint64_t danced = 0;
  std::uint64_t heard_poses = 0;
  int server_starts = 0;
  Duration worst_error;
};

TEST_F(Soak, NothingGrowsDriftsOrGetsStuck) {
  const char* asked = std::getenv("DANCE_SOAK_MINUTES");
  const int minutes = asked != nullptr ? std::max(std::atoi(asked), 4) : 60;
  dancers.reserve(3);
  tunnel.on_datagram = [this](bool, PeerId, wire::Bytes) { return random.next_u64() % 100 != 0; };
  // 50 ppm apart each, as quartzes are at their worst: 0.36 s in an hour.
  add("alice", Duration::s(3), Duration::ns(50));
  add("bob", -Duration::s(1000), -Duration::ns(50));
  add("carol", Duration::s(86'400), Duration());
  std::size_t used_early = 0;
  for (int minute = 0; minute < minutes; ++minute) {
    const std::uint64_t heard_before = heard_poses;
    tunnel.run(Duration::s(60), [this] { each_ms(); });
    if (HasFatalFailure()) return;
    // Each dances for two others; many are away or cut off at times.
    EXPECT_GT(heard_poses - heard_before, 60u * 60u) << "in minute " << minute;
    const std::size_t used = mallinfo2().uordblks;
    if (minute == minutes / 4) used_early = used;
    if (minute > minutes / 4) {
      EXPECT_LT(used, used_early + 300'000) << "in minute " << minute;
    }
  }
  // Nobody knows the asymmetry of a line: half of what delays can differ by, and a way's change
  // that the mapping has not seen yet.
  EXPECT_LT(worst_error, Duration::ms(85));
  // When nothing happens any more everybody is there again.
  for (Dancer& dancer : dancers) {
    if (dancer.comes_back.is_set()) come_back(dancer);
    dancer.next_event = tunnel.now() + Duration::s(3600);
  }
  next_server_start = tunnel.now() + Duration::s(3600);
  tunnel.run(Duration::s(10), [this] { each_ms(); });
  for (const Dancer& dancer : dancers) {
    EXPECT_TRUE(dancer.house->link->is_connected());
    std::size_t here = 0;
    for (const auto& remote : dancer.house->link->remote_stats()) here += remote.is_here ? 1 : 0;
    EXPECT_EQ(here, 2u);
  }
  EXPECT_EQ(tunnel.server().guest_count(), 3u);
  std::printf(
      "%d minutes, %d starts of the server, %llu poses danced, %llu heard, mapping off by "
      "%.1f ms at worst\n",
      minutes, server_starts, static_cast<unsigned long long>(danced),
      static_cast<unsigned long long>(heard_poses), worst_error.as_ms());
}

}  // namespace
}  // namespace dance
