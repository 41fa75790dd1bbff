#include "bench/headset/bench_headset.h"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <memory>
#include <vector>

#include "apps/latency/latency_report.h"
#include "core/bus/bus.h"
#include "core/net/mono_clock.h"
#include "core/net/poller.h"
#include "core/net/udp_socket.h"
#include "core/program/child_process.h"
#include "core/program/program.h"
#include "testing/scratch_folder.h"

namespace dance {
namespace {

constexpr Duration kOpens = Duration::s(20), kSettles = Duration::s(3);
// A dancer who sways and steps, with trackers at hips and feet.
constexpr const char* kScript = R"(
at 0 pose hips 0 0.98 0.04 0 0 0 1
at 0 pose left-foot 0.1 0.1 0 0 0 0 1
at 0 pose right-foot -0.1 0.1 0 0 0 0 1
at 0 pose head -0.1 1.66 0 0 0 0 1
at 300 pose head 0.1 1.62 0.1 0 0.0998 0 0.995
)";

class HeadsetHouses {
 public:
  explicit HeadsetHouses(const BenchHeadsetOptions& options) : options_(options) {}
  Result<void> open();
  Result<BenchHeadsetResult> run();

 private:
  using Words = std::vector<std::string>;
  Result<void> start(const std::string& program, const Words& words);
  Result<void> open_houses(const std::string& server);
  Result<void> turn_until(MonoTime end, const std::function<bool()>& is_done);

