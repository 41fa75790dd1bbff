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
#include "lobby/shelf/recorded_dance.h"
#include "viewer/words/texts.h"

namespace dance {

enum class LobbyScreen { kYou, kDance, kHost, kShelf };

// What is asked for; done by lobby/run.
enum class LobbyWish {
  kNone,
  kJoin,          // the settings' server and room
  kAlone,         // with a partner
  kPractise,      // with music and a mirror
  kWithoutVoice,  // kJoin, without voice
  kWatchRoom,     // kJoin, without dancing
  kCancel,        // while going in
  kOpenRoom,      // a server here
  kCloseRoom,
  kAskRouter,  // to forward the room's port
  kInvite,     // host.guest to host.room
  kWithdraw,   // host.withdrawn
  kListInvited,
  kCopyMessage,  // host.invitation as a message
  kSavePage,     // host.invitation as a file
  kOpenPageFolder,
  kOpenInvitation,  // invitation_typed
  kConfirmJoin,     // join_request
  kPlayCountIn,
  kAskRooms,   // their round trips anew
  kLookAgain,  // for cameras and addresses
  kListDances,
  // These act on shelf.chosen.
  kWatch,
  kMakeVideo,
  kExportBvh,
  kExportGlb,
  kCancelExport,
  kRename,  // to shelf.name_typed
  kDelete,
  kOpenFolder,
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
  Text other_button = Text::kCount;   // kCount = none
  LobbyWish other_request = LobbyWish::kNone;
  bool operator==(const LobbyBanner&) const = default;
};

LobbyBanner error_banner(Text text, std::vector<std::string> values = {}, std::string detail = "");

struct CameraFact {
  std::string path;
  std::string name;
  std::string trouble;
};

// A figure that can be chosen, and its still picture.
struct FigureOption {
  std::string avatar;       // the same as LobbySettings::avatar
  std::string name;         // of its file; "" = the mannequin, or a file of the store
  void* texture = nullptr;  // ImTextureID, rows from the bottom; null = not drawn yet
};

// The pictures of dancers that lobby/figures draws. Sizes are pixels of a monitor with 96 dpi.
struct FigureFacts {
  static constexpr float kCoupleWidth_u = 520.0f, kCoupleHeight_u = 296.0f;
  static constexpr float kChosenWidth_u = 280.0f, kChosenHeight_u = 400.0f;
  static constexpr float kPortraitWidth_u = 92.0f, kPortraitHeight_u = 128.0f;

  std::vector<FigureOption> options;
  bool has_listed_own = false;  // the files of the user's store are among them
  bool is_unreadable = false;   // the chosen file cannot be shown
  // The same kind as FigureOption::texture.
  void* chosen_texture = nullptr;
  void* couple_texture = nullptr;
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
struct LobbySoundDevice {
  std::string name;
  std::string description;
};

// What is heard, while it is tested.
struct SoundFacts {
  bool is_tested = false;
  float level = 0.0f;  // 0 to 1
  float held = 0.0f;
  std::vector<LobbySoundDevice> microphones, loudspeakers;
  std::vector<Text> advice;
};

// A QR code's modules, row by row.
struct InvitationCode {
  int size = 0;
  std::vector<bool> dark;
};

// A guest's key or invitation, as `dance server --list-keys` shows it.
struct InvitedGuest {
  enum class State { kInvited, kUsed, kExpired };
  std::string name;
  State state = State::kUsed;
  std::string until;  // of an invitation or a key that ends; "" = until it is withdrawn
  bool operator==(const InvitedGuest&) const = default;
};

struct HostFacts {
  enum class State { kClosed, kOpening, kOpen };
  State state = State::kClosed;
  static constexpr std::uint16_t kUsualPort = 7400;  // an address may leave it out
  std::uint16_t port = kUsualPort;
  std::vector<std::string> addresses;  // of this machine
  std::vector<std::string> guests;     // who is there now: "alice (salsa)"
  std::vector<InvitedGuest> invited;
  // The router's answer to the request to forward the port.
  enum class Router { kNotAsked, kAsking, kOpen, kBehindAnother, kRefused, kSilent };
  Router router = Router::kNotAsked;
  std::string router_address;     // its internet address; "" until it is known
  bool was_reached = false;       // from another network
  std::string invitation;         // the last one
  std::string invited_guest;      // the guest it is for
  bool is_for_home_only = false;  // its address works in this network only
  std::string page;               // the file of its page; "" = not saved
  InvitationCode code;            // its QR code; size 0 = none
  // As typed.
  std::string guest;
  std::string address;
  std::string withdrawn;
};

// The recordings, and what is done with the chosen one.
struct ShelfFacts {
  enum class Question { kNone, kExport, kRename, kDelete, kFile };
  std::vector<RecordedDance> dances;  // newest first
  std::string folder;                 // of new ones, for people
  std::int64_t now_us = 0;            // the wall clock, for "today"
  bool has_video = true;              // videos can be written here
  bool has_graphics_card = true;      // else videos are drawn plainly, and smaller
  bool has_opener = false;            // a file manager can be started
  std::string chosen;                 // path; "" = none
  Question question = Question::kNone;
  std::string name_typed;
  std::string exported_name;  // of the file that is being written; "" = none
  int percent = -1;           // of it; -1 = unknown

