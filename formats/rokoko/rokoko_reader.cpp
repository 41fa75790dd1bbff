#include "formats/rokoko/rokoko_reader.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

namespace dance {
namespace {

using nlohmann::json;

constexpr std::size_t kDeepest = 16;
constexpr float kFarthest_m = 1000.0f;

// What the object or array that is open now is.
enum class Place : std::uint8_t {
  kOther,  // and all within
  kRoot,
  kScene,
  kActors,
  kActor,
  kColor,
  kMeta,
  kDimensions,
  kBody,
  kJoint,
  kPosition,
  kRotation,
};

Place place_in(Place outer, std::string_view key, bool is_array) {
  switch (outer) {
    case Place::kRoot:
      return key == "scene" && !is_array ? Place::kScene : Place::kOther;
    case Place::kScene:
      return key == "actors" && is_array ? Place::kActors : Place::kOther;
    case Place::kActors:
      return is_array ? Place::kOther : Place::kActor;
    case Place::kActor:
      if (is_array) return key == "color" ? Place::kColor : Place::kOther;
      if (key == "meta") return Place::kMeta;
      if (key == "dimensions") return Place::kDimensions;
      return key == "body" ? Place::kBody : Place::kOther;
    case Place::kBody:
      return is_array ? Place::kOther : Place::kJoint;
    case Place::kJoint:
      if (is_array) return Place::kOther;
      if (key == "position") return Place::kPosition;
      return key == "rotation" ? Place::kRotation : Place::kOther;
    default:
      return Place::kOther;
  }
}

// The events of nlohmann's reader; false ends it.
class Scene final : public nlohmann::json_sax<json> {
 public:
  explicit Scene(RokokoFrame& frame) : frame_(frame) { key_.reserve(64); }

  RokokoFault fault() const {
    if (fault_ != RokokoFault::kNone) return fault_;
    if (!is_version_3_) return RokokoFault::kOtherVersion;
    return has_actors_ && has_time_ ? RokokoFault::kNone : RokokoFault::kNoScene;
  }

  bool null() override { return true; }
  bool boolean(bool value) override {
    if (place() == Place::kMeta) meta(value);
    return true;
  }
  bool number_integer(number_integer_t value) override { return a_number(double(value)); }
  bool number_unsigned(number_unsigned_t value) override { return a_number(double(value)); }
  bool number_float(number_float_t value, const string_t&) override { return a_number(value); }
  bool string(string_t& text) override {
    if (place() == Place::kRoot && key_ == "version") is_version_3_ = text.starts_with("3");
    if (place() != Place::kActor || key_ != "name") return true;
    if (text.empty() || !actor_.name.assign(text)) return refuse(RokokoFault::kBadName);
    return true;
  }
  bool binary(binary_t&) override { return true; }
  bool key(string_t& text) override {
    key_ = text;
    return true;
  }
  bool start_object(std::size_t) override { return open(false); }
  bool start_array(std::size_t) override { return open(true); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
    return refuse(RokokoFault::kNotJson);
  }

 private:
  Place place() const { return depth_ == 0 ? Place::kOther : places_[depth_ - 1]; }
  bool refuse(RokokoFault fault) {
    if (fault_ == RokokoFault::kNone) fault_ = fault;
    return false;
  }

  bool open(bool is_array) {
    if (depth_ == kDeepest) return refuse(RokokoFault::kNotJson);
    const Place next =
        depth_ == 0 ? (is_array ? Place::kOther : Place::kRoot) : place_in(place(), key_, is_array);
    places_[depth_++] = next;
    if (next == Place::kActors) has_actors_ = true;
    if (next == Place::kActor) actor_ = RokokoActor();
    if (next == Place::kColor) colors_ = 0;
    if (next == Place::kJoint) {
      joint_ = find_rokoko_joint(key_);
      seen_ = 0;
      values_.fill(0.0f);
    }
    return true;
  }

  bool close() {
    const Place closed = place();
    if (depth_ > 0) --depth_;
    if (closed == Place::kJoint) take_joint();
    if (closed != Place::kActor) return true;
    if (actor_.name.empty()) return refuse(RokokoFault::kBadName);
    return frame_.actors.try_push(actor_) || refuse(RokokoFault::kTooManyActors);
  }

