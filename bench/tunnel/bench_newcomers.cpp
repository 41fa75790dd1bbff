#include "bench/tunnel/bench_newcomers.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "core/net/mono_clock.h"
#include "core/net/poller.h"
#include "core/program/child_process.h"
#include "core/program/figures.h"
#include "core/program/program.h"
#include "testing/scratch_folder.h"
#include "tunnel/link/link.h"
#include "tunnel/seal/keys/house_keys.h"

namespace dance {
namespace {

constexpr std::uint16_t kPort = 7452;
constexpr std::size_t kGuestsPerRoom = 30;
constexpr Duration kLongest = Duration::s(30);
// The flood has then used up the burst of handshakes that the server allows.
constexpr Duration kFloodBefore = Duration::s(4);

GuestId name_of(const char* kind, std::size_t number) {
  return *GuestId::parse(kind + std::to_string(number));
}

const GuestId kNewcomer = *GuestId::parse("newcomer"), kHall = *GuestId::parse("hall");

// The server as a guest in network `number` reaches it: on a loopback device the source of a
// datagram to a local address is that address.
Address seen_from(std::size_t number) {
  const std::array<std::uint8_t, 4> ip{10, static_cast<std::uint8_t>(number % 250),
                                       static_cast<std::uint8_t>(number / 250), 1};
  return Address::of(ip, kPort);
}

Result<void> add_route(const std::vector<std::string>& arguments) {
  DANCE_TRY(ChildProcess ip, ChildProcess::start({"ip", arguments}));
  if (!ip.wait(Duration::s(10)) || !ip.ended_well())
    return fail("ip " + arguments[0] + " route: " + ip.exit_text() +
                "; the newcomers need the package iproute2 and a private network");
  return {};
}

class BenchNewcomers {
 public:
  explicit BenchNewcomers(const BenchNewcomersOptions& options) : options_(options) {}

  Result<NewcomersResult> run() {
    if (auto prepared = prepare(); !prepared) return tl::make_unexpected(prepared.error());
    if (auto started = start_server(); !started) return tl::make_unexpected(started.error());
    if (auto done = newcomers("calm", options_.newcomers); !done)
      return tl::make_unexpected(done.error());
    if (auto begun = open_guests(); !begun) return tl::make_unexpected(begun.error());

    NewcomerFlood::Options attack;
    DANCE_TRY(attack.server, Address::resolve("[::1]:" + std::to_string(kPort)));
    attack.per_second = options_.hellos_per_second;
    attack.network_bits = options_.network_bits;
    DANCE_TRY(const auto flood, NewcomerFlood::make(attack));
    flood->start();
    turn_until([] { return false; }, kFloodBefore);
    const MonoTime begin = mono_now();
    const Duration cpu = server_->cpu_time();
    if (auto done = newcomers("flood", options_.newcomers); !done)
      return tl::make_unexpected(done.error());
    result_.server_cpu_percent =
        100.0 * (server_->cpu_time() - cpu).as_seconds() / (mono_now() - begin).as_seconds();
    if (auto done = restart(); !done) return tl::make_unexpected(done.error());
    result_.attack = flood->totals();
    return std::move(result_);
  }

 private:
  struct Guest {
    std::unique_ptr<Link> link;
    std::uint64_t sessions_before = 0;
    std::optional<Duration> took;
  };

  Result<void> prepare() {
    DANCE_TRY(poller_, Poller::create());
    if (auto stops = poller_->stop_on_signals(); !stops) return stops;
    DANCE_TRY(scratch_, ScratchFolder::make());
    if (auto made = add_route({"-6", "route", "add", "local", NewcomerFlood::kPrefix, "dev", "lo"});
        !made)
      return made;
    if (auto made = add_route({"-4", "route", "add", "local", "10.0.0.0/8", "dev", "lo"}); !made)
      return made;
    DANCE_TRY(newcomer_key_, make_key("--new-guest", kNewcomer));
    for (std::size_t room = 0; room * kGuestsPerRoom < options_.guests; ++room) {
      DANCE_TRY(LinkKey key, make_key("--new-room-key", name_of("party", room)));
      room_keys_.push_back(std::move(key));
    }
    return {};
  }

