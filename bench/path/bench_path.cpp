#include "bench/path/bench_path.h"

#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include "bench/path/bare_hops.h"
#include "bench/path/measured_way.h"
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

constexpr Duration kTimeout = Duration::s(15);
constexpr Duration kWarmUp = Duration::s(1);
// Longer than any pose on one machine should be under way.
constexpr Duration kStragglers = Duration::ms(500);
constexpr const char* kGuestName = "alice";

class BenchPath {
 public:
  BenchPath(const BenchPathOptions& options, std::string own_program)
      : options_(options), own_program_(std::move(own_program)) {}

  Result<void> prepare();
  Result<BenchPathResult> run();

 private:
  Result<void> open_buses();
  Result<void> start(const std::string& name, const std::string& program,
                     const std::vector<std::string>& arguments);
  Result<void> start_houses();
  Result<void> start_bare_hops(const std::string& name, const std::string& bus_to_udp,
                               const std::string& udp_to_bus, const std::string& option,
                               const std::string& from, const std::string& to);
  void listen();
  void send_pose();
  void send_floor();
  void send_raw_floor();
  void start_sending();
  Result<void> wait_until_open();
  void turn_for(Duration span);
  void begin(Way::Stretch stretch);
  Result<void> measure_flooded(Duration span);

  BenchPathOptions options_;
  std::string own_program_;
  std::unique_ptr<ScratchFolder> scratch_;
  std::unique_ptr<Poller> poller_;
  std::array<std::uint16_t, 6> ports_{};  // buses A and B of the poses and of the two floors
  std::unique_ptr<Bus> bus_a_, bus_b_;
  std::unique_ptr<LcmEnd> floor_a_, floor_b_;
  int raw_a_ = -1, raw_b_ = -1;
  GuestId guest_ = *GuestId::parse(kGuestName);
  GuestJourney steps_{guest_};
  Way pose_way_, floor_way_, raw_way_;
  bool is_sending_ = true;
  std::vector<std::pair<std::string, ChildProcess>> children_;
};

std::string url_of(std::uint16_t port) {
  return "udpm://239.255.76.67:" + std::to_string(port) + "?ttl=0";
}

Result<void> BenchPath::open_buses() {
  for (std::uint16_t& port : ports_) {
    DANCE_TRY(port, free_loopback_port());
  }
  DANCE_TRY(bus_a_, Bus::open(url_of(ports_[0])));
  DANCE_TRY(bus_b_, Bus::open(url_of(ports_[1])));
  floor_a_ = std::make_unique<LcmEnd>(url_of(ports_[2]));
  floor_b_ = std::make_unique<LcmEnd>(url_of(ports_[3]));
  if (!floor_a_->is_open() || !floor_b_->is_open()) return fail("the floor: LCM opens no bus");
  raw_a_ = open_group_sender(ports_[4]);
  raw_b_ = open_group_receiver(ports_[5]);
  if (raw_a_ < 0 || raw_b_ < 0) return fail("the floor: the kernel opens no multicast socket");
  return {};
}

