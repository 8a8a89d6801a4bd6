#pragma once
// The container of the RGL material database [Dupuy2018]: named arrays in one file. Little-endian:
// "tensor_file" and a zero, version 1.0, the number of fields; of each field its name, number of
// dimensions, type, place in the file and shape; then the data, C order, each at a multiple of 8.
//
// Reading allocates no data: fields are views of the bytes. Every field lies within the bytes, the
// product of its shape does not overflow, names differ, and nothing but padding is behind the last.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "proc/core/result.h"

namespace gonio::proc {

enum class TensorType : std::uint8_t {
    U8 = 1,
    I8,
    U16,
    I16,
    U32,
    I32,
    U64,
    I64,
    F16,
    F32,
    F64
};
[[nodiscard]] std::size_t bytesOf(TensorType type);

struct TensorField {
    std::string name;
    TensorType type = TensorType::F32;
    std::vector<std::size_t> shape;
    std::string_view data;  ///< of the file's bytes, which must outlive it

    /// "2 x 3".
    [[nodiscard]] std::string shapeText() const;
};

/// `name` stands in errors: "rgl: NAME: field 'ndf': 8 x 8 values of 4 bytes at 1000, the file
/// has 1100".
[[nodiscard]] Result<std::vector<TensorField>> parseTensorFile(std::string_view bytes,
                                                               std::string_view name);
/// Each field's data must have the size of its shape and type.
[[nodiscard]] std::string writeTensorFile(const std::vector<TensorField>& fields);

}  // namespace gonio::proc
