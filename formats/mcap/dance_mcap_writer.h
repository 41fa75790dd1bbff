// DanceMcapWriter: a recorded night as MCAP for Foxglove and its relatives: transforms and a body
// of each guest, and what transforms cannot hold as JSON. docs/files.md has the channels.
//
// Units/frames: a message's time is when it was recorded; "world" is +Z up, "stage" in it is W.
// Ownership:    as McapWriter, and 16 KiB of each guest. Beside new guests, changed skeletons and
//               the ends of chunks it allocates nothing.
// Threads:      none inside; one owner.
// Failure:      what `put` does with the bytes. Guests beyond kMostGuests, and what is before 1970,
//               which MCAP cannot express, are left out and counted.
#pragma once

#include <array>
#include <memory>

#include "formats/mcap/json_text.h"
#include "formats/mcap/mcap_writer.h"
#include "formats/recording/recording_sink.h"

namespace dance {

class DanceMcapWriter : public RecordingSink {
 public:
  static constexpr std::size_t kMostGuests = 64;
  // Bodies, floor and the stage's own frame come again so often: readers may begin anywhere.
  static constexpr std::int64_t kShapesAgain_us = 1'000'000;
  // A guest that is silent for longer is taken off the stage.
  static constexpr std::int64_t kSilence_us = 5'000'000;

  struct Counters {
    std::uint64_t poses = 0;
    std::uint64_t hands = 0;
    std::uint64_t beats = 0;
    std::uint64_t beyond_guests = 0;
    std::uint64_t before_1970 = 0;
  };

  explicit DanceMcapWriter(McapWriter::Put put);
  ~DanceMcapWriter() override;

  void on_skeleton(const GuestId& guest, const Skeleton& skeleton, std::int64_t time_us) override;
  void on_pose(const GuestId& guest, const Pose& pose, std::int64_t time_us) override;
  void on_hands(const GuestId& guest, const Hands& hands, std::int64_t time_us) override;
  void on_beat(const Beat& beat, std::int64_t time_us) override;
  // What was written so far can be read from then on.
  void end_chunk() { writer_.end_chunk(); }
  void finish() { writer_.finish(); }

  std::size_t guests() const { return guests_.size(); }
  const Counters& counters() const { return counters_; }
  const McapWriter& file() const { return writer_; }

 private:
  struct Guest;
  Guest* guest_of(const GuestId& id);
  bool is_time(std::int64_t time_us);
  void write_shapes(std::int64_t time_us);
  void write_stage(std::uint64_t time_ns);
  void write_body(Guest& guest, std::uint64_t time_ns);
  void write_transforms(const Guest& guest, const Pose& pose, std::uint64_t time_ns);
  void write_pose(const Guest& guest, const Pose& pose, std::uint64_t time_ns);
  // The text that was put together, as a message.
  void write(std::uint16_t channel, std::uint32_t sequence, std::uint64_t time_ns);

  McapWriter writer_;
  JsonText json_;
  std::vector<std::unique_ptr<Guest>> guests_;
  std::uint16_t transforms_schema_ = 0;
  std::uint16_t scene_schema_ = 0;
  std::uint16_t pose_schema_ = 0;
  std::uint16_t hands_schema_ = 0;
  std::uint16_t stage_channel_ = 0;
  std::uint16_t floor_channel_ = 0;
  std::uint16_t beat_channel_ = 0;
  std::int64_t shapes_us_ = 0;
  bool has_shapes_ = false;
  Counters counters_;
};

}  // namespace dance
