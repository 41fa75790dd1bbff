// Rate limits for datagrams of unknown senders: one per source (an IPv4 address or an IPv6 /64) and
// one for all. While more than half of the common burst is used up, wider networks are limited too,
// so that one owner of many sources cannot use the common rate alone.
//
// Ownership: tables of fixed size; networks that hash to one place share its tokens.
// Failure:   take() tells whether the source or the crowd is over its limit.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/token_bucket.h"
#include "tunnel/seal/network_levels.h"

namespace dance {

class SourceLimits {
 public:
  struct Rates {
    double per_source = 0.0;  // a second
    double source_burst = 0.0;
    double all = 0.0;
    double all_burst = 0.0;
  };
  enum class Answer : std::uint8_t { kYes, kSourceHadEnough, kAllHadEnough };

  SourceLimits(const Rates& rates, std::uint64_t secret)
      : secret_(secret), all_(rates.all, rates.all_burst), strained_below_(rates.all_burst / 2) {
    sources_.fill(TokenBucket(rates.per_source, rates.source_burst));
    for (std::size_t level = 0; level < kWideLevels; ++level)
      wide_[level].fill(TokenBucket(rates.all * kShares[level], rates.all_burst * kShares[level]));
  }

  Answer take(const Address& from, MonoTime now) {
    const NetworkLevels networks = NetworkLevels::of(from);
    if (!sources_[place_of_network(networks.narrowest(), secret_, kPlaces)].take(1.0, now))
      return Answer::kSourceHadEnough;
    bool is_over_share = false;
    for (std::size_t level = 0; level < kWideLevels; ++level) {
      const std::size_t place = place_of_network(networks.prefix[level], secret_, kWidePlaces);
      is_over_share |= !wide_[level][place].take(1.0, now);
    }
    if (is_over_share && all_.level(now) < strained_below_) return Answer::kAllHadEnough;
    return all_.take(1.0, now) ? Answer::kYes : Answer::kAllHadEnough;
  }

 private:
  static constexpr std::size_t kPlaces = 4096, kWidePlaces = 1024;
  // Shares of the common rate: IPv6 /32, /48, /56; IPv4 /16, /24, /32.
  static constexpr std::array<double, NetworkLevels::kLevels - 1> kShares{0.25, 0.125, 0.0625};
  static constexpr std::size_t kWideLevels = kShares.size();

  std::uint64_t secret_;
  std::array<TokenBucket, kPlaces> sources_;
  std::array<std::array<TokenBucket, kWidePlaces>, kWideLevels> wide_;
  TokenBucket all_;
  double strained_below_;
};

}  // namespace dance
