#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/text/cut_text.h"
#include "formats/bvh/bvh.h"
#include "formats/bvh/bvh_tokens.h"

namespace dance {
namespace {

// Bound of valid places and angles.
constexpr double kLargestNumber = 1e7;
constexpr double kSlowestFrame_s = 10.0;
constexpr double kFastest_hz = 10'000.0;

struct ChannelName {
  std::string_view name;
  BvhChannel channel;
};
constexpr ChannelName kChannelNames[] = {
    {"Xposition", BvhChannel::kXPosition}, {"Yposition", BvhChannel::kYPosition},
    {"Zposition", BvhChannel::kZPosition}, {"Xrotation", BvhChannel::kXRotation},
    {"Yrotation", BvhChannel::kYRotation}, {"Zrotation", BvhChannel::kZRotation},
    {"Xscale", BvhChannel::kScale},        {"Yscale", BvhChannel::kScale},
    {"Zscale", BvhChannel::kScale},
};

class Reader {
 public:
  Reader(std::string_view text, const BvhLimits& limits) : tokens_(text), limits_(limits) {}

  Result<Bvh> read() {
    if (auto ok = read_hierarchy(); !ok) return tl::make_unexpected(ok.error());
    if (auto ok = read_motion_header(); !ok) return tl::make_unexpected(ok.error());
    if (auto ok = read_frames(); !ok) return tl::make_unexpected(ok.error());
    return std::move(bvh_);
  }

 private:
  using Ok = Result<bool>;

  tl::unexpected<Error> fail_here(const std::string& what) const {
    return fail("line " + std::to_string(tokens_.line()) + ": " + what);
  }
  tl::unexpected<Error> fail_at(std::string_view word, const std::string& what) const {
    if (word.empty()) return fail_here("the file ends too early; it was cut short");
    return fail_here(quoted(word) + " " + what);
  }

  Ok read_hierarchy() {
    std::string_view word = tokens_.next();
    if (!equals_ignoring_case(word, "HIERARCHY"))
      return fail_at(word, "stands where HIERARCHY should: this is not a BVH file");
    word = tokens_.next();
    if (!equals_ignoring_case(word, "ROOT"))
      return fail_at(word, "stands where ROOT should begin the skeleton");
    if (auto ok = open_joint(); !ok) return ok;
    while (!open_.empty())
      if (auto ok = read_statement(); !ok) return ok;
    return true;
  }

  // One line inside a joint's braces.
  Ok read_statement() {
    const std::string_view word = tokens_.next();
    if (equals_ignoring_case(word, "OFFSET")) return read_offset();
    if (equals_ignoring_case(word, "CHANNELS")) return read_channels();
    if (equals_ignoring_case(word, "JOINT") && !in_end_site_) return open_joint();
    if (equals_ignoring_case(word, "End") && !in_end_site_) return open_end_site();
    if (word == "}") {
      if (in_end_site_)
        in_end_site_ = false;
      else
        open_.pop_back();
      return true;
    }
    return fail_at(word, "stands where OFFSET, CHANNELS, JOINT, End Site or } should");
  }

  Ok open_brace(std::string_view of) {
    const std::string_view word = tokens_.next();
    if (word == "{") return true;
    return fail_at(word, "stands where the { of " + quoted(of) + " should");
  }

  Ok open_joint() {
    BvhJoint joint;
    joint.name = std::string(cut_text(tokens_.rest_of_line(), 200));
    if (joint.name.empty()) return fail_here("a joint without a name; write one after JOINT");
    if (bvh_.joints.size() >= limits_.joints)
      return fail_here("more than " + std::to_string(limits_.joints) +
                       " joints; leave out what is not the dancer");
    if (open_.size() >= limits_.depth)
      return fail_here("joints nested deeper than " + std::to_string(limits_.depth) +
                       "; is a } missing?");
    joint.parent = open_.empty() ? -1 : open_.back();
    open_.push_back(static_cast<int>(bvh_.joints.size()));
    bvh_.joints.push_back(std::move(joint));
    return open_brace(bvh_.joints.back().name);
  }

  Ok open_end_site() {
    tokens_.rest_of_line();  // "Site", or whatever a tool calls it
    in_end_site_ = true;
    return open_brace("End Site");
  }

