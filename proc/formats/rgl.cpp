#include "proc/formats/rgl.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "proc/formats/metadata_text.h"
#include "proc/formats/shown.h"
#include "proc/formats/tensor_file.h"
#include "proc/table/tensor_bsdf.h"

namespace gonio::proc {
namespace {

constexpr std::string_view kKnown[] = {"description",
                                       "jacobian",
                                       "theta_i",
                                       "phi_i",
                                       "ndf",
                                       "sigma",
                                       "vndf",
                                       "luminance",
                                       "rgb",
                                       "spectra",
                                       "wavelengths"};

/// Takes the fields of one file. The first complaint stops it: each step answers false then.
class Reader {
public:
    Reader(const std::vector<TensorField>& fields, std::string_view name)
        : fields_(fields), name_(name) {}

    Result<FileRead<TensorTable>> read() {
        if (header() && grids() && values() && whole()) return std::move(read_);
        return *error_;
    }

private:
    bool fail(std::string_view field, const std::string& what) {
        error_ = Error{ErrorKind::File,
                       "rgl: " + std::string(name_) + ": field " + shown(field) + ": " + what};
        return false;
    }

    [[nodiscard]] const TensorField* find(std::string_view field) const {
        const auto found = std::find_if(
            fields_.begin(), fields_.end(), [&](const TensorField& f) { return f.name == field; });
        return found == fields_.end() ? nullptr : &*found;
    }

    /// A field of a type and number of dimensions.
    const TensorField* take(std::string_view field, TensorType type, std::size_t dimensions) {
        const TensorField* found = find(field);
        if (found == nullptr) {
            fail(field, "missing");
        } else if (found->type != type || found->shape.size() != dimensions) {
            fail(field,
                 "type " + std::to_string(static_cast<int>(found->type)) + " of " +
                     std::to_string(found->shape.size()) + " dimensions, wanted " +
                     std::to_string(static_cast<int>(type)) + " of " + std::to_string(dimensions));
        } else {
            return found;
        }
        return nullptr;
    }

    bool floats(const TensorField& field, std::vector<float>& into) {
        into.resize(field.data.size() / sizeof(float));
        if (!into.empty()) {
            std::memcpy(into.data(), field.data.data(), into.size() * sizeof(float));
        }
        // A sum of the products with 0 is 0 but for infinities and NaN; a loop without a branch.
        float odd = 0;
        for (const float value : into) odd += value * 0;
        return odd == 0 || fail(field.name, "a value is not a finite number");
    }

    bool axis(std::string_view field, std::vector<float>& into) {
        const TensorField* found = take(field, TensorType::F32, 1);
        if (found == nullptr || !floats(*found, into)) return false;
        for (std::size_t i = 1; i < into.size(); ++i) {
            if (!(into[i - 1] < into[i])) return fail(field, "does not ascend");
        }
        return !into.empty() || fail(field, "empty");
    }

    bool header() {
        const TensorField* text = take("description", TensorType::U8, 1);
        const TensorField* jacobian =
            text != nullptr ? take("jacobian", TensorType::U8, 1) : nullptr;
        if (jacobian == nullptr) return false;
        if (jacobian->data.size() != 1) return fail("jacobian", "wanted one value");
        auto about = metadataOfText(text->data);
        if (!about) {
            return fail("description",
                        "more than " + std::to_string(kMostMetadataLines) + " lines");
        }
        read_.about = std::move(*about);
        read_.content.jacobian = jacobian->data[0] != 0;
        return axis("theta_i", read_.content.thetaIn) && axis("phi_i", read_.content.phiIn);
    }

    /// The last two dimensions are one picture's, those before it `slices`.
    bool grid(std::string_view field, std::vector<std::size_t> slices, GridStack& into) {
        const TensorField* found = take(field, TensorType::F32, slices.size() + 2);
        if (found == nullptr) return false;
        if (!std::equal(slices.begin(), slices.end(), found->shape.begin())) {
            return fail(field, found->shapeText() + " values, not those of phi_i and theta_i");
        }
        into.height = found->shape[slices.size()];
        into.width = found->shape[slices.size() + 1];
        if (into.width < 2 || into.height < 2) {
            return fail(field, found->shapeText() + " values, wanted at least 2 x 2 each");
        }
        return floats(*found, into.values);
    }

    bool grids() {
        TensorTable& table = read_.content;
        const std::vector<std::size_t> lights{table.phiIn.size(), table.thetaIn.size()};
        return grid("ndf", {}, table.ndf) && grid("sigma", {}, table.sigma) &&
               grid("vndf", lights, table.vndf) && grid("luminance", lights, table.luminance);
    }

    bool values() {
        TensorTable& table = read_.content;
        std::vector<std::size_t> slices{table.phiIn.size(), table.thetaIn.size(), 3};
        if (find("spectra") == nullptr) {
            table.channels = {{"R", {}}, {"G", {}}, {"B", {}}};
            return grid("rgb", slices, table.values);
        }
        std::vector<float> wavelengths;
        if (!axis("wavelengths", wavelengths)) return false;
        for (const float nm : wavelengths) table.channels.push_back({"", nm});
        slices.back() = wavelengths.size();
        if (find("rgb") != nullptr) {
            read_.warnings.emplace_back("rgb is left out: spectra are there too");
        }
        return grid("spectra", slices, table.values);
    }

