#include "formats/csv/csv_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "formats/csv/table_times.h"
#include "formats/recording/recorded_time.h"

namespace dance {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// Bones of the same body differ by no more than the rounding of their places from row to row.
constexpr float kSameBone_m = 1e-5f;
constexpr float kRounding = 8.0f * 1.2e-7f;

std::string_view trimmed(std::string_view cell) {
  while (!cell.empty() && (cell.front() == ' ' || cell.front() == '\t')) cell.remove_prefix(1);
  while (!cell.empty() && (cell.back() == ' ' || cell.back() == '\t')) cell.remove_suffix(1);
  if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') {
    cell.remove_prefix(1);
    cell.remove_suffix(1);
  }
  return cell;
}

template <class Number>
bool parse(std::string_view cell, Number& value) {
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc() && end == cell.data() + cell.size();
}

template <class Number>
bool parse_number(std::string_view cell, Number& value) {
  return parse(cell, value) && std::isfinite(value);
}

// Spreadsheets write large whole numbers as 1.5E+15.
template <class Whole>
bool parse_whole(std::string_view cell, Whole& value) {
  if (parse(cell, value)) return true;
  double number = 0.0;
  constexpr double kMost = 1.8e19;
  if (!parse_number(cell, number) || !(std::abs(number) < kMost)) return false;
  if constexpr (std::is_signed_v<Whole>) {
    if (std::abs(number) > 9.2e18) return false;
    value = static_cast<Whole>(std::llround(number));
  } else {
    if (number < 0.0 || number > static_cast<double>(std::numeric_limits<Whole>::max()))
      return false;
    value = static_cast<Whole>(number);
  }
  return true;
}

bool is_same_bone(const Eigen::Vector3f& a, const Eigen::Vector3f& b, float furthest_m) {
  return (a - b).cwiseAbs().maxCoeff() <= kSameBone_m + kRounding * furthest_m;
}

}  // namespace

Result<CsvReader> CsvReader::open(const std::string& path) {
  DANCE_TRY(CsvLines lines, CsvLines::open(path));
  CsvReader reader(std::move(lines), path);
  if (auto read = reader.read_names(); !read) return tl::make_unexpected(read.error());
  return reader;
}

Result<CsvReader> CsvReader::over(std::string_view text) {
  CsvReader reader(CsvLines::over(text), "the table");
  if (auto read = reader.read_names(); !read) return tl::make_unexpected(read.error());
  return reader;
}

