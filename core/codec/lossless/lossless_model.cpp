#include "core/codec/lossless/lossless_model.h"

#include <cmath>
#include <limits>

#include "core/codec/exact/exact_math.h"

namespace dance {
namespace {

constexpr std::uint32_t kSign = 0x8000'0000u;
constexpr std::uint64_t kNoMusicBits = 0x7ff8'0000'0000'0000u;
constexpr int kMantissaBits = 23;
constexpr int kExponentBias = 127;
// Larger numbers are written, but not used for prediction.
constexpr double kLargestMeant = 1e6;
constexpr double kFirstResidual = 0.25;  // of an intra frame, against the T-pose
constexpr double kFirstMovement = 0.02;  // of the next frame
constexpr double kNewResidual = 0.2;     // weight of the newest in the mean
constexpr double kLeastResidual = 1e-25;
constexpr double kGroupWeight = 0.3;  // weight of earlier residuals in the next one's scale
constexpr double kSurpriseOfFrame = 0.3;
constexpr double kUsualSurprise = -0.9;  // mean of log2(|residual| / mean |residual|)
constexpr int kCellsInResidual_log2 = 2;
constexpr int kLeastCell_log2 = -100;
constexpr double kLargestScale_log2 = 20.0;
constexpr std::int64_t kFineClasses = 8;
constexpr std::uint32_t kEscapeClass = 60;  // and all above
constexpr std::int64_t kLargestResidual = 65535;
constexpr std::int64_t kEscape = std::numeric_limits<std::int64_t>::min();

double meant(std::uint32_t bits) {
  const auto x = static_cast<double>(std::bit_cast<float>(bits));
  return std::abs(x) <= kLargestMeant ? x : 0.0;
}

double power_of_two(int n) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(n + 1023) << 52);
}

// log2 of the distance between floats of this size.
int spacing_log2(double x) {
  const auto exponent = static_cast<int>(std::bit_cast<std::uint64_t>(x) >> 52 & 0x7ff) - 1023;
  return std::max(exponent - kMantissaBits, kLeastCell_log2);
}

// Neighbouring floats map to neighbouring integers; −0 comes just before +0.
std::int64_t ordered(std::uint32_t bits) {
  const auto size = static_cast<std::int64_t>(bits & ~kSign);
  return (bits & kSign) != 0 ? -1 - size : size;
}
std::uint32_t from_ordered(std::int64_t n) {
  return n < 0 ? static_cast<std::uint32_t>(-1 - n) | kSign : static_cast<std::uint32_t>(n);
}
std::uint64_t ordered(std::uint64_t bits) {
  constexpr std::uint64_t kSign64 = std::uint64_t{1} << 63;
  return (bits & kSign64) != 0 ? ~(bits & ~kSign64) : bits;
}

// Which cell of the grid ⌊x / cell⌋ x lies in, mirrored at 0 so that −0 and +0 have cells of their
// own.
std::int64_t cell_of(double x, int cell_log2) {
  const auto n = static_cast<std::int64_t>(std::abs(x) * power_of_two(-cell_log2));
  return std::signbit(x) ? -1 - n : n;
}

}  // namespace

LosslessFrame lossless_frame(const Pose& pose) {
  LosslessFrame frame;
  std::size_t at = 0;
  const auto add = [&](float x) { frame.floats[at++] = std::bit_cast<std::uint32_t>(x); };
  for (const auto& q : pose.R_PB)
    for (Eigen::Index i = 0; i < 4; ++i) add(q.coeffs()[i]);
  for (Eigen::Index i = 0; i < 3; ++i) add(pose.p_WH_m[i]);
  add(pose.confidence);
  frame.presence = pose.presence;
  frame.music = std::bit_cast<std::uint64_t>(pose.music_beats);
  return frame;
}

