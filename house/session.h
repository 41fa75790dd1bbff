// HouseConfig: what a house is and does, read from its TOML file: who dances here, the server and
// room, the bus, routes, whom it wants to hear, hosted producers and consumers, music, further
// channels.
//
// Units/frames: rates in Hz.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      an error names file, line and column, the thing and the cure; a key that is not
//               known is an error too, as a misspelt one would be silently without effect.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "consumers/consumer_table.h"
#include "core/base/guest_id.h"
#include "core/base/result.h"
#include "core/base/text/shown_name.h"
#include "core/signal/style.h"
#include "haptics/haptic_table.h"
#include "house/avatar_choice.h"
#include "house/headset/hosted_headset.h"
#include "house/session_window.h"
#include "house/voice/hosted_voice.h"
#include "manager/route.h"
#include "producers/receive/receiver_table.h"
#include "tunnel/policy/channel_rule.h"
#include "tunnel/policy/hearing.h"
#include "tunnel/policy/interest.h"

namespace dance {

// A producer inside the manager's process: no bus hop before its poses are routed.
struct HostedProducer {
  enum class Kind { kSalsa, kReplay };
  Kind kind = Kind::kSalsa;
  GuestId guest;
  double rate_hz = 60.0;
  // salsa
  std::string role = "any";  // any: leads, or follows a dancer who leads there
  double tempo_bpm = 180.0;
  std::int64_t seed = 1;
  // replay
  std::string file;
  std::string dancer;  // of several in the file; "" = called as the guest, or the first
  double speed = 1.0;
};

// A dancer whom a camera sees: `dance capture`, started beside the house.
struct HostedCamera {
  GuestId guest;
  // Who dances before the same camera, from the left to the right behind the guest, who is the one
  // on the left; with the height of each in metres, 0 = not told.
  struct Partner {
    GuestId guest;
    double height_m = 0.0;
  };
  static constexpr std::size_t kMostPartners = 3;
  std::vector<Partner> partners;
  std::string device;       // as dance capture takes it; "" = the first camera
  std::string also;         // another camera of the same dancer; "" = none
  std::string model;        // lite, full or heavy; "" = as dance capture chooses
  std::string calibration;  // a file; "" = none
  double height_m = 0.0;    // of the dancer; 0 = not told
  bool mirror = false;
  bool hands = true;  // where their networks are
  bool face = false;
};

// A dancer who comes from another program or a device, inside the house's process.
struct HostedReceiver {
  std::string from;  // a name of producers/receive/receiver_table.h
  ReceiverOptions options;
};

// A consumer inside the house's process.
struct HostedConsumer {
  std::string to = "text";  // a name of consumers/consumer_table.h
  RouteEnd from;
  ConsumerOptions options;
};

// A device that a dancer of this house feels with.
struct HostedHaptics {
  std::string to = "evdev";  // a name of haptics/haptic_table.h
  GuestId guest;
  HapticOptions options;
  bool realtime = false;  // by a program of its own, which goes before others
};

// The music of the house, played beside it.
struct HostedMusic {
  static constexpr double kBandVolume = 0.6;
  std::string file;   // "" = the room's time only, or what the microphone hears
  std::string beats;  // "" = the .beats file beside it
  // Plays for the room as this guest; not set = for the house alone. A house that is alone
  // publishes the song's title under this name.
  GuestId guest;
  bool is_alone = false;  // in no room: a file may be stopped, slowed and changed
  bool follow = false;
  bool loop = false;
  bool silent = false;
  bool microphone = false;
  std::string band;  // style of the house band, which plays in the place of a file; "" = no band
  double volume = 1.0;
  double trim_ms = 0.0;
  double steps_bpm = 0.0;  // about how fast dancers step; 0 = as is heard
};

// How a guest of this house wants to be shown, from the start on; said on STYLE/capture.
struct HostedStyle {
  GuestId guest;
  Style style;
};

// How a guest of this house is drawn.
struct HostedAvatar {
  GuestId guest;
  AvatarChoice choice;
};

struct HouseConfig {
  std::vector<GuestId>
      guests;  // who dances in this house; may be empty (a house that only watches)
  std::map<GuestId, ShownName> shown_names;  // of guests whose shown name differs from the id
  std::string room = "dance";
  std::string server;  // host:port; "" = no tunnel
  // How the server knows this house; "" = by the key that `dance key` keeps.
  std::string key_file;
  std::string certificate;
  std::string private_key;
  std::string authorities;
  std::string bus;                     // LCM URL; "" = default
  std::vector<GuestId> bus_captures;   // whose captures are taken from the bus
  double quality_mm = 1.0;             // the largest error in a joint at the others'
  double pose_bytes_per_second = 0.0;  // of each guest, at most; 0 = whatever quality_mm takes
  double avatar_bytes_per_second = 131'072.0;  // of files of avatars, each way; 0 = none
  Interest interest;                           // whom it wants to hear, and how often
  Hearing hearing;                             // whose voices it wants
  bool view = true;                            // open the viewer (dance join)
  bool watch = false;  // its guests enter the room and do not dance: only_watch()
  std::vector<Route> routes;
  std::vector<HostedProducer> producers;
  std::vector<HostedReceiver> receivers;
  std::vector<HostedCamera> cameras;
  std::vector<HostedHeadset> headsets;
  std::vector<HostedConsumer> consumers;
  std::vector<HostedHaptics> haptics;
  std::vector<HostedAvatar> avatars;
  std::optional<HostedMusic> music;
  bool has_no_band = false;  // the house file names no music and excludes the band
  std::optional<HostedVoice> voice;
  std::vector<HostedStyle> styles;
  std::vector<ChannelRule> channels;  // that ride along, or are let in
  WindowChoices window;               // of dance lobby
  double practice_volume = 1.0;       // of what practise_to() plays: [music]'s, else [window]'s

  // Windows are not all that needs the other guests' records here: films and engines, what is felt,
  // and further channels, which come of no guest of whom no pose is wanted.
  bool needs_hidden_guests() const {
    return !consumers.empty() || !haptics.empty() || lets_any_in(channels);
  }
};

// `name` stands in errors. Relative file names in it are taken from the folder of `name`.
Result<HouseConfig> parse_session(std::string_view text, const std::string& name);
Result<HouseConfig> load_session(const std::string& path);

// The routes of a house without a session file: own dancers straight to the stage, remote
// ones predicted, carried over lapses, on the beat and in their style.
std::vector<Route> default_routes();

}  // namespace dance
