"""Reads an RGL tensor file (.bsdf) and prints f at directions, plainly and slowly.

Written from the description of the format and [Dupuy2018] alone, to be held against the program's
own reader and writer: it shares no code with them. Usage: rgl.py FILE < PAIRS; a pair is a line
theta_i,phi_i,theta_o,phi_o in degrees, the answer a line of R, G, B (or one value for each
wavelength) in 1/sr, nan where there is none. The file holds f cos(theta_o); its cosine is divided out.
"""
import math
import struct
import sys

TYPES = {1: "B", 2: "b", 3: "H", 4: "h", 5: "I", 6: "i", 7: "Q", 8: "q", 9: "e", 10: "f", 11: "d"}


def fields_of(path):
    """name -> (shape, flat values)"""
    with open(path, "rb") as file:
        data = file.read()
    if data[:12] != b"tensor_file\0" or data[12:14] != b"\1\0":
        raise ValueError("no tensor file of version 1.0")
    count, at = struct.unpack_from("<I", data, 14)[0], 18
    fields = {}
    for _ in range(count):
        length = struct.unpack_from("<H", data, at)[0]
        name = data[at + 2:at + 2 + length].decode()
        at += 2 + length
        ndim, dtype, offset = struct.unpack_from("<HBQ", data, at)
        shape = struct.unpack_from(f"<{ndim}Q", data, at + 11)
        at += 11 + 8 * ndim
        values = struct.unpack_from(f"<{math.prod(shape)}{TYPES[dtype]}", data, offset)
        fields[name] = (shape, values)
    return fields


class Picture:
    """Values at the nodes of a grid over the unit square, one grid for each (phi_i, theta_i) of
    `parameters`, linear between nodes and between grids."""

    def __init__(self, shape, values, parameters=()):
        self.height, self.width = shape[-2:]
        self.values, self.parameters = values, parameters

    def slices(self, position):
        """The grids about a position and their weights."""
        found = [(0, 1.0)]
        for axis, x in zip(self.parameters, position):
            found = [(s * len(axis) + k, w * t) for s, w in found for k, t in weights(axis, x)]
        return found

    def node(self, s, x, y):
        return self.values[(s * self.height + y) * self.width + x]

    def at(self, u, v, position=()):
        x, tx = cell(u, self.width)
        y, ty = cell(v, self.height)
        return sum(w * ((1 - ty) * ((1 - tx) * self.node(s, x, y) + tx * self.node(s, x + 1, y)) +
                        ty * ((1 - tx) * self.node(s, x, y + 1) + tx * self.node(s, x + 1, y + 1)))
                   for s, w in self.slices(position))


class Warp(Picture):
    """The same as a density: where in the unit square a point of it comes from when rows are drawn
    by their integrals and then a place within the row."""

    def __init__(self, shape, values, parameters):
        super().__init__(shape, values, parameters)
        grids = math.prod(shape[:-2])
        self.rows, self.below, scaled = {}, {}, []
        for s in range(grids):
            along = []  # integrals along each row, up to each node
            for y in range(self.height):
                sums = [0.0]
                for x in range(self.width - 1):
                    sums.append(sums[-1] + 0.5 * (self.node(s, x, y) + self.node(s, x + 1, y)))
                along.append(sums)
            below = [0.0]
            for y in range(self.height - 1):
                below.append(below[-1] + 0.5 * (along[y][-1] + along[y + 1][-1]))
            self.rows[s] = [[c / below[-1] for c in row] for row in along]
            self.below[s] = [c / below[-1] for c in below]
            start = s * self.height * self.width
            scaled += [value / below[-1] for value in values[start:start + self.height * self.width]]
        self.values = scaled

    def invert(self, u, v, position):
        x, tx = cell(u, self.width)
        y, ty = cell(v, self.height)
        used = self.slices(position)

        def blended(get):
            return sum(w * get(s) for s, w in used)

        left = blended(lambda s: (1 - ty) * self.node(s, x, y) + ty * self.node(s, x, y + 1))
        right = blended(lambda s: (1 - ty) * self.node(s, x + 1, y) + ty * self.node(s, x + 1, y + 1))
        before = blended(lambda s: (1 - ty) * self.rows[s][y][x] + ty * self.rows[s][y + 1][x])
        lower = blended(lambda s: self.rows[s][y][-1])
        upper = blended(lambda s: self.rows[s][y + 1][-1])
        along = before + tx * (left + 0.5 * tx * (right - left))
        across = blended(lambda s: self.below[s][y]) + ty * (lower + 0.5 * ty * (upper - lower))
        return along / ((1 - ty) * lower + ty * upper), across


def weights(axis, x):
    if len(axis) == 1:
        return [(0, 1.0)]
    x = min(max(x, axis[0]), axis[-1])
    k = max(i for i in range(len(axis) - 1) if i == 0 or axis[i] <= x)
    t = (x - axis[k]) / (axis[k + 1] - axis[k])
    return [(k, 1 - t), (k + 1, t)]


def cell(x, nodes):
    x = min(max(x, 0.0), 1.0) * (nodes - 1)
    k = min(int(x), nodes - 2)
    return k, x - k


class Material:
    def __init__(self, path):
        fields = fields_of(path)
        phi, theta = fields["phi_i"][1], fields["theta_i"][1]
        self.isotropic = len(phi) <= 2
        self.ndf = Picture(*fields["ndf"])
        self.sigma = Picture(*fields["sigma"])
        self.vndf = Warp(*fields["vndf"], (phi, theta))
        colours = "rgb" if "rgb" in fields else "spectra"
        self.channels = fields[colours][0][2]
        axis = tuple(range(self.channels))
        self.values = Picture(*fields[colours], (phi, theta, axis))

    def evaluate(self, theta_i, phi_i, theta_o, phi_o):
        wi, wo = direction(theta_i, phi_i), direction(theta_o, phi_o)
        if wi[2] <= 0 or wo[2] <= 0:
            return [math.nan] * self.channels
        half = [a + b for a, b in zip(wi, wo)]
        theta_h, phi_h = spherical(half)
        theta, phi = spherical(wi)
        turned = phi_h - phi if self.isotropic else phi_h
        u, v = theta_to_u(theta_h), phi_to_v(turned) % 1.0
        sample = self.vndf.invert(u, v, (phi, theta))
        scale = self.ndf.at(u, v) / (4 * self.sigma.at(theta_to_u(theta), phi_to_v(phi)))
        return [self.values.at(*sample, (phi, theta, c)) * scale / wo[2]
                for c in range(self.channels)]


def theta_to_u(theta):
    return math.sqrt(2 * theta / math.pi)


def phi_to_v(phi):
    return (phi + math.pi) / (2 * math.pi)


def spherical(w):
    return math.atan2(math.hypot(w[0], w[1]), w[2]), math.atan2(w[1], w[0])


def direction(theta, phi):
    t, p = math.radians(theta), math.radians(phi)
    return (math.sin(t) * math.cos(p), math.sin(t) * math.sin(p), math.cos(t))


def main():
    material = Material(sys.argv[1])
    for line in sys.stdin:
        print(",".join(repr(f) for f in material.evaluate(*map(float, line.split(",")))))


main()
