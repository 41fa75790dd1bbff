// dance-bench-avatar: what a file of an avatar takes through the tunnel, and what it does to the
// poses beside it, turn about with and without.

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "bench/parts/salsa_poses.h"
#include "core/net/mono_clock.h"
#include "core/net/udp_socket.h"
#include "core/program/child_process.h"
#include "core/program/figures.h"
#include "core/program/program.h"
#include "tunnel/link/link.h"
#include "tunnel/seal/keys/key_files.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance bench avatar                       1.3 MB at the usual rate, poses at 60 Hz beside it
  dance bench avatar --mb 16 --rate 1000000
Two links and a server over this machine's loopback, sealed. Poses are timed from the sender's link
to the receiver's handler; each round has as long without a file as the file took.
)";

struct Options {
  double mb = 1.3;
  double rate = LinkOptions().file_bytes_per_second;
  double hz = 60.0;
  int rounds = 2;
  bool is_json = false;
};

struct Measure {
  std::uint64_t sent = 0;
  std::vector<Duration> took;
};

GuestId named(const char* name) { return *GuestId::parse(name); }

class BenchAvatar {
 public:
  explicit BenchAvatar(const Options& options) : options_(options) {}

  Result<void> run() {
    if (auto opened = open(); !opened) return opened;
    dance_until([&, end = mono_now() + Duration::s(3)] { return mono_now() >= end; }, nullptr);
    for (int round = 0; round < options_.rounds; ++round) {
      if (auto chosen = choose_file(static_cast<std::uint8_t>(round + 1)); !chosen) return chosen;
      const MonoTime begin = mono_now(), give_up = begin + longest_transfer();
      is_here_ = false;
      receiver_->fetch_file(named("alice"), hash_, ChunkedFile(size_bytes()), begin);
      dance_until([&] { return is_here_ || mono_now() >= give_up; }, &with_);
      if (!is_here_ && !poller_->is_stopped())
        return fail("the file was not there after " +
                    std::to_string(static_cast<int>(longest_transfer().as_seconds())) + " s");
      const Duration took = mono_now() - begin;
      transfers_.push_back(took);
      dance_until([&, end = mono_now() + took] { return mono_now() >= end; }, &without_);
      if (poller_->is_stopped()) return fail("stopped by a signal before the end");
    }
    print();
    return {};
  }

 private:
  Result<void> open() {
    DANCE_TRY(poller_, Poller::create());
    if (auto stops = poller_->stop_on_signals(); !stops) return stops;
    DANCE_TRY(const std::uint16_t port, free_loopback_port());
    DANCE_TRY(ChildProcess server,
              ChildProcess::start({program_folder() + "/dance-server",
                                   {"--bind", "127.0.0.1", "--port", std::to_string(port)},
                                   "/dev/null",
                                   "/dev/null"}));
    server_ = std::make_unique<ChildProcess>(std::move(server));
    LinkHandlers hears;
    hears.on_pose = [this](const GuestId&, const Pose& pose, MonoTime) { arrived(pose.sequence); };
    hears.on_file = [this](const GuestId& who, const FileHash& hash, ChunkedFile&&) {
      is_here_ = true;
      receiver_->core().files().settle(who, hash, FileVerdict::kRight);
    };
    hears.on_avatar_file = [this](const GuestId&, const AvatarFile& file, MonoTime) {
      heard_ = file.hash;
    };
    DANCE_TRY(sender_, link("alice", port, {}));
    DANCE_TRY(receiver_, link("bob", port, std::move(hears)));
    const MonoTime give_up = mono_now() + Duration::s(15);
    while (sender_->remote_stats().empty() || receiver_->remote_stats().empty()) {
      if (mono_now() > give_up) return fail("the links were not let in within 15 s");
      poller_->run_once(Duration::ms(20));
    }
    return {};
  }

  Result<std::unique_ptr<Link>> link(const char* name, std::uint16_t port, LinkHandlers handlers) {
    LinkKey key;
    key.identity = kLocalKeyName;
    DANCE_TRY(key.key, local_key());
    LinkOptions of;
    of.room = named("bench");
    of.file_bytes_per_second = options_.rate;
    static_cast<void>(of.guests.try_push(named(name)));
    return Link::open({Address::loopback(port)}, key, of, std::move(handlers), *poller_);
  }

  std::uint32_t size_bytes() const { return static_cast<std::uint32_t>(options_.mb * 1e6); }
  Duration longest_transfer() const {
    return Duration::seconds(30.0 + 5.0 * size_bytes() / options_.rate);
  }

  // A server passes on files that their guest has chosen, once it has heard so.
  Result<void> choose_file(std::uint8_t number) {
    auto bytes = std::make_shared<std::vector<std::uint8_t>>(size_bytes());
    for (std::size_t i = 0; i < bytes->size(); ++i)
      (*bytes)[i] = static_cast<std::uint8_t>(i * number);
    hash_.bytes.fill(number);
    sender_->core().files().offer(named("alice"), hash_, std::move(bytes));
    AvatarFile file;
    file.time = mono_now();
    file.clock_id = this_clock_id();
    file.hash = hash_;
    file.size_bytes = static_cast<std::int32_t>(size_bytes());
    sender_->core().send(named("alice"), file, file.time);
    const MonoTime give_up = mono_now() + Duration::s(15);
    dance_until([&] { return heard_ == hash_ || mono_now() >= give_up; }, nullptr);
    if (!(heard_ == hash_) && !poller_->is_stopped())
      return fail("the choice of an avatar was not heard within 15 s");
    return {};
  }

