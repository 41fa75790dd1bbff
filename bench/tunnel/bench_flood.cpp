#include "bench/tunnel/bench_flood.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "bench/parts/salsa_poses.h"
#include "bench/tunnel/crowd.h"
#include "core/net/mono_clock.h"
#include "core/program/child_process.h"
#include "core/program/program.h"
#include "testing/line/lossy_proxy.h"
#include "testing/scratch_folder.h"

namespace dance {
namespace {

constexpr Duration kCoupleComes = Duration::s(20);
constexpr Duration kSettling = Duration::ms(500);

std::int64_t rss_kb_of(pid_t pid) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmRSS:")) return std::stoll(line.substr(6));
  return 0;
}

class BenchFlood {
 public:
  explicit BenchFlood(const BenchFloodOptions& options) : options_(options) {}

  Result<FloodResult> run() {
    if (auto begun = begin(); !begun) return tl::make_unexpected(begun.error());
    const Duration calm = Duration::seconds(options_.calm_s);
    if (auto danced = dance("before", [&](Duration so_far) { return so_far >= calm; }); !danced)
      return tl::make_unexpected(danced.error());
    attack_->start();
    if (auto danced = dance("flood", [&](Duration) { return attack_->is_over(); }); !danced)
      return tl::make_unexpected(danced.error());
    if (auto danced = dance("after", [&](Duration so_far) { return so_far >= calm; }); !danced)
      return tl::make_unexpected(danced.error());
    result_.attack = attack_->totals();
    result_.has_server_ended = server_->has_ended();
    crowd_.reset();
    server_->stop(Duration::s(5));
    read_summary();
    return std::move(result_);
  }

 private:
  Result<void> begin() {
    DANCE_TRY(poller_, Poller::create());
    if (auto stops = poller_->stop_on_signals(); !stops) return stops;
    DANCE_TRY(const std::uint16_t port, free_loopback_port());
    DANCE_TRY(scratch_, ScratchFolder::make());
    DANCE_TRY(ChildProcess server,
              ChildProcess::start({program_folder() + "/dance-server",
                                   {"--bind", "0.0.0.0", "--port", std::to_string(port), "--json"},
                                   scratch_->file("summary.json"),
                                   "/dev/null"}));
    server_ = std::make_unique<ChildProcess>(std::move(server));
    FloodAttack::Options flood;
    flood.server = Address::loopback(port);
    flood.datagrams = options_.datagrams;
    flood.per_second = options_.per_second;
    flood.sources = options_.sources;
    flood.seed = 20'260'101;
    DANCE_TRY(attack_, FloodAttack::make(flood));
    // The couple's line has a listener on it, as a line in a café has.
    DANCE_TRY(line_, LossyProxy::open(Address::loopback(0), Address::loopback(port), LossyLine(),
                                      *poller_));
    line_->set_tap([this](LossyProxy::Direction direction, std::span<const std::uint8_t> bytes) {
      if (direction == LossyProxy::Direction::kUp) attack_->record(bytes);
    });
    DANCE_TRY(crowd_,
              open_tunnel_crowd({2, line_->local_address(),
                                 [this](std::size_t, std::size_t sender, std::uint32_t sequence) {
                                   arrived(sender, sequence);
                                 }},
                                *poller_));
    const MonoTime give_up = mono_now() + kCoupleComes;
    while (!crowd_->is_open()) {
      if (server_->has_ended()) return fail("the server " + server_->exit_text());
      if (mono_now() > give_up) return fail("the couple was not let in within 20 s");
      turn(Duration::ms(20));
    }
    return {};
  }

  void turn(Duration longest) { poller_->run_once(longest); }

  void arrived(std::size_t sender, std::uint32_t sequence) {
    if (sequence <= newest_[sender]) {
      ++result_.poses_shown_old;
      return;
    }
    newest_[sender] = sequence;
    if (phase_ == nullptr || sequence < first_of_phase_) return;
    ++phase_->delivered;
    phase_->took.push_back(mono_now() - sent_at_[sequence % sent_at_.size()]);
  }

  Result<void> dance(const char* name, const std::function<bool(Duration)>& is_over) {
    FloodPhase phase;
    phase.name = name;
    phase_ = &phase;
    first_of_phase_ = next_;
    const MonoTime begin = mono_now();
    const Duration cpu = server_->cpu_time();
    const Duration frame = Duration::seconds(1.0 / options_.hz);
    MonoTime due = begin;
    while (!is_over(mono_now() - begin)) {
      if (poller_->is_stopped()) return fail("stopped by a signal before the end");
      if (server_->has_ended()) break;
      if (mono_now() >= due) {
        send_both(phase);
        due += frame;
      }
      turn(std::max(due - mono_now(), Duration()));
    }
    const MonoTime danced = mono_now();
    for (const MonoTime until = danced + kSettling; mono_now() < until;) turn(Duration::ms(10));
    phase_ = nullptr;
    phase.seconds = (danced - begin).as_seconds();
    phase.server_cpu_percent =
        100.0 * (server_->cpu_time() - cpu).as_seconds() / (mono_now() - begin).as_seconds();
    phase.server_rss_kb = rss_kb_of(server_->pid());
    std::sort(phase.took.begin(), phase.took.end());
    result_.phases.push_back(std::move(phase));
    return {};
  }

  void send_both(FloodPhase& phase) {
    const std::uint32_t sequence = next_++;
    for (std::size_t guest = 0; guest < 2; ++guest) {
      Pose pose = poses_[(sequence + 97 * guest) % poses_.size()];
      pose.sequence = sequence;
      pose.clock_id = this_clock_id();
      const MonoTime at = mono_now();
      pose.capture_time = at;
      sent_at_[sequence % sent_at_.size()] = at;
      ++phase.sent;
      crowd_->send(guest, pose, at);
    }
  }

  void read_summary() {
    std::ifstream file(scratch_->file("summary.json"));
    std::stringstream text;
    text << file.rdbuf();
    const auto summary = nlohmann::json::parse(text.str(), nullptr, false);
    if (summary.is_discarded() || !summary.contains("kept_out")) return;
    for (const auto& [cause, count] : summary["kept_out"].items())
      result_.kept_out.emplace_back(cause, count.get<std::uint64_t>());
  }

  BenchFloodOptions options_;
  std::vector<Pose> poses_ = salsa_poses();
  std::unique_ptr<ScratchFolder> scratch_;
  std::unique_ptr<Poller> poller_;
  std::unique_ptr<ChildProcess> server_;
  std::unique_ptr<FloodAttack> attack_;
  std::unique_ptr<LossyProxy> line_;
  std::unique_ptr<Crowd> crowd_;
  std::array<MonoTime, 1024> sent_at_;
  std::uint32_t next_ = 1;
  std::uint32_t first_of_phase_ = 1;
  std::array<std::uint32_t, 2> newest_{};
  FloodPhase* phase_ = nullptr;
  FloodResult result_;
};

}  // namespace

Result<FloodResult> run_bench_flood(const BenchFloodOptions& options) {
  BenchFlood bench(options);
  return bench.run();
}

}  // namespace dance
