#include "proc/models/schlick_regression.h"

#include <Eigen/QR>
#include <cmath>

namespace gonio::proc {

SchlickRegression regressSchlick(const RegressionGrid& grid) {
    constexpr Eigen::Index kColumns = 5;  // 1, s, s^2, s^3 and the truth
    Eigen::MatrixXd block = Eigen::MatrixXd::Zero(kColumns + grid.angles, kColumns);
    for (int n = 1; n <= grid.powers; ++n) {
        for (int i = 0; i < grid.angles; ++i) {
            const double c = std::cos(grid.thetaStep * i);
            const double s = c / (n - n * c + c);
            block.row(kColumns + i) << 1, s, s * s, s * s * s, std::pow(c, n);
        }
        const Eigen::HouseholderQR<Eigen::MatrixXd> qr(block);
        block.topRows(kColumns) = qr.matrixQR().topRows(kColumns).triangularView<Eigen::Upper>();
    }
    const Eigen::Matrix<double, kColumns, kColumns> r = block.topRows(kColumns);
    const Eigen::Vector4d k =
        r.topLeftCorner<4, 4>().triangularView<Eigen::Upper>().solve(r.col(4).head<4>());
    const auto rows = static_cast<std::size_t>(grid.powers) * static_cast<std::size_t>(grid.angles);
    return {.a = k[3],
            .b = k[2],
            .c = k[1],
            .d = k[0],
            .rms = std::abs(r(4, 4)) / std::sqrt(static_cast<double>(rows)),
            .rows = rows};
}

}  // namespace gonio::proc
