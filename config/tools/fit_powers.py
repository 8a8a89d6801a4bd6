#!/usr/bin/env python3
"""Fits the coefficients of proc/models/fast_exp.h and proc/models/powers.h anew and prints them beside
those in the headers, each set with the largest error that it makes:

    /usr/bin/python3 config/tools/fit_powers.py [--starts N] [--seed N]

Needs numpy and scipy (Debian: apt-get install python3-numpy python3-scipy). Nothing is written. Exit
code 0: no set in the headers errs by more than 3 % above its refit; 1: one does; 2: wrong usage, or a
package or a header is missing.

Polynomials, by linear programming: the largest weighted error e over a grid is minimised subject to
-e <= W(x) (P(x) - L(x)) <= e in every point. The solver's tolerance is absolute (1e-7), so each program
is solved again for the correction, in units of the error that is left.
    exp2<d>   1 + f p(f) for 2^f, |f| <= 1/2: relative error.
    log2<d>   s p(s) for log2(1 + s), 1 + s in [sqrt(1/2), sqrt(2)]: error in c^n at the worst n. With
              L = -ln c it is W = max over n of n exp(-n L) = 1 / (e L); c = 1 + s where s <= 0, and
              (1 + s) / 2 or less where s > 0.
    lite<5>   t p(t) for -log2(1 - t), 0 < t < 1: the same with n >= 8 only, W = 8 exp(-8 L) where
              L > 1/8.
Lobes, by Nelder and Mead's simplex on the logarithm of the largest |f(n t, t) - (1 - t)^n|, n >= 8: sq8,
sq8d3, rec2m4, rec3m4. The least maximum is not a smooth function, and a simplex stops early: it is begun
anew where it stopped until that no longer helps, from the first terms of the series of c^n and from
random starts about them. This tells the error to a per cent or so, and some coefficients no better: the
clip of sq8 and its factor of t, or rec2m4's of t, may move by several per cent at the same error. Of
the clips that do as well sq8 has one near the least of its parabola, where what stays far from the peak
is least; that of sq8d3 (26.5) only keeps u^2 in range, and is not fitted.
"""
import argparse
import math
import pathlib
import re
import sys

try:
    import numpy as np
    from scipy.optimize import linprog, minimize
except ImportError as error:
    print(f"fit_powers: {error}: apt-get install python3-numpy python3-scipy, and run it with "
          "/usr/bin/python3", file=sys.stderr)
    sys.exit(2)

ROOT = pathlib.Path(__file__).resolve().parents[2]
LN2 = math.log(2)
LEAST_POWER = 8
ALLOWED = 1.03


def in_header(file, begin, end):
    """The factors of f, s, t, u between two marks of a header: T(0.25), T(-0.0153642856), ..."""
    path = ROOT / "proc/models" / file
    try:
        text = path.read_text()
        first = text.index(begin) + len(begin)
        part = text[first:text.index(end, first)]
    except (OSError, ValueError) as error:
        print(f"fit_powers: {path}: '{begin}' .. '{end}': {error}", file=sys.stderr)
        sys.exit(2)
    return np.array([float(number) for number in re.findall(r"T\((-?\d*\.\d+)\)", part)])


def chebyshev(a, b, count):
    return (a + b) / 2 - (b - a) / 2 * np.cos(np.linspace(0, math.pi, count))


class Polynomial:
    """x p(x) for `target`, the error weighted."""

    def __init__(self, x, degree, target, weight):
        self.columns = np.stack([x**k for k in range(1, degree + 1)], axis=1)
        self.target = target
        self.weight = weight

    def error(self, p):
        return np.abs(self.weight * (self.columns @ p - self.target)).max()

    def fit(self):
        scale = np.abs(self.columns).max(axis=0)
        weighted = self.weight[:, None] * self.columns / scale
        wanted = self.weight * self.target
        count = len(scale)
        bound = -np.ones((len(wanted), 1))
        rows = np.block([[weighted, bound], [-weighted, bound]])
        p = np.linalg.lstsq(weighted, wanted, rcond=None)[0]
        for _ in range(4):
            left = weighted @ p - wanted
            unit = np.abs(left).max()
            solved = linprog([0] * count + [1], A_ub=rows, b_ub=np.concatenate([-left, left]) / unit,
                             bounds=[(None, None)] * (count + 1), method="highs")
            p = p + solved.x[:count] * unit
        return p / scale


def exp2_polynomial(degree):
    f = chebyshev(-0.5, 0.5, 1501)
    return Polynomial(f, degree, np.exp2(f) - 1, np.exp2(-f))


def log2_polynomial(degree):
    s = chebyshev(math.sqrt(0.5) - 1, math.sqrt(2) - 1, 2000)
    s = s[np.abs(s) > 1e-7]
    log = np.log1p(s)
    attenuation = np.where(s <= 0, -log, LN2 - log)
    return Polynomial(s, degree + 1, log / LN2, LN2 / (math.e * attenuation))


def lite_polynomial(degree):
    t = chebyshev(0, 1, 3000)[1:-1]
    log = -np.log1p(-t)
    weight = np.where(log > 1 / LEAST_POWER, LEAST_POWER * np.exp(-LEAST_POWER * log),
                      1 / (math.e * log))
    return Polynomial(t, degree, log / LN2, LN2 * weight)