  const RecordedDance* find_chosen() const;
};

// The question whether to join the room of an invitation. The invitation's parser has checked all
// three texts: letters, digits and a few marks of ASCII, of bounded length.
struct JoinRequest {
  std::string room;
  std::string server;  // HOST, or HOST:PORT where the port is not the usual one
  std::string guest;
  bool speaks = false;        // with the microphone on
  bool watches_only = false;  // an invitation for listeners: sends nothing
  bool has_new_key = false;   // the server's key differs from the one that this house has saved
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
  std::string headset_error;  // why no headset can be used; "" = one may be there
  std::string sound_error;    // why the sound server cannot be reached; "" = it can, or unknown
  std::vector<std::string> avatars;
  std::vector<RoomFact> rooms;  // as settings.window.rooms
  HostFacts host;
  ShelfFacts shelf;

  // What is open.
  std::optional<JoinRequest> join_request;  // shown until it is confirmed or cancelled
  bool is_at_top = true;                    // the page is shown from its top in the next picture
  bool is_going_in = false;
  LobbyWish going_for = LobbyWish::kNone;
  bool shows_command = false;
  FileChooser chooser;
  std::string name_typed, server_typed, room_typed, invitation_typed;
  void* preview_texture = nullptr;  // ImTextureID; null = no picture
  float preview_aspect = 16.0f / 9.0f;
  std::vector<Text> advice;
  SoundFacts sound;
  FigureFacts figures;

  // Takes settings over into what is typed.
  void take(const LobbySettings& settings);
  // Takes what the dance panel saved during a dance: those of its settings that differ.
  void take_changes(const LobbySettings& before, const LobbySettings& after);
  void show(LobbyScreen to);
  // The newest comes first; of more than kMostBanners the oldest goes, of the same one stays.
  void tell(LobbyBanner banner);
  void forget(Text banner);
  void ask(LobbyWish what);
  void set_language(Language language);
  // Uses the typed name as the shown name. The id follows it until a room is known; after that it
  // stays, because the room's key belongs to the id.
  void take_typed_name();
  const std::string& shown_name() const {
    return settings.shown_name.empty() ? settings.name : settings.shown_name;
  }
  // If the id is in the room already, the next try uses another id that the same key allows.
  void take_further_name() { settings.name = further_name(settings.name); }
  // The room that is typed, as the one to join; false where it is none.
  bool choose_typed_room();
  void choose_room(const KnownRoom& room);
  // Joins the room. If its server does not answer, a banner reports that first; a closed room of
  // this computer is opened.
  void join_known_room(std::size_t which);
  // True if this computer can open the room, on the host page.
  bool is_own_room(const KnownRoom& room) const;
  void open_own_room(const KnownRoom& room);
  void remember_room();  // the settings' own, first among those known
  void forget_room(std::size_t which);
  // What a terminal takes in the stead of a click.
  std::string command(LobbyWish wish) const;
  std::optional<LobbyBanner> find_camera_error(const std::string& camera) const;
  std::optional<LobbyBanner> find_headset_error() const;
  // The fault of these settings that prevents a start; nullopt = none.
  std::optional<LobbyBanner> start_error(LobbyWish what, const LobbySettings& chosen) const;
  std::optional<LobbyBanner> start_error(LobbyWish what) const {
    return start_error(what, settings);
  }
};

// True if the camera of the settings is a recorded video.
bool is_video_file(std::string_view camera);

// "example.org:7400" → "example.org".
std::string_view without_usual_port(std::string_view server);
// True if both are one room: the usual port may be left out.
bool is_same_room(const KnownRoom& a, const KnownRoom& b);

// A word of a command line, in quotes where a shell wants them.
std::string shell_word(std::string_view word);

}  // namespace dance
