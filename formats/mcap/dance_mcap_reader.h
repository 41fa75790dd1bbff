// DanceMcapReader: reads an MCAP file that DanceMcapWriter wrote back into a RecordingSink;
// channels that are not ours are ignored.
//
// Units/frames: as formats/recording/recording_sink.h.
// Ownership:    owns the file.
// Threads:      none inside; one owner.
// Failure:      open() names the file and the reason, read_into() one that cannot be read to its
//               end or in which nobody dances. Input is untrusted: messages that are not valid are
//               left out and counted by cause.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "formats/mcap/mcap_reader.h"
#include "formats/recording/recording_sink.h"

namespace dance {

class DanceMcapReader {
 public:
  static constexpr std::size_t kMostGuests = 256;
  static constexpr std::size_t kMostMessage_bytes = std::size_t{1} << 18;

  struct Counters {
    std::uint64_t poses = 0;
    std::uint64_t unreadable = 0;  // messages of our channels that are not as their schema says
    std::uint64_t invalid = 0;     // poses, skeletons, hands and beats that none can be
    std::uint64_t beyond_guests = 0;
    std::uint64_t without_transforms = 0;  // poses whose transforms did not come, or are invalid
    std::uint64_t bare = 0;                // read from transforms alone, as their pose did not come
  };

  static Result<DanceMcapReader> open(const std::string& path);
  static Result<DanceMcapReader> over(std::span<const std::uint8_t> bytes);

  Result<void> read_into(RecordingSink& sink);

  const Counters& counters() const { return counters_; }
  const McapReader& file() const { return reader_; }
  // The file was not in the order of its times; it was read in that order.
  bool was_sorted() const { return was_sorted_; }

 private:
  // Transforms come before the rest of their pose.
  struct Guest {
    GuestId id;
    bool is_pending = false;
    std::int64_t time_us = 0;
    Pose pose;
    Skeleton skeleton;  // always a valid one
    bool has_skeleton = false;
    Skeleton told;
    std::uint32_t next_sequence = 1;
  };

  DanceMcapReader(McapReader reader, std::string name)
      : reader_(std::move(reader)), name_(std::move(name)) {}
  Guest* guest_of(std::string_view topic, std::string_view end);
  void take(const McapMessage& message, RecordingSink& sink);
  void take_transforms(Guest& guest, const nlohmann::json& json, std::int64_t time_us,
                       RecordingSink& sink);
  void take_pose(Guest& guest, const nlohmann::json& json, std::int64_t time_us,
                 RecordingSink& sink);
  // Transforms whose pose did not come.
  void tell_pending(Guest& guest, RecordingSink& sink);
  void tell(Guest& guest, RecordingSink& sink);

  McapReader reader_;
  std::string name_;
  std::vector<Guest> guests_;
  bool was_sorted_ = false;
  Counters counters_;
};

}  // namespace dance
