// Models of prediction, as `dance predict train` writes them, for evaluations: a model must not be
// judged on dances that it was trained on.
//
// Units/frames: as transformers/predict/model/predict_model.h.
// Ownership:    models are shared.
// Threads:      none.
// Failure:      names the file, and what is wrong with it.
#pragma once

#include <memory>
#include <string>

#include "core/base/result.h"
#include "transformers/flow.h"
#include "transformers/predict/model/predict_model.h"

namespace dance {

Result<std::shared_ptr<const PredictModel>> read_predict_model_file(const std::string& path);

// What flows are made with: the built-in model where no file is named.
Result<FlowParts> parts_with_model(const std::string& path);

}  // namespace dance
