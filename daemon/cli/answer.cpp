#include "daemon/cli/answer.h"

#include <nlohmann/json.hpp>

#include "daemon/cli/output.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

Error notUnderstood(const std::string& what) {
    return {ErrorKind::Internal,
            "the daemon's answer is not understood: " + what +
                "; is it another version? gonio --version, goniod --version"};
}

}  // namespace

Result<void> understood(const std::string& answer, const Show& use) {
    const Json json = Json::parse(answer, nullptr, false);
    if (!json.is_object()) return notUnderstood("it is no JSON object");
    try {
        use(json);
        return {};
    } catch (const Json::exception& e) {
        return notUnderstood(e.what());
    }
}

Result<void> shown(const CommonOptions& common,
                   const Result<std::string>& answer,
                   const Show& show) {
    if (!answer) return answer.error();
    return understood(*answer, [&](const Json& json) {
        if (common.json) {
            printJson(json);
        } else if (!common.quiet) {
            show(json);
        }
    });
}

}  // namespace gonio::daemon