    bool whole() {
        if (const std::string wrong = complaintOf(read_.content); !wrong.empty()) {
            error_ = Error{ErrorKind::File, "rgl: " + std::string(name_) + ": " + wrong};
            return false;
        }
        std::size_t unknown = 0;
        for (const TensorField& field : fields_) {
            unknown +=
                std::find(std::begin(kKnown), std::end(kKnown), field.name) == std::end(kKnown)
                    ? 1U
                    : 0U;
        }
        if (unknown > 0) {
            read_.warnings.push_back(std::to_string(unknown) +
                                     " fields of other names are left out");
        }
        std::size_t negative = 0;
        for (const float value : read_.content.values.values) negative += value < 0 ? 1U : 0U;
        if (negative > 0) {
            read_.warnings.push_back(std::to_string(negative) + " negative values, answered as 0");
        }
        return true;
    }

    const std::vector<TensorField>& fields_;
    std::string_view name_;
    FileRead<TensorTable> read_;
    std::optional<Error> error_;
};

std::string_view bytesOfFloats(const std::vector<float>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)};  // NOLINT
}

TensorField floatField(std::string_view name,
                       std::vector<std::size_t> shape,
                       const std::vector<float>& values) {
    return {.name = std::string(name),
            .type = TensorType::F32,
            .shape = std::move(shape),
            .data = bytesOfFloats(values)};
}

TensorField gridField(std::string_view name,
                      std::vector<std::size_t> slices,
                      const GridStack& grid) {
    slices.push_back(grid.height);
    slices.push_back(grid.width);
    return floatField(name, std::move(slices), grid.values);
}

TensorField textField(std::string_view name, std::string_view bytes) {
    return {
        .name = std::string(name), .type = TensorType::U8, .shape = {bytes.size()}, .data = bytes};
}

bool areBands(const std::vector<Channel>& channels) {
    return channels.size() == 3 && channels[0].name == "R" && channels[1].name == "G" &&
           channels[2].name == "B";
}

bool areWavelengths(const std::vector<Channel>& channels) {
    for (std::size_t i = 0; i < channels.size(); ++i) {
        if (!channels[i].nanometres || !channels[i].name.empty()) return false;
        if (i > 0 && *channels[i - 1].nanometres >= *channels[i].nanometres) return false;
    }
    return true;
}

/// One channel as three.
GridStack thrice(const GridStack& grid) {
    GridStack out{.width = grid.width, .height = grid.height, .values = {}};
    const std::size_t each = grid.width * grid.height;
    for (std::size_t at = 0; at < grid.values.size(); at += each) {
        const auto begin = grid.values.begin() + static_cast<std::ptrdiff_t>(at);
        for (int i = 0; i < 3; ++i) {
            out.values.insert(out.values.end(), begin, begin + static_cast<std::ptrdiff_t>(each));
        }
    }
    return out;
}

}  // namespace

Result<FileRead<TensorTable>> parseRgl(std::string_view bytes, std::string_view name) {
    const auto fields = parseTensorFile(bytes, name);
    if (!fields) return fields.error();
    return Reader(*fields, name).read();
}

Result<Written> writeRgl(const TensorTable& table, const Metadata& about) {
    if (const std::string wrong = complaintOf(table); !wrong.empty()) {
        return Error{ErrorKind::Usage, "rgl: " + wrong};
    }
    const bool one = table.channels.size() == 1 && !table.channels[0].nanometres;
    const bool bands = areBands(table.channels) || one;
    if (!bands && !areWavelengths(table.channels)) {
        return Error{ErrorKind::Usage, "rgl: wanted channels R, G, B, or ascending wavelengths"};
    }
    const std::string description = metadataText(about);
    std::vector<float> wavelengths;
    for (const Channel& channel : table.channels) {
        wavelengths.push_back(static_cast<float>(channel.nanometres.value_or(0)));
    }
    const std::string jacobian(1, table.jacobian ? '\1' : '\0');
    const GridStack copies = one ? thrice(table.values) : GridStack{};
    const std::size_t phis = table.phiIn.size();
    const std::size_t thetas = table.thetaIn.size();
    std::vector<TensorField> fields{textField("description", description),
                                    textField("jacobian", jacobian),
                                    floatField("theta_i", {thetas}, table.thetaIn),
                                    floatField("phi_i", {phis}, table.phiIn),
                                    gridField("ndf", {}, table.ndf),
                                    gridField("sigma", {}, table.sigma),
                                    gridField("vndf", {phis, thetas}, table.vndf),
                                    gridField("luminance", {phis, thetas}, table.luminance)};
    if (bands) {
        fields.push_back(gridField("rgb", {phis, thetas, 3}, one ? copies : table.values));
    } else {
        fields.push_back(floatField("wavelengths", {wavelengths.size()}, wavelengths));
        fields.push_back(gridField("spectra", {phis, thetas, wavelengths.size()}, table.values));
    }
    Written out{.bytes = writeTensorFile(fields), .loss = {}};
    out.loss.add(Loss::Resampled, "one channel, written as R, G and B", one ? 1 : 0);
    if (bands) {
        std::size_t named = 0;
        for (const Channel& channel : table.channels) named += channel.nanometres ? 1U : 0U;
        out.loss.add(Loss::Dropped, "wavelengths of R, G, B", named);
    }
    return out;
}

}  // namespace gonio::proc
