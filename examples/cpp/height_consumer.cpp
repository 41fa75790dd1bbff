// height_consumer: prints how high each dancer's right hand is, for every pose that is heard. Of
// each dancer the proportions come on SKELETON/…, once a second, and the poses on POSE/….

#include <cstdio>
#include <map>
#include <string>

#include "core/bus/bus.h"
#include "core/net/mono_clock.h"
#include "core/net/poller.h"
#include "core/pose/kinematics.h"
#include "core/program/program.h"

namespace {

dance::Result<void> listen(dance::Where where, double seconds) {
  DANCE_TRY(const auto poller, dance::Poller::create());
  DANCE_TRY(const auto bus, dance::Bus::open(""));  // DANCE_BUS_URL, else the default
  std::map<std::string, dance::Skeleton> skeletons;

  bus->subscribe<dance::TimedSkeleton>(
      where,
      [&](const dance::Channel& channel, const dance::TimedSkeleton& timed, dance::MonoTime) {
        skeletons[std::string(channel.guest().view())] = timed.skeleton;
      });
  bus->subscribe<dance::Pose>(
      where, [&](const dance::Channel& channel, const dance::Pose& pose, dance::MonoTime) {
        const std::string guest(channel.guest().view());
        const auto body = skeletons.try_emplace(guest, dance::average_skeleton()).first;
        dance::BodyFrames frames;
        dance::forward_kinematics(body->second, pose, frames);
        std::printf("%s %u %.3f\n", guest.c_str(), pose.sequence,
                    static_cast<double>(frames.position(dance::Bone::kRightHand).y()));
      });
  poller->watch(bus->fd(), [&](dance::MonoTime now) { bus->drain(now); });
  if (seconds > 0.0) {
    poller->add_timer(dance::mono_now() + dance::Duration::seconds(seconds), [&](dance::MonoTime) {
      poller->stop();
      return dance::MonoTime();  // never again
    });
  }
  poller->run();
  poller->unwatch(bus->fd());
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  std::string where = "stage";
  double seconds = 0.0;
  dance::CommandLine line(
      "How high each dancer's right hand is: guest, number of the pose, metres.",
      "height_consumer");
  line.add("--where", where, "which poses").one_of({"capture", "guest", "stage"}).shows_default();
  line.add("--seconds", seconds, "how long; 0 = until ctrl-C").range(0.0, 1e7);
  return dance::run_program(line, argc, argv,
                            [&] { return listen(*dance::find_where(where), seconds); });
}
