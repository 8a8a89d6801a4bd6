#include "daemon/engine/reference_capture.h"

namespace gonio::daemon {

Result<View> newestView(const JobRun& run) {
    const Result<CalibrationRecord> mirror = newestOf(run.bench().store, run.serial(), "mirror");
    if (!mirror) return mirror.error();
    return viewOf(*mirror, run.newestGood("flat"), run.newestGood("leds"));
}

Result<Captured> captureReference(const JobRun& run,
                                  const View& view,
                                  const BracketPlan& plan,
                                  int darkFrames) {
    Bench bench = run.measuring();
    bench.glare = view.lens.glare;
    bench.corrections = view.corrections;
    run.bench().monitor.begin(placementSteps(bench));
    return measurePlacement(bench, view.lens.fit.map, plan, darkFrames);
}

Result<ReferenceRecord> storedReference(const JobRun& run,
                                        const std::string& kind,
                                        const View& view) {
    const Result<CalibrationRecord> record = newestOf(run.bench().store, run.serial(), kind);
    if (!record) return record.error();
    auto found = run.whileAlive([&] { return readReference(run.bench().store, *record, view); });
    if (!found) return found;
    if (Result<void> fits = run.fitsThisRig(*found); !fits) return fits.error();
    return found;
}

}  // namespace gonio::daemon
