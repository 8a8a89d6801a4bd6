#pragma once
// References as this rig sees them: taken now, and from the store.

#include "daemon/engine/job_run.h"
#include "daemon/measurement.h"

namespace gonio::daemon {

/// How this rig's pictures are seen now. Quality error without a lens map.
[[nodiscard]] Result<View> newestView(const JobRun& run);

/// Takes all states of what lies under the rig, which is dark afterwards.
[[nodiscard]] Result<Captured> captureReference(const JobRun& run,
                                                const View& view,
                                                const BracketPlan& plan,
                                                int darkFrames);

/// The newest of the store, as this view has it.
[[nodiscard]] Result<ReferenceRecord> storedReference(const JobRun& run,
                                                      const std::string& kind,
                                                      const View& view);

}  // namespace gonio::daemon