void to_pose(const LosslessFrame& frame, Pose& pose) {
  std::size_t at = 0;
  const auto next = [&] { return std::bit_cast<float>(frame.floats[at++]); };
  for (auto& q : pose.R_PB)
    for (Eigen::Index i = 0; i < 4; ++i) q.coeffs()[i] = next();
  for (Eigen::Index i = 0; i < 3; ++i) pose.p_WH_m[i] = next();
  pose.confidence = next();
  pose.presence = frame.presence;
  pose.music_beats = std::bit_cast<double>(frame.music);
}

// Damped velocity, until weights are learned.
LosslessModel::Track::Track() : predictor({1.3, -0.3}), mean_residual(kFirstResidual) {}

LosslessModel::LosslessModel() { restart(); }

void LosslessModel::restart() {
  frames_ = 0;
  digest_ = 0;
  const LosslessFrame first = lossless_frame(Pose{});
  for (std::size_t i = 0; i < kLosslessFloats; ++i) {
    tracks_[i] = Track();
    tracks_[i].bits = first.floats[i];
    tracks_[i].past.fill(meant(first.floats[i]));
  }
  opening_.restart();
  largest_residual_.fill(1.0);
  group_stood_.fill(false);
  is_turned_over_.fill(false);
  turns_over_ = AdaptiveBit();
  group_stands_.fill(AdaptiveBit());
  float_stands_.fill(AdaptiveBit());
  residual_classes_.fill(ClassTree());
  residual_signs_.fill(AdaptiveBit());
  largest_classes_.fill(ClassTree());
  largest_signs_.fill(AdaptiveBit());
  octaves_.fill(AdaptiveBit());
}

LosslessModel::Group LosslessModel::group(std::size_t index) {
  if (index < kBoneCount) return {4 * index, 4, true};
  if (index == kBoneCount) return {4 * kBoneCount, 3, false};
  return {4 * kBoneCount + 3, 1, false};
}

template <class Coder>
void LosslessModel::code(Coder& coder, LosslessFrame& frame) {
  opening_.code(coder, frame.presence, frame.music);
  Surprise of_frame;
  for (std::size_t i = 0; i < kBoneCount + 2; ++i) code_group(coder, i, frame, of_frame);
  if (is_key()) {
    for (Track& track : tracks_) {
      track.past.fill(track.past[0]);
      track.mean_residual = kFirstMovement;
    }
  }
  const auto add = [this](std::uint64_t bits) { digest_ = (digest_ ^ bits) * 0x100'0000'01b3u; };
  for (const std::uint32_t bits : frame.floats) add(bits);
  add(frame.presence);
  add(frame.music);
  ++frames_;
}

