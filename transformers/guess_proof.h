// GuessProof: who has been right lately. It tells how much of the personal model's correction to take, joint by joint; and
// where the whole prediction was worse than standing still, than going on, or than going on and slowing down, how far to
// go back to that.
//
// Units/frames: ways as transformers/moment_guesses.h.
// Ownership:    plain value; never allocates.
// Threads:      none inside; one owner.
// Failure:      none; before anything is known, nothing of the personal model, and the prediction as it is.
#pragma once

#include <array>
#include <memory>

#include "transformers/moment_guesses.h"
#include "transformers/predict_model.h"

namespace dance {

// What anyone can do: stand still, go on as between the last two rows, go on and slow down (100 ms).
constexpr std::size_t kPlainGuesses = 3;
std::array<BodyRow, kPlainGuesses> plain_ways(const MomentGuesses& guesses, std::size_t horizon);

class GuessProof {
 public:
  explicit GuessProof(const std::array<float, kRowGroups>& lever);
  void clear();

  // A moment that is over: it went `way`.
  void learn(std::size_t horizon, const MomentGuesses& guesses, const BodyRow& way);
  // Adds what is proved of guesses.personal.
  void add_personal(std::size_t horizon, const MomentGuesses& guesses, BodyRow& way) const;
  // How far it is proved that the personal model knows this dancer: 0 to 1, by the bones that are seen.
  float proved(std::size_t horizon, std::uint32_t presence) const;
  // guesses.blended, or as far back to plain guesses as those were better.
  void finish(std::size_t horizon, const MomentGuesses& guesses, BodyRow& way) const;
  // After a gap: how good guesses were lately is not known.
  void forget_errors();
  // Forgets what the personal model has proved: a new one is there.
  void doubt_personal();

 private:
  // Sums of the errors of the prediction and of the plain guesses, lately.
  struct Errors {
    float heard = 0.0f;
    float ours = 0.0f;
    std::array<float, kPlainGuesses> plain{};
  };
  struct Horizon {
    // Share s of a correction c to a guess p that is least wrong: sum (y - p) c / sum c².
    alignas(64) std::array<float, kRowGroups> right{}, size{};
    alignas(64) std::array<float, kRowGroups> share{};
    std::array<Errors, 2> errors{};  // while the dancer stands and while they move
  };
  static float way_back(const Errors& errors);
  bool is_moving(const MomentGuesses& guesses) const;
  float error_m(const BodyRow& said, const BodyRow& way) const;

  std::array<float, kRowGroups> lever_{};
  std::array<Horizon, kHorizons> horizons_{};
};

}  // namespace dance
