#include "proc/formats/tensor_file.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <set>

#include "proc/formats/little_endian.h"
#include "proc/formats/shown.h"

namespace gonio::proc {
namespace {

constexpr std::string_view kMagic("tensor_file\0", 12);
constexpr std::string_view kVersion("\1\0", 2);
constexpr std::size_t kAlignment = 8;

/// Reads the list of fields. The first complaint stops it.
class Reader {
public:
    Reader(std::string_view bytes, std::string_view name) : bytes_(bytes), name_(name) {}

    Result<std::vector<TensorField>> read() {
        if (!bytes_.starts_with(kMagic)) return fail("no tensor file");
        at_ = kMagic.size();
        if (bytes_.substr(at_, kVersion.size()) != kVersion)
            return fail("a version other than 1.0");
        at_ += kVersion.size();
        const auto count = take<std::uint32_t>();
        constexpr std::size_t kLeast = 2 + 2 + 1 + 8;  // bytes of the smallest field
        if (!count || *count > (bytes_.size() - at_) / kLeast) {
            return fail("more fields than the file can hold");
        }
        std::vector<TensorField> fields;
        for (std::uint32_t i = 0; i < *count; ++i) {
            auto field = takeField();
            if (!field) return field.error();
            if (!names_.insert(field->name).second) {
                return fail("field " + shown(field->name) + " is given twice");
            }
            end_ = std::max(end_, place_ + field->data.size());
            fields.push_back(std::move(*field));
        }
        end_ = std::max(end_, at_);
        return nothingBehind()
                   ? Result(std::move(fields))
                   : fail(std::to_string(bytes_.size() - end_) + " bytes behind the last field");
    }

private:
    [[nodiscard]] Error fail(const std::string& what) const {
        return {ErrorKind::File, "rgl: " + std::string(name_) + ": " + what};
    }

    /// Zeros up to the next multiple of 8 are padding.
    [[nodiscard]] bool nothingBehind() const {
        const std::string_view rest = bytes_.substr(end_);
        return rest.size() < kAlignment && rest.find_first_not_of('\0') == std::string_view::npos;
    }

    template <class T>
    std::optional<T> take() {
        if (bytes_.size() - at_ < sizeof(T)) return std::nullopt;
        const T value = littleAt<T>(bytes_, at_);
        at_ += sizeof(T);
        return value;
    }

    Result<TensorField> takeField() {
        const Error ends =
            fail("byte " + std::to_string(at_) + ": the file ends in a field's head");
        TensorField field;
        const auto nameSize = take<std::uint16_t>();
        if (!nameSize || bytes_.size() - at_ < *nameSize) return ends;
        field.name = bytes_.substr(at_, *nameSize);
        at_ += *nameSize;
        const auto dimensions = take<std::uint16_t>();
        const auto type = take<std::uint8_t>();
        const auto place = take<std::uint64_t>();
        if (!dimensions || !type || !place) return ends;
        if (*type < 1 || *type > static_cast<std::uint8_t>(TensorType::F64)) {
            return fail("field " + shown(field.name) + ": type " + std::to_string(*type) +
                        ", wanted 1 to 11");
        }
        field.type = static_cast<TensorType>(*type);
        if ((bytes_.size() - at_) / sizeof(std::uint64_t) < *dimensions) return ends;
        for (std::uint16_t i = 0; i < *dimensions; ++i) {
            field.shape.push_back(*take<std::uint64_t>());
        }
        return withData(std::move(field), *place);
    }

    [[nodiscard]] Result<TensorField> withData(TensorField field, std::uint64_t place) {
        std::size_t size = bytesOf(field.type);
        bool fits = true;
        for (const std::size_t extent : field.shape) {
            fits = fits && !__builtin_mul_overflow(size, extent, &size);
        }
        if (!fits || place > bytes_.size() || size > bytes_.size() - place) {
            return fail("field " + shown(field.name) + ": " + field.shapeText() + " values of " +
                        std::to_string(bytesOf(field.type)) + " bytes at " + std::to_string(place) +
                        ", the file has " + std::to_string(bytes_.size()));
        }
        field.data = bytes_.substr(place, size);
        place_ = place;
        return field;
    }

    std::string_view bytes_, name_;
    std::size_t at_ = 0;
    std::size_t place_ = 0, end_ = 0;  ///< of the field's data, of all fields'
    std::set<std::string> names_;
};

std::size_t aligned(std::size_t at) { return (at + kAlignment - 1) / kAlignment * kAlignment; }

}  // namespace

std::size_t bytesOf(TensorType type) {
    constexpr std::array<std::size_t, 12> kBytes{0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};
    return kBytes.at(static_cast<std::size_t>(type));
}

std::string TensorField::shapeText() const {
    constexpr std::size_t kMost = 8;  // what a hostile file says is not repeated at length
    std::string text;
    for (std::size_t i = 0; i < shape.size() && i < kMost; ++i) {
        text += (i > 0 ? " x " : "") + std::to_string(shape[i]);
    }
    return text + (shape.size() > kMost ? " x ..." : "");
}

Result<std::vector<TensorField>> parseTensorFile(std::string_view bytes, std::string_view name) {
    return Reader(bytes, name).read();
}

std::string writeTensorFile(const std::vector<TensorField>& fields) {
    std::size_t head = kMagic.size() + kVersion.size() + sizeof(std::uint32_t);
    for (const TensorField& field : fields)
        head += 2 + field.name.size() + 2 + 1 + 8 + 8 * field.shape.size();
    std::string bytes(kMagic);
    bytes += kVersion;
    appendLittle(bytes, static_cast<std::uint32_t>(fields.size()));
    std::size_t place = aligned(head);
    for (const TensorField& field : fields) {
        appendLittle(bytes, static_cast<std::uint16_t>(field.name.size()));
        bytes += field.name;
        appendLittle(bytes, static_cast<std::uint16_t>(field.shape.size()));
        appendLittle(bytes, static_cast<std::uint8_t>(field.type));
        appendLittle(bytes, static_cast<std::uint64_t>(place));
        for (const std::size_t extent : field.shape) {
            appendLittle(bytes, static_cast<std::uint64_t>(extent));
        }
        place = aligned(place + field.data.size());
    }
    for (const TensorField& field : fields) {
        bytes.resize(aligned(bytes.size()), '\0');
        bytes += field.data;
    }
    return bytes;
}

}  // namespace gonio::proc