template <class Coder>
void LosslessModel::code_group(Coder& coder, std::size_t index, LosslessFrame& frame,
                               Surprise& of_frame) {
  const Group g = group(index);
  std::uint32_t* const floats = frame.floats.data() + g.first;
  Track* const tracks = tracks_.data() + g.first;
  // q and −q are one rotation: the one nearer to the previous frame is used.
  std::uint32_t turned = 0;
  if (g.is_rotation) {
    double dot = 0.0;
    for (std::size_t i = 0; i < 4; ++i) dot += meant(floats[i]) * tracks[i].past[0];
    is_turned_over_[index] ^= coder.bit(turns_over_, (dot < 0.0) != is_turned_over_[index]);
    turned = is_turned_over_[index] ? kSign : 0;
  }
  bool stands = true;
  for (std::size_t i = 0; i < g.count; ++i) {
    floats[i] ^= turned;
    stands = stands && floats[i] == tracks[i].bits;
  }
  stands = coder.bit(group_stands_[group_stood_[index] ? 1 : 0], stands);
  group_stood_[index] = stands;
  const std::size_t largest = g.is_rotation ? largest_of(g) : g.count;
  std::array<double, 4> innovations{};  // of this group; correlated
  Surprise of_group;
  const auto code_one = [&](std::size_t i) {
    Track& track = tracks[i];
    const double before = track.past[0];
    LeastSquares<kInputs>::Inputs inputs;
    for (std::size_t k = 0; k < kSteps; ++k) inputs[k] = track.past[k] - track.past[k + 1];
    std::copy(innovations.begin(), innovations.end(), inputs.begin() + kSteps);
    double predicted = before + track.predictor.predict(inputs);
    if (!(std::abs(predicted) <= kLargestMeant)) predicted = before;
    if (coder.bit(float_stands_[track.unchanged], floats[i] == track.bits)) {
      floats[i] = track.bits;
      track.unchanged = (track.unchanged << 1 | 1u) & 3u;
    } else {
      track.unchanged = track.unchanged << 1 & 3u;
      const double usual = exact::log2(track.mean_residual);
      double cell = 0.0;
      const float x = code_predicted(
          coder, std::bit_cast<float>(floats[i]), predicted,
          usual + kGroupWeight * of_group.mean() + kSurpriseOfFrame * of_frame.mean(), cell);
      floats[i] = std::bit_cast<std::uint32_t>(x);
      const double residual = std::abs(meant(floats[i]) - predicted);
      of_group.sum +=
          std::clamp(exact::log2(residual + 0.3 * cell) - usual, -4.0, 6.0) - kUsualSurprise;
      of_group.count += 1.0;
      learn_residual(track, residual, cell);
    }
    const double moved = meant(floats[i]) - before;
    innovations[i] = moved;
    for (std::size_t k = 0; k < kSteps; ++k)
      innovations[i] -= track.predictor.weights()[k] * inputs[k];
    if (!is_key()) track.predictor.learn(inputs, moved);
  };
  if (!stands) {
    for (std::size_t i = 0; i < g.count; ++i)
      if (i != largest) code_one(i);
    if (of_group.count > 0.0) {
      of_frame.sum += of_group.mean();
      of_frame.count += 1.0;
    }
    if (largest < g.count) {
      // x² + y² + z² + w² = 1
      double rest = 1.0;
      for (std::size_t i = 0; i < 4; ++i)
        if (i != largest) rest -= meant(floats[i]) * meant(floats[i]);
      const double before = tracks[largest].past[0];
      const double size = rest > 0.0 ? std::sqrt(rest) : std::abs(before);
      floats[largest] = std::bit_cast<std::uint32_t>(
          code_largest(coder, index, std::bit_cast<float>(floats[largest]),
                       std::signbit(before) ? -size : size));
    }
  }
  for (std::size_t i = 0; i < g.count; ++i) {
    Track& track = tracks[i];
    if (stands) floats[i] = track.bits;
    track.bits = floats[i];
    for (std::size_t k = kSteps; k > 0; --k) track.past[k] = track.past[k - 1];
    track.past[0] = meant(floats[i]);
    floats[i] ^= turned;
  }
}

std::size_t LosslessModel::largest_of(const Group& g) const {
  std::size_t largest = 0;
  for (std::size_t i = 1; i < g.count; ++i)
    if (std::abs(tracks_[g.first + i].past[0]) > std::abs(tracks_[g.first + largest].past[0]))
      largest = i;
  return largest;
}

// The first residuals weigh more.
void LosslessModel::learn_residual(Track& track, double residual, double cell) {
  const double share = std::max(kNewResidual, 1.0 / (static_cast<double>(frames_) + 1.0));
  track.mean_residual += share * (residual + 0.1 * cell - track.mean_residual);
  track.mean_residual = std::max(track.mean_residual, kLeastResidual);
}

