#pragma once
// What the API says, as JSON. Missing is null; times are UTC in ISO 8601; schemas gonio/<name>/1.

#include <nlohmann/json_fwd.hpp>

#include "daemon/engine/engine.h"

namespace gonio::daemon {

[[nodiscard]] nlohmann::ordered_json toJson(const EngineStatus& status);
[[nodiscard]] nlohmann::ordered_json toJson(const JobRecord& job);
[[nodiscard]] nlohmann::ordered_json toJson(const SessionRecord& session);
[[nodiscard]] nlohmann::ordered_json toJson(const RigListing& rig);
[[nodiscard]] nlohmann::ordered_json toJson(const SampleRecord& sample);
[[nodiscard]] nlohmann::ordered_json toJson(const Finding& finding);

/// `whyNot`: why it is not good now; empty: it is.
[[nodiscard]] nlohmann::ordered_json toJson(const CalibrationRecord& calibration,
                                            const std::string& whyNot);

/// Text of a document with its schema in front: {"schema": "gonio/<name>/1", ...}.
[[nodiscard]] std::string document(const std::string& name, const nlohmann::ordered_json& content);

}  // namespace gonio::daemon
