// LobbyModel: all that the window before the dance shows, and what a person has asked for in it.
// Screens (lobby/screen/lobby_screens.h) draw it and change the settings; lobby/run/ fills in what
// is known of machine, rooms and server, and does what is asked for.
//
// Units/frames: none.
// Ownership:    plain values.
// Threads:      the drawing thread.
// Failure:      none: what goes wrong is a banner.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/time.h"
#include "lobby/screen/file_chooser.h"
#include "lobby/settings/lobby_settings.h"
#include "viewer/words/texts.h"

namespace dance {

enum class LobbyScreen { kYou, kDance, kHost };

// What is asked for; done by lobby/run.
enum class LobbyWish {
  kNone,
  kJoin,      // the settings' server and room
  kAlone,     // with a partner
  kPractise,  // with music and a mirror
  kCancel,    // while going in
  kOpenRoom,  // a server here
  kCloseRoom,
  kInvite,    // host.guest to host.room
  kWithdraw,  // host.withdrawn
  kListInvited,
  kOpenInvitation,  // invitation_typed
  kPlayCountIn,
  kAskRooms,   // their round trips anew
  kLookAgain,  // for cameras and addresses
  kQuit,
};

// A trouble, or news, in words; below it what the program itself said.
struct LobbyBanner {
  enum class Kind { kGood, kTrouble };
  Kind kind = Kind::kTrouble;
  Text text = Text::kCount;
  std::vector<std::string> values;
  std::string detail;                 // "" = none
  Text button = Text::kCount;         // kCount = none
  LobbyWish wish = LobbyWish::kNone;  // of the button
  bool operator==(const LobbyBanner&) const = default;
};

struct CameraFact {
  std::string path;
  std::string name;
  std::string trouble;
};

// What is known of a room and its server.
struct RoomFact {
  enum class State { kAsking, kSilent, kAnswers };
  State state = State::kAsking;
  Duration round_trip;
  enum class Who { kUnknown, kNoKey, kRefused, kKnown };
  Who who = Who::kUnknown;
  std::size_t guest_count = 0;
  std::vector<std::string> guests;  // names of the first of them
  MonoTime told;                    // when the server said who is there, or did not
};

// A microphone or a loudspeaker: as the file has it, and for people.
struct SoundDevice {
  std::string name;
  std::string description;
};

// What is heard, while it is tested.
struct SoundFacts {
  bool is_tested = false;
  float level = 0.0f;  // 0 to 1
  float held = 0.0f;
  std::vector<SoundDevice> microphones, loudspeakers;
  std::vector<Text> advice;
};

// A QR code's modules, row by row.
struct InvitationCode {
  int size = 0;
  std::vector<bool> dark;
};

struct HostFacts {
  enum class State { kClosed, kOpening, kOpen };
  State state = State::kClosed;
  std::uint16_t port = 7400;
  std::vector<std::string> addresses;  // of this machine
  std::vector<std::string> guests;     // who is there now: "alice (salsa)"
  std::vector<std::string> invited;    // names that have a key
  bool was_reached = false;            // from another network
  std::string invitation;              // made last
  std::string invited_guest;           // for whom
  InvitationCode code;                 // of it; size 0 = none
  // As typed.
  std::string guest;
  std::string address;
  std::string withdrawn;
};

struct LobbyModel {
  static constexpr std::size_t kMostBanners = 3;

  Texts texts{Language::kEnglish};
  LobbySettings settings;
  LobbyScreen screen = LobbyScreen::kDance;
  std::vector<LobbyBanner> banners;
  LobbyWish wish = LobbyWish::kNone;

  // What is known.
  std::string settings_path;  // as a shell takes it: "~/.config/dancegraph/house.toml"
  bool has_camera = true;     // built with cameras
  bool has_music = true;
  bool has_voice = true;
  bool has_headset = true;  // built with what headsets need
  bool has_server = true;
  bool knows_cameras = false;  // they have been looked for
  std::vector<CameraFact> cameras;
  std::vector<std::string> avatars;
  std::vector<RoomFact> rooms;  // as settings.window.rooms
  HostFacts host;

  // What is open.
  bool is_going_in = false;
  LobbyWish going_for = LobbyWish::kNone;
  bool shows_command = false;
  LobbyWish command_for = LobbyWish::kNone;
  FileChooser chooser;
  std::string name_typed, server_typed, room_typed, invitation_typed;
  void* preview_texture = nullptr;  // ImTextureID; null = no picture
  float preview_aspect = 16.0f / 9.0f;
  std::vector<Text> advice;
  SoundFacts sound;

  // Takes settings over into what is typed.
  void take(const LobbySettings& settings);
  void show(LobbyScreen to);
  // The newest comes first; of more than kMostBanners the oldest goes, of the same one stays.
  void tell(LobbyBanner banner);
  void forget(Text banner);
  void ask(LobbyWish what);
  void set_language(Language language);
  // The room that is typed, as the one to join; false where it is none.
  bool choose_typed_room();
  void choose_room(const KnownRoom& room);
  void remember_room();  // the settings' own, first among those known
  void forget_room(std::size_t which);
  // What a terminal takes in the stead of a click.
  std::string command(LobbyWish wish) const;
  // What is wrong with what was chosen, before anything is started; nothing = go.
  std::optional<LobbyBanner> trouble_before(LobbyWish wish) const;
};

// A word of a command line, in quotes where a shell wants them.
std::string shell_word(std::string_view word);

}  // namespace dance
