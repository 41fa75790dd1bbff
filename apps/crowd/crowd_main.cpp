// dance crowd: a load generator of simulated guests.

#include <algorithm>
#include <cstdio>

#include "apps/crowd/crowd_report.h"
#include "core/program/program.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance crowd                                   30 guests in one room of a server of its own
  dance crowd --guests 300 --rooms 30           thirty rooms of ten
  dance crowd --server dance.example.org --room salsa --guests 12 --name alice
                                                with alice's key: alice-1, alice-2 …
  dance crowd --server 192.0.2.7 --server 192.0.2.8 --guests 60
                                                the guests of a room dealt over two servers
  dance crowd --guests 40 --churn 2 --seconds 60   two a second leave, and come back
  dance crowd --guests 60 --decode 4 --threads 2   four decode, the others only count
  dance crowd --seconds 0 --json                until Ctrl-C: a line of JSON each second
All guests speak the full protocol over sockets of their own. Latencies are of one clock, from a
guest's pose to another guest's, encoded, through the server, and decoded.
)";

struct Options {
  CrowdPlan plan;
  std::uint64_t guests = 30, rooms = 1, threads = 1, decoders = 0;
  std::vector<std::string> want;
  bool is_json = false;
};

Result<void> check(Options& options) {
  CrowdPlan& plan = options.plan;
  plan.guests = options.guests;
  plan.rooms = options.rooms;
  plan.threads = std::min<std::size_t>(options.threads, options.guests);
  if (options.decoders > 0) plan.decoders = options.decoders;
  const auto interest = parse_interest(options.want);
  if (!interest) return fail("--want " + interest.error().what);
  plan.interest = *interest;
  DANCE_TRY(plan, checked_plan(std::move(plan)));
  if (plan.share_ms >= 0.0 && !plan.servers.empty())
    return fail("--share-ms is of a server of its own: leave out --server");
  return {};
}

void tell(const std::string& text) {
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout);
}

Result<void> run(const Options& options) {
  if (!options.is_json) tell(crowd_heading());
  DANCE_TRY(const CrowdSummary summary, run_crowd(options.plan, [&](const CrowdSecond& second) {
              tell(options.is_json ? crowd_second_json(second) : crowd_second_line(second));
            }));
  tell(options.is_json ? crowd_summary_json(options.plan, summary)
                       : crowd_summary_text(options.plan, summary));
  if (summary.seconds > 0 && summary.tally.delivered == 0 && options.plan.guests_per_room() > 1)
    return fail("nothing was delivered while it was measured");
  return {};
}

void add_crowd_options(CommandLine& line, Options& options) {
  CrowdPlan& plan = options.plan;
  line.add("--server", plan.servers,
           "HOST or HOST:PORT of `dance server`; repeated, the guests of each room are dealt over "
           "them (else a server of its own, on this machine)")
      .one_each_time();
  line.add("--guests", options.guests, "in all rooms together")
      .range(1, kMostCrowdGuests)
      .shows_default();
  line.add("--rooms", options.rooms, "that they are dealt over")
      .range(1, kMostCrowdGuests)
      .shows_default();
  line.add("--hz", plan.hz, "poses a second of each guest").range(1.0, 240.0).shows_default();
  line.add("--seconds", plan.seconds, "measured, once all are in; 0 = until Ctrl-C or SIGTERM")
      .range(0.0, 1e6)
      .shows_default();
  line.add("--join-rate", plan.join_rate,
           "guests who join a second: servers let a network begin twenty")
      .range(0.1, 10'000.0)
      .shows_default();
  line.add("--wait", plan.wait_s, "seconds that the last one has to get in")
      .range(1.0, 600.0)
      .shows_default();
  line.add("--churn", plan.churn, "guests who leave a second, and come back after one to three")
      .range(0.0, 1000.0)
      .shows_default();
  line.add("--threads", options.threads, "that the guests are dealt over")
      .range(1, kMostCrowdThreads)
      .shows_default();
  line.add("--decode", options.decoders,
           "guests of each room who decode what they hear; the others only count it (else all "
           "decode)")
      .range(1, kMostCrowdGuests);
  line.add_flag("--together", plan.is_together,
                "everybody's pose at the same moment, instead of spread evenly over the frame");
  line.add("--want", options.want,
           "how many poses of a guest each of the others asks for, as of dance link: default=N, "
           "NAME=N; may be repeated")
      .one_each_time();
}

void add_identity_options(CommandLine& line, Options& options) {
  CrowdPlan& plan = options.plan;
  line.add("--take", plan.takes,
           "a recorded dance (.bvh, .glb) instead of the synthetic one; may be repeated")
      .one_each_time();
  line.add("--room", plan.room, "which room; with a number where there are several")
      .shows_default();
  line.add("--name", plan.name, "of the guests, with a number each").shows_default();
  line.add("--key-file", plan.key.key_file,
           "file of keys to servers (else where dance key keeps them)");
  line.add("--certificate", plan.key.certificates.chain,
           "PEM file with a certificate, instead of a key");
  line.add("--private-key", plan.key.certificates.private_key, "PEM file of its private key");
  line.add("--authorities", plan.key.certificates.authorities,
           "PEM file of those who may sign the server's certificate (else the system's)");
  line.add("--share-ms", plan.share_ms,
           "how long its own server lets poses wait to share a datagram; else as that chooses")
      .range(0.0, 20.0);
  line.add("--cpu-of", plan.cpu_of,
           "number of a server's process on this machine, whose processor time is told; may be "
           "repeated (that of a server of its own is told anyway)")
      .one_each_time();
  line.add_flag("--json", options.is_json,
                "a line of JSON each second, and one with \"summary\" at the end");
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Options options;
  dance::CommandLine line(
      "A load generator: simulated guests who dance in rooms of a server, and what they hear of "
      "each other.",
      "dance crowd");
  dance::add_crowd_options(line, options);
  dance::add_identity_options(line, options);
  line.finally([&] { return dance::check(options); });
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run(options); });
}