Result<void> BenchPath::prepare() {
  DANCE_TRY(scratch_, ScratchFolder::make());
  DANCE_TRY(poller_, Poller::create());
  if (auto stops = poller_->stop_on_signals(); !stops) return stops;
  if (auto opened = open_buses(); !opened) return opened;
  listen();
  if (auto started = start_houses(); !started) return started;
  if (auto started = start_bare_hops("bare-hop", "bus-to-udp", "udp-to-bus", "--url",
                                     url_of(ports_[2]), url_of(ports_[3]));
      !started)
    return started;
  return start_bare_hops("raw-hop", "group-to-udp", "udp-to-group", "--group-port",
                         std::to_string(ports_[4]), std::to_string(ports_[5]));
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
          server + "\"\nbus = \"" + url_of(ports_[0]) + "\"\nbus_captures = [\"" +
          std::string(kGuestName) + "\"]\n",
      "[house]\nroom = \"bench\"\nserver = \"" + server + "\"\nbus = \"" + url_of(ports_[1]) +
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

Result<void> BenchPath::start_bare_hops(const std::string& name, const std::string& bus_to_udp,
                                        const std::string& udp_to_bus, const std::string& option,
                                        const std::string& from, const std::string& to) {
  DANCE_TRY(const std::uint16_t first, free_loopback_port());
  DANCE_TRY(const std::uint16_t second, free_loopback_port());
  const std::string up = std::to_string(first), down = std::to_string(second);
  const std::vector<std::string> hops[3] = {
      {"--bare-hop", bus_to_udp, option, from, "--to-port", up},
      {"--bare-hop", "udp-to-udp", "--from-port", up, "--to-port", down},
      {"--bare-hop", udp_to_bus, "--from-port", down, option, to}};
  for (int hop = 0; hop < 3; ++hop)
    if (auto started = start(name + "-" + std::to_string(hop + 1), own_program_, hops[hop]);
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
  poller_->watch(bus_b_->fd(), [this](MonoTime now) { bus_b_->drain(now); });
  // Poses are decoded on every path, as decoding is part of receiving them.
  const auto decode_for = [](Way& way, const void* data, std::size_t size) {
    Pose pose;
    if (decode(data, size, pose) == Decoded::kFine) way.arrived(pose.sequence, mono_now());
  };
  floor_b_->listen(*poller_, [this, decode_for](const void* data, std::size_t size) {
    decode_for(floor_way_, data, size);
  });
  poller_->watch(raw_b_, [this, decode_for](MonoTime) {
    std::array<std::uint8_t, 2048> datagram;
    for (ssize_t size = 0;
         (size = recv(raw_b_, datagram.data(), datagram.size(), MSG_DONTWAIT)) > 0;)
      decode_for(raw_way_, datagram.data(), static_cast<std::size_t>(size));
  });
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

void BenchPath::send_pose() {
  const MonoTime now = mono_now();
  Pose pose = pose_at(now);
  pose.sequence = pose_way_.send(now);
  pose.stamp(Hop::kPublished, now);
  bus_a_->publish(Channel::of(Signal::kPose, Where::kCapture, guest_), pose);
}

void BenchPath::send_floor() {
  const MonoTime now = mono_now();
  Pose pose = pose_at(now);
  pose.sequence = floor_way_.send(now);
  MessageBuffer buffer;
  const std::size_t size = encode(pose, buffer);
  floor_a_->publish(buffer, size);
}

void BenchPath::send_raw_floor() {
  const MonoTime now = mono_now();
  Pose pose = pose_at(now);
  pose.sequence = raw_way_.send(now);
  MessageBuffer buffer;
  const std::size_t size = encode(pose, buffer);
  // A datagram that cannot be sent counts as not delivered.
  [[maybe_unused]] const auto sent = ::send(raw_a_, buffer.data(), size, 0);
}

// The three paths send in turn, a third of a period apart, so that their messages do not meet.
void BenchPath::start_sending() {
  const MonoTime begin = mono_now() + Duration::ms(10);
  const auto every_period = [&](double offset, void (BenchPath::*send_one)()) {
    const MonoTime first = begin + Duration::seconds(offset / options_.hz);
    poller_->add_timer(first,
                       [this, send_one, pacer = Pacer(first, options_.hz)](MonoTime now) mutable {
                         if (!is_sending_) return MonoTime();
                         (this->*send_one)();
                         pacer.advance(now);
                         return pacer.deadline();
                       });
  };
  every_period(0.0, &BenchPath::send_pose);
  every_period(1.0 / 3.0, &BenchPath::send_floor);
  every_period(2.0 / 3.0, &BenchPath::send_raw_floor);
}

Result<void> BenchPath::wait_until_open() {
  const MonoTime give_up = mono_now() + kTimeout;
  while (!(pose_way_.is_open() && floor_way_.is_open() && raw_way_.is_open()) &&
         !poller_->is_stopped()) {
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

void BenchPath::turn_for(Duration span) {
  for (const MonoTime end = mono_now() + span; mono_now() < end && !poller_->is_stopped();)
    poller_->run_once(Duration::ms(20));
}

void BenchPath::begin(Way::Stretch stretch) {
  for (Way* way : {&pose_way_, &floor_way_, &raw_way_}) way->begin(stretch);
}

Result<void> BenchPath::measure_flooded(Duration span) {
  DANCE_TRY(ChildProcess flood,
            ChildProcess::start(
                {own_program_,
                 {"--bare-hop", "flood", "--from-port", std::to_string(ports_[0]), "--to-port",
                  std::to_string(ports_[1]), "--flood", std::to_string(options_.flood_hz)},
                 scratch_->file("flood.out"),
                 scratch_->file("flood.txt")}));
  turn_for(kStragglers);
  begin(Way::Stretch::kFlooded);
  turn_for(span);
  if (flood.has_ended()) return fail("the flood ended: " + flood.exit_text());
  begin(Way::Stretch::kNone);
  flood.stop(Duration::s(5));
  turn_for(kStragglers);
  return {};
}

Result<BenchPathResult> BenchPath::run() {
  start_sending();
  if (auto open = wait_until_open(); !open) return tl::make_unexpected(open.error());
  turn_for(kWarmUp);
  for (Way* way : {&pose_way_, &floor_way_, &raw_way_})
    way->expect(static_cast<std::size_t>(options_.hz * options_.seconds));
  const bool is_flooded = options_.flood_hz > 0.0;
  const int stretches = is_flooded ? std::max(2, static_cast<int>(options_.seconds / 5.0)) : 1;
  const Duration span = Duration::seconds(options_.seconds / stretches);
  for (int i = 0; i < stretches && !poller_->is_stopped(); ++i) {
    if (i % 2 == 1) {
      if (auto measured = measure_flooded(span); !measured)
        return tl::make_unexpected(measured.error());
      continue;
    }
    begin(Way::Stretch::kQuiet);
    turn_for(span);
    begin(Way::Stretch::kNone);
  }
  is_sending_ = false;
  turn_for(kStragglers);
  if (poller_->is_stopped()) return fail("stopped by a signal before the end");
  constexpr auto kQuiet = Way::Stretch::kQuiet;
  BenchPathResult result{pose_way_.result(kQuiet),
                         floor_way_.result(kQuiet),
                         raw_way_.result(kQuiet),
                         std::move(steps_),
                         {}};
  if (is_flooded) result.flooded_pose = pose_way_.result(Way::Stretch::kFlooded);
  return result;
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