  Ok read_offset() {
    Eigen::Vector3d offset;
    for (int axis = 0; axis < 3; ++axis) {
      auto number = read_number("in an OFFSET");
      if (!number) return tl::make_unexpected(number.error());
      offset[axis] = *number;
    }
    BvhJoint& joint = bvh_.joints[static_cast<std::size_t>(open_.back())];
    if (!in_end_site_)
      joint.offset = offset;
    else if (!joint.end_site)
      joint.end_site = offset;
    return true;
  }

  Ok read_channels() {
    const std::string_view count_word = tokens_.next();
    const auto count = to_whole_number(count_word);
    if (!count || *count < 0 || *count > static_cast<long long>(kMaxBvhChannelsPerJoint))
      return fail_at(count_word, "is no count of channels; it should be 0 to 9, mostly 3 or 6");
    BvhJoint& joint = bvh_.joints[static_cast<std::size_t>(open_.back())];
    if (in_end_site_ && *count > 0)
      return fail_here("an End Site has no channels; make it a JOINT");
    if (in_end_site_) return true;
    if (joint.channel_count > 0)
      return fail_here("a second CHANNELS of joint " + quoted(joint.name) + "; leave one");
    joint.first_channel = bvh_.channel_count;
    for (long long i = 0; i < *count; ++i) {
      const std::string_view word = tokens_.next();
      const ChannelName* found = nullptr;
      for (const ChannelName& known : kChannelNames)
        if (equals_ignoring_case(word, known.name)) found = &known;
      if (!found)
        return fail_at(word,
                       "is no channel; use Xposition to Zposition and Xrotation to Zrotation");
      joint.channels[joint.channel_count++] = found->channel;
    }
    bvh_.channel_count += joint.channel_count;
    return true;
  }

  Result<double> read_number(const char* where) {
    const std::string_view word = tokens_.next();
    const auto number = to_number(word);
    if (!number) {
      const bool comma = word.find(',') != word.npos;
      return fail_at(word, std::string("is no number ") + where +
                               (comma ? "; write decimals with a point" : ""));
    }
    if (!std::isfinite(*number) || std::abs(*number) > kLargestNumber)
      return fail_at(
          word, std::string("is out of range ") + where + "; a broken capture? export it again");
    return *number;
  }

  // The value of a label, which may be "Frames:", "Frames :" or "Frames:12".
  Result<std::string_view> read_labelled(std::string_view label) {
    std::string_view word = tokens_.next();
    if (!equals_ignoring_case(word.substr(0, label.size()), label))
      return fail_at(word, "stands where " + std::string(label) + ": should");
    word.remove_prefix(label.size());
    if (word.empty()) word = tokens_.next();
    if (!word.empty() && word[0] == ':') word.remove_prefix(1);
    if (word.empty()) word = tokens_.next();
    return word;
  }

  Ok read_motion_header() {
    std::string_view word = tokens_.next();
    if (equals_ignoring_case(word, "ROOT"))
      return fail_here("a second ROOT; one file holds one dancer, so split it");
    if (!equals_ignoring_case(word, "MOTION"))
      return fail_at(word, "stands where MOTION should; is a { or } too many or missing?");
    auto frames_word = read_labelled("Frames");
    if (!frames_word) return tl::make_unexpected(frames_word.error());
    const auto frames = to_whole_number(*frames_word);
    if (!frames || *frames < 0)
      return fail_at(*frames_word, "is no count of frames; it should be a whole number from 0");
    if (*frames > static_cast<long long>(limits_.frames))
      return fail_at(*frames_word, "frames are too many; at most " +
                                       std::to_string(limits_.frames) + " fit, so cut the file");
    bvh_.frame_count = static_cast<std::size_t>(*frames);
    if (bvh_.frame_count * bvh_.channel_count > limits_.values)
      return fail_at(*frames_word, "frames of " + std::to_string(bvh_.channel_count) +
                                       " numbers are too much to hold; cut the file");
    if (equals_ignoring_case(tokens_.peek(), "Frame")) tokens_.next();
    const bool joined = equals_ignoring_case(tokens_.peek().substr(0, 9), "FrameTime");
    auto time_word = read_labelled(joined ? "FrameTime" : "Time");
    if (!time_word) return tl::make_unexpected(time_word.error());
    return read_rate(*time_word);
  }

