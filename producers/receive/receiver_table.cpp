#include "producers/receive/receiver_table.h"

#include <algorithm>

#include "producers/engine/engine_receiver.h"
#include "producers/natnet/natnet_receiver.h"
#include "producers/rokoko/rokoko_receiver.h"
#include "producers/vmc/vmc_receiver.h"

namespace dance {
namespace {

using Opened = Result<std::unique_ptr<PoseReceiver>>;

struct Row {
  ReceiverKind kind;
  Opened (*open)(const ReceiverOptions&, CaptureSink&, Poller&);
};

const std::vector<Row>& rows() {
  static const std::vector<Row> kRows{
      {{"vmc", InputKind::kAddress, VmcReceiver::kUsualAddress, false}, VmcReceiver::open},
      {{"engine", InputKind::kMemory, EngineReceiver::kUsualName, false},
       [](const ReceiverOptions& options, CaptureSink& sink, Poller& poller) -> Opened {
         return EngineReceiver::open(options.name, options.guest, sink, poller);
       }},
      {{"natnet", InputKind::kAddress, kUsualNatNetPlace, true},
       [](const ReceiverOptions& options, CaptureSink& sink, Poller& poller) -> Opened {
         return NatNetReceiver::open({options.guest, options.listen, options.actor}, sink, poller);
       }},
      {{"rokoko", InputKind::kAddress, RokokoReceiver::kUsualAddress, true},
       [](const ReceiverOptions& options, CaptureSink& sink, Poller& poller) -> Opened {
         return RokokoReceiver::open({options.guest, options.listen, options.actor}, sink, poller);
       }},
  };
  return kRows;
}

const Row* find_row(const std::string& name) {
  const auto row = std::find_if(rows().begin(), rows().end(),
                                [&](const Row& each) { return each.kind.name == name; });
  return row == rows().end() ? nullptr : &*row;
}

}  // namespace

std::vector<std::string> receiver_names() {
  std::vector<std::string> names;
  for (const Row& row : rows()) names.push_back(row.kind.name);
  return names;
}

const ReceiverKind* find_receiver_kind(const std::string& name) {
  const Row* row = find_row(name);
  return row ? &row->kind : nullptr;
}

Result<void> check_receiver_options(const ReceiverKind& kind, const ReceiverOptions& options) {
  if (!options.listen.empty() && kind.input != InputKind::kAddress)
    return fail("'" + kind.name + "' has a name, not an address to listen at");
  if (!options.name.empty() && kind.input != InputKind::kMemory)
    return fail("'" + kind.name + "' listens at an address, as 0.0.0.0:39539; it has no name");
  if (!options.actor.empty() && !kind.has_actors)
    return fail("'" + kind.name + "' carries one dancer; leave the actor out");
  return {};
}

Result<std::unique_ptr<PoseReceiver>> open_receiver(const std::string& from,
                                                    const ReceiverOptions& options,
                                                    CaptureSink& sink, Poller& poller) {
  const Row* row = find_row(from);
  if (!row) {
    std::string known;
    for (const std::string& name : receiver_names()) known += known.empty() ? name : ", " + name;
    return fail("there is no receiver '" + from + "'; known are " + known);
  }
  if (auto checked = check_receiver_options(row->kind, options); !checked)
    return tl::make_unexpected(checked.error());
  return row->open(options, sink, poller);
}

}  // namespace dance
