#include "proc/table/spherical_turn.h"

#include <algorithm>
#include <cmath>

namespace gonio::proc {
namespace {

constexpr double kTurn = 360;
constexpr double kSame = 1e-9;

double intoTurn(double azimuth) {
    const double within = azimuth - kTurn * std::floor(azimuth / kTurn);
    return within >= kTurn - kSame ? 0 : within;
}

/// One azimuth of the new axis and the row of the old one that it takes.
struct Row {
    double azimuth = 0;
    std::size_t from = 0;
};

std::vector<Row> turnedCircle(const std::vector<double>& axis, double turn) {
    const bool closed = axis.size() > 1 && std::abs(axis.back() - axis.front() - kTurn) <= kSame;
    std::vector<Row> rows;
    for (std::size_t i = 0; i + (closed ? 1 : 0) < axis.size(); ++i) {
        rows.push_back({intoTurn(axis[i] + turn), i});
    }
    std::stable_sort(
        rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.azimuth < b.azimuth; });
    if (closed && rows.front().azimuth == 0) rows.push_back({kTurn, rows.front().from});
    return rows;
}

std::vector<Row> turnedHalf(const std::vector<double>& axis, double turn, double mirror) {
    std::vector<Row> rows;
    for (std::size_t i = 0; i < axis.size(); ++i) rows.push_back({axis[i] + turn, i});
    if (rows.back().azimuth > kTurn || rows.front().azimuth < 0) {
        for (Row& row : rows) row.azimuth = 2 * mirror - row.azimuth;
        std::reverse(rows.begin(), rows.end());
    }
    const double down = kTurn * std::floor((rows.front().azimuth + kSame) / kTurn);
    for (Row& row : rows) row.azimuth -= down;
    return rows;
}

}  // namespace

SphericalTable withMirrorAt(SphericalTable table, double mirrorAzimuthDeg) {
    const double turn = mirrorAzimuthDeg - table.mirrorAzimuthDeg;
    if (turn == 0) return table;
    table.mirrorAzimuthDeg = mirrorAzimuthDeg;
    for (SphericalBlock& block : table.blocks) {
        if (block.azimuthDeg.empty()) continue;
        const std::vector<Row> rows = table.planeSymmetrical
                                          ? turnedHalf(block.azimuthDeg, turn, mirrorAzimuthDeg)
                                          : turnedCircle(block.azimuthDeg, turn);
        SphericalBlock turned = block;
        turned.azimuthDeg.clear();
        turned.f.clear();
        for (const Row& row : rows) {
            turned.azimuthDeg.push_back(row.azimuth);
            const auto start =
                block.f.begin() + static_cast<std::ptrdiff_t>(block.index(row.from, 0));
            turned.f.insert(
                turned.f.end(), start, start + static_cast<std::ptrdiff_t>(block.thetaDeg.size()));
        }
        block = std::move(turned);
    }
    return table;
}

}  // namespace gonio::proc
