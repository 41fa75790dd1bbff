#include "viewer/feed/stage_feed.h"

#include <pthread.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/net/mono_clock.h"
#include "core/net/secure_random.h"

namespace dance {

namespace {

// The link publishes the room's song once a second.
constexpr Duration kRoomSong = Duration::ms(3500);

bool is_shown(const FeedOptions& options, Where where) {
  switch (options.shown) {
    case Shown::kBest:
      return where == Where::kStage || (where == Where::kCapture && !options.stage_only);
    case Shown::kCapture:
      return where == Where::kCapture;
    case Shown::kGuest:
      return where == Where::kGuest;
    case Shown::kStage:
      return where == Where::kStage;
  }
  return false;
}

// For views that compare, and not to be shown by itself.
bool is_compared(const FeedOptions& options, Where where) {
  return options.shown == Shown::kBest && where == Where::kGuest;
}

// The board hears poses of these places, and the instruments with it; of the others the instruments
// alone. Each pose is counted once.
bool is_for_board(const FeedOptions& options, Where where) {
  return is_shown(options, where) || is_compared(options, where);
}

}  // namespace

StageFeed::StageFeed(const FeedOptions& options)
    : board_(this_clock_id(), options.stage_only || options.shown == Shown::kStage),
      instruments_(this_clock_id()),
      step_scores_(this_clock_id()),
      begin_(mono_now()) {
  hidden_.clock_id = this_clock_id();
  hidden_.viewer = recording_.viewer = secure_random_u64() | 1;
  recording_.clock_id = this_clock_id();
}

Result<std::unique_ptr<StageFeed>> StageFeed::create(const FeedOptions& options) {
  std::unique_ptr<StageFeed> feed(new StageFeed(options));
  DANCE_TRY(feed->poller_, Poller::create());
  if (auto stops = feed->poller_->stop_on_signals(); !stops) return fail(stops.error().what);
  DANCE_TRY(feed->bus_, Bus::open(options.bus_url));
  feed->port_ = std::make_unique<HousePublisher>(*feed->bus_, feed->bus_->url(), *feed->poller_);
  feed->wake_fd_ = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (feed->wake_fd_ < 0) return fail(std::string("no eventfd: ") + std::strerror(errno));
  if (options.shown == Shown::kGuest) feed->board_.show_guest_channel();
  feed->subscribe(options);
  feed->measure(options);
  feed->hear_house();
  feed->count_steps();
  feed->thread_ = std::thread([raw = feed.get()] { raw->run(); });
  return feed;
}

StageFeed::~StageFeed() {
  if (thread_.joinable()) {
    asked_to_end_.store(true, std::memory_order_release);
    wake();
    thread_.join();
  }
  if (wake_fd_ >= 0) close(wake_fd_);
}

void StageFeed::subscribe(const FeedOptions& options) {
  for (const Where where : {Where::kCapture, Where::kGuest})
    bus_->subscribe<Face>(
        where,
        [this](const Channel& channel, const Face& face, MonoTime now) {
          board_.on_face(channel.guest(), face, now);
        },
        Delivery::kNewest);
  for (const Where where : {Where::kCapture, Where::kGuest, Where::kStage}) {
    if (!is_for_board(options, where)) continue;
    // Every pose is taken, so that rates and losses are right; the board's slots keep the newest.
    bus_->subscribe<Pose>(where, [this](const Channel& channel, const Pose& pose, MonoTime now) {
      board_.on_pose(channel.where(), channel.guest(), pose, now);
      instruments_.on_pose(channel.where(), channel.guest(), pose, now);
    });
    if (!is_shown(options, where)) continue;
    bus_->subscribe<Hands>(
        where,
        [this](const Channel& channel, const Hands& hands, MonoTime now) {
          board_.on_hands(channel.where(), channel.guest(), hands, now);
        },
        Delivery::kNewest);
    bus_->subscribe<TimedSkeleton>(
        where, [this](const Channel& channel, const TimedSkeleton& skeleton, MonoTime now) {
          board_.on_skeleton(channel.guest(), skeleton.skeleton, now);
          instruments_.on_skeleton(channel.guest(), skeleton.skeleton);
        });
  }
  // Choices, voices and lines of this house's guests are on capture channels; those of other houses
  // arrive through the tunnel.
  for (const Where where : {Where::kCapture, Where::kGuest}) {
    bus_->subscribe<Chat>(where, [this](const Channel& channel, const Chat& chat, MonoTime now) {
      board_.on_chat(channel.guest(), chat, now);
    });
    bus_->subscribe<Profile>(where,
                             [this](const Channel& channel, const Profile& profile, MonoTime now) {
                               board_.on_profile(channel.where(), channel.guest(), profile, now);
                             });
    bus_->subscribe<Voice>(
        where,
        [this](const Channel& channel, const Voice& voice, MonoTime now) {
          board_.on_voice(channel.guest(), voice, now);
        },
        Delivery::kNewest);
    bus_->subscribe<Avatar>(where,
                            [this](const Channel& channel, const Avatar& avatar, MonoTime now) {
                              board_.on_avatar(channel.guest(), avatar, now);
                            });
    bus_->subscribe<AvatarFile>(
        where, [this](const Channel& channel, const AvatarFile& file, MonoTime now) {
          board_.on_avatar(channel.guest(), file, now);
        });
  }
  bus_->subscribe<VoiceState>(
      Where::kCapture, [this](const Channel& channel, const VoiceState& state, MonoTime now) {
        board_.on_voice_state(channel.guest(), state, now);
      });
  bus_->subscribe<VoiceState>(
      Where::kGuest, [this](const Channel& channel, const VoiceState& state, MonoTime now) {
        board_.on_remote_voice_state(channel.guest(), state, now);
      });
  bus_->subscribe<Beat>(Where::kLocal, [this](const Channel&, const Beat& beat, MonoTime) {
    board_.on_beat(beat);
    instruments_.on_beat(beat);
  });
  bus_->subscribe<GuestStatus>(
      Where::kStage, [this](const Channel& channel, const GuestStatus& status, MonoTime now) {
        board_.on_status(channel.guest(), status, now);
        dance_.on_status(channel.guest(), status, now);
      });
}

// What is heard for the instruments alone.
void StageFeed::measure(const FeedOptions& options) {
  for (const Where where : {Where::kCapture, Where::kGuest, Where::kStage}) {
    if (is_for_board(options, where)) continue;
    bus_->subscribe<Pose>(where, [this](const Channel& channel, const Pose& pose, MonoTime now) {
      instruments_.on_pose(channel.where(), channel.guest(), pose, now);
    });
  }
  bus_->subscribe<GuestTraffic>(
      Where::kGuest, [this](const Channel& channel, const GuestTraffic& traffic, MonoTime now) {
        instruments_.on_traffic(channel.guest(), traffic);
        dance_.on_traffic(channel.guest(), now);
      });
  // Where nothing is swapped here, as in pictures for files, what another display of the house did.
  bus_->subscribe<StageTime>(Where::kView,
                             [this](const Channel& channel, const StageTime& shown, MonoTime) {
                               if (shown_count_ == 0) instruments_.on_shown(channel.guest(), shown);
                             });
  bus_->subscribe<FlowSetting>(
      Where::kStage, [this](const Channel& channel, const FlowSetting& setting, MonoTime) {
        instruments_.on_flow(channel.guest(), setting);
      });
  bus_->subscribe<Playout>(Where::kStage,
                           [this](const Channel& channel, const Playout& playout, MonoTime) {
                             instruments_.on_playout(channel.guest(), playout);
                           });
  static constexpr Duration kLook = Duration::ms(100);
  poller_->add_timer(mono_now() + kLook, [this](MonoTime now) {
    publish_figures(now);
    return now + kLook;
  });
}

// What the dance panel shows beside the dance.
void StageFeed::hear_house() {
  bus_->subscribe<VoiceLevel>(
      Where::kCapture, [this](const Channel& channel, const VoiceLevel& level, MonoTime now) {
        dance_.on_level(channel.guest(), level, now);
      });
  // A house alone has only its own music and song; in a room those are requests.
  bus_->subscribe<Music>(Where::kRoom, [this](const Channel&, const Music& music, MonoTime now) {
    room_music_at_ = now;
    dance_.on_music(music);
  });
  bus_->subscribe<Music>(Where::kCapture, [this](const Channel&, const Music& music, MonoTime now) {
    if (!room_music_at_.is_set() || now - room_music_at_ > kRoomSong) dance_.on_music(music);
  });
  bus_->subscribe<RoomSong>(Where::kRoom,
                            [this](const Channel&, const RoomSong& song, MonoTime now) {
                              room_song_at_ = now;
                              dance_.on_song(song);
                            });
  bus_->subscribe<RoomSong>(Where::kCapture,
                            [this](const Channel&, const RoomSong& song, MonoTime now) {
                              if (!room_song_at_.is_set() || now - room_song_at_ > kRoomSong)
                                dance_.on_song(song);
                            });
  bus_->subscribe<HouseLink>(Where::kLocal,
                             [this](const Channel&, const HouseLink& link, MonoTime now) {
                               if (link.clock_id == this_clock_id()) dance_.on_link(link, now);
                             });
}

// The steps of this house's dancers, whatever is shown of them.
void StageFeed::count_steps() {
  bus_->subscribe<Pose>(Where::kCapture,
                        [this](const Channel& channel, const Pose& pose, MonoTime now) {
                          step_scores_.on_pose(channel.guest(), pose, now);
                        });
  bus_->subscribe<TimedSkeleton>(
      Where::kCapture, [this](const Channel& channel, const TimedSkeleton& skeleton, MonoTime now) {
        step_scores_.on_skeleton(channel.guest(), skeleton.skeleton, now);
      });
  bus_->subscribe<Beat>(Where::kLocal, [this](const Channel&, const Beat& beat, MonoTime) {
    step_scores_.on_beat(beat);
  });
}

// What a panel asks for.
void StageFeed::publish_asked() {
  if (dance_.is_recording() != recording_.is_recording) {
    recording_.is_recording = dance_.is_recording();
    publish_recording(mono_now());
  }
  if (const DanceBoard::HiddenGuests* hidden = dance_.take_hidden()) {
    hidden_.hidden = *hidden;
    publish_hidden(mono_now());
  }
  while (const auto asked = dance_.take_asked())
    port_->publish(Channel::of_house(Signal::kRemoval),
                   Removal{mono_now(), this_clock_id(), asked->what, asked->guest});
  while (auto written = dance_.take_written()) {
    written->what.time = mono_now();
    written->what.clock_id = this_clock_id();
    port_->publish(Where::kCapture, written->guest, written->what);
  }
  while (const auto renamed = dance_.take_renamed())
    port_->publish(
        Where::kCapture, renamed->guest,
        Profile{mono_now(), this_clock_id(), renamed->what, recording_.is_recording, false});
  while (const auto asked = instruments_.take_asked_flow())
    port_->publish(Where::kCapture, asked->guest, asked->what);
  while (const auto asked = instruments_.take_asked_style())
    port_->publish(Where::kCapture, asked->guest, asked->what);
}

void StageFeed::publish_figures(MonoTime now) {
  publish_asked();  // where no picture shows anything new
  instruments_.end_seconds(now, [this](const GuestId& guest, const GuestStats& stats) {
    bus_->publish(Where::kView, guest, stats);
  });
  if (now - counted_ >= Duration::s(1)) publish_counters(now);
}

void StageFeed::publish_counters(MonoTime now) {
  counted_ = now;
  Stats stats;
  stats.time = now;
  stats.clock_id = this_clock_id();
  stats.uptime = now - begin_;
  stats.dropped_invalid = static_cast<std::int64_t>(bus_->counters().refused());
  stats.dropped_overflow = static_cast<std::int64_t>(board_.no_room());
  stats.received =
      static_cast<std::int64_t>(board_.poses()) + stats.dropped_invalid + stats.dropped_overflow;
  stats.forwarded = shown_count_;
  stats.superseded =
      std::max<std::int64_t>(0, static_cast<std::int64_t>(board_.poses()) - shown_count_);
  bus_->publish(Channel::of_program(Signal::kStats, "view"), stats);
  publish_hidden(now);
  if (recording_.is_recording) publish_recording(now);
}

void StageFeed::publish_recording(MonoTime now) {
  recording_.time = now;
  port_->publish(Channel::of_house(Signal::kRecording), recording_);
}

// Also where nobody is hidden here: poses go on coming, though another window hides the guest.
void StageFeed::publish_hidden(MonoTime now) {
  hidden_.time = now;
  port_->publish(Channel::of_house(Signal::kInterest), hidden_);
}

void StageFeed::run() {
  pthread_setname_np(pthread_self(), "view-bus");
  poller_->watch(bus_->fd(), [this](MonoTime now) { bus_->drain(now); });
  poller_->watch(wake_fd_, [this](MonoTime) { on_wake(); });
  poller_->run();
  over_.store(true, std::memory_order_release);
}

void StageFeed::wake() {
  const std::uint64_t one = 1;
  // Fails only when it is already awake 2^64 times over.
  [[maybe_unused]] const auto written = write(wake_fd_, &one, sizeof(one));
}

void StageFeed::on_wake() {
  std::uint64_t times = 0;
  [[maybe_unused]] const auto taken = read(wake_fd_, &times, sizeof(times));
  while (const auto shown = shown_.pop()) {
    bus_->publish(Channel::of(Signal::kStageTime, Where::kView, shown->guest), shown->time);
    instruments_.on_shown(shown->guest, shown->time);
    ++shown_count_;
  }
  publish_asked();
  if (asked_to_end_.load(std::memory_order_acquire)) poller_->stop();
}

}  // namespace dance
