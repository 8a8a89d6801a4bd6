#pragma once
// Whether values that ought to be the same are. Over groups of n values f_i of one quantity, with
// u_i the standard uncertainty of each that the others do not share and m their mean weighted by
// 1 / u_i^2,
//     chi^2 = sum of ((f_i - m) / u_i)^2,   with n - 1 degrees of freedom of each group.
// Where the values differ by chance alone, chi^2 per degree is 1 and its probability is even in
// (0, 1); a group of one tells nothing.

#include <cstddef>
#include <limits>
#include <vector>

namespace gonio::proc {

/// Standard uncertainties beyond which a value is no longer taken for chance: one in two million.
inline constexpr double kOutlier = 5;

struct Consistency {
    double chiSquare = 0;
    std::size_t freedom = 0;
    std::size_t values = 0;  ///< in groups of two and more
    /// Median over the groups of the values' root mean square deviation from m, relative to m.
    double medianRelative = std::numeric_limits<double>::quiet_NaN();
    std::size_t outliers = 0;  ///< values further than kOutlier from their group's mean

    /// NaN where nothing was compared.
    [[nodiscard]] double perFreedom() const;
    /// That chance alone makes chi^2 as large; 1 where nothing was compared.
    [[nodiscard]] double probability() const;
};

class ConsistencySum {
public:
    struct Group {
        double chiSquare = 0;
        std::size_t freedom = 0;
        double relative = 0;  ///< root mean square deviation over |m|
        std::size_t outliers = 0;
    };
    /// One without freedom adds nothing.
    void add(const Group& group);
    [[nodiscard]] Consistency result() const;

private:
    Consistency sum_;
    std::vector<double> relative_;
};

}  // namespace gonio::proc