// The grid's cell is a quarter of the expected residual, or one float where that is more: the
// distribution of the residual in cells is then nearly the same for all. The floats of a cell are
// equally likely.
template <class Coder>
float LosslessModel::code_predicted(Coder& coder, float x, double predicted, double log_scale,
                                    double& cell) {
  const double scale = std::clamp(log_scale, -90.0, kLargestScale_log2);
  const int whole = static_cast<int>(scale + 128.0) - 128;
  const int spacing = spacing_log2(predicted);
  int cell_log2 = whole - kCellsInResidual_log2;
  int context = static_cast<int>((scale - whole) * 4.0);
  if (cell_log2 <= spacing) {
    cell_log2 = spacing;
    context = 4 + std::clamp(static_cast<int>((scale - spacing + 8.0) * 4.0), 0, 43);
  }
  cell = power_of_two(cell_log2);
  const std::int64_t expected = cell_of(predicted, cell_log2);
  const auto exact_x = static_cast<double>(x);
  std::int64_t residual = kEscape;
  if (std::abs(exact_x) < cell * 0x1p40) residual = cell_of(exact_x, cell_log2) - expected;
  const auto which = static_cast<std::size_t>(context);
  residual = code_residual(coder, residual_classes_[which], residual_signs_[which], residual);
  const auto x_bits = std::bit_cast<std::uint32_t>(x);
  if (residual == kEscape) return std::bit_cast<float>(coder.raw(x_bits, 32));
  const std::int64_t n = expected + residual;
  const std::uint32_t sign = n < 0 ? kSign : 0;
  const std::int64_t size = n < 0 ? -1 - n : n;
  if (size == 0) return code_below_cell(coder, x, cell_log2, n < 0);
  const auto low = static_cast<float>(static_cast<double>(size) * cell);
  const int finer = std::max(0, cell_log2 - spacing_log2(static_cast<double>(low)));
  const std::uint32_t within = coder.raw(x_bits & ((1u << finer) - 1), finer);
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(low) | within | sign);
}

// In the cell at 0 floats get closer and closer: how many octaves below its end, then the mantissa.
template <class Coder>
float LosslessModel::code_below_cell(Coder& coder, float x, int cell_log2, bool negative) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const int highest = cell_log2 + kExponentBias - 1;
  const int exponent = static_cast<int>(bits >> kMantissaBits & 0xff);
  const auto below = static_cast<int>(
      coder.tree(octaves_, static_cast<std::uint32_t>(std::clamp(highest - exponent, 0, 255))));
  const std::uint32_t mantissa = coder.raw(bits & ((1u << kMantissaBits) - 1), kMantissaBits);
  const auto coded = static_cast<std::uint32_t>(std::max(0, highest - below));
  return std::bit_cast<float>(coded << kMantissaBits | mantissa | (negative ? kSign : 0));
}

// The unit norm determines it but for rounding, whose distribution depends on how near to half a
// step it was.
template <class Coder>
float LosslessModel::code_largest(Coder& coder, std::size_t bone, float x, double predicted) {
  const auto nearest = static_cast<float>(predicted);
  const double spacing = power_of_two(spacing_log2(static_cast<double>(nearest)));
  const double off = (std::abs(predicted) - std::abs(static_cast<double>(nearest))) / spacing + 0.5;
  const auto part = static_cast<std::size_t>(std::clamp(static_cast<int>(off * 6.0), 0, 5));
  const auto usual =
      std::min(static_cast<std::size_t>(largest_residual_[bone] * 2.0), std::size_t{5});
  const std::size_t which = usual * 6 + part;
  const bool negative = std::signbit(nearest);
  const std::int64_t expected = ordered(std::bit_cast<std::uint32_t>(nearest));
  std::int64_t residual = ordered(std::bit_cast<std::uint32_t>(x)) - expected;
  if (negative) residual = -residual;
  residual = code_residual(coder, largest_classes_[which], largest_signs_[which], residual);
  constexpr double kMany = 1000.0;
  const double size =
      residual == kEscape ? kMany : std::min(kMany, std::abs(static_cast<double>(residual)));
  largest_residual_[bone] += 0.1 * (size - largest_residual_[bone]);
  if (residual == kEscape)
    return std::bit_cast<float>(coder.raw(std::bit_cast<std::uint32_t>(x), 32));
  return std::bit_cast<float>(from_ordered(expected + (negative ? -residual : residual)));
}

