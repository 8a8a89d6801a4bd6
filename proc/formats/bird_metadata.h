#pragma once
// The metadata object of a BiRD file: as Metadata, and back.

#include <cstddef>
#include <optional>
#include <string>

#include "proc/formats/json_scan.h"
#include "proc/table/metadata.h"

namespace gonio::proc {

struct BirdMetadata {
    Metadata about;
    std::string symmetry;     ///< properties_symmetry; empty where it is not said
    std::size_t leftOut = 0;  ///< values and arrays beyond what is kept of one file
};

/// Behind the key `metadata`. Empty where the scan has a fault.
[[nodiscard]] std::optional<BirdMetadata> readBirdMetadata(JsonScan& scan);

/// The object, with all that the schema requires.
[[nodiscard]] std::string birdMetadataJson(const Metadata& about, bool isotropic);

}  // namespace gonio::proc
