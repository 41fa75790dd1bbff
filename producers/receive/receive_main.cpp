// dance receive: takes a dancer from another program or a device and puts them into the house.

#include "core/bus/bus.h"
#include "core/control/house_publisher.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "producers/receive/receiver_table.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance receive --from engine --guest alice             what an engine here tracks, as alice
  dance receive --from vmc --guest carol                what an avatar app here sends, as carol
  dance receive --from rokoko --guest bob --listen 0.0.0.0:14043   an actor of Rokoko Studio
  dance receive --from natnet --guest ann --actor Ann              Ann's skeleton in Motive
)";

struct ReceiveOptions {
  std::string from;
  std::string guest = "guest";
  ReceiverOptions receiver;
  std::string bus;
  double seconds = 0.0;
};

Result<void> receive(ReceiveOptions& options) {
  const auto guest = GuestId::parse(options.guest);
  if (!guest) return fail("--guest '" + options.guest + "': " + kGuestIdRule);
  options.receiver.guest = *guest;
  DANCE_TRY(const auto poller, Poller::create());
  if (auto stops = poller->stop_on_signals(); !stops) return tl::make_unexpected(stops.error());
  DANCE_TRY(const auto bus, Bus::open(options.bus));
  HousePublisher port(*bus, bus->url(), *poller);
  PortCaptureSink sink(port);
  poller->watch(bus->fd(), [&](MonoTime now) { bus->drain(now); });
  DANCE_TRY(const auto receiver, open_receiver(options.from, options.receiver, sink, *poller));
  if (options.seconds > 0.0) {
    poller->add_timer(mono_now() + Duration::seconds(options.seconds), [&](MonoTime) {
      poller->stop();
      return MonoTime();
    });
  }
  talk::info("takes {} from {} to POSE/capture/{}", guest->view(), options.from, guest->view());
  poller->run();
  poller->unwatch(bus->fd());
  talk::info("{}", receiver->summary());
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::ReceiveOptions options;
  dance::CommandLine line("Takes a dancer from another program or a device.", "dance receive");
  line.add("--from", options.from, "the program's protocol")
      .one_of(dance::receiver_names())
      .required();
  line.add("--guest", options.guest, "the dancer's name in this house")
      .guest_name()
      .shows_default();
  line.add("--listen", options.receiver.listen,
           "address:port to hear it at; without it, the protocol's port, from this machine only "
           "(natnet: Motive's usual group)");
  line.add("--name", options.receiver.name, "name of the engine; without it, its usual one");
  line.add(
      "--actor", options.receiver.actor,
      "which dancer of a stream with several, as the sender names them; without it, the first");
  line.add("--seconds", options.seconds, "how long; 0 = until told to stop").range(0.0, 1e7);
  line.add("--bus", options.bus, "LCM URL of the bus");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::receive(options); });
}
