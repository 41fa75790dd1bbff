#include "research/codec/codec_room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "core/base/assert.h"
#include "core/base/deadline.h"
#include "core/base/random.h"
#include "core/codec/lattice/lattice_codec.h"
#include "core/codec/lossless/lossless_codec.h"
#include "testing/line/lossy_model.h"
#include "tunnel/link/link_core.h"
#include "tunnel/server/server_core.h"

namespace dance {
namespace {

constexpr Duration kCapture = Duration::ms(5);  // from the camera to the link

struct Traffic {
  std::size_t bytes = 0;
  std::size_t datagrams = 0;
  void add(wire::Bytes datagram) {
    bytes += datagram.size() + wire::kSealOverhead + kIpUdp_bytes;
    ++datagrams;
  }
};

struct Ages {
  double sum = 0.0;
  double count = 0.0;
};

// Looks how old what all have is when the next pose is made.
class WatchedEncoder final : public PoseEncoder {
 public:
  WatchedEncoder(std::shared_ptr<const PoseModel> model, Ages& ages)
      : encoder_(std::move(model)), ages_(ages) {}
  CodecName name() const override { return encoder_.name(); }
  std::size_t encode(const Pose& pose, std::span<std::uint8_t> payload) override {
    if (acked_ != 0) {
      ages_.sum += static_cast<double>(pose.sequence - acked_);
      ages_.count += 1.0;
    }
    return encoder_.encode(pose, payload);
  }
  void acknowledged(std::uint32_t sequence) override {
    acked_ = std::max(acked_, sequence);
    encoder_.acknowledged(sequence);
  }
  void request_intra() override { encoder_.request_intra(); }
  void request_refresh() override { encoder_.request_refresh(); }
  void request_base() override { encoder_.request_base(); }
  void base_acknowledged(std::uint32_t sequence) override { encoder_.base_acknowledged(sequence); }
  bool is_intra() const override { return encoder_.is_intra(); }
  void restart() override { encoder_.restart(); }
  void set_references(References references) override { encoder_.set_references(references); }
  void set_quality(double error_m) override { encoder_.set_quality(error_m); }
  void set_skeleton(const Skeleton& skeleton) override { encoder_.set_skeleton(skeleton); }

 private:
  LatticeEncoder encoder_;
  Ages& ages_;
  std::uint32_t acked_ = 0;
};

class Room {
 public:
  Room(const std::vector<CodecTake>& takes, const CodecRoomOptions& options);
  CodecRoom run();

 private:
  struct Guest;
  class LinkSink final : public DatagramSink {
   public:
    LinkSink(Room& room, Guest& guest) : room_(room), guest_(guest) {}
    void send(const Address&, std::span<const std::uint8_t> bytes) override {
      room_.post(true, guest_, bytes);
    }

   private:
    Room& room_;
    Guest& guest_;
  };
  class ServerSink final : public PeerSink {
   public:
    explicit ServerSink(Room& room) : room_(room) {}
    void send(PeerId to, std::span<const std::uint8_t> bytes) override {
      room_.post(false, *room_.guests_[to - 1], bytes);
    }

   private:
    Room& room_;
  };
  struct Guest {
    GuestId id;
    PeerId peer = 0;
    std::uint64_t clock_id = 0;
    Duration clock_ahead;
    LossyModel up, down;
    const CodecTake* take = nullptr;
    std::size_t place = 0;  // in the take, which is danced to and fro
    std::uint32_t sequence = 1;
    MonoTime next_pose;
    Traffic sent, received;
    std::unique_ptr<LinkSink> sink;
    std::unique_ptr<LinkCore> link;
    LinkCounters before;
    Guest(const LossySpec& line, std::uint64_t stream)
        : up({.spec = line}, stream), down({.spec = line}, stream + 1) {}
    MonoTime time(MonoTime now) const { return now + clock_ahead; }
  };
  struct Parcel {
    bool to_server;
    Guest* guest;
    std::vector<std::uint8_t> bytes;
  };

  void add_guest(std::size_t number, const std::vector<CodecTake>& takes);
  void run_until(MonoTime end);
  MonoTime next_event() const;
  void step();
  void dance(Guest& guest);
  void post(bool to_server, Guest& guest, std::span<const std::uint8_t> bytes);
  void count_costs(wire::Bytes datagram);
  CodecRoom result() const;

