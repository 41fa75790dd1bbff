#include "house/session_producers.h"

#include <fmt/ranges.h>

#include <charconv>

namespace dance {
namespace {

constexpr double kLeastHeight_m = 0.8, kMostHeight_m = 2.5;  // of a dancer

// A file's name is taken from the folder of the session file; what a camera is called stays as it
// is: "auto", "1", "HD Webcam".
std::string device_from(const std::filesystem::path& folder, const std::string& device) {
  const std::filesystem::path path = device;
  if (path.is_absolute()) return device;
  std::error_code error;
  const bool is_file = path.has_parent_path() || path.has_extension() ||
                       std::filesystem::exists(folder / path, error);
  return is_file && !device.empty() ? (folder / path).string() : device;
}

// "bob", or "bob=1.80" with the height in metres.
HostedCamera::Partner read_partner(TomlReader& reader, const std::string& text) {
  HostedCamera::Partner partner;
  const std::size_t mark = text.find('=');
  partner.guest = read_guest(reader, "partners", text.substr(0, mark));
  if (mark == std::string::npos) return partner;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data() + mark + 1, end, partner.height_m);
  if (error != std::errc() || rest != end ||
      !(partner.height_m >= kLeastHeight_m && partner.height_m <= kMostHeight_m))
    reader.complain("partners", "a height is in metres, from 0.8 to 2.5, as \"bob=1.80\"");
  return partner;
}

void read_camera(TomlReader& reader, const std::filesystem::path& folder, HouseConfig& session) {
  HostedCamera camera;
  camera.guest = read_guest(reader, "guest", reader.required_string("guest"));
  camera.device = device_from(folder, reader.string_or("device", ""));
  camera.also = device_from(folder, reader.string_or("also", ""));
  camera.model = reader.string_or("model", "");
  if (!camera.model.empty() && camera.model != "lite" && camera.model != "full" &&
      camera.model != "heavy")
    reader.complain("model", "is lite, full or heavy");
  if (const auto file = reader.maybe_string("calibration"))
    camera.calibration = (folder / *file).string();
  for (const std::string& partner : reader.strings("partners", "[\"bob\", \"carol=1.65\"]"))
    camera.partners.push_back(read_partner(reader, partner));
  if (camera.partners.size() > HostedCamera::kMostPartners)
    reader.complain("partners", "one camera sees four dancers at most");
  camera.height_m = reader.number_or("height", 0.0, 0.0, kMostHeight_m);
  if (camera.height_m != 0.0 && camera.height_m < kLeastHeight_m)
    reader.complain("height", "is the dancer's, in metres, from 0.8 to 2.5");
  camera.mirror = reader.bool_or("mirror", false);
  camera.hands = reader.bool_or("hands", true);
  camera.face = reader.bool_or("face", false);
  if (!camera.partners.empty() && !camera.also.empty())
    reader.complain("also", "sees one dancer; leave out partners");
  reader.finish();
  session.cameras.push_back(camera);
}

void read_receiver(TomlReader& reader, const std::string& kind, HouseConfig& session) {
  HostedReceiver receiver;
  receiver.from = kind;
  ReceiverOptions& options = receiver.options;
  options.guest = read_guest(reader, "guest", reader.required_string("guest"));
  options.listen = reader.string_or("listen", "");
  options.name = reader.string_or("name", "");
  options.actor = reader.string_or("actor", "");
  if (const auto checked = check_receiver_options(*find_receiver_kind(kind), options); !checked)
    reader.complain("kind", checked.error().what);
  reader.finish();
  session.receivers.push_back(receiver);
}

}  // namespace

void read_producer(TomlReader& reader, const std::filesystem::path& folder, HouseConfig& session) {
  HostedProducer producer;
  const std::string kind = reader.required_string("kind");
  if (kind == "camera") return read_camera(reader, folder, session);
  if (kind == "headset") return session.headsets.push_back(read_headset(reader));
  if (find_receiver_kind(kind)) return read_receiver(reader, kind, session);
  producer.guest = read_guest(reader, "guest", reader.required_string("guest"));
  producer.rate_hz = reader.number_or("rate", 60.0, 1.0, 1000.0);
  if (kind == "salsa") {
    producer.kind = HostedProducer::Kind::kSalsa;
    producer.role = reader.string_or("role", "any");
    if (producer.role != "any" && producer.role != "lead" && producer.role != "follow")
      reader.complain("role", "is any, lead or follow");
    producer.tempo_bpm = reader.number_or("tempo", 180.0, 60.0, 300.0);
    producer.seed = reader.integer_or("seed", 1, 0, 1'000'000'000);
  } else if (kind == "replay") {
    producer.kind = HostedProducer::Kind::kReplay;
    producer.file = (folder / reader.required_string("file")).string();
    producer.dancer = reader.string_or("dancer", "");
    producer.speed = reader.number_or("speed", 1.0, 0.05, 20.0);
  } else {
    reader.complain("kind", fmt::format("is camera, headset, salsa, replay, {}",
                                        fmt::join(receiver_names(), ", ")));
  }
  reader.finish();
  session.producers.push_back(producer);
}

}  // namespace dance
