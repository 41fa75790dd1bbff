// A model of prediction as a stranger would hand it over: what is let through predicts finite
// poses.
#include <algorithm>
#include <memory>

#include "core/base/assert.h"
#include "tests/fuzz_target.h"
#include "transformers/predict/dance_predictor.h"

DANCE_FUZZ_TARGET(predict_model) {
  // The input stands in for the beginning of a whole file: header, weights, dancers. Of 550 kB no
  // mutation would be whole.
  static const std::vector<std::uint8_t> kWhole =
      dance::write_predict_model(*dance::built_in_predict_model());
  const auto alone = dance::read_predict_model({data, size});
  std::vector<std::uint8_t> file = kWhole;
  std::copy_n(data, std::min(size, file.size()), file.begin());
  const auto model = dance::read_predict_model(file);
  if (!model) return 0;
  dance::DancePredictor predictor(*model);
  dance::Pose pose, out;
  for (int i = 0; i < 40; ++i) {
    pose.capture_time = dance::MonoTime::from_us(1'000'000 + 16'667 * i);
    pose.p_WH_m.x() = 0.01f * static_cast<float>(i);
    predictor.observe(pose);
  }
  predictor.predict(pose.capture_time + dance::Duration::ms(300), out);
  DANCE_ASSERT(dance::is_valid(out));
  return 0;
}
