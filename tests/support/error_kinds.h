#pragma once
// Every kind of error there is.

#include <array>

#include "proc/core/result.h"

namespace gonio::test {

inline constexpr std::array kErrorKinds{ErrorKind::Internal,
                                        ErrorKind::Usage,
                                        ErrorKind::NoRig,
                                        ErrorKind::Busy,
                                        ErrorKind::Device,
                                        ErrorKind::File,
                                        ErrorKind::Quality,
                                        ErrorKind::Interrupted};

}  // namespace gonio::test
