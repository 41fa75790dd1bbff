#include "haptics/osc/osc_haptics.h"

#include <pthread.h>

#include <chrono>

#include "core/base/deadline.h"
#include "core/base/fixed_string.h"

namespace dance {
namespace {

using OscName = FixedString<63>;

OscName joined(std::string_view front, std::string_view bone) {
  std::array<char, 63> text{};
  std::size_t size = 0;
  for (const std::string_view part : {front, bone})
    for (const char c : part)
      if (size < text.size()) text[size++] = c;
  OscName name;
  [[maybe_unused]] const bool fits = name.assign({text.data(), size});
  return name;
}

}  // namespace

Result<std::unique_ptr<HapticOutput>> OscHaptics::open(const std::string& address) {
  DANCE_TRY(OscOutput output, OscOutput::open(address, kUsualAddress));
  std::unique_ptr<OscHaptics> haptics(new OscHaptics(address));
  haptics->way_ = std::make_unique<Way>(std::move(output));
  return std::unique_ptr<HapticOutput>(std::move(haptics));
}

std::unique_ptr<HapticOutput> OscHaptics::later(const std::string& address) {
  std::unique_ptr<OscHaptics> haptics(new OscHaptics(address));
  haptics->search_ = std::thread([raw = haptics.get()] { raw->search(); });
  return haptics;
}

OscHaptics::~OscHaptics() {
  {
    const std::lock_guard lock(mutex_);
    ends_search_ = true;
  }
  ended_.notify_one();
  if (search_.joinable()) search_.join();
}

void OscHaptics::search() {
  pthread_setname_np(pthread_self(), "haptics-osc");
  for (;;) {
    if (auto output = OscOutput::open(address_, kUsualAddress)) {
      found_way_ = std::make_unique<Way>(std::move(*output));
      found_ = true;
      return;
    }
    std::unique_lock lock(mutex_);
    if (ended_.wait_for(lock, std::chrono::nanoseconds(kLooks.count_ns()),
                        [this] { return ends_search_; }))
      return;
  }
}

void OscHaptics::send_level(std::size_t bone, float level) {
  way_->writer.add(joined("/avatar/parameters/dance_", kBones[bone].name).c_str(), {level});
}

bool OscHaptics::play(const Haptic& haptic, MonoTime now) {
  if (!way_) return false;
  const std::size_t bone = index_of(haptic.bone);
  way_->writer.add(
      joined("/dance/haptic/", kBones[bone].name).c_str(),
      {haptic.amplitude, static_cast<float>(haptic.duration.as_seconds()), haptic.frequency_hz});
  send_level(bone, haptic.amplitude);
  way_->writer.flush();
  const MonoTime end = now + haptic.duration;
  if (end > ends_[bone]) ends_[bone] = end;
  return true;
}

MonoTime OscHaptics::work(MonoTime now) {
  if (!way_ && found_) {
    search_.join();
    way_ = std::move(found_way_);
  }
  if (!way_) return {};
  MonoTime next;
  bool has_ended = false;
  for (std::size_t bone = 0; bone < kBoneCount; ++bone) {
    MonoTime& end = ends_[bone];
    if (!end.is_set()) continue;
    if (end > now) {
      next = earlier(next, end);
      continue;
    }
    end = MonoTime();
    send_level(bone, 0.0f);
    has_ended = true;
  }
  if (has_ended) way_->writer.flush();
  return next;
}

void OscHaptics::stop() {
  if (!way_) return;
  for (std::size_t bone = 0; bone < kBoneCount; ++bone)
    if (ends_[bone].is_set()) send_level(bone, 0.0f);
  ends_ = {};
  way_->writer.flush();
}

std::string OscHaptics::name() const {
  return "osc to " + (address_.empty() ? kUsualAddress : address_);
}

std::string OscHaptics::summary() const {
  return way_ ? way_->output.summary() : name() + ", not found yet";
}

}  // namespace dance
