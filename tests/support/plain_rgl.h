#pragma once
// A second, plain reader and evaluator of RGL files, written from the description of the format
// alone and sharing nothing with ours: tables by name, bilinear by hand, the warp inverted by brute
// sums over thin strips. Slow, and for sound files only.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <vector>

namespace gonio::test {

class PlainRgl {
public:
    explicit PlainRgl(const std::string& bytes) {
        std::size_t at = 14;
        const auto number = [&](std::size_t size) {
            std::uint64_t value = 0;
            for (std::size_t i = 0; i < size; ++i) {
                value |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[at + i]))
                         << (8 * i);
            }
            at += size;
            return value;
        };
        const std::uint64_t count = number(4);
        for (std::uint64_t f = 0; f < count; ++f) {
            const std::size_t length = number(2);
            const std::string name = bytes.substr(at, length);
            at += length;
            const std::uint64_t dimensions = number(2);
            const std::uint64_t type = number(1);
            const std::uint64_t place = number(8);
            Field field;
            std::size_t total = 1;
            for (std::uint64_t d = 0; d < dimensions; ++d) {
                field.shape.push_back(number(8));
                total *= field.shape.back();
            }
            if (type == 10) {
                field.values.resize(total);
                std::memcpy(field.values.data(), bytes.data() + place, 4 * total);
            }
            fields[name] = field;
        }
    }

    /// f cos(theta_o) of a channel. Directions x, y, z; both above the horizon.
    [[nodiscard]] double fCos(const std::array<double, 3>& wi,
                              const std::array<double, 3>& wo,
                              std::size_t channel) const {
        std::array<double, 3> h{};
        double length = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            h[i] = wi[i] + wo[i];
            length += h[i] * h[i];
        }
        for (double& x : h) x /= std::sqrt(length);
        const double thetaIn = theta(wi);
        const double phiIn = std::atan2(wi[1], wi[0]);
        const bool isotropic = fields.at("phi_i").values.size() <= 2;
        const double phiHalf = std::atan2(h[1], h[0]) - (isotropic ? phiIn : 0);
        const double u = std::sqrt(2 * theta(h) / kPi);
        double v = (phiHalf + kPi) / (2 * kPi);
        v -= std::floor(v);
        const std::vector<std::pair<std::size_t, double>> slices = blend(thetaIn, phiIn);
        double x = 0;
        double y = 0;
        uniform(slices, u, v, x, y);

        const std::string name = fields.contains("rgb") ? "rgb" : "spectra";
        const std::size_t channels = fields.at(name).shape[2];
        double value = 0;
        for (const auto& [slice, share] : slices) {
            value += share * table(name, slice * channels + channel, x, y);
        }
        const double uIn = std::sqrt(2 * thetaIn / kPi);
        const double vIn = (phiIn + kPi) / (2 * kPi);
        return value * table("ndf", 0, u, v) / (4 * table("sigma", 0, uIn, vIn));
    }

private:
    static constexpr double kPi = 3.141592653589793;
    struct Field {
        std::vector<std::size_t> shape;
        std::vector<float> values;
    };

    static double theta(const std::array<double, 3>& w) {
        const double chord = std::sqrt(w[0] * w[0] + w[1] * w[1] + (w[2] - 1) * (w[2] - 1));
        return 2 * std::asin(std::min(1.0, chord / 2));
    }

    /// Slices and shares of the light's direction.
    [[nodiscard]] std::vector<std::pair<std::size_t, double>> blend(double thetaIn,
                                                                    double phiIn) const {
        std::vector<std::pair<std::size_t, double>> out;
        for (const auto& [p, pShare] : on(fields.at("phi_i").values, phiIn)) {
            for (const auto& [t, tShare] : on(fields.at("theta_i").values, thetaIn)) {
                out.emplace_back(p * fields.at("theta_i").values.size() + t, pShare * tShare);
            }
        }
        return out;
    }
    static std::vector<std::pair<std::size_t, double>> on(const std::vector<float>& axis,
                                                          double at) {
        if (at <= axis.front()) return {{0, 1}};
        if (at >= axis.back()) return {{axis.size() - 1, 1}};
        std::size_t i = 0;
        while (axis[i + 1] <= at) ++i;
        const double t = (at - axis[i]) / (static_cast<double>(axis[i + 1]) - axis[i]);
        return {{i, 1 - t}, {i + 1, t}};
    }

    [[nodiscard]] double table(const std::string& name,
                               std::size_t slice,
                               double u,
                               double v) const {
        const Field& field = fields.at(name);
        const std::size_t height = field.shape[field.shape.size() - 2];
        const std::size_t width = field.shape.back();
        const double x = u * static_cast<double>(width - 1);
        const double y = v * static_cast<double>(height - 1);
        const auto i = std::min(static_cast<std::size_t>(x), width - 2);
        const auto j = std::min(static_cast<std::size_t>(y), height - 2);
        const auto at = [&](std::size_t column, std::size_t row) {
            return static_cast<double>(field.values[(slice * height + row) * width + column]);
        };
        const double s = x - static_cast<double>(i);
        const double t = y - static_cast<double>(j);
        return (1 - t) * ((1 - s) * at(i, j) + s * at(i + 1, j)) +
               t * ((1 - s) * at(i, j + 1) + s * at(i + 1, j + 1));
    }

    /// Where (u, v) of the visible normals' density lies on the uniform square: midpoint sums, as
    /// many strips to a cell as make them exact (a linear function's midpoint sum is).
    void uniform(const std::vector<std::pair<std::size_t, double>>& slices,
                 double u,
                 double v,
                 double& x,
                 double& y) const {
        const Field& field = fields.at("vndf");
        const std::size_t height = field.shape[2];
        const std::size_t width = field.shape[3];
        const auto rowUpTo = [&](std::size_t slice, double at, double end) {
            double sum = 0;
            const double step = 1.0 / static_cast<double>(width - 1);
            for (std::size_t i = 0; i + 1 < width; ++i) {
                const double from = static_cast<double>(i) * step;
                const double to = std::min(end, from + step);
                if (to > from) sum += (to - from) * table("vndf", slice, (from + to) / 2, at);
            }
            return sum;
        };
        const auto upTo = [&](std::size_t slice, double end) {
            double sum = 0;
            const double step = 1.0 / static_cast<double>(height - 1);
            for (std::size_t j = 0; j + 1 < height; ++j) {
                const double from = static_cast<double>(j) * step;
                const double to = std::min(end, from + step);
                if (to > from) sum += (to - from) * rowUpTo(slice, (from + to) / 2, 1);
            }
            return sum;
        };
        double part = 0;
        double row = 0;
        y = 0;
        for (const auto& [slice, share] : slices) {
            const double total = upTo(slice, 1);
            y += share * upTo(slice, v) / total;
            part += share * rowUpTo(slice, v, u) / total;
            row += share * rowUpTo(slice, v, 1) / total;
        }
        x = part / row;
    }

    std::map<std::string, Field> fields;
};

}  // namespace gonio::test
