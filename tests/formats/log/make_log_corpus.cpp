// Writes logs to damage: `make_log_corpus tests/formats/log/corpus` from the root of the tree. With
// a second word, how many frames, one packed log of that name instead: golden/version_1.lcm was
// made so, and stays.
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "formats/log/log_packer.h"
#include "tests/formats/log/recorded_dance.h"

namespace dance {
namespace {

bool write_log(const std::string& path, const OwnEvents& events) {
  auto writer = LogWriter::create(path);
  if (!writer) {
    std::fprintf(stderr, "%s\n", writer.error().what.c_str());
    return false;
  }
  for (const OwnEvent& event : events)
    if (!writer->append(event.event())) return false;
  std::printf("%s: %zu events\n", path.c_str(), events.size());
  return static_cast<bool>(writer->flush());
}

OwnEvents packed(const OwnEvents& events) {
  LogPacker packer;
  OwnEvents all;
  for (const OwnEvent& event : events) all.emplace_back(packer.pack(event.event()));
  return all;
}

bool write_corpus(const std::string& folder) {
  std::filesystem::create_directories(folder);
  const OwnEvents short_dance = recorded_evening(3);
  OwnEvents slow = recorded_evening(4);
  for (std::size_t i = 0; i < slow.size(); ++i)
    slow[i].time_us += static_cast<std::int64_t>(i / 6) * 6'000'000;
  OwnEvents newer = packed(short_dance);
  for (OwnEvent& event : newer)
    if (event.channel.starts_with("PACKED/")) event.data[3] = 2;
  OwnEvents joined = packed(short_dance);
  joined.insert(joined.end(), short_dance.begin(), short_dance.end());
  return write_log(folder + "/packed.lcm", packed(short_dance)) &&
         write_log(folder + "/plain.lcm", short_dance) &&
         write_log(folder + "/key-frames.lcm", packed(slow)) &&
         write_log(folder + "/packed-twice.lcm", packed(packed(recorded_evening(2)))) &&
         write_log(folder + "/newer.lcm", newer) && write_log(folder + "/joined.lcm", joined);
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  if (argc == 2) return dance::write_corpus(argv[1]) ? 0 : 1;
  if (argc == 3) {
    const auto frames = static_cast<std::uint32_t>(std::strtoul(argv[2], nullptr, 10));
    return dance::write_log(argv[1], dance::packed(dance::recorded_evening(frames))) ? 0 : 1;
  }
  std::fprintf(stderr, "make_log_corpus: name the folder of the corpus\n");
  return 2;
}