  Ok read_rate(std::string_view word) {
    const auto time_s = to_number(word);
    if (!time_s || !std::isfinite(*time_s) || *time_s <= 0.0)
      return fail_at(word, "is no Frame Time; write seconds a frame, 0.0333333 for 30 Hz");
    double hz = 1.0 / *time_s;
    const bool is_rate = *time_s > kSlowestFrame_s && *time_s <= 1000.0;
    if (is_rate) {
      hz = *time_s;
      bvh_.notes.push_back("Frame Time " + quoted(word) + " read as frames a second");
    }
    if (!is_rate && *time_s > kSlowestFrame_s)
      return fail_at(word, "is no Frame Time; write seconds a frame, 0.0333333 for 30 Hz");
    if (hz > kFastest_hz)
      return fail_at(word, "is too short a Frame Time; write seconds a frame, 0.0333333 for 30 Hz");
    // Files round 1/120 to .0083333.
    const double whole = std::round(hz);
    if (std::abs(hz - whole) < 5e-5 * hz) hz = whole;
    bvh_.frame_hz = hz;
    return true;
  }

  Ok read_frames() {
    const std::size_t wanted = bvh_.frame_count * bvh_.channel_count;
    // A number and the blank behind it take two bytes: a count that the text cannot fill reserves
    // no memory.
    bvh_.values.reserve(std::min(wanted, tokens_.remaining() / 2 + 1));
    std::size_t odd_line = 0;  // the first line that did not hold exactly one frame
    std::size_t line = 0;
    while (bvh_.values.size() < wanted) {
      if (is_cut_here(wanted)) return keep_whole_frames(odd_line);
      auto number = read_number("of a frame");
      if (!number) return tl::make_unexpected(number.error());
      const bool new_line = tokens_.line() != line;
      const bool new_frame = bvh_.values.size() % bvh_.channel_count == 0;
      if (new_line != new_frame && odd_line == 0 && line != 0)
        odd_line = new_line ? line : tokens_.line();
      line = tokens_.line();
      bvh_.values.push_back(static_cast<float>(*number));
    }
    if (!tokens_.peek().empty() && odd_line != 0) return fail_odd(odd_line);
    note_what_follows();
    return true;
  }

  // The text ends before the last number is whole: a number that it ends with may itself be cut.
  bool is_cut_here(std::size_t wanted) const {
    BvhTokens ahead = tokens_;
    const std::string_view word = ahead.next();
    const bool is_last_wanted = bvh_.values.size() + 1 == wanted;
    return word.empty() ||
           (ahead.remaining() == 0 && (!is_last_wanted || !to_number(word).has_value()));
  }

  void note_what_follows() {
    std::string_view word = tokens_.next();
    if (word.empty()) return;
    const std::string line = "line " + std::to_string(tokens_.line()) + ": ";
    std::size_t numbers = 0;
    for (; to_number(word); word = tokens_.next()) ++numbers;
    const std::size_t frames = bvh_.channel_count > 0 ? numbers / bvh_.channel_count : 0;
    if (frames > 0)
      bvh_.lost = line + std::to_string(frames) +
                  " frames beyond 'Frames: " + std::to_string(bvh_.frame_count) + "'";
    else
      bvh_.notes.push_back(line + "what follows frame " + std::to_string(bvh_.frame_count) +
                           " is left out");
  }

  tl::unexpected<Error> fail_odd(std::size_t line) const {
    return fail("line " + std::to_string(line) + ": not " + std::to_string(bvh_.channel_count) +
                " numbers in this frame's line, one for each channel; the line is damaged");
  }
  // Keeps what a file that was cut short still holds.
  Ok keep_whole_frames(std::size_t odd_line) {
    if (odd_line != 0) return fail_odd(odd_line);
    while (!tokens_.next().empty()) {
    }
    const std::size_t whole = bvh_.values.size() / bvh_.channel_count;
    const std::string what = "the file ends in frame " + std::to_string(whole + 1) + " of " +
                             std::to_string(bvh_.frame_count) + "; it was cut short";
    if (whole == 0) return fail_here(what);
    bvh_.lost = "line " + std::to_string(tokens_.line()) + ": " + what;
    bvh_.values.resize(whole * bvh_.channel_count);
    bvh_.frame_count = whole;
    return true;
  }

  BvhTokens tokens_;
  BvhLimits limits_;
  Bvh bvh_;
  std::vector<int> open_;  // joints not closed yet
  bool in_end_site_ = false;
};

}  // namespace

Result<Bvh> read_bvh(std::string_view text, const BvhLimits& limits) {
  return Reader(text, limits).read();
}

}  // namespace dance
