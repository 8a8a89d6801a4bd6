// Every form of cos^n against the library's power, in float and double, over random and extreme n
// and angles; and what the header says of each one's ends.

#include "proc/models/powers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace gonio::proc {
namespace {

constexpr std::uint64_t kSeed = 20241021;

template <class T>
NearOne<T> at(double theta) {
    const double half = std::sin(theta / 2);
    return {.c = static_cast<T>(std::max(0.0, std::cos(theta))),
            .t = static_cast<T>(2 * half * half)};
}

/// The slow, obvious twin, of the same c or t: t near the peak, where c has lost it.
template <class T>
double reference(T n, const NearOne<T>& x) {
    const auto power = static_cast<long double>(n);
    const auto c = static_cast<long double>(x.c);
    const auto t = static_cast<long double>(x.t);
    return static_cast<double>(c > 0.5L ? std::exp(power * std::log1p(-t)) : std::pow(c, power));
}

/// Half of the points in the lobe (n t up to 30), half anywhere, and the ends of n and theta.
template <class T>
double worstOf(T (*form)(T, const NearOne<T>&), double least) {
    std::mt19937_64 random(kSeed);
    std::uniform_real_distribution<double> share;
    double worst = 0;
    const auto look = [&](double n, double theta) {
        const auto power = static_cast<T>(n);
        const NearOne<T> x = at<T>(theta);
        const auto value = static_cast<double>(form(power, x));
        const double error = std::abs(value - reference(power, x));
        worst = error <= worst ? worst : error;  // NaN is kept
    };
    for (int i = 0; i < 20000; ++i) {
        const double n = least * std::pow(1e6 / least, share(random));
        look(n, 2 * std::asin(std::sqrt(std::min(0.5, 15 * share(random) / n))));
        look(n, kPi / 2 * share(random));
    }
    for (const double n : {least, least + 1, 999.5, 1e3, 999999.0, 1e6}) {
        for (const double theta : {0.0, 1e-300, 1e-20, 1e-8, 1e-4, kPi / 4, kPi / 3, kPi / 2}) {
            look(n, theta);
        }
    }
    return worst;
}

constexpr double kFloatUlp = 0x1p-24;

struct FormCase {
    const char* name;
    double (*exact)(double, const NearOne<double>&);
    float (*narrow)(float, const NearOne<float>&);
    double leastPower;
    double bound;
    double floatUlps;
};

template <PowerForm Form>
FormCase formCase(const char* name, double leastPower, double bound, double floatUlps) {
    return {name, power<Form, double>, power<Form, float>, leastPower, bound, floatUlps};
}

void PrintTo(const FormCase& one, std::ostream* out) { *out << one.name; }

class PowerForms : public ::testing::TestWithParam<FormCase> {};

TEST_P(PowerForms, MatchReferenceAsTheHeaderSays) {
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    const double worst = worstOf<double>(GetParam().exact, GetParam().leastPower);
    EXPECT_LE(worst, GetParam().bound);
    EXPECT_GE(worst, GetParam().bound / 2) << "the bound is not what the form does";
}

TEST_P(PowerForms, MatchReferenceInFloatToItsRounding) {
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    const double worst = worstOf<float>(GetParam().narrow, GetParam().leastPower);
    EXPECT_LE(worst, GetParam().bound + GetParam().floatUlps * kFloatUlp);
}

// The bounds: a polynomial's largest error as fit_powers.py prints it (exp2's and log2's add up),
// a lobe's likewise, a published form's as docs/powers.md has it for n in 8..1e6 (pow: ulps of the
// exponent, x exp(-x) <= 0.37 of the peak). Float adds roundings: of the exponent, 0.37 of the
// peak each, and of up to eight equal factors, one each.
INSTANTIATE_TEST_SUITE_P(All,
                         PowerForms,
                         ::testing::Values(formCase<PowerForm::Pow>("pow", 1, 1.2e-16, 3),
                                           formCase<PowerForm::Full75>("full75", 1, 1.41e-7, 4),
                                           formCase<PowerForm::Full54>("full54", 1, 5.1e-6, 4),
                                           formCase<PowerForm::Lite>("lite", 8, 1.2e-5, 4),
                                           formCase<PowerForm::Sq8d3>("sq8d3", 8, 1.0e-4, 10),
                                           formCase<PowerForm::Sq8>("sq8", 8, 1.7e-3, 10),
                                           formCase<PowerForm::Rec3m4>("rec3m4", 8, 2.02e-3, 8),
                                           formCase<PowerForm::Rec2m4>("rec2m4", 8, 1.02e-2, 8),
                                           formCase<PowerForm::Schlick>("schlick", 8, 0.205, 4),
                                           formCase<PowerForm::Bps>("bps", 8, 2.95e-2, 8),
                                           formCase<PowerForm::F8>("f8", 8, 3.55e-2, 10),
                                           formCase<PowerForm::Quadratic>("quadratic", 8, 0.281, 4),
                                           formCase<PowerForm::Cubic>("cubic", 8, 0.11, 8),
                                           formCase<PowerForm::Gauss>("gauss", 8, 2.4e-2, 8),
                                           formCase<PowerForm::Lagarde>("lagarde", 8, 1.9e-2, 4)),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(PowerForms, AreOneAtThePeakButForBps) {
    for (const double n : {1.0, 8.0, 1e3, 1e6}) {
        const NearOne<double> peak{.c = 1, .t = 0};
        EXPECT_EQ(power<PowerForm::Full75>(n, peak), 1);
        EXPECT_EQ(power<PowerForm::Full54>(n, peak), 1);
        EXPECT_EQ(power<PowerForm::Lite>(n, peak), 1);
        EXPECT_EQ(power<PowerForm::Sq8d3>(n, peak), 1);
        EXPECT_EQ(power<PowerForm::Sq8>(n, peak), 1);
        EXPECT_EQ(power<PowerForm::Rec3m4>(n, peak), 1);
        EXPECT_EQ(power<PowerForm::Rec2m4>(n, peak), 1);
        EXPECT_EQ(power<PowerForm::Cubic>(n, peak), 1);
        // -1.631 + 2.995 - 0.374 + 0.002737, exactly; to the rounding of the sum.
        EXPECT_NEAR(power<PowerForm::Bps>(n, peak), 0.992737, 1e-15);
    }
}

TEST(PowerForms, BpsIsNegativeOnTheFlankAndNeverFadesFarOut) {
    const auto ofSchlick = [](double s) {  // n = 1e6: t = (1 - s) / (1 + (n - 1) s)
        const double t = (1 - s) / (1 + (1e6 - 1) * s);
        return power<PowerForm::Bps>(1e6, NearOne<double>{.c = 1 - t, .t = t});
    };
    // The roots of the cubic without its peak, and its least value between them.
    EXPECT_GT(ofSchlick(0.0077), 0);
    EXPECT_LT(ofSchlick(0.0079), 0);
    EXPECT_LT(ofSchlick(0.1262), 0);
    EXPECT_GT(ofSchlick(0.1264), 0);
    EXPECT_NEAR(ofSchlick(0.0661), -0.00937, 5e-6);
    EXPECT_NEAR(power<PowerForm::Bps>(1e3, at<double>(kPi / 2)), 2.737e-3, 1e-15);
}

TEST(PowerForms, BpsAloneIsNegative) {
    std::mt19937_64 random(kSeed);
    std::uniform_real_distribution<double> share;
    for (int i = 0; i < 20000; ++i) {
        const double n = std::pow(1e6, share(random));
        const double angle = 12 * share(random) / std::sqrt(n);
        const NearOne<double> x = at<double>(std::min(kPi / 2, angle));
        ASSERT_GE(power<PowerForm::Full75>(n, x), 0);
        ASSERT_GE(power<PowerForm::Lite>(n, x), 0);
        ASSERT_GE(power<PowerForm::Sq8>(n, x), 0);
        ASSERT_GE(power<PowerForm::Sq8d3>(n, x), 0);
        ASSERT_GT(power<PowerForm::Rec3m4>(n, x), 0);
        ASSERT_GT(power<PowerForm::Rec2m4>(n, x), 0);
        ASSERT_GE(power<PowerForm::F8>(n, x), 0);
        ASSERT_GE(power<PowerForm::Quadratic>(n, x), 0);
        ASSERT_GE(power<PowerForm::Cubic>(n, x), 0);
    }
}

TEST(PowerForms, ReciprocalsFallAllTheWay) {
    for (const double n : {8.0, 50.0, 1e3, 1e6}) {
        double two = 1;
        double three = 1;
        for (int i = 1; i <= 2000; ++i) {
            const NearOne<double> x = at<double>(kPi / 2 * i / 2000);
            const double nextTwo = power<PowerForm::Rec2m4>(n, x);
            const double nextThree = power<PowerForm::Rec3m4>(n, x);
            ASSERT_LT(nextTwo, two);
            ASSERT_LT(nextThree, three);
            two = nextTwo;
            three = nextThree;
        }
    }
}

TEST(PowerForms, Sq8LeavesAResidueFarFromThePeak) {
    // u held at 9.03378256 where t is still small: (1 - 0.125 u + 0.0070169056 u^2)^8.
    const double q = 1 + 9.03378256 * (-0.125 + 0.0070169056 * 9.03378256);
    const double left = power<PowerForm::Sq8>(1e6, NearOne<double>{.c = 1 - 1e-4, .t = 1e-4});
    EXPECT_NEAR(left, std::pow(q, 8), 1e-5 * left + 8 * 9.1 * 0.054 * 1e-4 / q * left);
    EXPECT_NEAR(left, 1.5e-3, 5e-5);
    EXPECT_EQ(power<PowerForm::Sq8d3>(1e6, NearOne<double>{.c = 1 - 1e-4, .t = 1e-4}), 0);
}

// In float 1 - c has no digit left at t = 1e-9: c rounds to 1, and 1^n is 1.
TEST(PowerForms, FullTakesTheGivenTNearOne) {
    const float t = 1e-9F;
    const NearOne<float> given{.c = 1, .t = t};
    for (const float n : {1e3F, 1e5F, 1e6F}) {
        const double exact = std::exp(static_cast<double>(n) * std::log1p(-static_cast<double>(t)));
        // Polynomials 1.41e-7, and two roundings of the exponent and two of the result.
        EXPECT_NEAR(power<PowerForm::Full75>(n, given), exact, 1.41e-7 + 4 * kFloatUlp);
    }
    EXPECT_LT(power<PowerForm::Full75>(1e6F, given), 0.9991F);
    EXPECT_EQ(power<PowerForm::Full75>(1e6F, NearOne<float>{.c = 1, .t = 0}), 1);
}

TEST(PowerForms, FullIsTheLeastPowerAtACosineOfZero) {
    const NearOne<float> narrow{.c = 0, .t = 1};
    const NearOne<double> exact{.c = 0, .t = 1};
    EXPECT_LE(power<PowerForm::Full75>(1.0F, narrow), 1.2e-38F);
    EXPECT_LE(power<PowerForm::Full75>(1.0, exact), 1.2e-38);
    EXPECT_EQ(power<PowerForm::Full75>(0.0F, narrow), 1);
}

/// As printed, quotients of like terms [Romanyuk2023].
struct PrintedCubic {
    long double a, b, c;
};
PrintedCubic printedCubic(long double n) {
    const long double Q = 0.5L;
    const long double G = 1 / 18.0L;
    const long double R = std::pow(Q, 1 / n);
    const long double L = std::pow(G, 1 / n);
    const long double below =
        L * L * L * (R - R * R) + L * L * (R * R * R - R) - L * R * R * (R - 1);
    return {(L * R * (R - L) + G * R * (1 - R) + L * Q * (L - 1)) / below,
            (G * R * (R * R - 1) + L * R * (L * L - R * R) + L * Q * (1 - L * L)) / below,
            (G * R * (R - R * R) + L * L * Q * (L - 1) + L * R * (L * R * R - L * L * R)) / below};
}

TEST(CubicCoefficients, AreThoseOfThePublishedQuotients) {
    for (const double n : {3.0, 8.0, 50.0, 300.0, 1000.0}) {
        const CubicCoefficients ours = cubicCoefficients(n);
        const PrintedCubic printed = printedCubic(n);
        // The printed numerators and the denominator are of the size of 1 and cancel to n^-3; ours
        // have the roundings of a double, n of them in 1 - slope + a.
        const double lost = 100 * (n * n * n * 0x1p-64 + n * 0x1p-53);
        EXPECT_NEAR(ours.a, static_cast<double>(printed.a), lost * std::max(1.0, std::abs(ours.a)));
        EXPECT_NEAR(ours.b, static_cast<double>(printed.b), lost * std::max(1.0, std::abs(ours.b)));
        EXPECT_NEAR(ours.c, static_cast<double>(printed.c), lost * std::max(1.0, std::abs(ours.c)));
    }
}

TEST(CubicCoefficients, PassThroughTheirPointsAndAreCutWhereLeast) {
    for (const double n : {8.0, 50.0, 1e3, 1e6}) {
        const CubicCoefficients k = cubicCoefficients(n);
        const auto uncut = [&](double t) { return (1 - t) * (1 - t * (k.slope - k.a * t)); };
        // The points' t and the value's terms are known to some ulps.
        EXPECT_NEAR(uncut(-std::expm1(std::log(0.5) / n)), 0.5, 1e-14);
        EXPECT_NEAR(uncut(-std::expm1(std::log(1.0 / 18) / n)), 1.0 / 18, 1e-14);
        EXPECT_LT(uncut(k.tCut), uncut(0.99 * k.tCut));
        EXPECT_LT(uncut(k.tCut), uncut(1.01 * k.tCut));
        EXPECT_GT(uncut(k.tCut), 0) << "never reaches 0";
        const auto value = [&](double t) {
            return power<PowerForm::Cubic>(n, NearOne<double>{.c = 1 - t, .t = t});
        };
        EXPECT_EQ(value(0.999 * k.tCut), uncut(0.999 * k.tCut));
        EXPECT_EQ(value(k.tCut), 0);
    }
}

TEST(CubicCoefficients, OfASquareAreThoseOfTheSquare) {
    const CubicCoefficients k = cubicCoefficients(2);
    EXPECT_NEAR(k.a, 0, 1e-14);
    EXPECT_NEAR(k.b, 1, 1e-14);
    EXPECT_NEAR(k.c, 0, 1e-14);
    EXPECT_NEAR(k.cut, 0, 1e-7) << "a double zero of c^2: known to the root of an ulp";
}

template <class T>
void expectOctaves(const std::vector<T>& values) {
    for (const T x : values) {
        int exponent = 0;
        T mantissa = std::frexp(x, &exponent) * 2;  // in [1, 2)
        --exponent;
        if (mantissa / 2 >= std::bit_cast<T>(FloatBits<T>::kRootHalf)) {
            mantissa /= 2;
            ++exponent;
        }
        const Octave<T> octave = octaveOf(x);
        EXPECT_EQ(octave.octave, static_cast<T>(exponent)) << x;
        EXPECT_EQ(octave.s, mantissa - 1) << x;
    }
}

template <class T>
std::vector<T> aroundTheThresholds() {
    std::vector<T> values{std::numeric_limits<T>::min(), std::numeric_limits<T>::max()};
    for (const T about : {std::bit_cast<T>(FloatBits<T>::kRootHalf), T(0.5), T(1), T(1e-30)}) {
        values.insert(values.end(),
                      {std::nextafter(about, T(0)), about, std::nextafter(about, T(2))});
    }
    std::mt19937_64 random(kSeed);
    std::uniform_real_distribution<double> exponent(-120, 120);
    for (int i = 0; i < 1000; ++i) values.push_back(static_cast<T>(std::exp2(exponent(random))));
    return values;
}

TEST(Octave, IsThatOfFrexpAtAndAboutTheThreshold) {
    expectOctaves(aroundTheThresholds<float>());
    expectOctaves(aroundTheThresholds<double>());
}

}  // namespace
}  // namespace gonio::proc
