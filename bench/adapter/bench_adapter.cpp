#include "bench/adapter/bench_adapter.h"

#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstring>
#include <fstream>
#include <memory>
#include <thread>
#include <utility>

#include "bench/adapter/adapter_reader.h"
#include "consumers/engine/engine_consumer.h"
#include "core/base/pacer.h"
#include "core/bus/bus.h"
#include "core/net/mono_clock.h"
#include "core/net/poller.h"
#include "core/net/udp_socket.h"
#include "core/program/child_process.h"
#include "core/program/program.h"
#include "testing/scratch_folder.h"

namespace dance {
namespace {

constexpr Duration kTimeout = Duration::s(15);
constexpr Duration kWarmUp = Duration::s(1);
// Of a frame's time: when an engine hands its poses to the graphics.
constexpr double kUsedAt = 0.6;
// Between that and the display, as OpenXR's predicted display time has it.
constexpr Duration kToDisplay = Duration::ms(11);

// A reader that did not run for so long, and was put aside for other work meanwhile.
constexpr Duration kPutAside = Duration::us(200);

void sleep_until(MonoTime t) {
  timespec at{};
  at.tv_sec = t.since_zero_ns() / 1'000'000'000;
  at.tv_nsec = t.since_zero_ns() % 1'000'000'000;
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr) != 0) {
  }
}

GuestId guest_name(std::size_t i) { return *GuestId::parse("guest-" + std::to_string(i)); }

// How often this thread was put aside for other work.
long times_put_aside() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nivcsw;
}

class BenchAdapter {
 public:
  BenchAdapter(const BenchAdapterOptions& options, std::string own_program)
      : options_(options), own_program_(std::move(own_program)) {}

  Result<void> prepare();
  Result<BenchAdapterResult> run();

 private:
  Result<void> start(const std::string& name, const std::string& program,
                     const std::vector<std::string>& arguments);
  Result<void> wait_until_seen(AdapterReader& eye);
  void spin(AdapterReader& eye, Duration span, Spin& spun);
  void run_frames(AdapterReader& eye, double hz);
  void read_once(AdapterReader& eye, MonoTime display, FrameLoop& loop);
  void spin_on_memory();
  void count(const AdapterReader& eye);

  BenchAdapterOptions options_;
  std::string own_program_;
  std::string name_ = "bench-" + std::to_string(::getpid());
  std::unique_ptr<ScratchFolder> scratch_;
  std::string url_;
  std::unique_ptr<Bus> bus_;  // the other way: the stage over a hop of the bus
  std::array<MonoTime, 64> other_captured_{};
  std::uint64_t other_heard_ = 0;
  bool is_timing_other_ = false;
  std::vector<std::pair<std::string, ChildProcess>> children_;
  BenchAdapterResult result_;
};

Result<void> BenchAdapter::start(const std::string& name, const std::string& program,
                                 const std::vector<std::string>& arguments) {
  DANCE_TRY(ChildProcess child,
            ChildProcess::start({program, arguments, scratch_->file(name + ".out"),
                                 scratch_->file(name + ".txt")}));
  children_.emplace_back(name, std::move(child));
  return {};
}

Result<void> BenchAdapter::prepare() {
  DANCE_TRY(scratch_, ScratchFolder::make());
  DANCE_TRY(const std::uint16_t port, free_loopback_port());
  url_ = "udpm://239.255.76.67:" + std::to_string(port) + "?ttl=0";
  DANCE_TRY(bus_, Bus::open(url_));
  bus_->subscribe<Pose>(Where::kStage, [this](const Channel& channel, const Pose& pose, MonoTime) {
    const auto dancer = std::strtoul(channel.guest().c_str() + std::strlen("guest-"), nullptr, 10);
    other_captured_[dancer % other_captured_.size()] = pose.capture_time;
    ++other_heard_;
    if (is_timing_other_) result_.capture_to_lcm.push_back(mono_now() - pose.capture_time);
  });
  const std::string session = scratch_->file("house.toml");
  std::ofstream(session) << "[house]\nbus = \"" << url_ << "\"\n"
                         << "[[route]]\nfrom = \"POSE/capture/*\"\nto = \"POSE/stage/*\"\n"
                         << "[[listen]]\nto = \"engine\"\nname = \"" << name_ << "\"\n";
  if (auto started = start("house", program_folder() + "/dance-join", {session, "--no-view"});
      !started)
    return started;
  return start("dancers", own_program_,
               {"--dancers", url_, "--guests", std::to_string(options_.guests), "--hz",
                std::to_string(options_.hz)});
}

