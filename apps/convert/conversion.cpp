#include "apps/convert/conversion.h"

#include <algorithm>

#include "apps/convert/convert_sink.h"
#include "consumers/rate_limit.h"
#include "core/program/part_file.h"
#include "formats/recorded/recorded_file.h"

namespace dance {
namespace {

// Passes on what was chosen, and counts it.
class Chosen : public RecordingSink {
 public:
  Chosen(RecordingSink& to, const GuestId& guest, double hz)
      : to_(to), guest_(guest), pose_limit_(hz), hands_limit_(hz) {}

  void on_skeleton(const GuestId& guest, const Skeleton& skeleton, std::int64_t us) override {
    if (is_chosen(guest)) to_.on_skeleton(guest, skeleton, us);
  }
  void on_pose(const GuestId& guest, const Pose& pose, std::int64_t us) override {
    if (std::find(heard_.begin(), heard_.end(), guest) == heard_.end()) heard_.push_back(guest);
    if (!is_chosen(guest) || !pose_limit_.lets_through(guest, pose.capture_time)) return;
    first_us_ = count_ == 0 ? us : std::min(first_us_, us);
    last_us_ = count_ == 0 ? us : std::max(last_us_, us);
    ++count_;
    to_.on_pose(guest, pose, us);
  }
  void on_hands(const GuestId& guest, const Hands& hands, std::int64_t us) override {
    if (is_chosen(guest) && hands_limit_.lets_through(guest, hands.capture_time))
      to_.on_hands(guest, hands, us);
  }
  void on_beat(const Beat& beat, std::int64_t us) override { to_.on_beat(beat, us); }

  std::uint64_t count() const { return count_; }
  double seconds() const { return static_cast<double>(last_us_ - first_us_) * 1e-6; }
  std::uint64_t guests() const { return guest_.is_set() ? 1 : heard_.size(); }
  std::string names() const {
    std::string all;
    for (const GuestId& guest : heard_)
      all += (all.empty() ? "" : ", ") + std::string(guest.view());
    return all;
  }

 private:
  bool is_chosen(const GuestId& guest) const { return !guest_.is_set() || guest == guest_; }

  RecordingSink& to_;
  GuestId guest_;
  RateLimit pose_limit_;
  RateLimit hands_limit_;
  std::vector<GuestId> heard_;  // readers bound how many there are
  std::uint64_t count_ = 0;
  std::int64_t first_us_ = 0;
  std::int64_t last_us_ = 0;
};

}  // namespace

Result<Conversion> convert_recording(const ConversionOptions& options) {
  DANCE_TRY(const FileKind kind, output_kind(options.to));
  DANCE_TRY(const auto source,
            RecordedFile::open(options.from, {options.guest, options.where, options.retarget}));
  DANCE_TRY(const auto part, PartFile::create(options.to));
  DANCE_TRY(const auto sink,
            make_sink(kind, {part->path(), options.to, options.hz, source->where()}));
  // Clips are resampled, all else is thinned.
  const bool is_clip = kind == FileKind::kBvh || kind == FileKind::kGlb;
  Chosen chosen(*sink, options.guest, is_clip ? 0.0 : options.hz);
  if (auto read = source->read_into(chosen); !read) return tl::make_unexpected(read.error());
  if (chosen.count() == 0)
    return fail(options.from + ": nobody called " + std::string(options.guest.view()) +
                " dances in it; there are " + chosen.names());
  if (auto finished = sink->finish(); !finished) return tl::make_unexpected(finished.error());
  if (auto kept = part->keep(); !kept) return tl::make_unexpected(kept.error());
  Conversion conversion{sink->frames(),  chosen.guests(), chosen.seconds(),
                        source->notes(), source->lost(),  sink->left_out()};
  if (const std::string note = sink->note(); !note.empty()) conversion.notes.push_back(note);
  return conversion;
}

}  // namespace dance
