#include "proc/table/spherical_turn.h"

#include <algorithm>
#include <cmath>

namespace gonio::proc {
namespace {

constexpr double kTurn = 360;
constexpr double kSame = 1e-9;
/// A little more than what readers accept, so that rounding makes no difference to them.
constexpr double kOneNode = 1.1 * kFinestStepDeg;

double intoTurn(double azimuth) {
    const double within = azimuth - kTurn * std::floor(azimuth / kTurn);
    return within >= kTurn - kSame ? 0 : within;
}

/// One azimuth of the new axis and the row of the old one that it takes.
struct Row {
    double azimuth = 0;
    std::size_t from = 0;
};

void dropRepeated(std::vector<Row>& rows) {
    const auto same = [](const Row& a, const Row& b) { return b.azimuth - a.azimuth <= kOneNode; };
    rows.erase(std::unique(rows.begin(), rows.end(), same), rows.end());
    while (rows.size() > 1 && rows.front().azimuth + kTurn - rows.back().azimuth <= kOneNode) {
        rows.pop_back();
    }
}

std::vector<Row> turnedCircle(const std::vector<double>& axis, double turn) {
    const bool closed = axis.size() > 1 && std::abs(axis.back() - axis.front() - kTurn) <= kOneNode;
    std::vector<Row> rows;
    for (std::size_t i = 0; i + (closed ? 1 : 0) < axis.size(); ++i) {
        rows.push_back({intoTurn(axis[i] + turn), i});
    }
    std::stable_sort(
        rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.azimuth < b.azimuth; });
    dropRepeated(rows);
    if (closed && rows.front().azimuth == 0) {
        const std::size_t first = rows.front().from;
        rows.push_back({kTurn, first == 0 ? axis.size() - 1 : first});  // unturned: as it was
    }
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

/// Both sides of the mirror plane, each direction once.
std::vector<Row> unfolded(const std::vector<double>& axis, double mirror) {
    std::vector<Row> rows;
    for (std::size_t i = 0; i < axis.size(); ++i) {
        rows.push_back({intoTurn(axis[i]), i});
        rows.push_back({intoTurn(2 * mirror - axis[i]), i});
    }
    std::stable_sort(
        rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.azimuth < b.azimuth; });
    dropRepeated(rows);
    return rows;
}

bool coversCircle(const std::vector<Row>& rows) {
    double widest = 0;
    for (std::size_t i = 1; i < rows.size(); ++i) {
        widest = std::max(widest, rows[i].azimuth - rows[i - 1].azimuth);
    }
    return rows.front().azimuth + kTurn - rows.back().azimuth <= 1.5 * widest;
}

void takeRows(SphericalBlock& block, const std::vector<Row>& rows) {
    std::vector<double> azimuths;
    std::vector<double> f;
    f.reserve(rows.size() * block.thetaDeg.size());
    for (const Row& row : rows) {
        azimuths.push_back(row.azimuth);
        const auto start = block.f.begin() + static_cast<std::ptrdiff_t>(block.index(row.from, 0));
        f.insert(f.end(), start, start + static_cast<std::ptrdiff_t>(block.thetaDeg.size()));
    }
    block.azimuthDeg = std::move(azimuths);
    block.f = std::move(f);
}

}  // namespace

SphericalTable withMirrorAt(SphericalTable table, double mirrorAzimuthDeg) {
    const double turn = mirrorAzimuthDeg - table.mirrorAzimuthDeg;
    if (turn == 0) return table;
    table.mirrorAzimuthDeg = mirrorAzimuthDeg;
    for (SphericalBlock& block : table.blocks) {
        if (block.azimuthDeg.empty()) continue;
        takeRows(block,
                 table.planeSymmetrical ? turnedHalf(block.azimuthDeg, turn, mirrorAzimuthDeg)
                                        : turnedCircle(block.azimuthDeg, turn));
    }
    return table;
}

SphericalTable wholeCircle(SphericalTable table) {
    for (SphericalBlock& block : table.blocks) {
        if (block.azimuthDeg.empty()) continue;
        std::vector<Row> rows = table.planeSymmetrical
                                    ? unfolded(block.azimuthDeg, table.mirrorAzimuthDeg)
                                    : turnedCircle(block.azimuthDeg, 0);
        if (rows.front().azimuth == 0 && rows.back().azimuth < kTurn && coversCircle(rows)) {
            rows.push_back({kTurn, rows.front().from});
        }
        takeRows(block, rows);
    }
    table.planeSymmetrical = false;
    return table;
}

}  // namespace gonio::proc