Result<void> BenchAdapter::wait_until_seen(AdapterReader& eye) {
  for (const MonoTime give_up = mono_now() + kTimeout; !eye.see(options_.guests);) {
    for (auto& [name, child] : children_)
      if (child.has_ended()) {
        std::ifstream talk(scratch_->file(name + ".txt"));
        std::string line, last;
        while (std::getline(talk, line)) last = line;
        return fail(name + " " + child.exit_text() + ": " + last);
      }
    if (mono_now() > give_up)
      return fail("of " + std::to_string(options_.guests) + " dancers " +
                  std::to_string(eye.count()) +
                  " came into the memory in 15 s; `dance doctor` checks this machine");
    sleep_until(mono_now() + Duration::ms(20));
  }
  return {};
}

// A reader that does nothing but wait for the next pose of each dancer.
void BenchAdapter::spin(AdapterReader& eye, Duration span, Spin& spun) {
  std::array<std::int64_t, DANCE_MAX_GUESTS> staged{};
  long put_aside = times_put_aside();
  MonoTime looked = mono_now(), resumed;
  for (const MonoTime end = mono_now() + span; mono_now() < end;)
    for (std::size_t i = 0; i < eye.count(); ++i) {
      const bool is_read = eye.newest(i) == DANCE_OK;
      const MonoTime now = mono_now();
      if (now - std::exchange(looked, now) > kPutAside)
        if (const long times = times_put_aside(); times != std::exchange(put_aside, times))
          resumed = now;
      if (!is_read || eye.pose(i).staged_ns == staged[i]) continue;
      const std::int64_t now_ns = now.since_zero_ns();
      const bool is_first = staged[i] == 0;
      staged[i] = eye.pose(i).staged_ns;
      if (is_first) continue;
      spun.staged.push_back(Duration::ns(now_ns - staged[i]));
      spun.captured.push_back(Duration::ns(now_ns - eye.pose(i).capture_ns));
      if (staged[i] > resumed.since_zero_ns()) spun.on_processor.push_back(spun.staged.back());
    }
}

void BenchAdapter::read_once(AdapterReader& eye, MonoTime display, FrameLoop& loop) {
  static std::array<unsigned char, DANCE_MAX_GUESTS * sizeof(dance_pose)> copy;
  for (Durations* taken : {&loop.read_at, &loop.read_again})
    result_.watch([&] {
      const MonoTime begin = mono_now();
      eye.read_at(display);
      taken->push_back(mono_now() - begin);
    });
  eye.read_newest();
  eye.check();
  const MonoTime copying = mono_now();
  std::memcpy(copy.data(), eye.bytes(), eye.byte_count());
  const volatile unsigned char* used = copy.data();
  static_cast<void>(*used);
  loop.copied.push_back(mono_now() - copying);
}

void BenchAdapter::run_frames(AdapterReader& eye, double hz) {
  FrameLoop& loop = result_.loops.emplace_back();
  loop.hz = hz;
  Pacer frames(mono_now() + Duration::ms(20), hz);
  std::array<MonoTime, DANCE_MAX_GUESTS> early{}, other{};
  const MonoTime end = mono_now() + Duration::seconds(options_.seconds);
  while (mono_now() < end) {
    sleep_until(frames.deadline());
    const MonoTime begin = mono_now();
    const MonoTime used = frames.deadline() + Duration::seconds(kUsedAt / hz);
    // Early: what it has when the frame begins.
    result_.watch([&] {
      const MonoTime reading = mono_now();
      eye.read_newest();
      loop.read_newest.push_back(mono_now() - reading);
    });
    for (std::size_t i = 0; i < eye.count(); ++i)
      early[i] = MonoTime::from_ns(eye.pose(i).capture_ns);
    const MonoTime draining = mono_now();
    bus_->drain(draining);
    loop.drained.push_back(mono_now() - draining);
    other = other_captured_;
    // Late: what it has when it uses it.
    sleep_until(used);
    const MonoTime now = mono_now();
    read_once(eye, used + kToDisplay, loop);
    for (std::size_t i = 0; i < eye.count(); ++i) {
      loop.age_late.push_back(now - MonoTime::from_ns(eye.pose(i).capture_ns));
      loop.age_early.push_back(now - early[i]);
      if (other[i].is_set()) loop.age_other_early.push_back(now - other[i]);
    }
    frames.advance(begin);
  }
}

