#include "bench/path/bench_path.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/base/pacer.h"
#include "core/bus/bus.h"
#include "core/bus/encode.h"
#include "core/net/mono_clock.h"
#include "core/net/poller.h"
#include "core/net/udp_socket.h"
#include "core/program/child_process.h"
#include "core/program/figures.h"
#include "core/program/program.h"
#include "testing/scratch_folder.h"

namespace dance {
namespace {

namespace fs = std::filesystem;

constexpr Duration kTimeout = Duration::s(15);
constexpr Duration kWarmUp = Duration::s(1);
// Longer than any pose on one machine should be under way.
constexpr Duration kStragglers = Duration::ms(500);
constexpr const char* kFloorChannel = "BENCH/floor";
constexpr const char* kGuestName = "alice";

// One way from a bus to another: counts what is sent and times what arrives. Messages are numbered;
// those of the warm-up count for nothing.
class Way {
 public:
  std::uint32_t send(MonoTime now) {
    sent_at_[sequence_ % sent_at_.size()] = now;
    if (is_measuring_) ++result_.sent;
    return sequence_++;
  }
  void arrived(std::uint32_t sequence, MonoTime now) {
    ++arrived_;
    const std::uint32_t back = sequence_ - 1 - sequence;
    if (sequence < first_ || back >= sent_at_.size() || !is_measuring_) return;
    result_.took.push_back(now - sent_at_[sequence % sent_at_.size()]);
  }
  void begin_to_measure(std::size_t expected) {
    result_.took.reserve(expected + 64);
    first_ = sequence_;
    is_measuring_ = true;
  }
  bool is_open() const { return arrived_ > 0; }
  bool is_measuring() const { return is_measuring_; }
  WayResult result() const {
    WayResult sorted = result_;
    std::sort(sorted.took.begin(), sorted.took.end());
    return sorted;
  }

 private:
  std::array<MonoTime, 4096> sent_at_{};
  std::uint32_t sequence_ = 1;
  std::uint32_t first_ = 0;
  std::uint64_t arrived_ = 0;
  bool is_measuring_ = false;
  WayResult result_;
};

class BenchPath {
 public:
  BenchPath(const BenchPathOptions& options, std::string own_program)
      : options_(options), own_program_(std::move(own_program)) {}

  Result<void> prepare();
  Result<BenchPathResult> run();

 private:
  Result<std::unique_ptr<Bus>> open_bus(std::string& url);
  Result<void> start(const std::string& name, const std::string& program,
                     const std::vector<std::string>& arguments);
  Result<void> start_houses();
  Result<void> start_bare_hops();
  void listen();
  void send_pose(MonoTime now);
  void send_floor(MonoTime now);
  Result<void> wait_until_open();

