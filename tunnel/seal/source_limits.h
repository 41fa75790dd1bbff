// So many a second for each network that asks, and for all of them together: one noisy stranger
// does not use up what the others may have.
//
// Units/frames: tokens are whatever is counted.
// Ownership:    a table of fixed size; networks that fall on one place of it share its tokens.
// Threads:      none inside.
// Failure:      take() is false when a network, or everybody, has had enough.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/token_bucket.h"
#include "core/net/address.h"

namespace dance {

class SourceLimits {
 public:
  struct Rates {
    double per_source = 0.0;
    double source_burst = 0.0;
    double all = 0.0;
    double all_burst = 0.0;
  };
  enum class Answer : std::uint8_t { kYes, kSourceHadEnough, kAllHadEnough };

  // `secret` keeps strangers from choosing whom to share a place with.
  SourceLimits(const Rates& rates, std::uint64_t secret)
      : secret_(secret), all_(rates.all, rates.all_burst) {
    sources_.fill(TokenBucket(rates.per_source, rates.source_burst));
  }

  Answer take(const Address& from, MonoTime now) {
    if (!sources_[place_of(from)].take(1.0, now)) return Answer::kSourceHadEnough;
    return all_.take(1.0, now) ? Answer::kYes : Answer::kAllHadEnough;
  }

 private:
  static constexpr std::size_t kPlaces = 4096;

  std::size_t place_of(const Address& from) const {
    // The finaliser of SplitMix64 over address and secret.
    std::uint64_t x = from.network() ^ secret_;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return (x ^ (x >> 31)) % kPlaces;
  }

  std::uint64_t secret_;
  std::array<TokenBucket, kPlaces> sources_;
  TokenBucket all_;
};

}  // namespace dance
