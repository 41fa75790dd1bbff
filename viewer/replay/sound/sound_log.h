// SoundLog: reads the messages of a recording that concern its sound: songs of the house band,
// other music, beats and voices.
//
// Units/frames: times of the recorded house's clock.
// Ownership:    owns the open log.
// Failure:      open() names the file; messages that do not decode are left out.
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "core/base/beat.h"
#include "core/bus/channel.h"
#include "core/bus/state_messages.h"
#include "core/bus/voice.h"
#include "formats/log/log_file.h"
#include "formats/replay/replay_index.h"

namespace dance {

struct SoundEvent {
  MonoTime time;  // when it arrived at the recorder
  Channel channel;
  std::variant<RoomSong, Music, Beat, Voice> message;
};

class SoundLog {
 public:
  // Begins at least ReplayIndex::kLeadIn before `from`, or at the start of the log.
  static Result<SoundLog> open(const std::string& path, const ReplayIndex& index, MonoTime from);

  enum class Step {
    kSound,  // `event` is set
    kOther,  // the log's next message does not concern sound
    kEnd,    // the log ends, or its next message is later than `until`
  };
  Step step(MonoTime until, std::optional<SoundEvent>& event);

 private:
  SoundLog(LogReader reader, std::int64_t wall_ahead_us)
      : reader_(std::move(reader)), wall_ahead_us_(wall_ahead_us) {}

  LogReader reader_;
  std::int64_t wall_ahead_us_;
};

}  // namespace dance