void CsvReader::split(std::string_view line) {
  cells_.clear();
  while (cells_.size() < kMostCells) {
    const std::size_t comma = line.find(',');
    cells_.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

Result<void> CsvReader::read_names() {
  const auto line = lines_.next();
  if (auto ended = lines_.ended(); !ended) return ended;
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  std::string_view text = line.value_or(std::string_view());
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  split(text);
  const std::vector<std::string> names = table_column_names();
  for (std::size_t column = 0; column < names.size(); ++column) {
    const auto found = std::find(cells_.begin(), cells_.end(), names[column]);
    place_[column] = found == cells_.end() ? -1 : static_cast<int>(found - cells_.begin());
    const bool is_needed = names[column] == "guest" ||
                           (column >= TableColumns::kHips && column < TableColumns::kPositions);
    if (is_needed && place_[column] < 0)
      return fail(name_ + ": has no column '" + names[column] +
                  "'; a table of dance listen --to csv has it, with commas between its cells");
  }
  has_positions_ = true;
  for (std::size_t column = TableColumns::kPositions; column < TableColumns::kHipsHeight; ++column)
    has_positions_ = has_positions_ && has(column);
  return {};
}

std::string_view CsvReader::cell(std::size_t column) const {
  if (!has(column)) return {};
  const auto at = static_cast<std::size_t>(place_[column]);
  return at < cells_.size() ? cells_[at] : std::string_view();
}

template <class Vector>
bool CsvReader::read_xyz(std::size_t first, Vector& v) const {
  return parse_number(cell(first), v[0]) && parse_number(cell(first + 1), v[1]) &&
         parse_number(cell(first + 2), v[2]);
}

bool CsvReader::read_head(Row& row) const {
  // Cells that people may have left out; what they then mean.
  row.received_us = 0;
  std::int64_t capture_us = 0;
  std::uint64_t clock_id = 1;
  row.pose.sequence = static_cast<std::uint32_t>(counters_.rows);
  const auto optional = [&](std::size_t column, auto&& read) {
    return cell(column).empty() || read(cell(column));
  };
  const auto whole = [](auto& value) {
    return [&value](std::string_view text) { return parse_whole(text, value); };
  };
  const auto number = [](auto& value) {
    return [&value](std::string_view text) { return parse_number(text, value); };
  };
  row.pose.presence = kAllBones;
  row.pose.confidence = 1.0f;
  row.pose.music_beats = kNoMusic;
  if (!optional(0, whole(row.received_us)) || !optional(1, whole(capture_us)) ||
      !optional(2, whole(clock_id)) || !optional(4, whole(row.pose.sequence)) ||
      !optional(5, whole(row.pose.presence)) || !optional(6, number(row.pose.confidence)) ||
      !optional(7, number(row.pose.music_beats)))
    return false;
  if (cell(1).empty()) capture_us = row.received_us;
  if (cell(0).empty()) row.received_us = capture_us;
  if (!is_recorded_time(row.received_us) || !is_recorded_time(capture_us)) return false;
  row.pose.capture_time = MonoTime::from_us(capture_us);
  row.pose.clock_id = clock_id;
  row.pose.presence &= kAllBones;
  return true;
}

bool CsvReader::read_row(Row& row) const {
  const auto guest = GuestId::parse(cell(3));
  if (!guest || !read_head(row) || !read_xyz(TableColumns::kHips, row.pose.p_WH_m)) return false;
  row.guest = *guest;
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    for (std::size_t k = 0; k < 4; ++k)
      if (!parse_number(cell(TableColumns::kRotations + 4 * b + k),
                        row.pose.R_PB[b].coeffs()[static_cast<Eigen::Index>(k)]))
        return false;
  }
  if (!has_positions_) return true;
  row.p_WB_m[0] = row.pose.p_WH_m.cast<double>();
  for (std::size_t b = 1; b < kBoneCount; ++b)
    if (!read_xyz(TableColumns::kPositions + 3 * (b - 1), row.p_WB_m[b])) return false;
  for (std::size_t t = 0; t < kTipCount; ++t)
    if (!read_xyz(TableColumns::kTips + 3 * t, row.p_WT_m[t])) return false;
  row.hips_height_m = std::nan("");
  const std::string_view height = cell(TableColumns::kHipsHeight);
  return height.empty() || parse_number(height, row.hips_height_m);
}

Skeleton CsvReader::skeleton_of(const Row& row) const {
  Skeleton skeleton = average_skeleton();
  if (!has_positions_) return skeleton;
  std::array<Quaterniond, kBoneCount> R_WB;
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    const Quaterniond R_PB = row.pose.R_PB[b].cast<double>().normalized();
    if (b == 0) {
      R_WB[b] = R_PB;
      continue;
    }
    const auto parent = static_cast<std::size_t>(kBones[b].parent);
    R_WB[b] = R_WB[parent] * R_PB;
    skeleton.offset_m[b] =
        (R_WB[parent].conjugate() * (row.p_WB_m[b] - row.p_WB_m[parent])).cast<float>();
  }
  for (std::size_t t = 0; t < kTipCount; ++t) {
    const std::size_t b = index_of(kTipBones[t]);
    skeleton.tip_m[t] = (R_WB[b].conjugate() * (row.p_WT_m[t] - row.p_WB_m[b])).cast<float>();
  }
  // The hips stand as high as the left leg is long.
  float height_m = -skeleton.tip(Tip::kLeftToes).y();
  for (const Bone bone :
       {Bone::kLeftUpperLeg, Bone::kLeftLowerLeg, Bone::kLeftFoot, Bone::kLeftToes})
    height_m -= skeleton.offset(bone).y();
  if (std::isfinite(row.hips_height_m)) height_m = static_cast<float>(row.hips_height_m);
  skeleton.offset_m[0] = {0.0f, height_m, 0.0f};
  return skeleton;
}

