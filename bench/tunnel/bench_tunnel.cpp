#include "bench/tunnel/bench_tunnel.h"

#include <algorithm>
#include <array>
#include <optional>

#include "bench/parts/salsa_poses.h"
#include "bench/tunnel/crowd.h"
#include "core/base/assert.h"
#include "core/net/mono_clock.h"
#include "core/net/udp_socket.h"
#include "core/program/child_process.h"
#include "core/program/figures.h"
#include "core/program/program.h"

namespace dance {
namespace {

constexpr Duration kTimeout = Duration::s(15);
// Each way dances for so long before the next one does.
constexpr Duration kTurn = Duration::ms(500);
// Before it is measured: until links trust a line, they send more than it needs.
constexpr Duration kKnowsItsLine = Duration::s(10);
// Before a turn counts, and for what is still under way behind it.
constexpr Duration kSettles = Duration::ms(150);

// What is summed up of one way of dancing, turn by turn.
struct Sums {
  std::uint64_t poses_up = 0, voices_due = 0;
  Traffic traffic;
  Duration time, cpu;
};

// One relay and its crowd.
struct Way {
  TunnelWay result;
  std::unique_ptr<ChildProcess> relay;
  std::unique_ptr<Crowd> crowd;
  std::vector<std::array<MonoTime, 256>> sent_at;  // of each guest, by sequence
  std::vector<std::uint32_t> next, first;          // sequences; the first that counts in this turn
  TunnelMeasure* counts = nullptr;                 // set while it does
  std::size_t voices = 0;                          // guests who speak
  Sums together, spread;
  Duration idle_time, idle_cpu;

  void arrived(std::size_t listener, std::size_t sender, std::uint32_t sequence) {
    if (counts == nullptr || listener >= kListeners || sender >= next.size()) return;
    const std::uint32_t back = next[sender] - 1 - sequence;
    if (sequence < first[sender] || back >= sent_at[sender].size()) return;
    ++counts->delivered;
    counts->took.push_back(mono_now() - sent_at[sender][sequence % sent_at[sender].size()]);
  }
};

class BenchTunnel {
 public:
  explicit BenchTunnel(const BenchTunnelOptions& options) : options_(options) {}
  Result<void> prepare(const std::string& own_program);
  Result<TunnelWays> run();

 private:
  using OpenCrowd = Result<std::unique_ptr<Crowd>>(const CrowdOptions&, Poller&);
  Result<void> add(const std::string& name, const std::string& title, const std::string& program,
                   std::vector<std::string> arguments, OpenCrowd open);
  Result<void> wait_until_open(Way& way);
  void dance(Way& way, Duration span, bool counts);
  void add_up(Way& way, Duration took, Duration cpu, const Traffic& before);
  void finish(const Sums& sums, TunnelMeasure& measure) const;
  void send_due(Way& way, MonoTime now);
  void speak_due(Way& way, MonoTime now);
  void turn_for(Duration span);
  void take_turns(Duration turn);
  double poses_per_s() const { return options_.hz * static_cast<double>(options_.guests); }
  MonoTime next_due() const {
    const std::size_t frames = danced_ / options_.guests;
    return begin_ + Duration::seconds(is_together_ ? static_cast<double>(frames) / options_.hz
                                                   : static_cast<double>(danced_) / poses_per_s());
  }

  BenchTunnelOptions options_;
  std::string own_program_;
  std::vector<Pose> poses_ = salsa_poses();
  std::unique_ptr<Poller> poller_;
  std::vector<std::unique_ptr<Way>> ways_;
  bool is_together_ = false;  // everybody at the same moment
  // The talkers one after the other, spread over the 10 ms as their sound cards are.
  MonoTime next_voice(const Way& way) const {
    return begin_ +
           kVoiceFrame * static_cast<std::int64_t>(spoken_) / static_cast<std::int64_t>(way.voices);
  }