  Result<LinkKey> make_key(const char* option, const GuestId& name) {
    const std::string file = scratch_->file("key-" + std::string(name.view()));
    DANCE_TRY(ChildProcess made,
              ChildProcess::start({program_folder() + "/dance-server",
                                   {"--keys", scratch_->file("keys"), option,
                                    std::string(name.view()), "--address", "127.0.0.1"},
                                   file,
                                   "/dev/null"}));
    std::string line;
    if (made.wait(Duration::s(10)) && made.ended_well())
      std::getline(std::ifstream(file) >> std::ws, line);
    DANCE_TRY(const HouseKey key, HouseKey::parse(line));
    return LinkKey::of(key, PrivateKey::make());
  }

  // Returns when the server is ready to receive.
  Result<void> start_server() {
    const std::string talk = scratch_->file("talk-" + std::to_string(servers_++));
    DANCE_TRY(ChildProcess server,
              ChildProcess::start({program_folder() + "/dance-server",
                                   {"--bind", "::", "--port", std::to_string(kPort), "--keys",
                                    scratch_->file("keys"), "--max-sessions",
                                    std::to_string(2 * options_.guests + 64)},
                                   "/dev/null",
                                   talk}));
    server_.emplace(std::move(server));
    const auto is_up = [&] {
      std::stringstream text;
      text << std::ifstream(talk).rdbuf();
      return text.str().find("hears on") != std::string::npos;
    };
    if (!turn_until(is_up, kLongest)) return fail("the server did not start: " + talk);
    return {};
  }

  Result<Guest> open(const LinkKey& key, const GuestId& room, const GuestId& name,
                     std::size_t network) {
    LinkOptions of;
    of.room = room;
    (void)of.guests.try_push(name);
    Guest guest;
    DANCE_TRY(guest.link, Link::open({seen_from(network)}, key, of, {}, *poller_));
    return guest;
  }

  template <class Condition>
  bool turn_until(const Condition& is_so, Duration longest) {
    const MonoTime end = mono_now() + longest;
    while (!is_so() && mono_now() < end && !poller_->is_stopped()) {
      poller_->run_once(Duration::ms(2));
      if (ended_.is_set()) note_returns();
    }
    return is_so();
  }

  // Lets newcomers join one after the other, each from a network that is new to the server.
  Result<void> newcomers(
      const char* name, std::size_t count,
      const std::function<bool()>& is_over = [] { return false; }) {
    NewcomerTimes times;
    times.name = name;
    for (std::size_t i = 0; i < count && !is_over(); ++i) {
      const MonoTime begin = mono_now();
      DANCE_TRY(const Guest guest, open(newcomer_key_, kHall, kNewcomer, next_network_++));
      if (turn_until([&] { return guest.link->is_connected(); }, kLongest))
        times.took.push_back(mono_now() - begin);
      else
        ++times.missing;
      if (poller_->is_stopped()) return fail("stopped by a signal before the end");
      if (server_->has_ended()) return fail("the server " + server_->exit_text());
    }
    std::sort(times.took.begin(), times.took.end());
    result_.phases.push_back(std::move(times));
    return {};
  }

  Result<void> open_guests() {
    for (std::size_t i = 0; i < options_.guests; ++i) {
      const std::size_t room = i / kGuestsPerRoom;
      DANCE_TRY(Guest guest,
                open(room_keys_[room], name_of("party", room), name_of("g", i), next_network_++));
      guests_.push_back(std::move(guest));
    }
    const auto here = [this] {
      return static_cast<std::size_t>(std::ranges::count_if(
          guests_, [](const Guest& guest) { return guest.link->is_connected(); }));
    };
    if (!turn_until([&] { return here() == guests_.size(); }, kLongest))
      return fail("only " + std::to_string(here()) + " of " + std::to_string(guests_.size()) +
                  " guests came in before the restart");
    return {};
  }