  CodecRoomOptions options_;
  Random random_{20'260'102};
  MonoTime now_ = MonoTime::from_us(5'000'000'000);
  bool is_measured_ = false;
  ServerSink server_sink_{*this};
  ServerCore server_{ServerLimits(), [this] { return random_.next_u64(); }, server_sink_};
  std::vector<std::unique_ptr<Guest>> guests_;
  std::multimap<MonoTime, Parcel> parcels_;
  CodecRoomCosts costs_;
  Ages ages_;
  std::size_t records_ = 0, wide_ = 0;
  double delay_ms_ = 0.0;
  std::size_t heard_ = 0;
};

Room::Room(const std::vector<CodecTake>& takes, const CodecRoomOptions& options)
    : options_(options) {
  for (std::size_t i = 0; i < options.guests; ++i) add_guest(i, takes);
}

void Room::add_guest(std::size_t number, const std::vector<CodecTake>& takes) {
  LossySpec line;
  line.delay = options_.round_trip / 4;
  line.loss = options_.loss;
  line.seed = 1 + number;
  guests_.push_back(std::make_unique<Guest>(line, 2 * number));
  Guest& guest = *guests_.back();
  guest.id = *GuestId::parse("guest-" + std::to_string(number));
  guest.peer = number + 1;
  guest.clock_id = 100 + number;
  guest.clock_ahead = Duration::s(static_cast<std::int64_t>(number));
  guest.take = &takes[number % takes.size()];
  // Who have the same take are apart in it.
  guest.place = number * guest.take->poses.size() / options_.guests;
  guest.sink = std::make_unique<LinkSink>(*this, guest);
  LinkOptions link;
  link.room = *wire::RoomName::parse("room");
  const CodecName codec{CodecId::kLattice, options_.model->name};
  if (!link.guests.try_push(guest.id) || !link.codecs.try_push(codec)) DANCE_ASSERT(false);
  link.token = random_.next_u64() | 1;
  link.clock_id = guest.clock_id;
  link.seed = random_.next_u64();
  link.quality_m = options_.error_m;
  link.make_encoder = [this](CodecName) {
    return std::make_unique<WatchedEncoder>(options_.model, ages_);
  };
  link.make_decoder = [model = options_.model](CodecName) {
    return std::make_unique<LatticeDecoder>(model);
  };
  LinkHandlers handlers;
  handlers.on_pose = [this](const GuestId&, const Pose& pose, MonoTime now) {
    if (!is_measured_) return;
    delay_ms_ += (now - pose.capture_time - kCapture).as_ms();
    ++heard_;
  };
  guest.link = std::make_unique<LinkCore>(link, std::move(handlers), *guest.sink);
  guest.link->on_sealed(guest.time(now_));
  guest.link->send(guest.id, guest.take->skeleton, guest.time(now_));
  // Cameras do not wait for each other.
  guest.next_pose = now_ + Duration::seconds(1.0 + random_.uniform() / guest.take->hz);
}

void Room::dance(Guest& guest) {
  const auto& poses = guest.take->poses;
  const std::size_t there_and_back = 2 * (poses.size() - 1);
  const std::size_t at = guest.place++ % there_and_back;
  Pose pose = poses[at < poses.size() ? at : there_and_back - at];
  pose.sequence = guest.sequence++;
  pose.capture_time = guest.time(now_) - kCapture;
  pose.clock_id = guest.clock_id;
  pose.hops = {};
  pose.stamp(Hop::kPublished, guest.time(now_) - Duration::ms(1));
  guest.link->send(guest.id, pose, guest.time(now_));
  guest.next_pose += Duration::seconds(1.0 / guest.take->hz);
}

void Room::post(bool to_server, Guest& guest, std::span<const std::uint8_t> bytes) {
  if (is_measured_) {
    (to_server ? guest.sent : guest.received).add(bytes);
    if (!to_server) count_costs(bytes);
  }
  const auto fate =
      (to_server ? guest.up : guest.down).offer(bytes.size() + wire::kSealOverhead, now_);
  for (const MonoTime due : fate.deliveries())
    parcels_.emplace(due, Parcel{to_server, &guest, {bytes.begin(), bytes.end()}});
}

void Room::count_costs(wire::Bytes datagram) {
  costs_.ip_udp += kIpUdp_bytes;
  const auto size = static_cast<double>(datagram.size() + wire::kSealOverhead);
  const auto opening = wire::parse_opening(datagram);
  if (!opening || opening->type != wire::Type::kRecords) {
    costs_.rest += size;
    return;
  }
  ByteReader in(opening->body);
  const auto header = wire::parse_records_header(in);
  DANCE_ASSERT(header.has_value());
  const auto feedback =
      header->has_feedback ? 7.0 + 7.0 * static_cast<double>(header->feedback.guests.size()) : 0.0;
  costs_.feedback += feedback;
  costs_.headers += size - static_cast<double>(in.remaining()) - feedback;
  for (wire::RecordChain chain; in.remaining() > 0;) {
    const std::size_t before = in.remaining();
    // Says that ages follow, and is theirs.
    const double mark = chain.has_any ? 2.0 : 3.0;
    const auto record = wire::parse_record(chain, in);
    DANCE_ASSERT(record.has_value());
    const auto payload = static_cast<double>(record->payload.size());
    const double ages = record->sent_age_us != wire::kNoAge ? 6.0 + mark : 0.0;
    costs_.payloads += payload;
    costs_.ages += ages;
    costs_.record_heads += static_cast<double>(before - in.remaining()) - payload - ages;
    ++records_;
    if (!record->is_narrow) ++wide_;
  }
}

MonoTime Room::next_event() const {
  MonoTime next = server_.next_deadline();
  const auto sooner = [&](MonoTime time) { next = earlier(next, time); };
  if (!parcels_.empty()) sooner(parcels_.begin()->first);
  for (const auto& guest : guests_) {
    sooner(guest->next_pose);
    const MonoTime due = guest->link->next_deadline();
    if (due.is_set()) sooner(std::max(due - guest->clock_ahead, now_));
  }
  return next;
}

void Room::step() {
  while (!parcels_.empty() && parcels_.begin()->first <= now_) {
    const auto parcel = parcels_.extract(parcels_.begin());
    const Parcel& what = parcel.mapped();
    Guest& guest = *what.guest;
    if (what.to_server) {
      server_.receive(guest.peer, Access{.any_name = true}, what.bytes, now_, now_);
      server_.end_turn(now_);
    } else {
      guest.link->receive(what.bytes, guest.time(now_), guest.time(now_));
    }
  }
  for (auto& guest : guests_) {
    if (guest->next_pose <= now_) dance(*guest);
    const MonoTime due = guest->link->next_deadline();
    if (due.is_set() && due <= guest->time(now_)) guest->link->tick(guest->time(now_));
  }
  const MonoTime due = server_.next_deadline();
  if (due.is_set() && due <= now_) server_.tick(now_);
}

void Room::run_until(MonoTime end) {
  for (;;) {
    const MonoTime next = std::max(next_event(), now_);
    if (next >= end) break;
    now_ = next;
    step();
  }
  now_ = end;
}

CodecRoom Room::run() {
  run_until(now_ + options_.warm_up);
  for (auto& guest : guests_) guest->before = guest->link->counters();
  ages_ = Ages();
  is_measured_ = true;
  run_until(now_ + options_.measured);
  return result();
}

CodecRoom Room::result() const {
  CodecRoom room;
  room.guests = guests_.size();
  const auto guests = static_cast<double>(guests_.size());
  const double guest_seconds = guests * options_.measured.as_seconds();
  double received = 0.0, delivered = 0.0, sent = 0.0;
  std::map<std::string, int> policies;
  for (const auto& guest : guests_) {
    const LinkCounters& c = guest->link->counters();
    const LinkCounters& b = guest->before;
    room.hz += guest->take->hz / guests;
    room.down_bytes_per_s += static_cast<double>(guest->received.bytes) / guest_seconds;
    room.up_bytes_per_s += static_cast<double>(guest->sent.bytes) / guest_seconds;
    room.down_datagrams_per_s += static_cast<double>(guest->received.datagrams) / guest_seconds;
    room.up_datagrams_per_s += static_cast<double>(guest->sent.datagrams) / guest_seconds;
    received += static_cast<double>(c.poses_received - b.poses_received);
    delivered += static_cast<double>(c.poses_delivered - b.poses_delivered);
    sent += static_cast<double>(c.poses_sent - b.poses_sent);
    room.reference_missing += c.reference_missing - b.reference_missing;
    room.malformed += c.invalid - b.invalid;
    room.path_loss += guest->link->path().loss / guests;
    room.path_round_trip += guest->link->path().round_trip / static_cast<int>(guests_.size());
    ++policies[name_of(guest->link->local_stats().front().references)];
  }
  room.policy = std::max_element(policies.begin(), policies.end(), [](auto& a, auto& b) {
                  return a.second < b.second;
                })->first;
  room.down_costs = costs_;
  for (double* part : {&room.down_costs.ip_udp, &room.down_costs.headers, &room.down_costs.feedback,
                       &room.down_costs.record_heads, &room.down_costs.ages,
                       &room.down_costs.payloads, &room.down_costs.rest})
    *part /= guest_seconds;
  const auto records = static_cast<double>(std::max<std::size_t>(records_, 1));
  room.payload_bytes = costs_.payloads / records;
  room.wide_records = static_cast<double>(wide_) / records;
  room.decoded_fraction = delivered / std::max(received, 1.0);
  room.arrived_fraction = received / std::max(sent * (guests - 1.0), 1.0);
  room.acked_age_frames = ages_.sum / std::max(ages_.count, 1.0);
  room.delay_ms = delay_ms_ / static_cast<double>(std::max<std::size_t>(heard_, 1));
  room.raw_bytes_per_s =
      (guests - 1.0) * room.hz * static_cast<double>(kRawPose_bytes + kIpUdp_bytes);
  return room;
}

}  // namespace

CodecRoom dance_in_room(const std::vector<CodecTake>& takes, const CodecRoomOptions& options) {
  DANCE_ASSERT(!takes.empty() && options.guests >= 2 && options.model != nullptr);
  return Room(takes, options).run();
}

}  // namespace dance
