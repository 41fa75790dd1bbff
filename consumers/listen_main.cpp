// dance listen: hears the dancers of a bus and passes them on: as text, as a file, to the programs
// of others.

#include "consumers/consumer_feed.h"
#include "consumers/consumer_table.h"
#include "consumers/rate_limit.h"
#include "core/bus/bus.h"
#include "core/net/mono_clock.h"
#include "core/net/poller.h"
#include "core/program/program.h"
#include "core/program/talk.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance listen                                          who is on the stage, a line for each pose
  dance listen --hz 1 --where capture                   a line a second for each dancer here
  dance listen --to csv -o dance.csv --seconds 60       a minute as a table
  dance listen --to bvh -o alice.bvh --guest alice      alice's dance as BVH, until ctrl-C
  dance listen --to engine                              the stage for the engines of this machine
  dance listen --to glb -o couple.glb --seconds 60      all as figures, for Blender and the web
  dance listen --to vmc --guest alice                   alice to an avatar app on this machine
  dance listen --to rokoko                              to the plugins of Blender, Unity and Unreal
)";

constexpr Duration kSecond = Duration::s(1);

struct ListenOptions {
  std::string bus;
  std::string where = "stage";
  std::string guest;
  std::string to = "text";
  std::string output;
  std::string address;
  std::string name;
  std::string dialect;
  double hz = 0.0;
  double seconds = 0.0;
};

Result<void> listen(const ListenOptions& options) {
  ConsumerOptions consumer_options;
  consumer_options.hz = options.hz;
  consumer_options.own_clock_id = this_clock_id();
  consumer_options.file = options.output;
  consumer_options.address = options.address;
  consumer_options.name = options.name;
  consumer_options.dialect = options.dialect;
  if (!options.guest.empty()) {
    const auto guest = GuestId::parse(options.guest);
    if (!guest) return fail("--guest '" + options.guest + "': " + kGuestIdRule);
    consumer_options.guest = *guest;
  }
  const Where where = find_where(options.where).value_or(Where::kStage);
  DANCE_TRY(const auto poller, Poller::create());
  if (auto stops = poller->stop_on_signals(); !stops) return tl::make_unexpected(stops.error());
  DANCE_TRY(const auto consumer, make_consumer(options.to, consumer_options));
  DANCE_TRY(const auto bus, Bus::open(options.bus));

  const From from(where, consumer_options.guest);
  std::uint64_t heard = 0;
  bus->subscribe<Pose>(from, [&](const Channel&, const Pose&, MonoTime) { ++heard; });
  feed_consumer(*bus, from, *consumer);
  poller->watch(bus->fd(), [&](MonoTime now) { bus->drain(now); });
  // After each turn, so that the reader of a pipe gets a pose when it comes.
  poller->at_turn_end([&](MonoTime) {
    if (!consumer->flush()) poller->stop();
  });
  poller->add_timer(mono_now() + kSecond, [&](MonoTime now) {
    consumer->on_second(now);
    return now + kSecond;
  });
  if (options.seconds > 0.0) {
    poller->add_timer(mono_now() + Duration::seconds(options.seconds), [&](MonoTime) {
      poller->stop();
      return MonoTime();
    });
  }
  talk::info("listens to POSE/{}/{} on {}", options.where,
             options.guest.empty() ? "*" : options.guest, bus->url());
  poller->run();
  poller->unwatch(bus->fd());

  if (heard == 0)
    talk::warn("heard nobody on POSE/{}/*; dance top shows what is on the bus", options.where);
  Result<void> finished = consumer->finish();
  if (finished) talk::info("{}", consumer->summary());
  return finished;
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::ListenOptions options;
  dance::CommandLine line(
      "Hears the dancers of a bus and passes them on: as text, as a file, to other programs.",
      "dance listen");
  line.add("--to", options.to, "what to make of them")
      .one_of(dance::consumer_names())
      .shows_default();
  line.add("-o,--output", options.output, "file to write; without it, standard output");
  line.add("--address", options.address,
           "host:port that datagrams go to; without it, the protocol's port on this machine");
  line.add("--name", options.name, "name of the shared memory; without it, its usual one");
  line.add("--dialect", options.dialect, "which form of a protocol that has several");
  line.add("--where", options.where, "which poses: made here, come from other houses, shown")
      .one_of({"capture", "guest", "stage"})
      .shows_default();
  line.add("--guest", options.guest, "only this dancer").guest_name();
  line.add("--hz", options.hz,
           "at most so many lines or rows a second of each dancer (0: all); frames a second "
           "of a BVH (0: 60)")
      .range(0.0, dance::kFastestRate_hz);
  line.add("--seconds", options.seconds, "how long; 0 = until told to stop").range(0.0, 1e7);
  line.add("--bus", options.bus, "LCM URL of the bus");
  line.finally([&] { return dance::check_rate(options.hz); });
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::listen(options); });
}
