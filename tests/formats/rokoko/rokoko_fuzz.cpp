// libFuzzer target: any bytes as a datagram of Rokoko Studio, LZ4 included; what is read is written
// and read again.
#include <cstddef>
#include <cstdint>

#include "core/base/assert.h"
#include "formats/rokoko/rokoko_reader.h"
#include "formats/rokoko/rokoko_writer.h"
#include "producers/rokoko/rokoko_body.h"
#include "tests/fuzz_target.h"

DANCE_FUZZ_TARGET(rokoko) {
  static dance::RokokoReader reader, again;
  static dance::RokokoWriter writer;
  if (reader.read({data, size}) != dance::RokokoFault::kNone) return 0;
  const auto& frame = reader.frame();
  for (const auto& actor : frame.actors) {
    for (std::size_t j = 0; j < dance::kRokokoJointCount; ++j)
      DANCE_ASSERT(!actor.present[j] || actor.joints[j].position.allFinite());
    dance::JointFigure figure;
    dance::Pose pose;
    dance::Hands hands;
    const dance::FigureFrame frame_of_figure = dance::figure_of(actor);
    if (!figure.fit(frame_of_figure, pose)) continue;
    // The receiver checks them in its one place; here they must only not be worse than that.
    dance::is_valid(pose);
    if (dance::hands_of(actor, frame_of_figure, hands)) DANCE_ASSERT(dance::is_valid(hands));
  }
  const auto written =
      writer.write(frame, frame.actors.size(), dance::RokokoWriter::kMostTextBytes);
  DANCE_ASSERT(written.actors == frame.actors.size());
  const auto fault =
      again.read({reinterpret_cast<const std::uint8_t*>(written.text.data()), written.text.size()});
  // A name of nothing but quotation marks is not written.
  DANCE_ASSERT(fault == dance::RokokoFault::kNone || fault == dance::RokokoFault::kBadName);
  return 0;
}
