#include "formats/replay/replay_log.h"

#include <algorithm>
#include <limits>

#include "core/bus/encode.h"
#include "formats/recording/recorded_time.h"

namespace dance {
namespace {

// A packed channel that was silent for longer than this resumes with an intra frame.
constexpr std::int64_t kSilent_us = 10'000'000;
// Of a plain channel's poses before a jump's end so many are shown in full.
constexpr std::size_t kPlainShown = 2;
// What one jump keeps in memory, whatever the index says.
constexpr std::size_t kMostItems = 4'000'000;
constexpr std::size_t kMostItems_bytes = std::size_t{1} << 29;

// A pose as it would come out of its message, but for the body, which is a T-pose.
std::optional<Pose> glanced(const RawPose& raw) {
  Pose pose = raw.pose;
  pose.R_PB = identity_rotations();
  pose.presence &= kAllBones;
  if (!is_recorded_time(raw.capture_time_us)) return std::nullopt;
  pose.capture_time = MonoTime::from_us(raw.capture_time_us);
  for (std::size_t i = 0; i < kHopCount; ++i) {
    if (!is_recorded_time(raw.hop_time_us[i])) return std::nullopt;
    pose.hops[i] = MonoTime::from_us(raw.hop_time_us[i]);
  }
  return is_valid(pose) ? std::optional(pose) : std::nullopt;
}

}  // namespace

bool is_shown(const Channel& channel) {
  switch (channel.signal()) {
    case Signal::kPose:
      return channel.where() == Where::kCapture || channel.where() == Where::kGuest ||
             channel.where() == Where::kStage;
    case Signal::kHands:
    case Signal::kSkeleton:
      return channel.where() == Where::kCapture || channel.where() == Where::kStage;
    case Signal::kFace:
      return channel.where() == Where::kCapture || channel.where() == Where::kGuest;
    case Signal::kGuest:
    case Signal::kBeat:
    case Signal::kAvatar:
    case Signal::kAvatarFile:
    case Signal::kChat:
    case Signal::kProfile:
      return true;
    default:
      return false;
  }
}

Result<ReplayLog> ReplayLog::open(const std::string& path) {
  DANCE_TRY(LogReader reader, LogReader::open(path));
  return ReplayLog(std::move(reader));
}

ReplayLog ReplayLog::over(std::span<const std::uint8_t> bytes) {
  return ReplayLog(LogReader::over(bytes));
}

void ReplayLog::rewind() {
  reader_.rewind();
  lines_.clear();
}

// nullptr of channels that are not ours.
ReplayLog::Line* ReplayLog::line_of(std::string_view name) {
  const auto found = lines_.find(name);
  if (found != lines_.end()) return found->second.get();
  const auto channel = Channel::parse(name);
  if (!channel || lines_.size() >= kMostChannels) return nullptr;
  return lines_.emplace(name, std::make_unique<Line>(*channel)).first->second.get();
}

bool ReplayLog::tell_glance(Line& line, const PackedMotion& motion, std::int64_t time_us,
                            ReplaySink& sink) {
  if (!motion.is_pose) {
    sink.on_glance(line.channel, nullptr, time_us);
    return true;
  }
  RawPose raw;
  if (line.glance.look(motion.is_key, motion.packed, raw) != DecodeResult::kPose) return false;
  const auto pose = glanced(raw);
  if (pose) sink.on_glance(line.channel, &*pose, time_us);
  return pose.has_value();
}

bool ReplayLog::look(ReplaySink& sink) {
  while (const auto event = reader_.next()) {
    const auto motion = packed_motion_of(*event);
    Line* line = line_of(motion ? motion->channel : event->channel);
    if (line == nullptr || !line->shown) continue;
    line->heard_us = event->time_us;
    if (!motion) {
      if (is_packed(*event)) continue;
      sink.on_message(line->channel, event->data, event->time_us, true);
      return true;
    }
    line->is_packed = true;
    if (motion->is_key) line->key_at_bytes = reader_.event_at_bytes();
    if (motion->is_pose == (line->channel.signal() == Signal::kPose) &&
        tell_glance(*line, *motion, event->time_us, sink))
      return true;
    ++damaged_;
  }
  return false;
}

std::uint64_t ReplayLog::needed_from_bytes(std::int64_t now_us) const {
  std::uint64_t from = reader_.next_at_bytes();
  for (const auto& [name, line] : lines_)
    if (line->is_packed && now_us - line->heard_us < kSilent_us)
      from = std::min(from, line->key_at_bytes);
  return from;
}

// The plain message; empty where it cannot be restored.
std::span<const std::uint8_t> ReplayLog::unpack(Line& line, bool is_key, std::uint32_t checksum,
                                                std::span<const std::uint8_t> packed) {
  const MotionType type =
      line.channel.signal() == Signal::kPose ? MotionType::kPose : MotionType::kHands;
  if (!line.unpacker) line.unpacker = std::make_unique<MotionUnpacker>(type);
  RawMotion motion;
  const DecodeResult result = line.unpacker->unpack(is_key, packed, motion);
  if (result == DecodeResult::kReferenceMissing) return {};
  if (result == DecodeResult::kPose) {
    const std::span<const std::uint8_t> message{line.message.data(), encode(motion, line.message)};
    if (checksum_of(line.channel.view(), message) == checksum) return message;
  }
  line.unpacker->restart();
  return {};
}

bool ReplayLog::step(std::int64_t until_us, ReplaySink& sink) {
  while (const auto event = reader_.next()) {
    if (event->time_us > until_us) {
      reader_.again();
      return false;
    }
    const auto motion = packed_motion_of(*event);
    Line* line = line_of(motion ? motion->channel : event->channel);
    if (line == nullptr) continue;
    if (!motion) {
      if (is_packed(*event)) continue;
      sink.on_message(line->channel, event->data, event->time_us, false);
      return true;
    }
    const auto message = motion->is_pose == (line->channel.signal() == Signal::kPose)
                             ? unpack(*line, motion->is_key, motion->checksum, motion->packed)
                             : std::span<const std::uint8_t>();
    if (!message.empty()) {
      sink.on_message(line->channel, message, event->time_us, false);
      return true;
    }
    ++damaged_;
  }
  return false;
}

void ReplayLog::read_items(std::uint64_t at_bytes, std::int64_t until_us) {
  items_.clear();
  bytes_.clear();
  while (const auto event = reader_.next()) {
    const bool is_before = reader_.event_at_bytes() < at_bytes;
    if (!is_before && event->time_us > until_us) {
      reader_.again();
      return;
    }
    if (items_.size() >= kMostItems || bytes_.size() >= kMostItems_bytes) return;
    const auto motion = packed_motion_of(*event);
    if (is_before && !motion) continue;
    Line* line = line_of(motion ? motion->channel : event->channel);
    if (line == nullptr || !line->shown || (!motion && is_packed(*event))) continue;
    if (motion && motion->is_pose != (line->channel.signal() == Signal::kPose)) continue;
    const auto data = motion ? motion->packed : event->data;
    items_.push_back({line, event->time_us, bytes_.size(), data.size(),
                      motion ? motion->checksum : 0, motion.has_value(), motion && motion->is_key,
                      is_before, std::nullopt});
    bytes_.insert(bytes_.end(), data.begin(), data.end());
  }
}

// The item of a chain from which on its messages are wanted whole: of poses the last; of hands also
// those that the guest's last pose was shown with.
std::size_t ReplayLog::target_of(const Chain& chain) const {
  const std::size_t last = chain.items.back();
  const Channel& channel = chain.line->channel;
  if (channel.signal() == Signal::kPose) return last;
  std::size_t last_pose = items_.size();
  for (std::size_t i = items_.size(); i-- > 0 && last_pose == items_.size();) {
    const Channel& other = items_[i].line->channel;
    if (other.signal() == Signal::kPose && other.guest() == channel.guest()) last_pose = i;
  }
  const auto after = std::lower_bound(chain.items.begin(), chain.items.end(), last_pose);
  return after == chain.items.begin() ? chain.items.front() : *(after - 1);
}

void ReplayLog::unpack_chain(Chain& chain, std::size_t target) {
  auto at = std::upper_bound(chain.items.begin(), chain.items.end(), target);
  while (at != chain.items.begin() && !items_[*(at - 1)].is_key) --at;
  if (at != chain.items.begin()) --at;
  for (; at != chain.items.end(); ++at) {
    Item& item = items_[*at];
    const auto message = unpack(*chain.line, item.is_key, item.checksum,
                                std::span(bytes_).subspan(item.at, item.size));
    if (message.empty()) continue;
    item.whole = chain.unpacked.size();
    chain.unpacked.emplace_back(message.begin(), message.end());
  }
}

void ReplayLog::jump(std::uint64_t from_bytes, std::uint64_t at_bytes, std::int64_t until_us,
                     ReplaySink& sink, const ForEach& for_each) {
  for (auto& [name, line] : lines_) {
    line->glance = MotionGlance();
    if (line->unpacker) line->unpacker->restart();
  }
  reader_.seek(from_bytes);
  read_items(at_bytes, until_us);

  std::vector<Chain> chains;
  std::map<const Line*, std::size_t> chain_of;
  std::map<const Line*, std::size_t> plain_left;
  for (std::size_t i = 0; i < items_.size(); ++i) {
    if (!items_[i].is_packed) {
      ++plain_left[items_[i].line];
      continue;
    }
    const auto [found, is_new] = chain_of.emplace(items_[i].line, chains.size());
    if (is_new) chains.push_back({items_[i].line, {}, {}});
    chains[found->second].items.push_back(i);
  }
  std::vector<std::size_t> targets;
  for (const Chain& chain : chains) targets.push_back(target_of(chain));
  for_each(chains.size(), [&](std::size_t i) { unpack_chain(chains[i], targets[i]); });

  for (Item& item : items_) {
    const auto data = std::span<const std::uint8_t>(bytes_).subspan(item.at, item.size);
    Line& line = *item.line;
    if (!item.is_packed) {
      const std::size_t left = --plain_left[&line];
      const bool is_pose = line.channel.signal() == Signal::kPose;
      sink.on_message(line.channel, data, item.time_us, is_pose && left >= kPlainShown);
      continue;
    }
    const PackedMotion motion{line.channel.signal() == Signal::kPose, item.is_key,
                              line.channel.view(), item.checksum, data};
    // The glance follows the whole channel, as what it reads are differences.
    RawPose raw;
    std::optional<Pose> pose;
    if (motion.is_pose && !item.whole &&
        line.glance.look(item.is_key, data, raw) == DecodeResult::kPose)
      pose = glanced(raw);
    if (item.is_before) continue;
    if (item.whole)
      sink.on_message(line.channel, chains[chain_of[&line]].unpacked[*item.whole], item.time_us,
                      false);
    else if (!motion.is_pose || pose)
      sink.on_glance(line.channel, pose ? &*pose : nullptr, item.time_us);
  }
}

}  // namespace dance
