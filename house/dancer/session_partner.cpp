#include "house/dancer/session_partner.h"

#include <algorithm>

#include "core/program/talk.h"
#include "house/dancer/dancer_file.h"

namespace dance {
namespace {

bool is_in_house(const HouseConfig& session, const GuestId& guest) {
  const auto is_it = [&](const auto& it) { return it.guest == guest; };
  return std::find(session.guests.begin(), session.guests.end(), guest) != session.guests.end() ||
         std::any_of(session.producers.begin(), session.producers.end(), is_it) ||
         std::any_of(session.cameras.begin(), session.cameras.end(), is_it);
}

GuestId free_guest(const HouseConfig& session) {
  GuestId guest = *GuestId::parse("partner");
  for (int i = 2; is_in_house(session, guest); ++i)
    guest = *GuestId::parse("partner-" + std::to_string(i));
  return guest;
}

}  // namespace

void dance_alone(HouseConfig& session) {
  session.server.clear();
  if (!session.music) return;
  // The song is published under a guest's name, for the dance panel.
  if (session.music->microphone) session.music->guest = GuestId();
  session.music->is_alone = !session.music->file.empty();
  session.music->follow = false;
  const HostedMusic& music = *session.music;
  if (music.file.empty() && !music.microphone && music.band.empty()) session.music.reset();
}

Result<void> add_partner(HouseConfig& session, const std::string& partner) {
  HostedProducer producer;
  producer.guest = free_guest(session);
  const HostedProducer* own = nullptr;
  for (const HostedProducer& it : session.producers)
    if (!session.guests.empty() && it.guest == session.guests.front()) own = &it;
  if (partner == "lead" || partner == "follow") {
    producer.role = partner;
    if (own && own->kind == HostedProducer::Kind::kSalsa) {
      producer.tempo_bpm = own->tempo_bpm;
      if (own->role == producer.role) {
        producer.role = partner == "lead" ? "follow" : "lead";
        talk::info("{} has the role {} already: the partner's is {}", own->guest.view(), own->role,
                   producer.role);
      }
    }
  } else {
    producer.kind = HostedProducer::Kind::kReplay;
    producer.file = partner;
    DANCE_TRY(const std::vector<std::string> names, dancers_in_file(partner));
    const std::string taken = own && own->kind == HostedProducer::Kind::kReplay
                                  ? chosen_dancer(own->dancer, own->guest, names)
                                  : std::string();
    for (const std::string& name : names)
      if (name != taken) producer.dancer = name;
  }
  session.guests.push_back(producer.guest);
  session.producers.push_back(std::move(producer));
  return {};
}

void let_band_play(HouseConfig& session, const std::string& style) {
  if (session.music || session.has_no_band) return;
  HostedMusic& music = session.music.emplace();
  music.band = style;
  music.volume = HostedMusic::kBandVolume;
  music.follow = !session.server.empty();
  if (!session.guests.empty()) music.guest = session.guests.front();
}

void practise_to(HouseConfig& session, const std::string& music) {
  HostedMusic hosted;
  hosted.file = music;
  hosted.loop = true;
  hosted.volume = session.practice_volume;
  if (session.music) hosted.trim_ms = session.music->trim_ms;  // the loudspeaker is the same
  hosted.is_alone = session.server.empty();
  if (hosted.is_alone && !session.guests.empty()) hosted.guest = session.guests.front();
  session.music = hosted;
}

}  // namespace dance