// From the writer's call to a reader that spins: the memory alone, without a bus or any other
// program of this benchmark, so that each has a processor where there are two.
void BenchAdapter::spin_on_memory() {
  const std::string name = name_ + "m";
  auto consumer = EngineConsumer::open(name, 0.0, this_clock_id(), mono_now());
  if (!consumer) return;
  std::atomic<bool> is_over{false};
  std::thread writer([&] {
    Pacer pacer(mono_now(), options_.hz * static_cast<double>(options_.guests));
    for (std::uint32_t n = 0; !is_over; ++n) {
      sleep_until(pacer.deadline());
      Pose pose = numbered_pose(n / static_cast<std::uint32_t>(options_.guests));
      const MonoTime now = mono_now();
      pose.clock_id = this_clock_id();
      pose.capture_time = now;
      pose.stamp(Hop::kStaged, now);
      (*consumer)->on_pose(guest_name(n % options_.guests), pose, now);
      pacer.advance(now);
    }
  });
  AdapterReader eye(name);
  if (wait_until_seen(eye)) spin(eye, Duration::seconds(options_.seconds), result_.memory);
  is_over = true;
  writer.join();
  count(eye);
}

void BenchAdapter::count(const AdapterReader& eye) {
  const dance_counters counters = eye.counters();
  result_.reads += counters.reads;
  result_.gave_up += counters.busy;
  result_.torn += eye.torn() + counters.damaged;
}

Result<BenchAdapterResult> BenchAdapter::run() {
  AdapterReader eye(name_);
  if (auto seen = wait_until_seen(eye); !seen) return tl::make_unexpected(seen.error());
  sleep_until(mono_now() + kWarmUp);
  for (const double hz : {60.0, 72.0, 90.0}) run_frames(eye, hz);
  spin(eye, Duration::seconds(options_.seconds), result_.house);
  count(eye);
  // The same dancers, as another program hears them over the bus.
  DANCE_TRY(const auto poller, Poller::create());
  bus_->drain(mono_now());
  is_timing_other_ = true;
  poller->watch(bus_->fd(), [this](MonoTime now) { bus_->drain(now); });
  for (const MonoTime end = mono_now() + Duration::seconds(options_.seconds); mono_now() < end;)
    poller->run_once(Duration::ms(20));
  poller->unwatch(bus_->fd());
  for (auto& [name, child] : children_) child.stop(Duration::s(2));
  children_.clear();
  bus_.reset();  // and its thread
  spin_on_memory();
  return std::move(result_);
}

}  // namespace

Result<void> run_dancers(const std::string& bus_url, std::size_t guests, double hz) {
  DANCE_TRY(const auto poller, Poller::create());
  if (auto stops = poller->stop_on_signals(); !stops) return stops;
  DANCE_TRY(const auto bus, Bus::open(bus_url));
  Pacer pacer(mono_now(), hz * static_cast<double>(guests));
  std::size_t n = 0;
  // One after the other, as dancers of a room come.
  poller->add_timer(pacer.deadline(), [&](MonoTime now) {
    Pose pose = numbered_pose(static_cast<std::uint32_t>(n / guests));
    pose.clock_id = this_clock_id();
    pose.capture_time = mono_now();
    pose.stamp(Hop::kPublished, pose.capture_time);
    bus->publish(Where::kCapture, guest_name(n % guests), pose);
    ++n;
    pacer.advance(now);
    return pacer.deadline();
  });
  poller->run();
  return {};
}

Result<BenchAdapterResult> run_bench_adapter(const BenchAdapterOptions& options,
                                             const std::string& own_program) {
  BenchAdapter bench(options, own_program);
  if (auto prepared = bench.prepare(); !prepared) return tl::make_unexpected(prepared.error());
  return bench.run();
}

}  // namespace dance
