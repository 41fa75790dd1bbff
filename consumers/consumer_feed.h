// Subscribes a consumer to the signals of a house: poses, proportions and hands of the guests that
// it listens to, and the beat.
//
// Units/frames: as core/bus/signal_port.h has them.
// Ownership:    refers to the consumer, which must outlive the port.
// Threads:      the port's.
// Failure:      none; what cannot be decoded the port counts.
#pragma once

#include "consumers/pose_consumer.h"
#include "core/bus/signal_port.h"

namespace dance {

inline void feed_consumer(SignalPort& port, const From& from, PoseConsumer& consumer) {
  port.subscribe<Pose>(from, [&consumer](const Channel& channel, const Pose& pose, MonoTime now) {
    consumer.on_pose(channel.guest(), pose, now);
  });
  port.subscribe<TimedSkeleton>(
      from, [&consumer](const Channel& channel, const TimedSkeleton& timed, MonoTime now) {
        consumer.on_skeleton(channel.guest(), timed.skeleton, now);
      });
  port.subscribe<Hands>(from,
                        [&consumer](const Channel& channel, const Hands& hands, MonoTime now) {
                          consumer.on_hands(channel.guest(), hands, now);
                        });
  // Faces have no stage: what is captured here, and what came through the tunnel.
  for (const Where where : {Where::kCapture, Where::kGuest})
    port.subscribe<Face>({where, from.guest},
                         [&consumer](const Channel& channel, const Face& face, MonoTime now) {
                           consumer.on_face(channel.guest(), face, now);
                         });
  port.subscribe<Beat>(Where::kLocal, [&consumer](const Channel&, const Beat& beat, MonoTime now) {
    consumer.on_beat(beat, now);
  });
}

}  // namespace dance
