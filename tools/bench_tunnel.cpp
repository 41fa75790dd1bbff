#include "tools/bench_tunnel.h"

#include <algorithm>
#include <array>

#include "bench/crowd.h"
#include "bench/salsa_poses.h"
#include "core/net/mono_clock.h"
#include "core/net/udp_socket.h"
#include "core/program/program.h"
#include "tools/child_process.h"
#include "tools/figures.h"

namespace dance {
namespace {

constexpr Duration kPatience = Duration::s(15);
// Each way dances for so long before the next one does.
constexpr Duration kTurn = Duration::ms(500);
// Before a turn counts, and for what is still under way behind it.
constexpr Duration kSettles = Duration::ms(150);

// One relay and its crowd.
struct Way {
  TunnelWay result;
  std::unique_ptr<ChildProcess> relay;
  std::unique_ptr<Crowd> crowd;
  std::vector<std::array<MonoTime, 256>> sent_at;  // of each guest, by sequence
  std::vector<std::uint32_t> next, first;          // sequences; the first that counts in this turn
  bool is_counting = false;
  std::uint64_t bytes = 0;
  double danced_s = 0.0;  // what the counted poses are worth
  Duration busy_time, busy_cpu, idle_time, idle_cpu;

  void arrived(std::size_t listener, std::size_t sender, std::uint32_t sequence) {
    if (!is_counting || listener >= kListeners || sender >= next.size()) return;
    const std::uint32_t back = next[sender] - 1 - sequence;
    if (sequence < first[sender] || back >= sent_at[sender].size()) return;
    ++result.delivered;
    result.took.push_back(mono_now() - sent_at[sender][sequence % sent_at[sender].size()]);
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
  void send_due(Way& way, MonoTime now);
  void turn_for(Duration span);
  double poses_per_s() const { return options_.hz * static_cast<double>(options_.guests); }
  MonoTime next_due() const {
    return begin_ + Duration::seconds(static_cast<double>(danced_) / poses_per_s());
  }

  BenchTunnelOptions options_;
  std::vector<Pose> poses_ = salsa_poses();
  std::unique_ptr<Poller> poller_;
  std::vector<std::unique_ptr<Way>> ways_;
  MonoTime begin_;           // of this turn
  std::size_t danced_ = 0;   // poses in this turn, guest after guest
  std::size_t counted_ = 0;  // of them
};

Result<void> BenchTunnel::prepare(const std::string& own_program) {
  DANCE_TRY(poller_, Poller::create());
  if (auto stops = poller_->stop_on_signals(); !stops) return stops;
  std::vector<std::string> more;
  if (options_.share_ms >= 0.0) more = {"--share-ms", std::to_string(options_.share_ms)};
  if (auto added =
          add("", "the tunnel", program_folder() + "/dance-server", more, open_tunnel_crowd);
      !added)
    return added;
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
  if (name.empty()) arguments.insert(arguments.end(), {"--bind", "127.0.0.1"});
  arguments.insert(arguments.end(), {"--port", std::to_string(port)});
  DANCE_TRY(ChildProcess relay,
            ChildProcess::start({program, arguments, "/dev/null", "/dev/null"}));
  way->relay = std::make_unique<ChildProcess>(std::move(relay));
  Way* const at = way.get();
  DANCE_TRY(way->crowd,
            open({options_.guests, Address::loopback(port),
                  [at](std::size_t listener, std::size_t sender, std::uint32_t sequence) {
                    at->arrived(listener, sender, sequence);
                  }},
                 *poller_));
  ways_.push_back(std::move(way));
  return wait_until_open(*at);
}

Result<void> BenchTunnel::wait_until_open(Way& way) {
  const MonoTime give_up = mono_now() + kPatience;
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

// Guests begin one after the other within a period, as people do who did not start together.
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
    if (way.is_counting) {
      way.result.sent += guest < kListeners ? kListeners - 1 : kListeners;
      ++counted_;
    }
    way.crowd->send(guest, pose, at);
  }
}

// As many poses as belong in `span`, however long the machine takes for them.
void BenchTunnel::dance(Way& way, Duration span, bool counts) {
  begin_ = mono_now();
  danced_ = counted_ = 0;
  const auto settles = static_cast<std::size_t>(kSettles.as_seconds() * poses_per_s());
  const auto all = settles + static_cast<std::size_t>(span.as_seconds() * poses_per_s());
  Duration cpu;
  std::uint64_t bytes = 0;
  MonoTime counts_from;
  while (danced_ < all && !poller_->is_stopped()) {
    if (counts && !way.is_counting && danced_ >= settles) {
      way.is_counting = true;
      way.first = way.next;
      cpu = way.relay->cpu_time();
      bytes = way.crowd->bytes_down();
      counts_from = mono_now();
    }
    send_due(way, mono_now());
    poller_->run_once(std::max(next_due() - mono_now(), Duration()));
  }
  turn_for(kSettles);
  if (way.is_counting) {
    way.busy_time += mono_now() - counts_from - kSettles;
    way.danced_s += static_cast<double>(counted_) / poses_per_s();
    way.busy_cpu += way.relay->cpu_time() - cpu;
    way.bytes += way.crowd->bytes_down() - bytes;
  }
  way.is_counting = false;
}

Result<TunnelWays> BenchTunnel::run() {
  // Until every way knows what its line is like.
  for (auto& way : ways_)
    dance(*way, std::min(Duration::s(1), Duration::seconds(options_.seconds)), false);
  const Duration all = Duration::seconds(options_.seconds);
  for (Duration done; done < all && !poller_->is_stopped(); done += kTurn)
    for (auto& way : ways_) {
      const MonoTime from = mono_now();
      std::vector<Duration> cpu;
      for (auto& other : ways_) cpu.push_back(other->relay->cpu_time());
      dance(*way, std::min(kTurn, all - done), true);
      for (std::size_t i = 0; i < ways_.size(); ++i) {
        if (ways_[i] == way) continue;
        ways_[i]->idle_time += mono_now() - from;
        ways_[i]->idle_cpu += ways_[i]->relay->cpu_time() - cpu[i];
      }
    }
  if (poller_->is_stopped()) return fail("stopped by a signal before the end");
  for (auto& way : ways_)
    if (way->danced_s <= 0.0) return fail("--seconds is too short: no pose was counted");
  TunnelWays results;
  for (auto& way : ways_) {
    TunnelWay& result = way->result;
    std::sort(result.took.begin(), result.took.end());
    result.server_cpu_percent = 100.0 * way->busy_cpu.as_seconds() / way->busy_time.as_seconds();
    result.idle_cpu_percent = 100.0 * way->idle_cpu.as_seconds() / way->idle_time.as_seconds();
    result.down_bytes_per_s =
        static_cast<double>(way->bytes) / way->danced_s / static_cast<double>(options_.guests);
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace

double TunnelWay::percentile_us(double fraction) const {
  return percentile<Duration>(took, fraction).as_us();
}

Result<TunnelWays> run_bench_tunnel(const BenchTunnelOptions& options,
                                    const std::string& own_program) {
  BenchTunnel bench(options);
  if (auto prepared = bench.prepare(own_program); !prepared)
    return tl::make_unexpected(prepared.error());
  return bench.run();
}

}  // namespace dance
