#include "consumers/consumer_table.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "consumers/engine/engine_consumer.h"
#include "consumers/files/glb_consumer.h"
#include "consumers/files/kept_take.h"
#include "consumers/mcap/mcap_consumer.h"
#include "consumers/rate_limit.h"
#include "consumers/rokoko/rokoko_consumer.h"
#include "consumers/text/bvh_consumer.h"
#include "consumers/text/csv_consumer.h"
#include "consumers/text/text_consumer.h"
#include "consumers/vmc/vmc_consumer.h"
#include "consumers/vrchat/vrchat_consumer.h"
#include "core/net/clock/recording_clock.h"
#include "core/net/mono_clock.h"

namespace dance {
namespace {

constexpr double kClipFrames_hz = 60.0;

using Made = Result<std::unique_ptr<PoseConsumer>>;

struct Row {
  ConsumerKind kind;
  Made (*make)(const ConsumerOptions&);
};

// A row for a consumer that is made of its file and the options.
template <class Consumer, class... Arguments>
Made on_file(const ConsumerOptions& options, Arguments&&... arguments) {
  DANCE_TRY(auto output, OutputFile::open(options.file));
  return std::make_unique<Consumer>(std::shared_ptr<OutputFile>(std::move(output)),
                                    std::forward<Arguments>(arguments)...);
}

// A device or a pipe (/dev/null) has no folder for a log beside it.
bool has_place_beside(const std::string& path) {
  std::error_code ignored;
  const auto kind = std::filesystem::symlink_status(path, ignored).type();
  return kind == std::filesystem::file_type::not_found ||
         kind == std::filesystem::file_type::regular || kind == std::filesystem::file_type::symlink;
}

// Like on_file(), for a format that can only be written when the recording ends.
template <class Consumer>
Made on_take(const ConsumerOptions& options) {
  const bool is_file =
      !options.file.empty() && options.file != "-" && has_place_beside(options.file);
  if (is_file)
    if (auto checked = KeptTake::check(options.file); !checked)
      return tl::make_unexpected(checked.error());
  DANCE_TRY(
      auto consumer,
      on_file<Consumer>(options, options.hz > 0.0 ? options.hz : kClipFrames_hz, options.guest));
  if (!is_file) return consumer;
  return KeptTake::make(std::move(consumer), options.file, options.guest);
}

Made make_text(const ConsumerOptions& options) {
  return on_file<TextConsumer>(options, options.hz, options.own_clock_id);
}

Made make_csv(const ConsumerOptions& options) { return on_file<CsvConsumer>(options, options.hz); }

Made make_bvh(const ConsumerOptions& options) { return on_take<BvhConsumer>(options); }

Made make_glb(const ConsumerOptions& options) { return on_take<GlbConsumer>(options); }

Made make_mcap(const ConsumerOptions& options) {
  return on_file<McapConsumer>(options, options.hz, RecordingClock().wall_ahead());
}

Made make_engine(const ConsumerOptions& options) {
  return EngineConsumer::open(options.name, options.hz, options.own_clock_id, mono_now());
}

Made make_rokoko(const ConsumerOptions& options) {
  const bool is_plain = options.dialect == "json";
  return RokokoConsumer::open(
      {options.address, is_plain ? RokokoConsumer::Dialect::kJson : RokokoConsumer::Dialect::kLz4,
       options.hz, options.own_clock_id});
}

const std::vector<Row>& rows() {
  using enum OutputKind;
  static const std::vector<Row> kRows{
      {{"text", kFile, "", {}}, make_text},
      {{"csv", kFile, "", {}}, make_csv},
      {{"bvh", kFile, "", {}}, make_bvh},
      {{"glb", kFile, "", {}}, make_glb},
      {{"mcap", kFile, "", {}}, make_mcap},
      {{"engine", kMemory, EngineConsumer::kUsualName, {}}, make_engine},
      {{"vmc", kAddress, VmcConsumer::kUsualAddress, {"vrm0", "vrm1"}}, VmcConsumer::open},
      {{"vrchat", kAddress, VrchatConsumer::kUsualAddress, {}}, VrchatConsumer::open},
      {{"rokoko", kAddress, RokokoConsumer::kUsualAddress, {"lz4", "json"}}, make_rokoko},
  };
  return kRows;
}

const Row* find_row(const std::string& name) {
  const auto row = std::find_if(rows().begin(), rows().end(),
                                [&](const Row& each) { return each.kind.name == name; });
  return row == rows().end() ? nullptr : &*row;
}

std::string listed(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) list += list.empty() ? word : ", " + word;
  return list;
}

const char* what_it_takes(OutputKind kind) {
  switch (kind) {
    case OutputKind::kFile:
      return "a file";
    case OutputKind::kAddress:
      return "an address, as 127.0.0.1:39539";
    case OutputKind::kMemory:
      return "a name for its memory";
  }
  return "";
}

}  // namespace

std::vector<std::string> consumer_names() {
  std::vector<std::string> names;
  for (const Row& row : rows()) names.push_back(row.kind.name);
  return names;
}

const ConsumerKind* find_consumer_kind(const std::string& name) {
  const Row* row = find_row(name);
  return row ? &row->kind : nullptr;
}

Result<void> check_consumer_options(const ConsumerKind& kind, const ConsumerOptions& options) {
  const auto misplaced = [&](const std::string& value, OutputKind wanted, const char* what) {
    return !value.empty() && kind.output != wanted ? std::string(what) : std::string();
  };
  for (const std::string& given : {misplaced(options.file, OutputKind::kFile, "a file"),
                                   misplaced(options.address, OutputKind::kAddress, "an address"),
                                   misplaced(options.name, OutputKind::kMemory, "a name")})
    if (!given.empty())
      return fail("'" + kind.name + "' takes " + what_it_takes(kind.output) + ", not " + given);
  if (auto rate = check_rate(options.hz); !rate) return rate;
  if (options.dialect.empty() ||
      std::find(kind.dialects.begin(), kind.dialects.end(), options.dialect) != kind.dialects.end())
    return {};
  if (kind.dialects.empty()) return fail("'" + kind.name + "' has no dialects");
  return fail("'" + kind.name + "' has no dialect '" + options.dialect + "'; it has " +
              listed(kind.dialects));
}

Result<std::unique_ptr<PoseConsumer>> make_consumer(const std::string& name,
                                                    const ConsumerOptions& options) {
  const Row* row = find_row(name);
  if (!row)
    return fail("there is no consumer '" + name + "'; known are " + listed(consumer_names()));
  if (auto checked = check_consumer_options(row->kind, options); !checked)
    return tl::make_unexpected(checked.error());
  return row->make(options);
}

}  // namespace dance
