"""Reads a MERL table and prints f at directions, plainly and slowly.

Written from the description of the format alone, to be held against the program's own reader and
writer: it shares no code with them. Usage: merl.py FILE < PAIRS; a pair is a line
theta_i,phi_i,theta_o,phi_o in degrees, the answer a line of R, G, B in 1/sr, nan where there is none.
"""
import math
import struct
import sys

SCALES = (1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0)


class Table:
    def __init__(self, path):
        with open(path, "rb") as file:
            self.bytes = file.read()
        self.dims = struct.unpack_from("<3i", self.bytes, 0)
        if len(self.bytes) != 12 + 3 * 8 * self.dims[0] * self.dims[1] * self.dims[2]:
            raise ValueError("the size of the file is not that of its counts")

    def value(self, colour, h, d, p):
        """Edges: nothing lies beyond the last node; phi_diff goes round."""
        h, d, p = min(h, self.dims[0] - 1), min(d, self.dims[1] - 1), p % self.dims[2]
        index = p + self.dims[2] * (d + self.dims[1] * (h + self.dims[0] * colour))
        stored = struct.unpack_from("<d", self.bytes, 12 + 8 * index)[0]
        return stored * SCALES[colour] if stored >= 0 else math.nan

    def evaluate(self, theta_i, phi_i, theta_o, phi_o):
        wi, wo = direction(theta_i, phi_i), direction(theta_o, phi_o)
        if wi[2] <= 0 or wo[2] <= 0:
            return [math.nan] * 3
        half = [a + b for a, b in zip(wi, wo)]
        theta_h = math.atan2(math.hypot(half[0], half[1]), half[2])
        phi_h = math.atan2(half[1], half[0])
        diff = about_y(about_z(wi, -phi_h), -theta_h)
        theta_d = math.atan2(math.hypot(diff[0], diff[1]), diff[2])
        phi_d = math.atan2(diff[1], diff[0]) % math.pi
        at = (self.dims[0] * math.sqrt(theta_h / (math.pi / 2)),
              self.dims[1] * theta_d / (math.pi / 2),
              self.dims[2] * phi_d / math.pi)
        return [self.interpolate(colour, *at) for colour in range(3)]

    def interpolate(self, colour, h, d, p):
        total = 0.0
        for i, wi in corners(h):
            for j, wj in corners(d):
                for k, wk in corners(p):
                    total += wi * wj * wk * self.value(colour, i, j, k)
        return total


def corners(x):
    k, t = math.floor(x), x - math.floor(x)
    return [(i, w) for i, w in ((k, 1 - t), (k + 1, t)) if w > 1e-12]


def direction(theta, phi):
    t, p = math.radians(theta), math.radians(phi)
    return (math.sin(t) * math.cos(p), math.sin(t) * math.sin(p), math.cos(t))


def about_z(v, angle):
    c, s = math.cos(angle), math.sin(angle)
    return (c * v[0] - s * v[1], s * v[0] + c * v[1], v[2])


def about_y(v, angle):
    c, s = math.cos(angle), math.sin(angle)
    return (c * v[0] + s * v[2], v[1], -s * v[0] + c * v[2])


def main():
    table = Table(sys.argv[1])
    for line in sys.stdin:
        print(",".join(repr(f) for f in table.evaluate(*map(float, line.split(",")))))


main()