  bool a_number(double value) {
    const auto number = static_cast<float>(value);
    switch (place()) {
      case Place::kRoot:
        if (key_ == "version") is_version_3_ = value >= 3.0 && value < 4.0;
        if (key_ == "fps" && value > 0.0 && value <= 1000.0) frame_.fps = value;
        break;
      case Place::kScene:
        if (key_ != "timestamp" || !(std::abs(value) < 1e12)) break;
        frame_.timestamp_s = value;
        has_time_ = true;
        break;
      case Place::kColor:
        if (colors_ < actor_.color.size() && value >= 0.0 && value <= 255.0)
          actor_.color[colors_++] = static_cast<std::uint8_t>(value);
        break;
      case Place::kDimensions:
        if (!(value > 0.0 && value < 10.0)) break;
        if (key_ == "totalHeight") actor_.total_height_m = number;
        if (key_ == "hipHeight") actor_.hip_height_m = number;
        break;
      case Place::kPosition:
        set_value(0, number);
        break;
      case Place::kRotation:
        set_value(3, number);
        break;
      default:
        break;
    }
    return true;
  }

  void meta(bool value) {
    if (key_ == "hasBody") actor_.has_body = value;
    if (key_ == "hasFace") actor_.has_face = value;
    if (key_ == "hasLeftGlove") actor_.has_left_glove = value;
    if (key_ == "hasRightGlove") actor_.has_right_glove = value;
  }

  // x, y, z of a position, x, y, z, w of a rotation after it.
  void set_value(std::size_t first, float number) {
    if (key_.size() != 1) return;
    const std::size_t axis = std::string_view("xyzw").find(key_[0]);
    if (axis == std::string_view::npos || first + axis >= values_.size()) return;
    if (first == 0 && axis == 3) return;
    values_[first + axis] = number;
    seen_ |= 1u << (first + axis);
  }

  void take_joint() {
    constexpr unsigned kAll = 0x7f;
    if (!joint_ || seen_ != kAll) return;
    const Eigen::Vector3f position(values_[0], values_[1], values_[2]);
    const Eigen::Quaternionf rotation(values_[6], values_[3], values_[4], values_[5]);
    const float norm = rotation.squaredNorm();
    if (!position.allFinite() || !(position.cwiseAbs().maxCoeff() < kFarthest_m)) return;
    if (!(norm > 0.98f && norm < 1.02f)) return;
    actor_.joints[*joint_] = {position, rotation.normalized()};
    actor_.present[*joint_] = true;
  }

  RokokoFrame& frame_;
  RokokoActor actor_;
  RokokoFault fault_ = RokokoFault::kNone;
  std::array<Place, kDeepest> places_{};
  std::size_t depth_ = 0;
  std::string key_;
  bool is_version_3_ = false;
  bool has_actors_ = false;
  bool has_time_ = false;
  std::size_t colors_ = 0;
  std::optional<std::size_t> joint_;
  std::array<float, 7> values_{};
  unsigned seen_ = 0;
};

}  // namespace

const char* text_of(RokokoFault fault) {
  switch (fault) {
    case RokokoFault::kNone:
      return "read";
    case RokokoFault::kNotLz4:
      return "damaged LZ4";
    case RokokoFault::kNotJson:
      return "no JSON";
    case RokokoFault::kOtherVersion:
      return "not JSON v3";
    case RokokoFault::kNoScene:
      return "no scene";
    case RokokoFault::kTooManyActors:
      return "too many actors";
    case RokokoFault::kBadName:
      return "an actor without a usable name";
  }
  return "";
}

RokokoFault RokokoReader::read(std::span<const std::uint8_t> datagram) {
  frame_->actors.clear();
  frame_->fps = 60.0;
  frame_->timestamp_s = 0.0;
  std::string_view text(reinterpret_cast<const char*>(datagram.data()), datagram.size());
  if (begins_as_lz4_frame(datagram)) {
    const auto unpacked = unpacker_.unpack(datagram);
    if (!unpacked) return RokokoFault::kNotLz4;
    text = *unpacked;
  }
  Scene scene(*frame_);
  const bool is_read = json::sax_parse(text.begin(), text.end(), &scene);
  const RokokoFault fault = scene.fault();
  if (!is_read && fault == RokokoFault::kNone) return RokokoFault::kNotJson;
  return fault;
}

}  // namespace dance