  BenchPathOptions options_;
  std::string own_program_;
  std::unique_ptr<ScratchFolder> scratch_;
  std::unique_ptr<Poller> poller_;
  std::string url_a_, url_b_, floor_url_a_, floor_url_b_;
  std::unique_ptr<Bus> bus_a_, bus_b_, floor_bus_a_, floor_bus_b_;
  GuestId guest_ = *GuestId::parse(kGuestName);
  GuestJourney steps_{guest_};
  Way pose_way_, floor_way_;
  std::vector<std::pair<std::string, ChildProcess>> children_;
};

Result<std::unique_ptr<Bus>> BenchPath::open_bus(std::string& url) {
  DANCE_TRY(const std::uint16_t port, free_loopback_port());
  url = "udpm://239.255.76.67:" + std::to_string(port) + "?ttl=0";
  return Bus::open(url);
}

Result<void> BenchPath::prepare() {
  DANCE_TRY(scratch_, ScratchFolder::make());
  DANCE_TRY(poller_, Poller::create());
  if (auto stops = poller_->stop_on_signals(); !stops) return stops;
  DANCE_TRY(bus_a_, open_bus(url_a_));
  DANCE_TRY(bus_b_, open_bus(url_b_));
  DANCE_TRY(floor_bus_a_, open_bus(floor_url_a_));
  DANCE_TRY(floor_bus_b_, open_bus(floor_url_b_));
  listen();
  if (auto started = start_houses(); !started) return started;
  return start_bare_hops();
}

Result<void> BenchPath::start(const std::string& name, const std::string& program,
                              const std::vector<std::string>& arguments) {
  DANCE_TRY(ChildProcess child,
            ChildProcess::start({program, arguments, scratch_->file(name + ".out"),
                                 scratch_->file(name + ".txt")}));
  children_.emplace_back(name, std::move(child));
  return {};
}

Result<void> BenchPath::start_houses() {
  DANCE_TRY(const std::uint16_t port, free_loopback_port());
  const std::string server = "127.0.0.1:" + std::to_string(port);
  const std::string sessions[2] = {
      "[house]\nguest = \"" + std::string(kGuestName) + "\"\nroom = \"bench\"\nserver = \"" +
          server + "\"\nbus = \"" + url_a_ + "\"\n",
      "[house]\nroom = \"bench\"\nserver = \"" + server + "\"\nbus = \"" + url_b_ +
          "\"\n[[route]]\nfrom = \"POSE/guest/*\"\nto = \"POSE/stage/*\"\n"};
  if (auto started = start("server", program_folder() + "/dance-server",
                           {"--bind", "127.0.0.1", "--port", std::to_string(port)});
      !started)
    return started;
  for (int house = 0; house < 2; ++house) {
    const std::string name = house == 0 ? "house-a" : "house-b";
    const std::string session = scratch_->file(name + ".toml");
    std::ofstream(session) << sessions[house];
    if (auto started = start(name, program_folder() + "/dance-join", {session, "--no-view"});
        !started)
      return started;
  }
  return {};
}

Result<void> BenchPath::start_bare_hops() {
  DANCE_TRY(const std::uint16_t first, free_loopback_port());
  DANCE_TRY(const std::uint16_t second, free_loopback_port());
  const std::string up = std::to_string(first), down = std::to_string(second);
  const std::vector<std::string> hops[3] = {
      {"--bare-hop", "bus-to-udp", "--url", floor_url_a_, "--to-port", up},
      {"--bare-hop", "udp-to-udp", "--from-port", up, "--to-port", down},
      {"--bare-hop", "udp-to-bus", "--from-port", down, "--url", floor_url_b_}};
  for (int hop = 0; hop < 3; ++hop)
    if (auto started = start("bare-hop-" + std::to_string(hop + 1), own_program_, hops[hop]);
        !started)
      return started;
  return {};
}

void BenchPath::listen() {
  bus_b_->subscribe<Pose>({Where::kStage, guest_},
                          [this](const Channel&, const Pose& pose, MonoTime) {
                            const MonoTime now = mono_now();
                            pose_way_.arrived(pose.sequence, now);
                            if (pose_way_.is_measuring()) steps_.heard(pose, now, this_clock_id());
                          });
  floor_bus_b_->on_anything(
      [this](std::string_view channel, const void* data, std::size_t size, MonoTime) {
        // Decoded as the other way's is: what hearing a pose costs is on both sides.
        Pose pose;
        if (channel == kFloorChannel && decode(data, size, pose) == Decoded::kFine)
          floor_way_.arrived(pose.sequence, mono_now());
      });
  for (Bus* bus : {bus_b_.get(), floor_bus_b_.get()})
    poller_->watch(bus->fd(), [bus](MonoTime now) { bus->drain(now); });
}

// A dancer who turns the head and sways, so that no two poses are alike.
Pose pose_at(MonoTime now) {
  Pose pose;
  const auto phase = static_cast<float>(now.since_zero_us() % 1'000'000) * 6.2831853e-6f;
  for (std::size_t i = 0; i < kBoneCount; ++i)
    pose.R_PB[i] = Eigen::Quaternionf(Eigen::AngleAxisf(
        0.3f * std::sin(phase + static_cast<float>(i)), Eigen::Vector3f::UnitX()));
  pose.p_WH_m.x() = 0.2f * std::sin(phase);
  pose.clock_id = this_clock_id();
  pose.capture_time = now;
  return pose;
}

void BenchPath::send_pose(MonoTime) {
  const MonoTime now = mono_now();
  Pose pose = pose_at(now);
  pose.sequence = pose_way_.send(now);
  pose.stamp(Hop::kPublished, now);
  bus_a_->publish(Channel::of(Signal::kPose, Where::kCapture, guest_), pose);
}

void BenchPath::send_floor(MonoTime) {
  const MonoTime now = mono_now();
  Pose pose = pose_at(now);
  pose.sequence = floor_way_.send(now);
  MessageBuffer buffer;
  const std::size_t size = encode(pose, buffer);
  floor_bus_a_->publish_raw(kFloorChannel, buffer.data(), size);
}

Result<void> BenchPath::wait_until_open() {
  const MonoTime give_up = mono_now() + kTimeout;
  while (!(pose_way_.is_open() && floor_way_.is_open()) && !poller_->is_stopped()) {
    for (auto& [name, child] : children_)
      if (child.has_ended()) {
        std::ifstream talk(scratch_->file(name + ".txt"));
        std::string line, last;
        while (std::getline(talk, line)) last = line;
        return fail(name + " " + child.exit_text() + ": " + last);
      }
    if (mono_now() > give_up)
      return fail(std::string(pose_way_.is_open() ? "the bare hops" : "the houses") +
                  " stayed silent for 15 s; `dance doctor` checks this machine");
    poller_->run_once(Duration::ms(50));
  }
  return {};
}

Result<BenchPathResult> BenchPath::run() {
  // Turn about, half a period apart, so that neither way meets the other's messages.
  const MonoTime begin = mono_now() + Duration::ms(10);
  const Duration half = Duration::seconds(0.5 / options_.hz);
  Pacer pose_pacer(begin, options_.hz), floor_pacer(begin + half, options_.hz);
  bool is_sending = true;
  poller_->add_timer(begin, [&](MonoTime now) {
    if (!is_sending) return MonoTime();
    send_pose(now);
    pose_pacer.advance(now);
    return pose_pacer.deadline();
  });
  poller_->add_timer(begin + half, [&](MonoTime now) {
    if (!is_sending) return MonoTime();
    send_floor(now);
    floor_pacer.advance(now);
    return floor_pacer.deadline();
  });
  const auto turn_for = [&](Duration span) {
    for (const MonoTime end = mono_now() + span; mono_now() < end && !poller_->is_stopped();)
      poller_->run_once(Duration::ms(20));
  };
  if (auto open = wait_until_open(); !open) return tl::make_unexpected(open.error());
  turn_for(kWarmUp);
  const auto expected = static_cast<std::size_t>(options_.hz * options_.seconds);
  pose_way_.begin_to_measure(expected);
  floor_way_.begin_to_measure(expected);
  turn_for(Duration::seconds(options_.seconds));
  is_sending = false;
  turn_for(kStragglers);
  if (poller_->is_stopped()) return fail("stopped by a signal before the end");
  return BenchPathResult{pose_way_.result(), floor_way_.result(), std::move(steps_)};
}

}  // namespace

double WayResult::percentile_us(double fraction) const {
  return percentile<Duration>(took, fraction).as_us();
}

Result<BenchPathResult> run_bench_path(const BenchPathOptions& options,
                                       const std::string& own_program) {
  BenchPath bench(options, own_program);
  if (auto prepared = bench.prepare(); !prepared) return tl::make_unexpected(prepared.error());
  return bench.run();
}

}  // namespace dance
