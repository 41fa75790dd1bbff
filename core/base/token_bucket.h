// Token bucket: limits a rate and its bursts, as of the work that one session or guest may cause a
// server.
//
// Units/frames: tokens are datagrams, bytes or the like.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      take() is false when no token is left.
#pragma once

#include <algorithm>

#include "core/base/time.h"

namespace dance {

class TokenBucket {
 public:
  TokenBucket() = default;
  TokenBucket(double per_second, double burst)
      : per_second_(per_second), burst_(burst), level_(burst) {}

  bool take(double tokens, MonoTime now) {
    if (level(now) < tokens) return false;
    level_ -= tokens;
    return true;
  }
  // Tokens that are left.
  double level(MonoTime now) {
    if (now > filled_at_) {
      const double elapsed_s = filled_at_.is_set() ? (now - filled_at_).as_seconds() : 0.0;
      level_ = std::min(burst_, level_ + per_second_ * elapsed_s);
      filled_at_ = now;
    }
    return level_;
  }

 private:
  double per_second_ = 0.0;
  double burst_ = 0.0;
  double level_ = 0.0;
  MonoTime filled_at_;
};

}  // namespace dance