// Classes: 0 to 7 themselves, then four to the octave; the bits below are raw.
template <class Coder>
std::int64_t LosslessModel::code_residual(Coder& coder, ClassTree& classes, AdaptiveBit& sign,
                                          std::int64_t residual) {
  const bool fits = residual >= -kLargestResidual && residual <= kLargestResidual;
  const auto size = static_cast<std::uint32_t>(fits ? std::abs(residual) : 0);
  std::uint32_t kind = fits ? size : kEscapeClass;
  if (fits && size >= kFineClasses) {
    const int octave = std::bit_width(size) - 4;
    kind = 8 + 4 * static_cast<std::uint32_t>(octave) + (size >> (octave + 1) & 3u);
  }
  kind = coder.tree(classes, kind);
  if (kind >= kEscapeClass) return kEscape;
  if (kind == 0) return 0;
  const bool negative = coder.bit(sign, residual < 0);
  std::int64_t coded = kind;
  if (kind >= kFineClasses) {
    const auto octave = static_cast<int>((kind - 8) / 4);
    const std::uint32_t low = coder.raw(size & ((2u << octave) - 1), octave + 1);
    coded = static_cast<std::int64_t>((4 + (kind - 8) % 4) << (octave + 1) | low);
  }
  return negative ? -coded : coded;
}

void LosslessOpening::restart() {
  presence_ = kAllBones;
  music_.fill(kNoMusicBits);
  presence_stays_ = AdaptiveBit();
  music_lengths_.fill(AdaptiveBit());
}

template <class Coder>
void LosslessOpening::code(Coder& coder, std::uint32_t& presence, std::uint64_t& music) {
  if (coder.bit(presence_stays_, presence == presence_))
    presence = presence_;
  else
    presence = presence_ = coder.raw(presence, 32);
  code_music(coder, music);
}

// Linear prediction of musical time. 64-bit arithmetic that wraps, so any bits are restored.
template <class Coder>
void LosslessOpening::code_music(Coder& coder, std::uint64_t& music) {
  std::uint64_t expected = music_[0];
  const auto last = std::bit_cast<double>(music_[0]);
  const auto before = std::bit_cast<double>(music_[1]);
  constexpr double kMostBeats = 1e15;
  if (std::abs(last) <= kMostBeats && std::abs(before) <= kMostBeats)
    expected = std::bit_cast<std::uint64_t>(last + (last - before));
  const std::uint64_t residual = ordered(music) - ordered(expected);
  const std::uint64_t zigzag = residual << 1 ^ (0 - (residual >> 63));
  const auto length =
      std::min(coder.tree(music_lengths_, static_cast<std::uint32_t>(std::bit_width(zigzag))), 64u);
  std::uint64_t coded = 0;
  if (length > 0) {
    const auto low = static_cast<int>(length - 1);
    const int low_half = std::min(low, 32);
    coded = std::uint64_t{1} << low;
    const std::uint64_t high_bits =
        coder.raw(static_cast<std::uint32_t>((zigzag & (coded - 1)) >> low_half), low - low_half);
    coded |= high_bits << low_half;
    const std::uint64_t low_mask = (std::uint64_t{1} << low_half) - 1;
    coded |= coder.raw(static_cast<std::uint32_t>(zigzag & low_mask), low_half);
  }
  const std::uint64_t coded_miss = coded >> 1 ^ (0 - (coded & 1));
  music = ordered(ordered(expected) + coded_miss);
  music_[1] = music_[0];
  music_[0] = music;
}

template void LosslessModel::code(BitEncoder&, LosslessFrame&);
template void LosslessModel::code(BitDecoder&, LosslessFrame&);
template void LosslessOpening::code(BitDecoder&, std::uint32_t&, std::uint64_t&);

}  // namespace dance
