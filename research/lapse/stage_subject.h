// StageSubject: what is asked sixty times a second for the pose to show, so that evaluations can
// compare transformers with what is shown without them.
//
// Units/frames: as transformers/flow.h; capture times and `now` are of one clock.
// Ownership:    its maker owns it.
// Threads:      none inside.
// Failure:      sample() is false while there is nothing to show.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "core/pose/pose.h"
#include "core/pose/skeleton.h"
#include "transformers/flow.h"

namespace dance {

class StageSubject {
 public:
  virtual ~StageSubject() = default;
  virtual void observe(const Pose& pose, MonoTime now) = 0;
  virtual bool sample(MonoTime now, Pose& out) = 0;
};
using MakeSubject = std::function<std::unique_ptr<StageSubject>(const Skeleton& skeleton)>;

// Shows the newest pose that came.
MakeSubject newest_subject();
// Goes on from the newest pose as it moved over its last six frames, ever slower: x + v tau (1 -
// exp(-h / tau)), with tau
// 0.1 s. With a half-life, corrections are inertialised.
MakeSubject damped_velocity_subject(Duration half_life = Duration());
// Continuation (transformers/conceal/continuation.h) from the first missing pose on, with a Finish:
// no prediction before it.
MakeSubject continuation_subject();
// A flow (transformers/flow.h), whose words must be right.
MakeSubject flow_subject(const std::vector<std::string>& through, const FlowParts& parts = {});

// What an evaluation compares, and adding to it the flows that a command line names; the first that
// cannot be made is an error. One without words shows what comes, and is left out.
using NamedSubjects = std::vector<std::pair<std::string, MakeSubject>>;
Result<void> add_flow_subjects(const std::vector<std::string>& flows, NamedSubjects& subjects,
                               const FlowParts& parts = {});

// "predict lead=1,bridge": the words of a flow as one word of a command line.
std::vector<std::string> words_of(std::string_view text);

}  // namespace dance