  void note_returns() {
    for (Guest& guest : guests_) {
      if (guest.took || !guest.link->is_connected() ||
          guest.link->seal_counters().sessions == guest.sessions_before)
        continue;
      guest.took = mono_now() - ended_;
      ++returned_;
    }
  }

  // The server ends without a goodbye, as when it crashes, and starts again at once.
  Result<void> restart() {
    for (Guest& guest : guests_) guest.sessions_before = guest.link->seal_counters().sessions;
    server_->kill_now();
    ended_ = mono_now();
    if (auto started = start_server(); !started) return started;
    const auto is_over = [this] {
      return returned_ == guests_.size() || mono_now() - ended_ > kLongest;
    };
    if (auto done = newcomers("restart", options_.newcomers, is_over); !done) return done;
    turn_until(is_over, kLongest);
    NewcomerTimes times;
    times.name = "returning";
    for (const Guest& guest : guests_)
      if (guest.took)
        times.took.push_back(*guest.took);
      else
        ++times.missing;
    std::sort(times.took.begin(), times.took.end());
    result_.phases.push_back(std::move(times));
    return {};
  }

  BenchNewcomersOptions options_;
  std::unique_ptr<ScratchFolder> scratch_;
  std::unique_ptr<Poller> poller_;
  std::optional<ChildProcess> server_;
  LinkKey newcomer_key_;
  std::vector<LinkKey> room_keys_;
  std::size_t next_network_ = 0;
  std::size_t servers_ = 0;   // started so far
  MonoTime ended_;            // when the first one was killed
  std::size_t returned_ = 0;  // of guests_, since then
  std::vector<Guest> guests_;
  NewcomersResult result_;
};

}  // namespace

Result<NewcomersResult> run_bench_newcomers(const BenchNewcomersOptions& options) {
  BenchNewcomers bench(options);
  return bench.run();
}

std::string bench_newcomers_table(const BenchNewcomersOptions& options,
                                  const NewcomersResult& result) {
  std::string out = fmt::format(
      "newcomers beside {:g} new handshakes a second from {} IPv6 /64s of one owner; {} guests "
      "return after a restart\n\n",
      options.hellos_per_second, 1u << options.network_bits, options.guests);
  const auto back = std::back_inserter(out);
  fmt::format_to(back, "  {:<11}{:>8}{:>9}{:>12}{:>9}{:>9}\n", "", "came in", "missing",
                 "median ms", "p90 ms", "max ms");
  for (const NewcomerTimes& phase : result.phases)
    fmt::format_to(back, "  {:<11}{:>8}{:>9}{:>12.1f}{:>9.1f}{:>9.1f}\n", phase.name,
                   phase.took.size(), phase.missing, percentile<Duration>(phase.took, 0.5).as_ms(),
                   percentile<Duration>(phase.took, 0.9).as_ms(),
                   percentile<Duration>(phase.took, 1.0).as_ms());
  fmt::format_to(back,
                 "\n  the flood: {} hellos, {} cookies answered; server cpu {:.1f} % of a core\n",
                 result.attack.hellos, result.attack.begun, result.server_cpu_percent);
  return out;
}

std::string bench_newcomers_json(const BenchNewcomersOptions& options,
                                 const NewcomersResult& result) {
  nlohmann::ordered_json json{{"hellos_per_second", options.hellos_per_second},
                              {"networks", 1u << options.network_bits},
                              {"guests", options.guests}};
  for (const NewcomerTimes& phase : result.phases)
    json[phase.name] = {{"came_in", phase.took.size()},
                        {"missing", phase.missing},
                        {"median_ms", rounded(percentile<Duration>(phase.took, 0.5).as_ms(), 10.0)},
                        {"p90_ms", rounded(percentile<Duration>(phase.took, 0.9).as_ms(), 10.0)},
                        {"max_ms", rounded(percentile<Duration>(phase.took, 1.0).as_ms(), 10.0)}};
  json["hellos"] = result.attack.hellos;
  json["cookies_answered"] = result.attack.begun;
  json["server_cpu_percent"] = rounded(result.server_cpu_percent, 10.0);
  return json.dump() + "\n";
}

}  // namespace dance
