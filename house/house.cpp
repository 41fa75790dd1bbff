#include "house/house.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "consumers/consumer_feed.h"
#include "core/net/clock/calendar_zero.h"
#include "core/net/mono_clock.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "house/dancer/dancer_file.h"
#include "producers/receive/receiver_table.h"
#include "producers/replay/clip_dancer.h"
#include "tunnel/link/find_server.h"
#include "tunnel/link/link_report.h"
#include "tunnel/server/server.h"

namespace dance {
namespace {

constexpr Duration kSecond = Duration::s(1);

Result<std::unique_ptr<Dancer>> make_clip(const HostedProducer& producer) {
  DANCE_TRY(NamedClip loaded, load_dancer_of(producer.file, producer.dancer, producer.guest));
  for (const std::string& note : loaded.notes) talk::info("{}: {}", producer.file, note);
  if (!loaded.lost.empty()) talk::warn("{}: {}; the rest is danced", producer.file, loaded.lost);
  ClipDancerOptions options;
  options.speed = producer.speed;
  return std::make_unique<ClipDancer>(std::make_shared<const MotionClip>(std::move(loaded.clip)),
                                      options);
}

// evening.csv, or evening-2.csv where that is there: a house that is started again loses nothing.
std::string free_name(const std::string& wanted) {
  namespace fs = std::filesystem;
  fs::path path = wanted;
  std::error_code error;  // what cannot be looked at is told when it is opened
  for (int i = 2; fs::is_regular_file(path, error) && i < 1000; ++i)
    path = fs::path(wanted).replace_filename(fs::path(wanted).stem().string() + "-" +
                                             std::to_string(i) +
                                             fs::path(wanted).extension().string());
  return path.string();
}

std::vector<GuestId> hosted_guests(const HouseConfig& session) {
  std::vector<GuestId> guests;
  for (const HostedProducer& producer : session.producers) guests.push_back(producer.guest);
  for (const HostedReceiver& receiver : session.receivers) guests.push_back(receiver.options.guest);
  return guests;
}

}  // namespace

House::House(const HouseConfig& session, Poller& poller) : session_(session), poller_(poller) {}

Result<std::unique_ptr<House>> House::open(const HouseConfig& session, Poller& poller) {
  std::unique_ptr<House> house(new House(session, poller));
  DANCE_TRY(house->bus_, Bus::open(session.bus));
  house->publisher_ = std::make_unique<HousePublisher>(*house->bus_, house->bus_->url(), poller);
  house->port_ = std::make_unique<HousePort>(
      *house->publisher_, HostedParts{!session.server.empty(), hosted_guests(session)});
  house->open_inputs();
  house->captures_ = std::make_unique<PortCaptureSink>(*house->port_);
  house->link_captures_ = std::make_unique<Captures>(*house->inputs_, this_clock_id());
  house->link_bus_ =
      std::make_unique<LinkBus>(*house->bus_, *house->link_captures_, this_clock_id());
  DANCE_TRY(WakeEvent avatars_wake, WakeEvent::create());
  house->link_avatars_ =
      std::make_unique<LinkAvatars>(AvatarStore::of_user(), std::move(avatars_wake), poller,
                                    [](const std::string& line) { talk::info("{}", line); });
  house->link_bus_->use_avatars(*house->link_avatars_);
  // The link first: a capture goes to the network before this house's own stage.
  if (auto linked = house->open_link(); !linked) return tl::make_unexpected(linked.error());
  house->manager_ = std::make_unique<Manager>(session.routes, *house->port_, poller);
  // Of more than the manager remembers each would be new again and again.
  house->manager_->on_other_manager([url = house->bus_->url(), said = MessageThrottle()]() mutable {
    if (!said.is_due(url, mono_now())) return;
    talk::warn(
        "another house is open on {}: both fill one stage, and dancers jump to and fro; end one of "
        "them, or give one another --bus",
        url);
  });
  if (auto opened = house->open_avatars(); !opened) return tl::make_unexpected(opened.error());
  if (auto opened = house->open_consumers(); !opened) return tl::make_unexpected(opened.error());
  house->open_haptics();
  if (auto opened = house->open_producers(); !opened) return tl::make_unexpected(opened.error());
  if (session.music) {
    DANCE_TRY(house->music_, HouseMusic::open(*session.music, house->bus_->url(), poller));
  }
  house->open_voice();
  house->profiles_ =
      std::make_unique<HouseProfiles>(session, *house->inputs_, *house->port_, this_clock_id());
  house->profiles_->publish_second(mono_now());
  for (HostedStyle hosted : session.styles) {
    hosted.style.time = mono_now();
    hosted.style.clock_id = this_clock_id();
    house->port_->publish(Where::kCapture, hosted.guest, hosted.style);
  }
  for (const HostedCamera& camera : session.cameras)
    house->cameras_.push_back(
        std::make_unique<HouseCamera>(camera, house->bus_->url(), *house->port_, poller));
  for (const HostedHeadset& headset : session.headsets)
    house->headsets_.push_back(
        std::make_unique<HouseHeadset>(headset, house->bus_->url(), *house->port_, poller));
  House* self = house.get();
  poller.watch(house->bus_->fd(), [self](MonoTime now) { self->bus_->drain(now); });
  poller.add_timer(mono_now() + kSecond, [self](MonoTime now) {
    self->avatars_->publish_second(now);
    self->profiles_->publish_second(now);
    self->link_bus_->publish_second(now);
    self->flush_consumers(now);
    return now + kSecond;
  });
  return house;
}

bool House::have_headsets_left() const {
  return !headsets_.empty() && std::all_of(headsets_.begin(), headsets_.end(),
                                           [](const auto& headset) { return headset->has_left(); });
}

House::~House() {
  if (bus_) poller_.unwatch(bus_->fd());
  if (manager_ && manager_->without_touch() > 0)
    talk::info(
        "{} times a dancer or a pair had no place to touch: 16 dancers have one, those "
        "nearest to this house's",
        manager_->without_touch());
  for (const auto& feed : haptics_)
    for (const auto& player : feed->players()) talk::info("{}", player->summary());
  for (const auto& feed : haptics_)
    if (feed->left_out() > 0)
      talk::info("{}: {} touches were left out, as others touched more often than is felt",
                 feed->guest().view(), feed->left_out());
  for (Listening& each : consumers_)
    if (auto finished = each.consumer->finish(); !finished)
      talk::error("{}", finished.error().what);
}

void House::open_inputs() {
  HouseInputs::Options options;
  options.bus_url = bus_->url();
  options.from_bus = session_.bus_captures;
  options.hosted = hosted_guests(session_);
  options.on_refused = [this](const GuestId& guest) {
    troubles_.warn(refused_poses_line(guest), mono_now());
  };
  inputs_ = std::make_unique<HouseInputs>(*port_, *bus_, std::move(options), poller_);
  if (!inputs_->problem().empty()) talk::warn("{}", no_house_socket_line(inputs_->problem()));
  port_->attach(*inputs_);
  publisher_->houses().leave_out(inputs_->socket_path());
}

Result<void> House::open_link() {
  if (session_.server.empty()) return {};
  LinkOptions options;
  options.room = *wire::RoomName::parse(session_.room);  // the session file has checked it
  options.listen_only = session_.guests.empty() || session_.watch;
  options.interest = session_.interest;
  options.hearing = session_.hearing;
  options.channels = session_.channels;
  LinkBus::add_own_rules(options.channels);
  options.clock_id = this_clock_id();
  options.quality_m = session_.quality_mm * 1e-3;
  options.file_bytes_per_second = session_.avatar_bytes_per_second;
  options.pose_bytes_per_second = session_.pose_bytes_per_second;
  const std::vector<GuestId> guests = session_.watch ? std::vector<GuestId>() : session_.guests;
  for (const GuestId& guest : guests)
    if (!options.guests.contains(guest) && !options.guests.try_push(guest))
      return fail("a house has at most 16 guests");
  LinkHandlers handlers = link_bus_->handlers();
  add_talk(handlers);
  link_bus_->tell_status(handlers);
  LinkKeySource source;
  source.key_file = session_.key_file;
  source.certificates = {session_.certificate, session_.private_key, session_.authorities};
  const GuestId first = session_.guests.empty() ? GuestId() : session_.guests.front();
  options.look_up = look_up_of(session_.server);
  DANCE_TRY(const FoundServer server,
            find_server(session_.server, options.look_up, options.room, first, source, poller_));
  if (server.addresses.empty()) talk::warn("{}", unknown_name_line(server.why));
  DANCE_TRY(link_, Link::open(server.addresses, server.key, options, std::move(handlers), poller_));
  link_bus_->attach(*link_);
  for (const GuestId& guest : guests) link_bus_->send_signals_of(guest);
  if (!options.listen_only) link_bus_->send_channels(session_.channels);
  link_bus_->follow_hearing(session_.hearing);
  if (!session_.needs_hidden_guests()) link_bus_->follow_interest(session_.interest);
  link_bus_->follow_removals();
  return {};
}

void House::add_talk(LinkHandlers& handlers) {
  handlers.on_state = [this](LinkState state, MonoTime) {
    if (state == LinkState::kConnected) {
      troubles_.forget();
      talk::info("in room '{}' on {}", session_.room, session_.server);
      for (PlacedSalsa* dancer : std::exchange(placed_, {})) dancer->arrive(mono_now());
    }
    if (state == LinkState::kLapsed)
      talk::warn("the server {} is silent; the house dances on, and asks it again",
                 session_.server);
  };
  handlers.on_guest_joined = [](const GuestId& guest, MonoTime) {
    talk::info("{} is here", guest.view());
  };
  handlers.on_guest_left = [this](const GuestId& guest, MonoTime) {
    link_bus_->forget(guest);
    talk::info("{} has left", guest.view());
  };
  handlers.on_room_state_refused = [](wire::StateKind kind, wire::StateVerdict verdict) {
    talk::info("{}", room_state_line(kind, verdict));
  };
  handlers.on_other_server = [](const Address& address) {
    talk::info("{}", other_server_line(address));
  };
  handlers.on_no_answer = [this](const Address& address) {
    troubles_.warn(no_answer_line(address), mono_now());
  };
  handlers.on_new_address = [this](const Address& address) {
    talk::info("{}", new_address_line(session_.server, address));
  };
  handlers.on_unknown_name = [this](const std::string& why) {
    troubles_.warn(unknown_name_line(why), mono_now());
  };
  handlers.on_no_entry = [this](SealTrouble trouble) {
    troubles_.warn(no_entry_line(trouble, session_.server), mono_now());
  };
  handlers.on_refused = [this](const wire::RefusalNotice& refusal, MonoTime now) {
    troubles_.warn(refusal_line(refusal, *wire::RoomName::parse(session_.room)), now);
  };
}

// Without [voice], or with one that is not enabled, a window can still turn it on.
void House::open_voice() {
  HostedVoice voice = session_.voice.value_or(HostedVoice());
  if (!session_.voice) {
    if (session_.guests.empty() || session_.watch) return;
    voice.guest = session_.guests.front();
    voice.enabled = false;
  }
  const std::string program = program_folder() + "/dance-voice";
  if (!voice.enabled && access(program.c_str(), X_OK) != 0) return;
  voice_ = std::make_unique<HouseVoice>(voice, bus_->url(), *port_, poller_);
}

Result<void> House::open_avatars() {
  avatars_ = std::make_unique<HouseAvatars>(*inputs_, this_clock_id());
  const AvatarStore store = AvatarStore::of_user();
  for (const HostedAvatar& avatar : session_.avatars) {
    auto chosen = choose_avatar(avatar.choice, store, data_folder() + "/avatars");
    if (!chosen) return fail(std::string(avatar.guest.view()) + ": " + chosen.error().what);
    for (const std::string& note : chosen->notes) talk::info("{}: {}", avatar.choice.what, note);
    avatars_->choose(avatar.guest, *chosen, mono_now());
  }
  return {};
}

Result<void> House::open_producers() {
  for (const HostedProducer& producer : session_.producers) {
    MonoTime start = mono_now();
    std::unique_ptr<Dancer> dancer;
    if (producer.kind == HostedProducer::Kind::kSalsa) {
      start = calendar_zero();
      DANCE_TRY(auto salsa, make_salsa(producer, captures_->captures().music(), start));
      show_others_to(*salsa);
      role_controls_.push_back(open_role_control_of(*salsa, producer.guest, bus_->url(), poller_));
      dancer = std::move(salsa);
    } else {
      DANCE_TRY(dancer, make_clip(producer));
    }
    feeds_.push_back(std::make_unique<DancerFeed>(std::move(dancer), producer.guest,
                                                  producer.rate_hz, *captures_, poller_, start));
  }
  for (const HostedReceiver& receiver : session_.receivers) {
    DANCE_TRY(auto opened, open_receiver(receiver.from, receiver.options, *captures_, poller_));
    talk::info("takes {} from {}", receiver.options.guest.view(), receiver.from);
    receivers_.push_back(std::move(opened));
  }
  return {};
}

// A synthetic dancer finds a spot of its own among the others, from the moment at which this house
// joins the room.
void House::show_others_to(PlacedSalsa& salsa) {
  for (const Where where : {Where::kCapture, Where::kGuest})
    inputs_->subscribe<Pose>(where,
                             [&salsa](const Channel& channel, const Pose& pose, MonoTime now) {
                               salsa.update_other(channel.guest(), pose, now);
                             });
  placed_.push_back(&salsa);
}

Result<void> House::open_consumers() {
  for (const HostedConsumer& wanted : session_.consumers) {
    ConsumerOptions options = wanted.options;
    options.own_clock_id = this_clock_id();
    const bool is_file = find_consumer_kind(wanted.to)->output == OutputKind::kFile;
    // A terminal that is stopped, or a pipe that is not read, would stop the house's dancers.
    if (is_file && (options.file.empty() || options.file == "-"))
      return fail("[[listen]] needs a file; to see poses in a terminal run dance listen");
    if (is_file) options.file = free_name(options.file);
    DANCE_TRY(auto consumer, make_consumer(wanted.to, options));
    talk::info("passes {} on as {}", wanted.from.where == Where::kStage ? "the stage" : "captures",
               is_file ? wanted.to + " to " + options.file : wanted.to);
    feed_consumer(*port_, From(wanted.from.where, wanted.from.guest), *consumer);
    consumers_.push_back({std::move(consumer)});
  }
  return {};
}

// A disk that is full is reported when it happens, and dancers go on.
void House::flush_consumers(MonoTime now) {
  for (Listening& each : consumers_) {
    each.consumer->on_second(now);
    const auto flushed = each.consumer->flush();
    if (!flushed && !each.has_failed) talk::error("{}", flushed.error().what);
    each.has_failed = !flushed;
  }
}

// A device that is not there now is no reason not to dance.
void House::open_haptics() {
  for (const HostedHaptics& wanted : session_.haptics) {
    if (wanted.realtime) {
      haptic_programs_.push_back(
          std::make_unique<HouseHaptics>(wanted, bus_->url(), haptic_programs_.size(), poller_));
      continue;
    }
    auto output = make_haptic_output(wanted.to, wanted.options);
    if (output) {
      talk::info("{} feels by {}", wanted.guest.view(), wanted.to);
    } else {
      auto later = haptic_output_for_later(wanted.to, wanted.options);
      talk::warn("{} feels nothing by {}{}: {}", wanted.guest.view(), wanted.to,
                 later ? " until it is there" : "", output.error().what);
      if (!later) continue;
      output = std::move(later);
    }
    auto feed = std::make_unique<HapticFeed>(wanted.guest, wanted.options.maker, *port_, poller_);
    auto player =
        std::make_unique<HapticPlayer>(std::move(*output), wanted.options.player, poller_);
    player->tell_changes([guest = wanted.guest](bool is_there, const std::string& line) {
      is_there ? talk::info("{}: {}", guest.view(), line)
               : talk::warn("{}: {}", guest.view(), line);
    });
    feed->add(std::move(player));
    haptics_.push_back(std::move(feed));
  }
  open_haptic_controls();
}

void House::open_haptic_controls() {
  std::map<GuestId, std::vector<HapticFeed*>> feeds;
  for (const auto& feed : haptics_) feeds[feed->guest()].push_back(feed.get());
  for (auto& [guest, own] : feeds) {
    auto control = HapticControl::open(
        bus_->url(), std::move(own), [](const std::string& line) { talk::info("{}", line); },
        poller_);
    if (control)
      haptic_controls_.push_back(std::move(*control));
    else
      talk::warn("{}", control.error().what);
  }
}

std::string House::report_json(MonoTime now) {
  nlohmann::ordered_json report = nlohmann::ordered_json::object();
  if (link_) report = nlohmann::ordered_json::parse(link_report_json(*link_));
  const Stats stats = manager_->stats(now);
  report["manager"] = {{"received", stats.received},
                       {"forwarded", stats.forwarded},
                       {"dropped_late", stats.dropped_late},
                       {"dropped_invalid", stats.dropped_invalid},
                       {"dropped_unrouted", stats.dropped_unrouted},
                       {"dropped_overflow", stats.dropped_overflow},
                       {"without_touch", manager_->without_touch()}};
  return report.dump();
}

}  // namespace dance
