#include "formats/recording/log_source.h"

#include <algorithm>

#include "core/bus/encode.h"

namespace dance {
namespace {

// In the order in which they are preferred.
constexpr std::array kPlaces{Where::kStage, Where::kCapture, Where::kGuest};

std::optional<std::size_t> place_of(Where where) {
  const auto* found = std::find(kPlaces.begin(), kPlaces.end(), where);
  if (found == kPlaces.end()) return std::nullopt;
  return static_cast<std::size_t>(found - kPlaces.begin());
}

template <class Message>
bool read(const LogEvent& event, Message& message) {
  return decode(event.data.data(), event.data.size(), message) == Decoded::kFine;
}

}  // namespace

LogSource::Guest* LogSource::guest_of(Where where, const GuestId& id) {
  std::vector<Guest>& list = guests_[*place_of(where)];
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const Guest& each) { return each.id == id; });
  if (found != list.end()) return &*found;
  if (list.size() >= kMostGuests) {
    ++counters_.beyond_guests;
    return nullptr;
  }
  list.push_back({id, false, {}, {}});
  return &list.back();
}

Result<LogSource> LogSource::open(const std::string& path, std::optional<Where> where) {
  DANCE_TRY(UnpackedLog log, UnpackedLog::open(path));
  return look_through(std::move(log), path, where);
}

Result<LogSource> LogSource::over(std::span<const std::uint8_t> bytes, std::optional<Where> where) {
  return look_through(UnpackedLog::over(bytes), "the log", where);
}

Result<LogSource> LogSource::look_through(UnpackedLog log, const std::string& name,
                                          std::optional<Where> where) {
  LogSource source(std::move(log));
  while (const auto event = source.log_.next()) {
    const auto channel = Channel::parse(event->channel);
    if (!channel || !place_of(channel->where())) continue;
    if (Pose pose; channel->signal() == Signal::kPose && read(*event, pose)) {
      if (Guest* guest = source.guest_of(channel->where(), channel->guest()))
        guest->has_pose = true;
    } else if (TimedSkeleton timed; channel->signal() == Signal::kSkeleton && read(*event, timed)) {
      Guest* guest = source.guest_of(channel->where(), channel->guest());
      if (guest && !guest->first_skeleton) guest->first_skeleton = timed.skeleton;
    }
  }
  if (auto ended = source.log_.ended(); !ended) return tl::make_unexpected(ended.error());
  for (const Where place : kPlaces) {
    if (where && place != *where) continue;
    source.where_ = place;
    if (!source.guests().empty()) return source;
  }
  return fail(name + ": holds no poses" +
              (where ? " on POSE/" + std::string(where_name(*where)) : std::string()) +
              "; name a log in which somebody dances");
}

std::vector<GuestId> LogSource::guests() const {
  std::vector<GuestId> ids;
  for (const Guest& guest : guests_[*place_of(where_)])
    if (guest.has_pose) ids.push_back(guest.id);
  return ids;
}

Result<void> LogSource::read_into(RecordingSink& sink) {
  log_.rewind();
  counters_ = {};
  for (Guest& guest : guests_[*place_of(where_)]) guest.told_skeleton.reset();
  while (const auto event = log_.next()) {
    const auto channel = Channel::parse(event->channel);
    if (!channel) continue;
    if (channel->signal() == Signal::kBeat || channel->where() == where_)
      tell(*channel, *event, sink);
  }
  return log_.ended();
}

void LogSource::tell(const Channel& channel, const LogEvent& event, RecordingSink& sink) {
  const std::int64_t time_us = event.time_us;
  const auto heard = [&](auto& message) {
    const bool is_fine = read(event, message);
    counters_.undecodable += !is_fine;
    return is_fine;
  };
  if (channel.signal() == Signal::kBeat) {
    if (Beat beat; heard(beat)) sink.on_beat(beat, time_us);
    return;
  }
  if (channel.signal() != Signal::kPose && channel.signal() != Signal::kHands &&
      channel.signal() != Signal::kSkeleton)
    return;
  Guest* guest = guest_of(where_, channel.guest());
  if (!guest || !guest->has_pose) return;
  const auto tell_skeleton = [&](const Skeleton& skeleton) {
    if (guest->told_skeleton == skeleton) return;
    guest->told_skeleton = skeleton;
    sink.on_skeleton(guest->id, skeleton, time_us);
  };
  if (!guest->told_skeleton && guest->first_skeleton) tell_skeleton(*guest->first_skeleton);
  if (channel.signal() == Signal::kSkeleton) {
    if (TimedSkeleton timed; heard(timed)) tell_skeleton(timed.skeleton);
  } else if (channel.signal() == Signal::kPose) {
    if (Pose pose; heard(pose)) sink.on_pose(guest->id, pose, time_us);
  } else {
    if (Hands hands; heard(hands)) sink.on_hands(guest->id, hands, time_us);
  }
}

}  // namespace dance
