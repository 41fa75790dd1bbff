// CsvReader: reads a table of CsvConsumer back into a RecordingSink. Columns are found by name, in
// any order; unknown ones are ignored. Skeletons are recovered from the positions of the bones.
//
// Units/frames: as formats/csv/dance_table.h; received_us is the recording's time (the column
//               heard_us).
// Ownership:    owns the file.
// Threads:      none inside; one owner.
// Failure:      open() names the file, and the column that is missing; read_into() a file that
//               cannot be read to its end, holds no pose, or whose times are all rounded. If one
//               of its two times is, the other one is used, and note() reports it. Invalid rows are
//               left out and counted by cause.
// Source:       offset_B = R_WP⁻¹ · (p_WB − p_WP).
#pragma once

#include <array>
#include <vector>

#include "formats/csv/csv_lines.h"
#include "formats/csv/dance_table.h"
#include "formats/recording/recording_sink.h"

namespace dance {

class CsvReader {
 public:
  static constexpr std::size_t kMostGuests = 256;
  static constexpr std::size_t kMostCells = 1024;

  struct Counters {
    std::uint64_t rows = 0;
    std::uint64_t poses = 0;
    std::uint64_t malformed = 0;  // cells missing, or no numbers
    std::uint64_t invalid = 0;    // poses and bodies that none can be
    std::uint64_t beyond_guests = 0;
  };

  static Result<CsvReader> open(const std::string& path);
  static Result<CsvReader> over(std::string_view text);

  Result<void> read_into(RecordingSink& sink);

  const Counters& counters() const { return counters_; }
  const std::string& note() const { return note_; }
  std::uint64_t too_long_lines() const { return lines_.too_long(); }

 private:
  struct Guest {
    GuestId id;
    bool has_skeleton = false;
    Skeleton skeleton;
  };
  enum class Times : std::uint8_t { kBoth, kReceivedOnly, kCaptureOnly };
  // Offset of the recording's time to a clock, for tables in which only capture_us is usable.
  struct Clock {
    std::uint64_t id = 0;
    std::int64_t ahead_us = 0;
  };
  // What stands in a row.
  struct Row {
    GuestId guest;
    std::int64_t received_us = 0;
    Pose pose;
    std::array<Eigen::Vector3d, kBoneCount> p_WB_m;
    std::array<Eigen::Vector3d, kTipCount> p_WT_m;
    double hips_height_m = 0.0;
  };

  CsvReader(CsvLines lines, std::string name) : lines_(std::move(lines)), name_(std::move(name)) {}
  Result<void> read_names();
  void split(std::string_view line);
  std::string_view cell(std::size_t column) const;
  bool has(std::size_t column) const { return place_[column] >= 0; }
  template <class Vector>
  bool read_xyz(std::size_t first, Vector& v) const;
  bool read_row(Row& row) const;
  bool read_head(Row& row) const;
  Skeleton skeleton_of(const Row& row) const;
  void tell(const Row& row, RecordingSink& sink);
  Result<void> choose_times(const std::vector<std::string>& lines);
  void use_other_time(Row& row);
  void read_line(std::string_view line, RecordingSink& sink);

  CsvLines lines_;
  std::string name_;
  std::array<int, TableColumns::kCount> place_{};  // of each column in the file; -1: it has none
  bool has_positions_ = false;
  std::vector<std::string_view> cells_;
  std::vector<Guest> guests_;
  Times times_ = Times::kBoth;
  std::vector<Clock> clocks_;
  std::int64_t last_us_ = 0;
  std::string note_;
  Counters counters_;
};

}  // namespace dance
