// Reads an LCM log, packed or plain, into a RecordingSink: its poses, skeletons, hands and beats.
//
// Units/frames: as formats/recording/recording_sink.h.
// Ownership:    a LogSource owns its file.
// Threads:      none inside; one owner.
// Failure:      open() names the file and says when nobody dances in it; read_into() a file that
//               cannot be read to its end. Damage is skipped and counted.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/bus/channel.h"
#include "formats/log/unpacked_log.h"
#include "formats/recording/recording_sink.h"

namespace dance {

class LogSource {
 public:
  static constexpr std::size_t kMostGuests = 256;

  struct Counters {
    std::uint64_t undecodable = 0;  // messages of our channels
    std::uint64_t beyond_guests = 0;
  };

  // Poses of the stage where the log holds some, else captures, else those of other houses; or
  // those of `where`. Looks through the whole log once.
  static Result<LogSource> open(const std::string& path, std::optional<Where> where = {});
  // Of bytes in memory, which must outlive it.
  static Result<LogSource> over(std::span<const std::uint8_t> bytes,
                                std::optional<Where> where = {});

  Where where() const { return where_; }
  // Those with poses there, in the order in which they came.
  std::vector<GuestId> guests() const;

  // Each guest's first skeleton is told before its first pose.
  Result<void> read_into(RecordingSink& sink);

  const Counters& counters() const { return counters_; }
  std::uint64_t skipped_bytes() const { return log_.skipped_bytes(); }
  const LogUnpacker::Counters& unpacking() const { return log_.unpacking(); }

 private:
  struct Guest {
    GuestId id;
    bool has_pose = false;
    std::optional<Skeleton> first_skeleton;
    std::optional<Skeleton> told_skeleton;
  };
  explicit LogSource(UnpackedLog log) : log_(std::move(log)) {}
  static Result<LogSource> look_through(UnpackedLog log, const std::string& name,
                                        std::optional<Where> where);
  // Of a place; nullptr beyond kMostGuests.
  Guest* guest_of(Where where, const GuestId& id);
  void tell(const Channel& channel, const LogEvent& event, RecordingSink& sink);

  UnpackedLog log_;
  Where where_ = Where::kStage;
  std::array<std::vector<Guest>, 3> guests_;  // by place: stage, capture, guest
  Counters counters_;
};

}  // namespace dance
