// Invitations in the window: it asks whether to join, tries the room, and saves the settings that
// worked.
#include <algorithm>
#include <utility>

#include "core/net/mono_clock.h"
#include "lobby/run/lobby_run.h"
#include "tunnel/invitation/open_invitation.h"

namespace dance {
namespace {

// Ignores clicks on Join for this time: they may be meant for what the question covers.
constexpr Duration kIgnoreClicksFor = Duration::ms(500);

KnownRoom room_of(const Invitation& invitation) {
  const std::string room(invitation.room.is_set() ? invitation.room.view() : "dance");
  return {room, invitation.server()};
}

JoinRequest request_of(const Invitation& invitation, bool speaks, bool watches) {
  static_assert(kInvitationPort == HostFacts::kUsualPort);
  return {room_of(invitation).room,
          std::string(without_usual_port(invitation.server())),
          std::string(invitation.guest.view()),
          speaks,
          watches || invitation.role == KeyKind::kListener,
          names_other_server_key(invitation).value_or(false)};
}

}  // namespace

// Until the user confirms, the lobby uses no part of an invitation and does not contact its server.
// Rooms that this house file already names are joined without a question.
void LobbyRun::open_invitation_typed() {
  model_.banners.clear();
  const auto invitation = parse_invitation(model_.invitation_typed);
  if (!invitation)
    return model_.tell(error_banner(Text::kLobbyInvitationBad, {}, invitation.error().what));
  invitation_ = *invitation;
  const bool watches = model_.settings.source == DancerSource::kWatch;
  const bool speaks = model_.settings.speaks && model_.has_voice && !watches;
  model_.join_request = request_of(*invitation, speaks, watches);
  asked_ = MonoTime();
  if (has_joined(*invitation)) return confirm_join();
  asked_ = mono_now();
  seen_.stop(model_);
}

// The server key that was saved when the invitation was opened identifies the server: a room of the
// same name on another server is another room.
bool LobbyRun::has_joined(const Invitation& invitation) const {
  const auto& rooms = model_.settings.window.rooms;
  return model_.settings.name == invitation.guest.view() &&
         std::ranges::any_of(
             rooms, [&](const KnownRoom& it) { return is_same_room(it, room_of(invitation)); }) &&
         was_opened_before(invitation).value_or(false);
}

void LobbyRun::confirm_join() {
  if (!invitation_ || !model_.join_request) return;
  if (asked_.is_set() && mono_now() - asked_ < kIgnoreClicksFor) return;
  if (!opener_->begin(*invitation_, model_.join_request->has_new_key)) return;
  trial_ = model_.settings;
  trial_->speaks = model_.join_request->speaks;
  model_.join_request.reset();
  invitation_.reset();
  look_for_cameras_once();
  model_.is_going_in = true;
  going_since_ = mono_now();
}

void LobbyRun::cancel() {
  model_.join_request.reset();
  invitation_.reset();
  look_for_cameras_once();
  stop_house();
}

void LobbyRun::look_for_cameras_once() {
  if (!std::exchange(has_looked_for_cameras_, true)) seen_.look_for_cameras(model_);
}

// Returns true when an outcome was applied.
bool LobbyRun::look_at_invitation() {
  // The dancer of a new house file is chosen once the cameras are known.
  if (model_.is_going_in && trial_ && chooses_source_) return false;
  const auto outcome = opener_->take();
  if (!outcome || !model_.is_going_in || house_ || !trial_) return false;
  model_.is_going_in = false;
  if (!outcome->empty()) {
    trial_.reset();
    model_.tell(error_banner(Text::kLobbyInvitationFailed, {}, *outcome));
    return true;
  }
  const Invitation& invitation = opener_->invitation();
  model_.invitation_typed.clear();
  // The key belongs to that name.
  trial_->name = std::string(invitation.guest.view());
  trial_->source =
      invitation.role == KeyKind::kListener ? DancerSource::kWatch : model_.settings.source;
  trial_->room = room_of(invitation).room;
  trial_->server = room_of(invitation).server;
  go_in(LobbyWish::kJoin);
  if (!house_) stop_house();
  return true;
}

// The server admitted the house: saves the trial settings.
void LobbyRun::keep_trial() {
  if (!trial_) return;
  const KnownRoom room{trial_->room, trial_->server};
  model_.settings = *std::exchange(trial_, std::nullopt);
  model_.name_typed = model_.shown_name();
  model_.choose_room(room);
  model_.remember_room();
  save();
  file_.remove_trial();
}

}  // namespace dance