  void arrived(std::uint32_t sequence) {
    if (counts_ == nullptr || sequence < first_) return;
    counts_->took.push_back(mono_now() - sent_at_[sequence % sent_at_.size()]);
  }

  template <class Done>
  void dance_until(const Done& is_done, Measure* counts) {
    const Duration frame = Duration::period_of_hz(options_.hz);
    counts_ = counts;
    first_ = next_;
    for (MonoTime due = mono_now(); !is_done() && !poller_->is_stopped();) {
      if (const MonoTime now = mono_now(); now >= due) {
        Pose pose = poses_[next_ % poses_.size()];
        pose.sequence = next_;
        pose.clock_id = this_clock_id();
        pose.capture_time = now;
        sent_at_[next_ % sent_at_.size()] = now;
        ++next_;
        if (counts != nullptr) ++counts->sent;
        sender_->send(named("alice"), pose, now);
        due += frame;
      }
      poller_->run_once(std::clamp(due - mono_now(), Duration(), Duration::ms(20)));
    }
    for (const MonoTime end = mono_now() + Duration::ms(100); mono_now() < end;)
      poller_->run_once(Duration::ms(10));
    counts_ = nullptr;
  }

  static double percentile_us(Measure& measure, double fraction) {
    std::ranges::sort(measure.took);
    return percentile<Duration>(measure.took, fraction).as_us();
  }

  void print() {
    std::ranges::sort(transfers_);
    const double seconds = transfers_[transfers_.size() / 2].as_seconds();
    const double rate = options_.mb * 1e6 / seconds;
    if (options_.is_json) {
      nlohmann::ordered_json report{{"megabytes", options_.mb},
                                    {"rate", options_.rate},
                                    {"seconds", rounded(seconds, 100.0)},
                                    {"bytes_per_second", rounded(rate, 1.0)}};
      for (auto& [name, measure] : {std::pair("with", &with_), std::pair("without", &without_)})
        report[name] = {{"sent", measure->sent},
                        {"delivered", measure->took.size()},
                        {"p50_us", rounded(percentile_us(*measure, 0.5), 10.0)},
                        {"p99_us", rounded(percentile_us(*measure, 0.99), 10.0)},
                        {"max_us", rounded(percentile_us(*measure, 1.0), 10.0)}};
      std::printf("%s\n", report.dump(2).c_str());
      return;
    }
    std::printf("%.1f MB at %.0f bytes/s: %.1f s (%.0f bytes/s of the file)\n\n", options_.mb,
                options_.rate, seconds, rate);
    std::printf("  %-22s%8s%8s%8s%9s%11s\n", "poses, us", "p50", "p99", "max", "sent", "delivered");
    for (auto& [title, measure] :
         {std::pair("beside the file", &with_), std::pair("baseline, no file", &without_)})
      std::printf("  %-22s%8.0f%8.0f%8.0f%9llu%11zu\n", title, percentile_us(*measure, 0.5),
                  percentile_us(*measure, 0.99), percentile_us(*measure, 1.0),
                  static_cast<unsigned long long>(measure->sent), measure->took.size());
    std::printf("  %-22s%7.2fx%7.2fx\n", "by the baseline",
                percentile_us(with_, 0.5) / percentile_us(without_, 0.5),
                percentile_us(with_, 0.99) / percentile_us(without_, 0.99));
  }

  Options options_;
  std::vector<Pose> poses_ = salsa_poses();
  std::unique_ptr<Poller> poller_;
  std::unique_ptr<ChildProcess> server_;
  std::unique_ptr<Link> sender_, receiver_;
  std::array<MonoTime, 1024> sent_at_{};
  std::uint32_t next_ = 1, first_ = 1;
  Measure* counts_ = nullptr;
  Measure with_, without_;
  std::vector<Duration> transfers_;
  FileHash hash_, heard_;  // of the file that is chosen, and of that which is known to be
  bool is_here_ = false;
};

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Options options;
  dance::CommandLine line("A file of an avatar through the tunnel, and the poses beside it.",
                          "dance bench avatar");
  line.add("--mb", options.mb, "megabytes of the file").range(0.01, 16.7).shows_default();
  line.add("--rate", options.rate, "bytes a second that files may take, as avatar_bytes_per_second")
      .range(1000.0, 1e7)
      .shows_default();
  line.add("--hz", options.hz, "poses a second").range(1.0, 240.0).shows_default();
  line.add("--rounds", options.rounds, "files, one after the other").range(1, 100).shows_default();
  line.add_flag("--json", options.is_json, "one JSON object instead of the table");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::BenchAvatar(options).run(); });
}
