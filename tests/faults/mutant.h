#pragma once
// Which of the drivers that are broken on purpose is at work (mutants.cmake).

#include <string>
#include <vector>

namespace gonio::fault_test {

enum class Door {
    inproc,
    usb
};

struct Mutant {
    std::string row;  ///< the script that must fail
    Door door;
    std::string file, sound, broken;
};

[[nodiscard]] const std::vector<Mutant>& mutants();

/// -1: none is, and the driver is sound.
void activateMutant(int id);
[[nodiscard]] bool mutant(int id);

}  // namespace gonio::fault_test
