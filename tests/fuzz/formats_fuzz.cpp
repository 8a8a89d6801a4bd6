// Every reader under libFuzzer and the sanitizers. One program, which reads what its name says:
// `fuzz_zemax` runs the reader `zemax`. `formats_fuzz --prepare` makes these names as links beside
// itself, and the seeds of each reader in seeds/NAME.

#include <algorithm>
#include <cstdint>
#include <cstdio>
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

std::string& reader() {
    static std::string name;
    return name;
}

void writeSeeds(const Reader& reader, const fs::path& folder) {
    fs::create_directories(folder);
    for (std::size_t i = 0; i < reader.sound.size(); ++i) {
        std::ofstream(folder / ("sound" + std::to_string(i)), std::ios::binary) << reader.sound[i];
    }
}

void prepare(const fs::path& program) {
    const fs::path folder = program.parent_path();
    for (const Reader& each : readers()) {
        const fs::path link = folder / (std::string(kPrefix) + each.name);
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
    reader() = name.starts_with(kPrefix) ? name.substr(kPrefix.size()) : "";
    const auto all = readers();
    const bool known = std::any_of(
        all.begin(), all.end(), [](const Reader& each) { return each.name == reader(); });
    if (!known) leave(2, name + " names no reader: run fuzz_zemax, ...; --prepare makes them");
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);  // NOLINT
    const auto complaint = gonio::test::complaintOf(gonio::test::reader(), bytes);
    if (complaint && complaint->message.find('\n') != std::string::npos) {
        std::cerr << "a complaint of several lines: " << complaint->message << "\n";
        std::abort();
    }
    return 0;
}
