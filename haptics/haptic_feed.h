// HapticFeed: what one dancer of a house feels, from the signals of a port: makes haptics of
// touches and beats, says them on HAPTIC/capture/<guest>, and hands them, and those that others
// make there, to the devices, those kinds that its options name. Of several makers for one dancer,
// as of a replay and this one, one makes each kind. A feed of certain dancers only makes touches,
// holds and the lead for itself, and takes them of a replay alone: an order does not say whose it
// is.
//
// Units/frames: times of this house's clock.
// Ownership:    refers to the port and the poller, which must outlive it; owns the players.
// Threads:      the poller's.
// Failure:      what is of another clock is left out and counted.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/bus/signal_port.h"
#include "core/net/poller.h"
#include "haptics/haptic_maker.h"
#include "haptics/haptic_player.h"

namespace dance {

class HapticFeed final : private HapticSink {
 public:
  // After an order of another maker this one holds back its own for kOtherMakes, or until it has
  // held back kMostRested with none from there: then the other has ended.
  static constexpr Duration kOtherMakes = Duration::s(30);
  static constexpr int kMostRested = 4;
  // Two makers' orders for one place within this are one.
  static constexpr Duration kSame = Duration::ms(60);

  HapticFeed(const GuestId& guest, const HapticMakerOptions& options, SignalPort& port,
             Poller& poller);
  ~HapticFeed() override;
  HapticFeed(const HapticFeed&) = delete;
  HapticFeed& operator=(const HapticFeed&) = delete;

  void add(std::unique_ptr<HapticPlayer> player) { players_.push_back(std::move(player)); }
  void set_on(bool is_on);
  // Whether a device is.
  bool is_on() const;
  void set_limit(float limit);
  const GuestId& guest() const { return guest_; }
  std::uint64_t touches() const { return touches_; }
  std::uint64_t made() const { return made_; }
  std::uint64_t heard() const { return heard_; }
  // Left out, as another maker had ordered the same.
  std::uint64_t twice() const { return twice_; }
  // Left out, as others touched more often than is felt.
  std::uint64_t left_out() const { return maker_.left_out(); }
  std::uint64_t of_other_clocks() const { return of_other_clocks_; }
  const std::vector<std::unique_ptr<HapticPlayer>>& players() const { return players_; }

 private:
  void on_haptic(const Haptic& haptic) override;
  void hear(const Haptic& haptic, MonoTime now);
  // Whether this one is to make a haptic of this kind now.
  bool makes(HapticSource source, MonoTime now);
  bool wants(HapticSource source) const;
  // Whether this kind is of dancers, and only certain ones are felt.
  bool is_own_choice(HapticSource source) const;
  // Whether another maker has ordered the same; notes the order.
  bool was_ordered(const Haptic& haptic);

  // What another maker was last heard with, of one kind.
  struct Other {
    MonoTime heard;
    int rested = 0;
  };
  struct Ordered {
    MonoTime play;
    std::uint64_t maker = 0;
  };

  GuestId guest_;
  HapticMakerOptions options_;
  std::uint64_t clock_id_, maker_id_;
  SignalPort& port_;
  Poller& poller_;
  Poller::TimerId timer_ = 0;
  HapticMaker maker_;
  std::vector<std::unique_ptr<HapticPlayer>> players_;
  std::array<Other, kHapticSources> others_{};
  std::array<std::array<Ordered, kBoneCount>, kHapticSources> ordered_{};
  std::uint64_t touches_ = 0, made_ = 0, heard_ = 0, twice_ = 0, of_other_clocks_ = 0;
};

}  // namespace dance
