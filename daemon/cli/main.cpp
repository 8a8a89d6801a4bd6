// The `gonio` program: reads the command line, calls one command, maps its error to an exit code.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>

#include "daemon/api/socket_path.h"
#include "daemon/cli/interrupt.h"
#include "daemon/cli/program.h"
#include "daemon/store.h"
#include "proc/core/log.h"

namespace gonio::daemon {
namespace {

constexpr int kUsage = 2;
constexpr int kInterrupted = 130;

/// What is wrong with the command line, in one line: a word that is no command is named, where the
/// library only says that a command is missing.
std::string complaint(const CLI::App& app, const CLI::ParseError& error) {
    const std::vector<std::string> unknown = app.remaining(true);
    std::string what = error.what();
    if (error.get_name() == "RequiredError" && !unknown.empty()) {
        what = "unknown command or option '" + unknown.front() + "'";
    }
    std::replace(what.begin(), what.end(), '\n', ' ');
    return what + "; see gonio --help";
}

int run(int argc, char** argv) {
    Program program;
    try {
        program.app->parse(argc, argv);
    } catch (const CLI::Success& success) {  // --help, --version
        return program.app->exit(success);
    } catch (const CLI::ParseError& error) {
        std::cerr << "gonio: " << complaint(*program.app, error) << "\n";
        return kUsage;
    }
    if (program.verbose) log::setLevel(log::Level::Info);
    const Result<void> done = program.chosen();
    std::cout.flush();
    if (done && std::cout) return interrupted() ? kInterrupted : 0;
    if (done) {
        std::cerr << "gonio: write to stdout: failed; is the disk full?\n";
        return exitCode(ErrorKind::File);
    }
    std::cerr << "gonio: " << done.error().message << "\n";
    return interrupted() ? kInterrupted : exitCode(done.error().kind);
}

}  // namespace

std::filesystem::path CommonOptions::socketPath() const {
    return daemon::socketPath(socket, store.empty() ? defaultStore() : store);
}

}  // namespace gonio::daemon

int main(int argc, char** argv) {
    try {
        return gonio::daemon::run(argc, argv);
    } catch (const std::exception& error) {
        std::cerr << "gonio: internal error: " << error.what() << "\n";
        return 1;
    }
}
