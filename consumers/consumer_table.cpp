#include "consumers/consumer_table.h"

#include <array>

#include "consumers/text/bvh_consumer.h"
#include "consumers/text/csv_consumer.h"
#include "consumers/text/text_consumer.h"

namespace dance {
namespace {

constexpr double kBvhFrames_hz = 60.0;

using Make = std::unique_ptr<PoseConsumer> (*)(OutputFile&, const ConsumerOptions&);

struct Row {
  const char* name;
  Make make;
};

const std::array<Row, 3> kConsumers{{
    {"text",
     [](OutputFile& output, const ConsumerOptions& options) -> std::unique_ptr<PoseConsumer> {
       return std::make_unique<TextConsumer>(output, options.hz, options.own_clock_id);
     }},
    {"csv",
     [](OutputFile& output, const ConsumerOptions& options) -> std::unique_ptr<PoseConsumer> {
       return std::make_unique<CsvConsumer>(output, options.hz);
     }},
    {"bvh",
     [](OutputFile& output, const ConsumerOptions& options) -> std::unique_ptr<PoseConsumer> {
       return std::make_unique<BvhConsumer>(output, options.hz > 0.0 ? options.hz : kBvhFrames_hz,
                                            options.guest);
     }},
}};

}  // namespace

std::vector<std::string> consumer_names() {
  std::vector<std::string> names;
  names.reserve(kConsumers.size());
  for (const Row& row : kConsumers) names.emplace_back(row.name);
  return names;
}

Result<std::unique_ptr<PoseConsumer>> make_consumer(const std::string& name, OutputFile& output,
                                                    const ConsumerOptions& options) {
  std::string known;
  for (const Row& row : kConsumers) {
    if (name == row.name) return row.make(output, options);
    known += known.empty() ? row.name : std::string(", ") + row.name;
  }
  return fail("there is no consumer '" + name + "'; known are " + known);
}

}  // namespace dance
