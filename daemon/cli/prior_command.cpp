// `gonio prior build`.

#include <iostream>
#include <nlohmann/json.hpp>

#include "daemon/cli/commands.h"
#include "daemon/cli/output.h"
#include "proc/fit/prior_library.h"
#include "proc/formats/file_bytes.h"

namespace gonio::daemon {

Result<void> buildPrior(const CommonOptions& common, const PriorOptions& options) {
    proc::PriorLibrary library = proc::PriorLibrary::standard(options.count, options.seed);
    std::size_t added = 0;
    for (const std::filesystem::path& file : options.fits) {
        const Result<std::size_t> some = library.addPublishedFits(file);
        if (!some) return some.error().in("prior build");
        added += *some;
    }
    if (auto done = proc::writeFile(options.output, library.text()); !done) return done;
    if (common.json) {
        printJson({{"schema", "gonio/prior-build/1"},
                   {"file", options.output.string()},
                   {"materials", library.specs.size()},
                   {"from_published_fits", added}});
    } else if (!common.quiet) {
        std::cout << options.output.string() << ": " << library.specs.size() << " materials, "
                  << added << " of them from published fits\n";
    }
    return {};
}

}  // namespace gonio::daemon
