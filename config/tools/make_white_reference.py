#!/usr/bin/env python3
"""Makes config/references/white-ptfe.csv from NIST's BRDF of sintered PTFE. Run once:

    config/tools/make_white_reference.py DATA/white_reference/PTFE.data.csv config/references/white-ptfe.csv

In: unpolarised f (column f_r11) at 351, 532, 633 and 1064 nm, incidences 0, 15 .. 75 degrees, outgoing
directions on a grid of direction cosines, 0.1 apart. Out: f at the rig's incidences and bands, on nodes
every 5 degrees of theta_o and every 10 degrees of phi_o.

1. Azimuth. The file's theta_i is negative: its light comes from phi = 180 degrees. Turned by 180
   degrees the light is at phi = 0, as everywhere in this project, and the mirror direction at 180. The
   tool checks that the peak of the 60 degree data lies there.
2. Symmetry. PTFE is isotropic: f(phi) = f(-phi), so both halves of the plane are used for each node;
   at normal incidence, the mean over all azimuths.
3. Direction. At each node a quadratic in the two direction cosines is fitted to the measured points
   around it, with Gaussian weights of 0.14 (1.4 grid steps): it passes near its points to the data's
   noise (they have three digits) and bridges the few directions that the detector could not see.
4. Incidence. The parabola through the three nearest measured incidences [Lagrange].
5. Wavelength. Linear between the two nearest measured ones.
"""
import csv
import math
import sys

INCIDENCES = [0, 20, 40, 60]
BANDS_NM = [630, 525, 465]
THETAS = list(range(0, 85, 5))
PHIS = list(range(0, 190, 10))
WEIGHT_WIDTH = 0.14

HEADER = """# gonio reference 1
# name: white-ptfe
# citation: T. A. Germer, Full four-dimensional and reciprocal Mueller matrix bidirectional reflectance distribution function of sintered polytetrafluoroethylene, Applied Optics (2017)
# licence: NIST data, work of a US federal employee, not subject to copyright in the USA
# made by: config/tools/make_white_reference.py from PTFE.data.csv
# u_common: 0.005
# u_per_direction: 0.003
# Light at phi = 0; the mirror direction is at phi_o = 180; 180..360 mirrors 0..180. f in 1/sr at 630, 525, 465 nm.
"""


def read(path):
    """{(wavelength in nm, incidence): [(x, y, f)]}, light at phi = 0."""
    data = {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            wavelength = round(1000 * float(row["lambda"]))
            incidence = round(abs(float(row["thetai"])))
            sin_theta = math.sin(math.radians(float(row["thetar"])))
            phi = math.radians(float(row["phir"]) + 180)
            point = (sin_theta * math.cos(phi), sin_theta * math.sin(phi), float(row["f_r11"]))
            data.setdefault((wavelength, incidence), []).append(point)
    return data


def solve(matrix, right):
    """Gauss elimination with pivots; the system is 6 x 6 and positive definite."""
    n = len(right)
    rows = [list(matrix[i]) + [right[i]] for i in range(n)]
    for column in range(n):
        pivot = max(range(column, n), key=lambda r: abs(rows[r][column]))
        rows[column], rows[pivot] = rows[pivot], rows[column]
        for r in range(column + 1, n):
            factor = rows[r][column] / rows[column][column]
            for c in range(column, n + 1):
                rows[r][c] -= factor * rows[column][c]
    x = [0.0] * n
    for r in reversed(range(n)):
        x[r] = (rows[r][n] - sum(rows[r][c] * x[c] for c in range(r + 1, n))) / rows[r][r]
    return x


def local_quadratic(points, x0, y0):
    """Value at (x0, y0) of the quadratic fitted to the points around it."""
    matrix = [[0.0] * 6 for _ in range(6)]
    right = [0.0] * 6
    for x, y, f in points:
        dx, dy = (x - x0) / WEIGHT_WIDTH, (y - y0) / WEIGHT_WIDTH
        distance2 = dx * dx + dy * dy
        if distance2 > 16:
            continue
        weight = math.exp(-distance2 / 2)
        terms = [1, dx, dy, dx * dx, dx * dy, dy * dy]
        for i in range(6):
            right[i] += weight * terms[i] * f
            for j in range(6):
                matrix[i][j] += weight * terms[i] * terms[j]
    return solve(matrix, right)[0]


def at_measured_incidence(points, incidence, theta, phi):
    sin_theta = math.sin(math.radians(theta))
    azimuths = PHIS[:-1] + [p + 180 for p in PHIS[:-1]] if incidence == 0 else [phi, -phi]
    values = [
        local_quadratic(points, sin_theta * math.cos(math.radians(a)), sin_theta * math.sin(math.radians(a)))
        for a in azimuths
    ]
    return sum(values) / len(values)


def lagrange(nodes, values, x):
    total = 0.0
    for i, node in enumerate(nodes):
        weight = 1.0
        for j, other in enumerate(nodes):
            if i != j:
                weight *= (x - other) / (node - other)
        total += weight * values[i]
    return total


def main(source, target):
    data = read(source)
    peak = max(data[(532, 60)], key=lambda p: p[2])
    if peak[0] > -0.5:
        sys.exit(f"{source}: the peak at 60 degrees lies at x = {peak[0]:.2f}, wanted the mirror side x < -0.5")
    measured = sorted({incidence for _, incidence in data})
    wavelengths = sorted({wavelength for wavelength, _ in data})
    cache = {}

    def node(wavelength, incidence, theta, phi):
        key = (wavelength, incidence, theta, phi if incidence and theta else 0)
        if key not in cache:
            cache[key] = at_measured_incidence(data[(wavelength, incidence)], incidence, theta, phi)
        return cache[key]

    def value(nm, incidence, theta, phi):
        below = max(w for w in wavelengths if w <= nm)
        above = min(w for w in wavelengths if w >= nm)
        nearest = sorted(sorted(measured, key=lambda m: abs(m - incidence))[:3])
        f = [lagrange(nearest, [node(w, m, theta, phi) for m in nearest], incidence) for w in (below, above)]
        share = (nm - below) / (above - below) if above > below else 0
        return f[0] + share * (f[1] - f[0])

    with open(target, "w", newline="\n") as out:
        out.write(HEADER)
        out.write("theta_i,theta_o,phi_o,f_r,f_g,f_b\n")
        for incidence in INCIDENCES:
            for theta in THETAS:
                for phi in PHIS:
                    bands = ",".join(f"{value(nm, incidence, theta, phi):.5f}" for nm in BANDS_NM)
                    out.write(f"{incidence},{theta},{phi},{bands}\n")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: make_white_reference.py PTFE.data.csv white-ptfe.csv")
    main(sys.argv[1], sys.argv[2])
