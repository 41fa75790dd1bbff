#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

#include "core/program/figures.h"
#include "research/capture/capture_eval.h"

namespace dance {
namespace {

nlohmann::json point_json(const Eigen::Vector3f& p, double scale) {
  return {rounded(p.x(), scale), rounded(p.y(), scale), rounded(p.z(), scale)};
}

nlohmann::json hand_json(const HandLandmarks& hand) {
  nlohmann::json image = nlohmann::json::array(), world = nlohmann::json::array();
  for (std::size_t i = 0; i < kHandPointCount; ++i) {
    image.push_back(point_json(hand.image_px[i], 1e3));
    world.push_back(point_json(hand.world_m[i], 1e6));
  }
  return {{"presence", rounded(hand.presence, 1e5)},
          {"region_side_px", rounded(hand.region.side_px, 1e3)},
          {"landmarks_px", std::move(image)},
          {"world_m", std::move(world)}};
}

nlohmann::json face_json(const FaceLandmarks& face) {
  nlohmann::json image = nlohmann::json::array();
  for (const Eigen::Vector3f& p : face.image_px) image.push_back(point_json(p, 1e3));
  return {{"presence", rounded(face.presence, 1e5)},
          {"region_side_px", rounded(face.region.side_px, 1e3)},
          {"landmarks_px", std::move(image)}};
}

nlohmann::json person_json(const CapturedPerson& person) {
  nlohmann::json image = nlohmann::json::array(), world = nlohmann::json::array();
  const BodyLandmarks& body = person.body;
  for (std::size_t i = 0; body.found && i < kLandmarkCount; ++i) {
    const Eigen::Vector3f& p = body.image_px[i];
    const Eigen::Vector3f& w = body.world_m[i];
    image.push_back({rounded(p.x(), 1e3), rounded(p.y(), 1e3), rounded(p.z(), 1e3),
                     rounded(body.visibility[i], 1e5)});
    world.push_back({rounded(w.x(), 1e6), rounded(w.y(), 1e6), rounded(w.z(), 1e6)});
  }
  nlohmann::json hands = nlohmann::json::object();
  for (std::size_t side = 0; side < 2; ++side)
    if (person.hands[side].found)
      hands[side == 0 ? "left" : "right"] = hand_json(person.hands[side]);
  return {{"detected", body.found},
          {"region_side_px", rounded(body.found ? body.region.side_px : 0.0, 1e3)},
          {"landmarks_px", std::move(image)},
          {"world_m", std::move(world)},
          {"hands", std::move(hands)},
          {"face", person.face.found ? face_json(person.face) : nlohmann::json()}};
}

nlohmann::json frame_json(const EvaluatedFrame& frame) {
  nlohmann::json json;
  if (frame.people.size() == 1) {
    json = person_json(frame.people[0]);
  } else {
    json["people"] = nlohmann::json::array();
    for (const CapturedPerson& person : frame.people) json["people"].push_back(person_json(person));
  }
  json["name"] = frame.name;
  return json;
}

// How many of something the frames have together.
template <class Count>
std::size_t total(const CaptureRun& run, const Count& count) {
  std::size_t sum = 0;
  for (const EvaluatedFrame& frame : run.frames)
    for (const CapturedPerson& person : frame.people)
      sum += static_cast<std::size_t>(count(person));
  return sum;
}

double per(double sum, std::size_t count) {
  return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

void print_several(const CaptureRun& run, std::size_t people,
                   std::back_insert_iterator<std::string> out) {
  const std::size_t frames = run.frames.size();
  fmt::format_to(out, "{:>7} frames", frames);
  for (std::size_t i = 0; i < people; ++i) {
    std::size_t found = 0;
    for (const EvaluatedFrame& frame : run.frames) found += frame.people[i].body.found ? 1 : 0;
    fmt::format_to(out, ", {} with dancer {} ({:.1f} %)", found, i + 1,
                   100.0 * per(static_cast<double>(found), frames));
  }
  const PeopleCounters& c = run.of_several;
  fmt::format_to(out,
                 "\n{:>7} searches of the whole picture, {} reads of regions, {} exchanged, {} on "
                 "one body, {} limbs given to the other\n\n",
                 c.searches, c.reads, c.exchanged, c.duplicates, c.limbs_hidden);
}

}  // namespace

std::string capture_eval_json(const CaptureRun& run) {
  nlohmann::json frames = nlohmann::json::array();
  for (const EvaluatedFrame& frame : run.frames) frames.push_back(frame_json(frame));
  nlohmann::json out{{"frames", std::move(frames)},
                     {"ms_per_frame", rounded(per(run.ms, run.frames.size()), 1e3)}};
  if (run.engines.regions > 0)
    out["engines"] = {{"first", name_of(run.engines.first)},
                      {"second", name_of(run.engines.second)},
                      {"regions", run.engines.regions},
                      {"first_ms", rounded(per(run.engines.first_ms, run.engines.regions), 1e3)},
                      {"second_ms", rounded(per(run.engines.second_ms, run.engines.regions), 1e3)},
                      {"worst_point_px", run.engines.worst_point_px},
                      {"worst_world_m", run.engines.worst_world_m}};
  return out.dump() + "\n";
}

std::string capture_eval_table(const CaptureRun& run, const CaptureEvalOptions& options) {
  const EstimatorCounters& c = run.counters;
  const std::size_t frames = run.frames.size();
  std::string text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "model {}, engine {}, one thread\n", name_of(options.estimator.model),
                 name_of(options.estimator.engine));
  if (options.people == 1) {
    fmt::format_to(out, "{:>7} frames, {} with a dancer ({:.1f} %)\n", frames, c.found,
                   100.0 * per(static_cast<double>(c.found), frames));
    fmt::format_to(out,
                   "{:>7} searches of the whole picture, {} looks for others, {} losses ({} "
                   "jumps), {} exchanged\n\n",
                   c.searches, c.looks, c.losses, c.refused, c.exchanged);
  } else {
    print_several(run, options.people, out);
  }
  fmt::format_to(out, "  processor time          ms a frame   ms each time\n");
  const auto line = [&](const char* what, double ms, std::size_t times) {
    fmt::format_to(out, "  {:<22} {:>11.2f} {:>14.2f}\n", what, per(ms, frames), per(ms, times));
  };
  const EstimatorTimes& t = run.times;
  line("read the file", run.decode_ms, frames);
  if (options.people == 1) {
    line("search", static_cast<double>(t.search_ns) * 1e-6, c.searches + c.looks);
    line("take the region", static_cast<double>(t.region_ns) * 1e-6, frames);
    line("network", static_cast<double>(t.network_ns) * 1e-6, frames);
    line("points, smoothing", static_cast<double>(t.rest_ns) * 1e-6, frames);
  }
  line("picture to points", run.ms, frames);
  if (run.hands_ms > 0.0) {
    const std::size_t seen =
        total(run, [](const CapturedPerson& p) { return p.hands[0].found + p.hands[1].found; });
    line("hands, both", run.hands_ms, frames);
    fmt::format_to(out, "  {} hands seen, {:.2f} a frame\n", seen,
                   per(static_cast<double>(seen), frames));
  }
  if (run.face_ms > 0.0) {
    const std::size_t seen = total(run, [](const CapturedPerson& p) { return p.face.found; });
    line("face", run.face_ms, frames);
    fmt::format_to(out, "  {} faces seen, {:.2f} a frame\n", seen,
                   per(static_cast<double>(seen), frames));
  }
  if (const HandFigures& h = run.hands; h.hands > 0) {
    fmt::format_to(out,
                   "  of the last video, with palms beside the body's points alone:\n"
                   "  wrists tremble by {:.2f} deg beside {:.2f}, are {:.1f} deg from the palms "
                   "that are seen beside {:.1f}; fingers tremble by {:.2f} deg\n",
                   h.palm_tremble_deg, h.solver_tremble_deg, h.palm_off_deg, h.solver_off_deg,
                   h.finger_tremble_deg);
  }
  if (const HandFigures& h = run.hands; h.faces > 0)
    fmt::format_to(out,
                   "  a face of the last video: {:.1f} bytes, {:.1f} expressions shown, a weight "
                   "changes by {:.4f} from picture to picture; the head is {:.1f} deg from the "
                   "body's\n",
                   h.face_bytes, h.shown, h.face_change, h.head_off_deg);
  const EngineComparison& e = run.engines;
  if (e.regions > 0) {
    fmt::format_to(out, "\n  the network on the same {} regions\n", e.regions);
    fmt::format_to(out, "  {:<22} {:>26.2f}\n", name_of(e.first), per(e.first_ms, e.regions));
    fmt::format_to(out, "  {:<22} {:>26.2f}\n", name_of(e.second), per(e.second_ms, e.regions));
    fmt::format_to(out, "  ratio {:.2f}; worst difference {:.5f} px of 256, {:.6f} m\n",
                   e.second_ms / e.first_ms, e.worst_point_px, e.worst_world_m);
  }
  return text;
}

}  // namespace dance
