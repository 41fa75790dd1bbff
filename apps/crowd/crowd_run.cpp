#include "apps/crowd/crowd_run.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <memory>
#include <span>
#include <string>

#include "apps/crowd/crowd_worker.h"
#include "core/net/mono_clock.h"
#include "core/net/udp_socket.h"
#include "core/program/child_pipe.h"
#include "core/program/child_process.h"
#include "core/program/program.h"
#include "tunnel/server/server.h"

namespace dance {
namespace {

// Each guest has a socket and hears of the machine's addresses.
constexpr std::size_t kFilesPerGuest = 2;
constexpr std::size_t kFilesBesides = 64;
// Before it is measured; between the end of a second and its count.
constexpr std::int64_t kSettles_s = 2;
constexpr Duration kCountsAfter = Duration::ms(200);
constexpr std::size_t kLongestLine_bytes = 400;

std::size_t open_file_limit(std::size_t wanted) {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return 0;
  if (limit.rlim_cur < wanted && limit.rlim_cur < limit.rlim_max) {
    limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, wanted);
    setrlimit(RLIMIT_NOFILE, &limit);
    getrlimit(RLIMIT_NOFILE, &limit);
  }
  return limit.rlim_cur;
}

Result<void> check_open_files(const CrowdPlan& plan) {
  const std::size_t wanted = kFilesPerGuest * plan.guests + kFilesBesides;
  const std::size_t limit = open_file_limit(wanted);
  if (limit >= wanted) return {};
  return fail(std::to_string(plan.guests) + " guests need " + std::to_string(wanted) +
              " open files, and this process may have " + std::to_string(limit) +
              ": raise the limit (ulimit -Hn) or lower --guests");
}

class CrowdRun {
 public:
  CrowdRun(const CrowdPlan& plan, const std::function<void(const CrowdSecond&)>& tell)
      : plan_(plan), tell_(tell) {}

  Result<CrowdSummary> run() {
    if (auto prepared = prepare(); !prepared) return tl::make_unexpected(prepared.error());
    Result<void> went;
    poller_->add_timer(begin_ + Duration::s(1) + kCountsAfter, [&](MonoTime now) {
      went = on_second(now);
      if (!went || is_over_) poller_->stop();
      return begin_ + Duration::s(second_ + 1) + kCountsAfter;
    });
    poller_->run();
    if (measured_from_ > 0 && !is_over_) note_cpu(false);
    for (auto& worker : workers_) worker->stop();
    if (!went) return tl::make_unexpected(went.error());
    return summary_;
  }

 private:
  Result<void> prepare() {
    if (auto enough = check_open_files(plan_); !enough) return enough;
    DANCE_TRY(poller_, Poller::create());
    if (auto stops = poller_->stop_on_signals(); !stops) return stops;
    if (plan_.servers.empty()) {
      if (auto started = start_server(); !started) return started;
    }
    for (const std::string& process : plan_.cpu_of) {
      pid_t pid = 0;
      const auto read = std::from_chars(process.data(), process.data() + process.size(), pid);
      if (read.ec != std::errc() || pid <= 0 || !cpu_time_of(pid))
        return fail("--cpu-of " + process + ": there is no such process");
      servers_.push_back(pid);
    }
    for (const std::string& server : plan_.servers) {
      DANCE_TRY(const auto addresses, Address::resolve_all(server, kDefaultServerPort));
      for (std::size_t room = 0; room < plan_.rooms; ++room) {
        CrowdDoor door{server, addresses, {}};
        DANCE_TRY(door.key,
                  choose_link_key(server, plan_.room_name(room), plan_.guest_name(0), plan_.key));
        doors_.push_back(std::move(door));
      }
    }
    DANCE_TRY(auto dances, CrowdDances::load(plan_.takes));
    dances_ = std::make_unique<CrowdDances>(std::move(dances));
    board_ = std::make_unique<CrowdBoard>(plan_.guests);
    begin_ = mono_now() + Duration::ms(10);
    const CrowdShared shared{plan_, *dances_, doors_, *board_, begin_};
    for (std::size_t i = 0; i < plan_.threads; ++i) {
      workers_.push_back(std::make_unique<CrowdWorker>(shared, i));
      workers_.back()->start();
    }
    return {};
  }

  Result<void> start_server() {
    DANCE_TRY(const std::uint16_t port, free_loopback_port());
    std::vector<std::string> arguments{
        "--port",
        std::to_string(port),
        "--max-rooms",
        std::to_string(plan_.rooms),
        "--max-sessions",
        std::to_string(std::min<std::size_t>(2 * plan_.guests, kMostCrowdGuests))};
    if (plan_.share_ms >= 0.0)
      arguments.insert(arguments.end(), {"--share-ms", std::to_string(plan_.share_ms)});
    DANCE_TRY(server_talk_, ChildPipe::open());
    ChildProcess::Options options{program_folder() + "/dance-server", arguments, "/dev/null"};
    options.talk_fd = server_talk_.child_fd();
    DANCE_TRY(ChildProcess server, ChildProcess::start(options));
    server_talk_.let_go();
    own_server_ = std::make_unique<ChildProcess>(std::move(server));
    servers_.push_back(own_server_->pid());
    plan_.servers.push_back("127.0.0.1:" + std::to_string(port));
    return {};
  }