  MonoTime begin_;              // of this turn
  std::size_t danced_ = 0;      // poses in this turn, guest after guest
  std::size_t counted_ = 0;     // of them
  std::size_t spoken_ = 0;      // packets of voices in this turn
  std::size_t voices_due_ = 0;  // that count, once for each receiver
};

Result<void> BenchTunnel::prepare(const std::string& own_program) {
  own_program_ = own_program;
  DANCE_TRY(poller_, Poller::create());
  if (auto stops = poller_->stop_on_signals(); !stops) return stops;
  std::vector<std::string> more;
  if (options_.share_ms >= 0.0) more = {"--share-ms", std::to_string(options_.share_ms)};
  if (auto added =
          add("", "the tunnel", program_folder() + "/dance-server", more, open_tunnel_crowd);
      !added)
    return added;
  if (options_.voices > 0) {
    // What the same twice differ by is the noise of this machine.
    const std::string server = program_folder() + "/dance-server";
    if (auto again = add("again", "the same again", server, more, open_tunnel_crowd); !again)
      return again;
    return add("with_voices", std::to_string(options_.voices) + " speak", server, more,
               open_tunnel_crowd);
  }
  if (auto added = add("baseline_raw_udp", "bare UDP relay", own_program, {"--relay", "udp"},
                       open_udp_crowd);
      !added)
    return added;
#if DANCE_HAVE_ENET
  return add("baseline_enet", "ENet relay", own_program, {"--relay", "enet"}, open_enet_crowd);
#else
  return {};
#endif
}

Result<void> BenchTunnel::add(const std::string& name, const std::string& title,
                              const std::string& program, std::vector<std::string> arguments,
                              OpenCrowd open) {
  DANCE_TRY(const std::uint16_t port, free_loopback_port());
  auto way = std::make_unique<Way>();
  way->result.name = name;
  way->result.title = title;
  way->sent_at.resize(options_.guests);
  way->next.assign(options_.guests, 1);
  way->first.assign(options_.guests, 1);
  way->voices = name == "with_voices" ? options_.voices : 0;
  if (program != own_program_) arguments.insert(arguments.end(), {"--bind", "127.0.0.1"});
  arguments.insert(arguments.end(), {"--port", std::to_string(port)});
  DANCE_TRY(ChildProcess relay,
            ChildProcess::start({program, arguments, "/dev/null", "/dev/null"}));
  way->relay = std::make_unique<ChildProcess>(std::move(relay));
  Way* const at = way.get();
  DANCE_TRY(way->crowd,
            open({options_.guests, Address::loopback(port),
                  [at](std::size_t listener, std::size_t sender, std::uint32_t sequence) {
                    at->arrived(listener, sender, sequence);
                  },
                  options_.is_plain ? std::optional(CodecName{CodecId::kPlain, 0}) : std::nullopt,
                  [at](std::size_t listener, const Voice& voice) {
                    if (at->counts != nullptr && listener < kListeners)
                      at->counts->voice_took.push_back(mono_now() - voice.capture_time);
                  }},
                 *poller_));
  ways_.push_back(std::move(way));
  return wait_until_open(*at);
}

Result<void> BenchTunnel::wait_until_open(Way& way) {
  const MonoTime give_up = mono_now() + kTimeout;
  while (!way.crowd->is_open()) {
    if (way.relay->has_ended())
      return fail(way.result.title + ": its server " + way.relay->exit_text());
    if (mono_now() > give_up)
      return fail(way.result.title + ": not every guest was let in within 15 s");
    if (poller_->is_stopped()) return fail("stopped by a signal before the end");
    turn_for(Duration::ms(50));
  }
  return {};
}

void BenchTunnel::turn_for(Duration span) {
  for (const MonoTime end = mono_now() + span; mono_now() < end && !poller_->is_stopped();)
    poller_->run_once(std::min(Duration::ms(20), end - mono_now()));
}

void BenchTunnel::send_due(Way& way, MonoTime now) {
  for (; next_due() <= now; ++danced_) {
    const std::size_t guest = danced_ % options_.guests;
    const std::uint32_t sequence = way.next[guest]++;
    Pose pose = poses_[(sequence + 97 * guest) % poses_.size()];
    pose.sequence = sequence;
    pose.clock_id = this_clock_id();
    const MonoTime at = mono_now();
    pose.capture_time = at;
    way.sent_at[guest][sequence % way.sent_at[guest].size()] = at;
    if (way.counts != nullptr) {
      way.counts->sent += guest < kListeners ? kListeners - 1 : kListeners;
      ++counted_;
    }
    way.crowd->send(guest, pose, at);
  }
}

void BenchTunnel::speak_due(Way& way, MonoTime now) {
  constexpr std::size_t kPacket_bytes = 40;  // 32 kbit/s
  for (; next_voice(way) <= now; ++spoken_) {
    Voice voice;
    voice.sequence = static_cast<std::uint32_t>(spoken_ / way.voices);
    voice.clock_id = this_clock_id();
    voice.level_dbfs = -20;
    std::array<std::uint8_t, kPacket_bytes> packet;
    packet.fill(static_cast<std::uint8_t>(spoken_));
    const bool fits = voice.set_packet(packet);
    DANCE_ASSERT(fits);
    voice.capture_time = mono_now();
    if (way.counts != nullptr) voices_due_ += options_.guests - 1;
    way.crowd->speak(spoken_ % way.voices, voice, voice.capture_time);
  }
}

// As many poses as belong in `span`, however long the machine takes for them.
void BenchTunnel::dance(Way& way, Duration span, bool counts) {
  begin_ = mono_now();
  danced_ = counted_ = spoken_ = voices_due_ = 0;
  const auto settles = static_cast<std::size_t>(kSettles.as_seconds() * poses_per_s());
  const auto all = settles + static_cast<std::size_t>(span.as_seconds() * poses_per_s());
  Duration cpu;
  Traffic before;
  MonoTime counts_from;
  while (danced_ < all && !poller_->is_stopped()) {
    if (counts && way.counts == nullptr && danced_ >= settles) {
      way.counts = is_together_ ? &way.result.together : &way.result.spread;
      way.first = way.next;
      cpu = way.relay->cpu_time();
      before = way.crowd->traffic();
      counts_from = mono_now();
    }
    send_due(way, mono_now());
    if (way.voices > 0) speak_due(way, mono_now());
    const MonoTime next = way.voices > 0 ? std::min(next_due(), next_voice(way)) : next_due();
    poller_->run_once(std::max(next - mono_now(), Duration()));
  }
  // Bytes and processor of the dance alone; poses may arrive still.
  if (way.counts != nullptr)
    add_up(way, mono_now() - counts_from, way.relay->cpu_time() - cpu, before);
  turn_for(kSettles);
  way.counts = nullptr;
}

void BenchTunnel::add_up(Way& way, Duration took, Duration cpu, const Traffic& before) {
  Sums& sums = is_together_ ? way.together : way.spread;
  const Traffic now = way.crowd->traffic();
  sums.poses_up += counted_;
  sums.voices_due += voices_due_;
  const std::uint64_t voice_up = now.voice_bytes_up - before.voice_bytes_up;
  const std::uint64_t voice_down = now.voice_bytes_down - before.voice_bytes_down;
  sums.traffic.voice_bytes_up += voice_up;
  sums.traffic.voice_bytes_down += voice_down;
  sums.traffic.voices_down += now.voices_down - before.voices_down;
  sums.traffic.bytes_up += now.bytes_up - before.bytes_up - voice_up;
  sums.traffic.bytes_down += now.bytes_down - before.bytes_down - voice_down;
  sums.traffic.poses_down += now.poses_down - before.poses_down;
  sums.traffic.payload_down += now.payload_down - before.payload_down;
  sums.time += took;
  sums.cpu += cpu;
}

// A pose's payload is the same on both ways.
void BenchTunnel::finish(const Sums& sums, TunnelMeasure& measure) const {
  std::sort(measure.took.begin(), measure.took.end());
  measure.server_cpu_percent = 100.0 * sums.cpu.as_seconds() / sums.time.as_seconds();
  const Traffic& traffic = sums.traffic;
  const double danced_s = static_cast<double>(sums.poses_up) / poses_per_s();
  measure.down_bytes_per_s =
      static_cast<double>(traffic.bytes_down) / danced_s / static_cast<double>(options_.guests);
  std::sort(measure.voice_took.begin(), measure.voice_took.end());
  if (sums.voices_due > 0) {
    const auto guests = static_cast<double>(options_.guests);
    measure.voices_share =
        static_cast<double>(traffic.voices_down) / static_cast<double>(sums.voices_due);
    measure.voice_up_bytes_per_s = static_cast<double>(traffic.voice_bytes_up) / danced_s /
                                   static_cast<double>(options_.voices);
    measure.voice_down_bytes_per_s =
        static_cast<double>(traffic.voice_bytes_down) / danced_s / guests;
  }
  if (traffic.poses_down == 0) return;
  const auto poses_down = static_cast<double>(traffic.poses_down);
  measure.payload_bytes = static_cast<double>(traffic.payload_down) / poses_down;
  measure.overhead_down =
      static_cast<double>(traffic.bytes_down) / poses_down - measure.payload_bytes;
  measure.overhead_up = static_cast<double>(traffic.bytes_up) / static_cast<double>(sums.poses_up) -
                        measure.payload_bytes;
}

// Each way dances for a turn, and the others' relays show what they take while nothing comes.
void BenchTunnel::take_turns(Duration turn) {
  for (auto& way : ways_) {
    const MonoTime from = mono_now();
    std::vector<Duration> cpu;
    for (auto& other : ways_) cpu.push_back(other->relay->cpu_time());
    dance(*way, turn, true);
    for (std::size_t i = 0; i < ways_.size(); ++i) {
      if (ways_[i] == way) continue;
      ways_[i]->idle_time += mono_now() - from;
      ways_[i]->idle_cpu += ways_[i]->relay->cpu_time() - cpu[i];
    }
  }
}

Result<TunnelWays> BenchTunnel::run() {
  const Duration all = Duration::seconds(options_.seconds);
  for (auto& way : ways_) dance(*way, std::min(kKnowsItsLine, all), false);
  const Duration half = all / 2;
  for (Duration done; done < half && !poller_->is_stopped(); done += kTurn)
    for (const bool together : {true, false}) {
      is_together_ = together;
      take_turns(std::min(kTurn, half - done));
    }
  if (poller_->is_stopped()) return fail("stopped by a signal before the end");
  TunnelWays results;
  for (auto& way : ways_) {
    if (way->together.poses_up == 0 || way->spread.poses_up == 0)
      return fail("--seconds is too short: no pose was counted");
    finish(way->together, way->result.together);
    finish(way->spread, way->result.spread);
    way->result.idle_cpu_percent = 100.0 * way->idle_cpu.as_seconds() / way->idle_time.as_seconds();
    results.push_back(std::move(way->result));
  }
  return results;
}

}  // namespace

double TunnelMeasure::percentile_us(double fraction) const {
  return percentile<Duration>(took, fraction).as_us();
}

double TunnelMeasure::voice_percentile_us(double fraction) const {
  return percentile<Duration>(voice_took, fraction).as_us();
}

Result<TunnelWays> run_bench_tunnel(const BenchTunnelOptions& options,
                                    const std::string& own_program) {
  BenchTunnel bench(options);
  if (auto prepared = bench.prepare(own_program); !prepared)
    return tl::make_unexpected(prepared.error());
  return bench.run();
}

}  // namespace dance
