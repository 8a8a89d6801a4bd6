"""Reads a Zemax tabular BSDF and prints f at directions, plainly and slowly.

Written from the description of the format alone, to be held against the program's own reader and
writer: it shares no code with them. Usage: zemax.py FILE < PAIRS; a pair is a line
theta_i,phi_i,theta_o,phi_o in degrees, the answer a line of f in 1/sr (XYZ: three), nan where there
is none.
"""
import math
import sys

SECTIONS = {"monochrome": ["monochrome"], "xyz": ["tristimulusx", "tristimulusy", "tristimulusz"]}
LISTS = ("samplerotation", "angleofincidence", "scatterazimuth", "scatterradial")


class Table:
    def __init__(self, path):
        with open(path, encoding="utf-8-sig") as file:
            lines = [line for line in file.read().split("\n") if not line.lstrip().startswith("#")]
        self.words = " ".join(lines).lower().split()
        self.at = 0
        self.header = {}
        while self.words[self.at] not in ("monochrome", "tristimulusx"):
            key = self.take()
            if key in LISTS:
                self.header[key] = self.numbers(int(self.take()))
            else:
                self.header[key] = self.take()
        self.rotations = self.header.get("samplerotation", [0.0])
        self.incidences = self.header["angleofincidence"]
        self.azimuths = self.header["scatterazimuth"]
        self.radials = self.header["scatterradial"]
        self.planes = [self.section(name) for name in SECTIONS[self.header["spectralcontent"]]]
        if self.at != len(self.words):
            raise ValueError("more after the last DataEnd: " + self.words[self.at])

    def take(self):
        self.at += 1
        return self.words[self.at - 1]

    def expect(self, word):
        seen = self.take()
        if seen != word:
            raise ValueError(f"{seen!r}, wanted {word!r}")

    def numbers(self, count):
        return [float(self.take()) for _ in range(count)]

    def section(self, name):
        """blocks[rotation][incidence][azimuth][radial]"""
        self.expect(name)
        self.expect("databegin")
        rotations = []
        for _ in self.rotations:
            blocks = []
            for _ in self.incidences:
                self.expect("tis")
                self.numbers(1)
                blocks.append([self.numbers(len(self.radials)) for _ in self.azimuths])
            rotations.append(blocks)
        self.expect("dataend")
        return rotations

    def evaluate(self, theta_i, phi_i, theta_o, phi_o):
        wi, wo = direction(theta_i, phi_i), direction(theta_o, phi_o)
        if wi[2] <= 0 or wo[2] <= 0:
            return [math.nan] * len(self.planes)
        mirror, u, v = specular_frame(wi, phi_i)
        radial = math.degrees(math.atan2(norm(cross(mirror, wo)), dot(mirror, wo)))
        azimuth = math.degrees(math.atan2(dot(wo, v), dot(wo, u))) % 360
        if self.header["symmetry"] == "planesymmetrical" and azimuth > 180:
            azimuth = 360 - azimuth
        # A sample turned by r under a fixed light has the light at -r; one rotation is of any.
        turned = -phi_i % 360 if len(self.rotations) > 1 else self.rotations[0]
        return [self.interpolate(plane, turned, theta_i, azimuth, radial)
                for plane in self.planes]

    def interpolate(self, plane, turned, theta_i, azimuth, radial):
        """Linear in all four; nan where a corner that counts is no data."""
        total = 0.0
        for k, wk in weights(self.rotations, turned):
            for i, wi in weights(self.incidences, theta_i):
                for a, wa in weights(self.azimuths, azimuth):
                    for r, wr in weights(self.radials, radial):
                        total += wk * wi * wa * wr * self.node(plane[k], i, a, r)
        return total

    def node(self, blocks, i, a, r):
        """A node below the horizon, or with exactly 0, holds no data."""
        value = blocks[i][a][r]
        mirror, u, v = specular_frame(direction(self.incidences[i], 0), 0)
        azimuth, radial = math.radians(self.azimuths[a]), math.radians(self.radials[r])
        z = math.cos(radial) * mirror[2] + math.sin(radial) * (
            math.cos(azimuth) * u[2] + math.sin(azimuth) * v[2])
        return value if z > 1e-12 and value != 0 else math.nan


def weights(axis, value):
    """The nodes about a value with their weights; those of weight 0 are left out."""
    if len(axis) == 1:
        return [(0, 1.0 if abs(axis[0] - value) < 1e-6 else math.nan)]
    if value < axis[0] - 1e-6 or value > axis[-1] + 1e-6:
        return [(0, math.nan)]
    k = max(i for i in range(len(axis) - 1) if i == 0 or axis[i] <= value)
    t = min(max((value - axis[k]) / (axis[k + 1] - axis[k]), 0.0), 1.0)
    return [(i, w) for i, w in ((k, 1 - t), (k + 1, t)) if w > 1e-12]


def specular_frame(wi, phi_i):
    """The mirror direction s, u from it toward the normal, v = s x u."""
    s = (-wi[0], -wi[1], wi[2])
    u = tuple(n - s[2] * c for n, c in zip((0.0, 0.0, 1.0), s))
    if norm(u) < 1e-9:  # the limit: u points to the side that the light comes from
        u = (math.cos(math.radians(phi_i)), math.sin(math.radians(phi_i)), 0.0)
    length = norm(u)
    u = tuple(c / length for c in u)
    return s, u, cross(s, u)


def direction(theta, phi):
    t, p = math.radians(theta), math.radians(phi)
    return (math.sin(t) * math.cos(p), math.sin(t) * math.sin(p), math.cos(t))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def norm(a):
    return math.sqrt(dot(a, a))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def main():
    table = Table(sys.argv[1])
    for line in sys.stdin:
        print(",".join(repr(f) for f in table.evaluate(*map(float, line.split(",")))))


main()
