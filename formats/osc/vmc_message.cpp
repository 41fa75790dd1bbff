#include "formats/osc/vmc_message.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/pose/pose.h"
#include "formats/osc/unity_axes.h"

namespace dance {
namespace {

using Kind = VmcMessage::Kind;

// Rounded to few digits a rotation is still one; anything else is no rotation.
constexpr float kLeastNorm = 0.9f;
constexpr float kMostNorm = 1.1f;

std::optional<float> float_at(const OscMessage& message, std::size_t i) {
  if (i >= message.arguments.size() || message.arguments[i].kind != OscArgument::Kind::kFloat ||
      !std::isfinite(message.arguments[i].real))
    return std::nullopt;
  return message.arguments[i].real;
}

bool has_text(const OscMessage& message) {
  return !message.arguments.empty() && message.arguments[0].kind == OscArgument::Kind::kText;
}

bool has_doubles(const OscMessage& message) {
  return std::any_of(message.arguments.begin(), message.arguments.end(), [](const auto& argument) {
    return argument.kind == OscArgument::Kind::kDouble;
  });
}

// (string){name} (float){p.x} {p.y} {p.z} {q.x} {q.y} {q.z} {q.w}
bool read_transform(const OscMessage& message, VmcMessage& parsed) {
  if (!has_text(message)) return false;
  float values[7];
  for (std::size_t i = 0; i < 7; ++i) {
    const auto value = float_at(message, 1 + i);
    if (!value) return false;
    values[i] = *value;
  }
  const Eigen::Vector3f p_m(values[0], values[1], values[2]);
  const Eigen::Quaternionf R(values[6], values[3], values[4], values[5]);
  const float norm = R.norm();
  if (!(norm >= kLeastNorm && norm <= kMostNorm)) return false;
  if (!(p_m.cwiseAbs().maxCoeff() <= kMaxStageDistance_m)) return false;
  parsed.name = message.arguments[0].text;
  parsed.p_m = other_hand(p_m);
  parsed.R = other_hand(R).normalized();
  return true;
}

bool read_available(const OscMessage& message, VmcMessage& parsed) {
  if (message.arguments.empty() || message.arguments[0].kind != OscArgument::Kind::kInt)
    return false;
  parsed.is_loaded = message.arguments[0].number != 0;
  return true;
}

bool read_time(const OscMessage& message, VmcMessage& parsed) {
  const auto time_s = float_at(message, 0);
  if (time_s) parsed.time_s = *time_s;
  return time_s.has_value();
}

bool read_blend(const OscMessage& message, VmcMessage& parsed) {
  const auto value = float_at(message, 1);
  if (!has_text(message) || !value) return false;
  parsed.name = message.arguments[0].text;
  parsed.value = *value;
  return true;
}

}  // namespace

VmcMessage parse_vmc(const OscMessage& message) {
  VmcMessage parsed;
  const auto as = [&](Kind kind, bool (*read)(const OscMessage&, VmcMessage&)) {
    parsed.kind = read(message, parsed) ? kind : Kind::kMalformed;
    if (parsed.kind == Kind::kMalformed) parsed.has_doubles = has_doubles(message);
    return parsed;
  };
  // Most are bones.
  if (message.address == "/VMC/Ext/Bone/Pos") return as(Kind::kBone, read_transform);
  if (message.address == "/VMC/Ext/Blend/Val") return as(Kind::kBlend, read_blend);
  if (message.address == "/VMC/Ext/Root/Pos") return as(Kind::kRoot, read_transform);
  if (message.address == "/VMC/Ext/T") return as(Kind::kTime, read_time);
  if (message.address == "/VMC/Ext/OK") return as(Kind::kAvailable, read_available);
  if (message.address == "/VMC/Ext/Blend/Apply") parsed.kind = Kind::kBlendApply;
  return parsed;
}

}  // namespace dance