  BenchHeadsetOptions options_;
  std::unique_ptr<ScratchFolder> scratch_;
  std::unique_ptr<Poller> poller_;
  std::string url_a_, url_b_;
  std::unique_ptr<Bus> bus_;
  std::vector<std::pair<std::string, ChildProcess>> children_;
  BenchHeadsetResult result_{GuestJourney(*GuestId::parse("alice")),
                             GuestJourney(*GuestId::parse("bob"))};
  bool measures_ = false, has_alice_ = false, has_bob_ = false;
};

Result<void> HeadsetHouses::start(const std::string& program, const Words& words) {
  const std::string name = program + std::to_string(children_.size());
  DANCE_TRY(ChildProcess child,
            ChildProcess::start({program_folder() + "/" + program, words,
                                 scratch_->file(name + ".out"), scratch_->file(name + ".txt")}));
  children_.emplace_back(name, std::move(child));
  return {};
}

Result<void> HeadsetHouses::open_houses(const std::string& server) {
  const std::string common = "room = \"bench\"\nserver = \"" + server + "\"\n";
  const std::string body = options_.learned ? "auto" : "rules";
  std::ofstream(scratch_->file("a.toml")) << "[house]\nguests = [\"alice\", \"bob\"]\n"
                                          << common << "bus = \"" << url_a_ << "\"\n";
  std::ofstream(scratch_->file("b.toml"))
      << "[house]\n"
      << common << "bus = \"" << url_b_
      << "\"\n[[route]]\nfrom = \"POSE/guest/*\"\nto = \"POSE/stage/*\"\n";
  for (const char* session : {"a.toml", "b.toml"})
    if (auto started = start("dance-join", {scratch_->file(session), "--no-view"}); !started)
      return started;
  const std::string hz = fmt::format("{:g}", options_.hz);
  if (auto started = start("dance-headset", {"--guest", "alice", "--tracking-only", "--no-haptics",
                                             "--bus", url_a_, "--rate", hz, "--body", body});
      !started)
    return started;
  return start("dance-salsa", {"--guest", "bob", "--bus", url_a_, "--hz", hz});
}

Result<void> HeadsetHouses::open() {
  DANCE_TRY(scratch_, ScratchFolder::make());
  DANCE_TRY(poller_, Poller::create());
  if (auto stops = poller_->stop_on_signals(); !stops) return stops;
  std::ofstream(scratch_->file("script")) << kScript;
  setenv("XR_RUNTIME_JSON", (program_folder() + "/../lib/dance_test_xr.json").c_str(), 1);
  setenv("DANCE_XR_SCRIPT", scratch_->file("script").c_str(), 1);
  for (std::string* url : {&url_a_, &url_b_}) {
    DANCE_TRY(const std::uint16_t port, free_loopback_port());
    *url = fmt::format("udpm://239.255.76.67:{}?ttl=0", port);
  }
  DANCE_TRY(bus_, Bus::open(url_b_));
  bus_->subscribe<Pose>(Where::kStage, [this](const Channel& channel, const Pose& pose, MonoTime) {
    const bool is_alice = channel.guest() == result_.headset.guest();
    (is_alice ? has_alice_ : has_bob_) = true;
    if (measures_)
      (is_alice ? result_.headset : result_.synthetic).heard(pose, mono_now(), this_clock_id());
  });
  poller_->watch(bus_->fd(), [this](MonoTime now) { bus_->drain(now); });
  DANCE_TRY(const std::uint16_t port, free_loopback_port());
  const std::string at = std::to_string(port);
  if (auto started = start("dance-server", {"--bind", "127.0.0.1", "--port", at}); !started)
    return started;
  return open_houses("127.0.0.1:" + at);
}

Result<void> HeadsetHouses::turn_until(MonoTime end, const std::function<bool()>& is_done) {
  while (mono_now() < end && !is_done()) {
    if (poller_->is_stopped()) return fail("stopped by a signal before the end");
    for (auto& [name, child] : children_) {
      if (!child.has_ended()) continue;
      std::ifstream talk(scratch_->file(name + ".txt"));
      std::string line, last;
      while (std::getline(talk, line)) last = line;
      return fail(name + " " + child.exit_text() + ": " + last);
    }
    poller_->run_once(Duration::ms(20));
  }
  return {};
}

Result<BenchHeadsetResult> HeadsetHouses::run() {
  const auto is_open = [this] { return has_alice_ && has_bob_; };
  if (auto turned = turn_until(mono_now() + kOpens, is_open); !turned)
    return tl::make_unexpected(turned.error());
  if (!is_open())
    return fail(std::string(has_alice_ ? "the synthetic dancer" : "the headset") +
                " stayed silent for 20 s; `dance doctor` checks this machine");
  const auto never = [] { return false; };
  if (auto turned = turn_until(mono_now() + kSettles, never); !turned)
    return tl::make_unexpected(turned.error());
  measures_ = true;
  if (auto turned = turn_until(mono_now() + Duration::seconds(options_.seconds), never); !turned)
    return tl::make_unexpected(turned.error());
  return std::move(result_);
}

// From the capture to the link, in µs.
double to_link_us(const GuestJourney& journey, double fraction) {
  for (const GuestJourney::Row& row : journey.rows())
    if (row.to == Step::kLinkSent && row.since_capture != nullptr)
      return row.since_capture->percentile(fraction).as_us();
  return 0.0;
}

}  // namespace

Result<BenchHeadsetResult> run_bench_headset(const BenchHeadsetOptions& options) {
  HeadsetHouses houses(options);
  if (auto opened = houses.open(); !opened) return tl::make_unexpected(opened.error());
  return houses.run();
}

std::string bench_headset_table(const BenchHeadsetOptions& options,
                                const BenchHeadsetResult& result) {
  std::string out = fmt::format("from the sensors' moment to the link, {:g} Hz, {:g} s (us)\n\n",
                                options.hz, options.seconds);
  out += fmt::format("  {:<28}{:>9}{:>9}{:>9}\n", "", "p50", "p99", "poses");
  const auto row = [&](const char* name, const GuestJourney& journey) {
    out += fmt::format("  {:<28}{:>9.0f}{:>9.0f}{:>9}\n", name, to_link_us(journey, 0.5),
                       to_link_us(journey, 0.99), journey.poses());
  };
  row("a headset", result.headset);
  row("a synthetic dancer", result.synthetic);
  const double beside = to_link_us(result.synthetic, 0.5);
  out += fmt::format("  {:<28}{:>9.2f}\n\nwhere the headset's time went:\n", "times the synthetic",
                     beside > 0.0 ? to_link_us(result.headset, 0.5) / beside : 0.0);
  return out + journey_table(result.headset);
}

}  // namespace dance