void CsvReader::tell(const Row& row, RecordingSink& sink) {
  auto guest = std::find_if(guests_.begin(), guests_.end(),
                            [&](const Guest& each) { return each.id == row.guest; });
  if (guest == guests_.end()) {
    if (guests_.size() >= kMostGuests) {
      ++counters_.beyond_guests;
      return;
    }
    guest = guests_.insert(guests_.end(), {row.guest, false, {}});
  }
  const Skeleton skeleton = skeleton_of(row);
  if (!is_valid(skeleton)) {
    ++counters_.invalid;
    return;
  }
  const float furthest_m = row.pose.p_WH_m.cwiseAbs().maxCoeff() + 2.0f;
  bool is_same = guest->has_skeleton;
  for (std::size_t b = 0; is_same && b < kBoneCount; ++b)
    is_same = is_same_bone(skeleton.offset_m[b], guest->skeleton.offset_m[b], furthest_m);
  for (std::size_t t = 0; is_same && t < kTipCount; ++t)
    is_same = is_same_bone(skeleton.tip_m[t], guest->skeleton.tip_m[t], furthest_m);
  if (!is_same) {
    guest->has_skeleton = true;
    guest->skeleton = skeleton;
    sink.on_skeleton(guest->id, skeleton, row.received_us);
  }
  sink.on_pose(guest->id, row.pose, row.received_us);
  ++counters_.poses;
}

Result<void> CsvReader::choose_times(const std::vector<std::string>& lines) {
  TableTimes times;
  for (const std::string& line : lines) {
    split(line);
    times.look(cell(3), cell(0), cell(1));
  }
  if (!times.is_received_rounded() && !times.is_capture_rounded()) return {};
  const bool is_received_usable = times.is_received_usable();
  if (!is_received_usable && !times.is_capture_usable())
    return fail(name_ + ": its times are rounded, as spreadsheets save them (" + times.example() +
                "): make the table again, or save heard_us and capture_us as numbers with all "
                "digits");
  times_ = is_received_usable ? Times::kReceivedOnly : Times::kCaptureOnly;
  note_ = std::string(is_received_usable ? "capture_us" : "heard_us") +
          " is rounded, as spreadsheets save it (" + times.example() +
          "): " + (is_received_usable ? "heard_us" : "capture_us") + " is used instead";
  return {};
}

// Rows are in the order of reception, which gives the offset between a second clock and the first.
void CsvReader::use_other_time(Row& row) {
  if (times_ == Times::kBoth) return;
  if (times_ == Times::kReceivedOnly) {
    row.pose.capture_time = MonoTime::from_us(row.received_us);
    return;
  }
  const std::int64_t capture_us = row.pose.capture_time.since_zero_us();
  auto clock = std::find_if(clocks_.begin(), clocks_.end(),
                            [&](const Clock& each) { return each.id == row.pose.clock_id; });
  if (clock == clocks_.end()) {
    const std::int64_t now_us = clocks_.empty() ? row.received_us : last_us_;
    if (clocks_.size() == kMostGuests) clocks_.pop_back();
    clock = clocks_.insert(clocks_.end(), {row.pose.clock_id, now_us - capture_us});
  }
  row.received_us = last_us_ = capture_us + clock->ahead_us;
}

void CsvReader::read_line(std::string_view line, RecordingSink& sink) {
  if (trimmed(line).empty()) return;
  ++counters_.rows;
  split(line);
  Row row;
  if (!read_row(row)) {
    ++counters_.malformed;
    return;
  }
  use_other_time(row);
  if (!is_recorded_time(row.received_us)) {
    ++counters_.malformed;
  } else if (!is_valid(row.pose)) {
    ++counters_.invalid;
  } else {
    normalize(row.pose);
    tell(row, sink);
  }
}

Result<void> CsvReader::read_into(RecordingSink& sink) {
  std::vector<std::string> first_lines;
  while (first_lines.size() < TableTimes::kRows) {
    const auto line = lines_.next();
    if (!line) break;
    first_lines.emplace_back(*line);
  }
  if (auto chosen = choose_times(first_lines); !chosen) return chosen;
  for (const std::string& line : first_lines) read_line(line, sink);
  while (const auto line = lines_.next()) read_line(*line, sink);
  if (auto ended = lines_.ended(); !ended) return ended;
  if (counters_.poses > 0) return {};
  if (counters_.rows > 0)
    return fail(name_ + ": none of its " + std::to_string(counters_.rows) +
                " rows is a pose; numbers need a decimal point, and commas stand between cells");
  return fail(name_ + ": has no rows; name a table in which somebody dances");
}

}  // namespace dance
