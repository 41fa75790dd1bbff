// RecordedVoices: plays the voices of a recording again, of this house and of others. They pass
// through the decoder and play-out of a live house, at the times at which the packets arrived.
//
// Units/frames: times of the recorded house's clock; stereo samples at kVoiceRate_hz are
//               interleaved.
// Ownership:    owns the decoders of at most kMostGuests.
// Failure:      create() returns an error that names the missing part.
#pragma once

#include <memory>
#include <set>
#include <span>
#include <string>

#include "core/base/guest_id.h"
#include "core/base/result.h"
#include "core/bus/voice.h"

namespace dance {

class RecordedVoices {
 public:
  static constexpr std::size_t kMostGuests = 16;

  static Result<std::unique_ptr<RecordedVoices>> create();
  virtual ~RecordedVoices() = default;

  // Call it in the order of the recording.
  virtual void put(const GuestId& guest, const Voice& voice, MonoTime arrival) = 0;
  // Adds the 10 ms that begin at `at`. Each call continues where the last one ended.
  virtual void add_to(MonoTime at, std::span<float> stereo) = 0;
  // True while a guest speaks, and for a pause of speech after that.
  virtual bool is_speech(MonoTime at) const = 0;
  // The ids of the guests whose voices were played.
  virtual const std::set<std::string>& heard() const = 0;
};

}  // namespace dance
