#include "viewer/program/view_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace dance {
namespace {
constexpr double kUsualSeconds = 3.0;
constexpr double kPastTheEnd_s = 0.5;  // a moment at the end may have been rounded
constexpr double kLongest_s = 24.0 * 3600.0;
constexpr std::size_t kMostPictures = 10'000;
constexpr int kSmallest_px = 64;
constexpr int kLargest_px = 8192;
}  // namespace

Result<std::vector<double>> plan_moments(const MomentWish& wish, double recorded_s) {
  std::vector<double> moments = wish.at_s;
  if (!moments.empty() && wish.every_s > 0.0)
    return fail("--at and --every are two ways to say the same; give one of them");
  const bool is_one = moments.empty() && wish.every_s <= 0.0 && wish.strip <= 0;
  double seconds = wish.seconds;
  if (seconds <= 0.0) {
    seconds = kUsualSeconds;
    if (recorded_s > 0.0) seconds = is_one ? std::min(seconds, recorded_s) : recorded_s;
  }
  if (wish.film && (!moments.empty() || wish.every_s > 0.0 || wish.strip > 0))
    return fail("--film takes all pictures; leave out --at, --every and --strip");
  if (wish.film) return std::vector<double>{wish.seconds > 0.0 ? wish.seconds : kLongest_s};
  if (moments.empty() && wish.every_s > 0.0) {
    if (seconds / wish.every_s > static_cast<double>(kMostPictures))
      return fail("--every asks for more than 10000 pictures; give a longer time between them");
    for (int k = 1; wish.every_s * k <= seconds + 1e-9; ++k) moments.push_back(wish.every_s * k);
  }
  if (moments.empty() && wish.strip > 0)
    for (int k = 1; k <= wish.strip; ++k) moments.push_back(seconds * k / wish.strip);
  if (moments.empty()) moments.push_back(seconds);
  for (const double moment : moments)
    if (!std::isfinite(moment) || moment < 0.0 || moment > kLongest_s)
      return fail("a moment of --at is not between 0 and 86400 seconds");
  for (const double moment : wish.at_s)
    if (recorded_s > 0.0 && moment > recorded_s + kPastTheEnd_s)
      return fail(fmt::format("--at {:g}: the recording is {:.1f} s long", moment, recorded_s));
  std::sort(moments.begin(), moments.end());
  return moments;
}

Result<void> check_shown(const ViewOptions& options) {
  if (options.log.empty() || options.feed.shown == Shown::kBest) return {};
  return fail(
      "--show is for a live house; of a log leave it out, or say --stage-only (own guests from the "
      "stage too) or --view compare (as it came beside as it was staged)");
}

Result<void> check_teacher(const ViewOptions& options) {
  const TeacherOptions& teacher = options.teacher;
  if (teacher.file.empty() && (teacher.dancer.is_set() || teacher.choices != TeacherChoices()))
    return fail("--teacher-speed, --teacher-mirrored and --teacher-dancer need --teacher FILE");
  if (!teacher.file.empty() && !options.log.empty())
    return fail("--teacher is for a live house; leave out the log");
  if (!teacher.file.empty() && options.headless)
    return fail("--teacher is for a window; leave out --headless");
  return {};
}

Venue place_to_draw(const ViewOptions& options) {
  const bool is_for_people = !options.headless || !options.export_to.empty();
  return options.place.value_or(is_for_people ? Venue::kStudio : Venue::kPlain);
}

Result<ViewPictureSize> parse_size(const std::string& text) {
  ViewPictureSize size;
  const char* end = text.data() + text.size();
  const auto [after_width, width_error] = std::from_chars(text.data(), end, size.width_px);
  if (width_error == std::errc() && after_width != end && *after_width == 'x') {
    const auto [after, error] = std::from_chars(after_width + 1, end, size.height_px);
    const bool is_sane = std::min(size.width_px, size.height_px) >= kSmallest_px &&
                         std::max(size.width_px, size.height_px) <= kLargest_px;
    if (error == std::errc() && after == end && is_sane) return size;
  }
  return fail("--size " + text + ": write it as 1280x720, each side from 64 to 8192");
}

}  // namespace dance