class Lobes:
    """n and t where a lobe is compared with (1 - t)^n: even in sqrt(n L), and out to the horizon."""

    def __init__(self, powers, steps):
        n, t = [], []
        for power in powers:
            near = -np.expm1(-40 / power * np.linspace(0, 1, steps)[1:]**2)
            near = near[near < 1]
            far = np.geomspace(near.max(), 1, 30)
            t += [near, far]
            n.append(np.full(len(near) + len(far), power))
        self.t = np.concatenate(t)
        n = np.concatenate(n)
        self.u = n * self.t
        with np.errstate(divide="ignore"):
            self.exact = np.exp(n * np.log1p(-self.t))

    def error(self, form, k):
        return np.abs(form(k, self.u, self.t) - self.exact).max()


def sq8(k, u, t):
    u = np.minimum(u, k[0])
    return (1 + u * (-0.125 + k[1] * u - k[2] * t))**8


def sq8d3(k, u, t):
    u = np.minimum(u, 26.5)
    q = 1 + u * (-0.125 + k[0] * u - k[1] * t - (k[2] * u * u - t * (k[3] * u - k[4] * t)))
    return np.maximum(q, 0)**8


def rec2m4(k, u, t):
    return np.abs(1 + u * (0.25 + k[0] * u + k[1] * t))**-4.0


def rec3m4(k, u, t):
    return np.abs(1 + u * (0.25 + k[0] * t + u * (k[1] + k[2] * t + k[3] * u)))**-4.0


def simplex(objective, x):
    """From x until beginning anew gains less than 1e-4 of the error."""
    value = objective(x)
    for attempt in range(12):
        edge = 0.05 if attempt < 6 else 0.01
        corners = np.vstack([x, x * (1 + edge * np.eye(len(x)))])
        found = minimize(objective, x, method="Nelder-Mead",
                         options={"initial_simplex": corners, "maxfev": 3000, "xatol": 1e-12,
                                  "fatol": 1e-10, "adaptive": len(x) > 3})
        gain = value - found.fun
        x, value = found.x, found.fun
        if attempt > 3 and gain < 1e-4:
            break
    return x, value


def fit_lobe(form, series, grid, starts, random):
    def objective(k):
        return math.log(grid.error(form, k))

    best = None
    for start in range(starts):
        spread = 0.1 * random.standard_normal(len(series)) if start > 0 else 0
        found = simplex(objective, np.array(series) * (1 + spread))
        if best is None or found[1] < best[1]:
            best = found
    return best[0]


def report(name, of_header, header_error, refit, refit_error):
    """Prints one set; returns whether the header's does as well as the refit."""
    good = header_error <= ALLOWED * refit_error
    print(f"{name}: largest error {header_error:.4g} in the header, {refit_error:.4g} refitted"
          + ("" if good else "  <- the header's is worse"))
    for ours, anew in zip(of_header, refit):
        print(f"    {ours:-16.11g}  {anew:-16.11g}")
    return good


def check_polynomial(name, polynomial, of_header):
    refit = polynomial.fit()
    return report(name, of_header, polynomial.error(of_header), refit, polynomial.error(refit))


def main():
    parser = argparse.ArgumentParser(description="Fits the coefficients of the power forms anew.")
    parser.add_argument("--starts", type=int, default=3, help="of each simplex fit, 1 or more")
    parser.add_argument("--seed", type=int, default=1, help="of the random starts")
    options = parser.parse_args()
    if options.starts < 1:
        parser.error(f"--starts {options.starts}: wanted 1 or more")

    good = True
    for degree, begin, end in ((3, "(Degree == 3) {", "}"), (4, "(Degree == 4) {", "}"),
                               (5, "} else {", "}")):
        good &= check_polynomial(f"exp2<{degree}>", exp2_polynomial(degree),
                                 in_header("fast_exp.h", begin, end))
    for degree, begin, end in ((5, "(Degree == 5) {", "} else"), (7, "(Degree == 5) {", "/// e^x")):
        numbers = in_header("fast_exp.h", begin, end)
        good &= check_polynomial(f"log2<{degree}>", log2_polynomial(degree), numbers[-degree - 1:])
    good &= check_polynomial("lite<5>", lite_polynomial(5),
                             in_header("powers.h", "T lite5(", "return"))

    grid = Lobes(np.concatenate([np.geomspace(LEAST_POWER, 1e3, 28), [1e4, 1e6]]), 500)
    finer = Lobes(np.concatenate([np.geomspace(LEAST_POWER, 1e3, 200), [1e4, 1e5, 1e6]]), 2000)
    random = np.random.default_rng(options.seed)
    # c^n = exp(-u - u t / 2 - ...): the first terms of its 8th and -4th root.
    lobes = (("sq8", sq8, [8.9, 1 / 128, 1 / 16], slice(0, None)),
             ("sq8d3", sq8d3, [1 / 128, 1 / 16, 1 / 3072, 1 / 128, 1 / 24], slice(1, None)),
             ("rec2m4", rec2m4, [1 / 32, 1 / 8], slice(0, None)),
             ("rec3m4", rec3m4, [1 / 8, 1 / 32, 1 / 16, 1 / 384], slice(0, None)))
    for name, form, series, fitted in lobes:
        numbers = in_header("powers.h", f"T {name}(", "return inverse" if "rec" in name else "\n}")
        numbers = np.array([abs(k) for k in numbers if k not in (0.25, -0.125)])
        numbers = LOBE_ORDER[name](numbers)[fitted]
        refit = fit_lobe(form, series, grid, options.starts, random)
        good &= report(name, numbers, finer.error(form, numbers), refit, finer.error(form, refit))
    return 0 if good else 1


# In the order of a header's text.
LOBE_ORDER = {
    "sq8": lambda k: k,
    "sq8d3": lambda k: k[[0, 4, 5, 1, 2, 3]],
    "rec2m4": lambda k: k,
    "rec3m4": lambda k: k[[3, 0, 1, 2]],
}

if __name__ == "__main__":
    sys.exit(main())
