// Every reader under libFuzzer and the sanitizers. One program, which reads what its name says:
// `fuzz_zemax` runs the reader `zemax`. `formats_fuzz --prepare` makes these names as links beside
// itself, and the seeds of each reader in seeds/NAME.

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <string_view>

#include "tests/formats/readers.h"

namespace gonio::test {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPrefix = "fuzz_";

const Reader*& chosen() {
    static const Reader* reader = nullptr;
    return reader;
}

void writeSeeds(const Reader& reader, const fs::path& folder) {
    fs::create_directories(folder);
    int count = 0;
    for (const std::string& bytes : reader.sound()) {
        std::ofstream(folder / ("sound" + std::to_string(count++)), std::ios::binary) << bytes;
    }
}

void prepare(const fs::path& program) {
    const fs::path folder = program.parent_path();
    for (const Reader& each : readers()) {
        const fs::path link = folder / (std::string(kPrefix) + std::string(each.name));
        fs::remove(link);
        fs::create_symlink(program.filename(), link);
        writeSeeds(each, folder / "seeds" / each.name);
    }
}

[[noreturn]] void leave(int code, const std::string& why) {
    if (!why.empty()) std::cerr << why << "\n";
    std::exit(code);
}

}  // namespace
}  // namespace gonio::test

// libFuzzer's names.
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    using namespace gonio::test;  // NOLINT(google-build-using-namespace)
    const fs::path program = (*argv)[0];
    if (*argc == 2 && std::string_view((*argv)[1]) == "--prepare") {
        prepare(program);
        leave(0, "");
    }
    const std::string name = program.filename();
    chosen() = readerOf(name.starts_with(kPrefix) ? name.substr(kPrefix.size()) : "");
    if (chosen() == nullptr) {
        leave(2, name + " names no reader: run fuzz_zemax, ...; --prepare makes them");
    }
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);  // NOLINT
    const auto complaint = gonio::test::chosen()->complaint(bytes);
    if (!complaint) return 0;
    const bool oneLine = complaint->message.find_first_of("\r\n") == std::string::npos;
    if (complaint->kind == gonio::ErrorKind::Internal || !oneLine) {
        std::cerr << "ERROR: not a complaint of one line, or of our own: " << complaint->message
                  << "\n";
        std::abort();
    }
    return 0;
}
