#include "daemon/cli/output.h"

#include <iostream>
#include <nlohmann/json.hpp>

namespace gonio::daemon {

void printJson(const nlohmann::ordered_json& json) {
    std::cout << json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << "\n";
}

}  // namespace gonio::daemon