  // Keeps the last line; the server never waits for room in the pipe.
  void read_server_talk() {
    std::array<char, 4096> bytes;
    while (const std::size_t count = server_talk_.read(bytes).value_or(0)) {
      for (const char byte : std::span(bytes).first(count)) {
        if (is_line_over_) server_line_.clear();
        is_line_over_ = byte == '\n';
        if (!is_line_over_ && server_line_.size() < kLongestLine_bytes) server_line_ += byte;
      }
    }
  }

  Result<void> on_second(MonoTime now) {
    CrowdTally sum;
    for (auto& worker : workers_) {
      if (const auto fault = worker->fault()) return fail(*fault);
      if (const auto tally = worker->take()) sum.add(*tally);
    }
    ++second_;
    const bool has_ended = own_server_ && own_server_->has_ended();
    read_server_talk();
    if (has_ended) return fail("its own server " + own_server_->exit_text() + ": " + server_line_);
    if (measured_from_ == 0) {
      if (auto waited = wait_for_all(sum, now); !waited) return waited;
    }
    const bool is_measured = measured_from_ > 0 && second_ > measured_from_;
    if (is_measured) {
      ++summary_.seconds;
      summary_.tally.add(sum);
      summary_.present = sum.present;
      is_over_ = plan_.seconds > 0.0 && static_cast<double>(summary_.seconds) >= plan_.seconds;
    }
    tell_({second_, is_measured, sum});
    if (is_over_) note_cpu(false);
    if (measured_from_ > 0 && second_ == measured_from_) note_cpu(true);
    return {};
  }

  // Everybody in, or who is not, and why.
  Result<void> wait_for_all(const CrowdTally& sum, MonoTime now) {
    const Duration joining = Duration::seconds(static_cast<double>(plan_.guests) / plan_.join_rate);
    if (sum.present == plan_.guests) {
      measured_from_ = second_ + kSettles_s;
      for (auto& worker : workers_) worker->begin_churn();
      return {};
    }
    if (now - begin_ <= joining + Duration::seconds(plan_.wait_s)) return {};
    std::string why = "nothing was said against them: is this machine, or the way, too slow?";
    for (auto& worker : workers_)
      if (const std::string trouble = worker->trouble(); !trouble.empty()) why = trouble;
    // Links try on; this is the end of it.
    constexpr std::string_view kTryingOn = " Trying on";
    if (why.ends_with(kTryingOn)) why.resize(why.size() - kTryingOn.size());
    return fail(std::to_string(plan_.guests - sum.present) + " of " + std::to_string(plan_.guests) +
                " guests are not in: " + why);
  }

  // Processor time of what is measured, at its begin and at its end.
  void note_cpu(bool is_begin) {
    const double sign = is_begin ? -1.0 : 1.0;
    summary_.knows_server_cpu = !servers_.empty();
    for (const pid_t server : servers_) {
      const auto cpu = cpu_time_of(server);
      if (!cpu) summary_.knows_server_cpu = false;  // it has ended
      summary_.server_cpu_s += sign * cpu.value_or(Duration()).as_seconds();
    }
    summary_.own_cpu_s += sign * cpu_time_of(getpid()).value_or(Duration()).as_seconds();
  }

  CrowdPlan plan_;
  const std::function<void(const CrowdSecond&)>& tell_;
  std::unique_ptr<Poller> poller_;
  std::unique_ptr<ChildProcess> own_server_;
  ChildPipe server_talk_;
  std::string server_line_;  // the last that it has written
  bool is_line_over_ = true;
  std::vector<pid_t> servers_;
  std::vector<CrowdDoor> doors_;
  std::unique_ptr<CrowdDances> dances_;
  std::unique_ptr<CrowdBoard> board_;
  MonoTime begin_;
  std::int64_t second_ = 0;
  std::int64_t measured_from_ = 0;  // the second before the first that counts; 0 = not yet
  bool is_over_ = false;
  CrowdSummary summary_;
  std::vector<std::unique_ptr<CrowdWorker>> workers_;  // last: they use the rest
};

}  // namespace

Result<CrowdSummary> run_crowd(const CrowdPlan& plan,
                               const std::function<void(const CrowdSecond&)>& tell) {
  return CrowdRun(plan, tell).run();
}

}  // namespace dance
