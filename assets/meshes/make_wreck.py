#!/usr/bin/env python3
"""Makes wreck.glb, the wreck of assets/scenes/wreck.yaml: a small hull on its side, with ribs, torn
plating, a boiler, a mast and the seabed around it. Standard library only; the same bytes each time.

    assets/meshes/make_wreck.py [OUT.glb]

y is up, metres; the keel lies along x.
"""

import json
import math
import pathlib
import struct
import sys
import zlib

LENGTH, BEAM, DEPTH = 6.0, 2.2, 1.5  # of the hull [m]
HEEL = math.radians(24)


def noise(*key):
    """A number in 0..1 that depends on whole numbers alone."""
    h = 2166136261
    for k in key:
        h = (h ^ (k & 0xFFFFFFFF)) * 16777619 & 0xFFFFFFFF
        h ^= h >> 15
    h = (h * 2246822519) & 0xFFFFFFFF
    return ((h ^ (h >> 13)) & 0xFFFFFF) / 0x1000000


def smooth_noise(x, y, seed):
    """The same between the points of a lattice, which repeats after 64 of them."""
    i, j = math.floor(x), math.floor(y)
    u, v = x - i, y - j
    u, v = u * u * (3 - 2 * u), v * v * (3 - 2 * v)

    def at(a, b):
        return noise(a % 64, b % 64, seed)

    low = at(i, j) * (1 - u) + at(i + 1, j) * u
    high = at(i, j + 1) * (1 - u) + at(i + 1, j + 1) * u
    return low * (1 - v) + high * v


def png(width, height, pixel):
    rows = b"".join(b"\0" + bytes(c for x in range(width) for c in pixel(x, y))
                    for y in range(height))

    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data
                + struct.pack(">I", zlib.crc32(kind + data)))

    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", width, height, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def blotches(size, dark, light, seed):
    """A picture between two colours, with detail from the whole of it down to its pixels."""
    def pixel(x, y):
        s = sum(smooth_noise(x * f / size, y * f / size, seed + f) * w
                for f, w in ((4, 0.3), (16, 0.3), (64, 0.4)))
        s = min(1.0, max(0.0, 2.2 * (s - 0.5) + 0.5))
        s = 0.75 * s + 0.25 * noise(x, y, seed)
        return [round(a + (b - a) * s) for a, b in zip(dark, light)]
    return png(size, size, pixel)


class Mesh:
    """Quads and what they are made of: positions, normals, texture coordinates."""

    def __init__(self):
        self.vertices, self.triangles = [], []

    def surface(self, rows, columns, at, keep=lambda i, j: True):
        """A grid of points at(u, v), u and v in 0..1, with smooth normals."""
        first = len(self.vertices)
        step = 1e-4
        for i in range(rows + 1):
            for j in range(columns + 1):
                u, v = i / rows, j / columns
                p = at(u, v)
                a = [b - c for b, c in zip(at(u + step, v), at(u - step, v))]
                b = [c - d for c, d in zip(at(u, v + step), at(u, v - step))]
                n = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                     a[0] * b[1] - a[1] * b[0]]
                length = math.sqrt(sum(x * x for x in n)) or 1.0
                n = [x / length for x in n] if any(n) else [0.0, 1.0, 0.0]
                self.vertices.append((p, n, self.texture_at(p)))
        for i in range(rows):
            for j in range(columns):
                if not keep(i, j):
                    continue
                a = first + i * (columns + 1) + j
                c = a + columns + 1
                self.triangles += [t for t in ((a, c, a + 1), (a + 1, c, c + 1))
                                   if self.has_area(t)]

    def has_area(self, triangle):
        """False at the poles of round things."""
        corners = [self.vertices[k][0] for k in triangle]
        return all(math.dist(p, q) > 1e-6 for p, q in zip(corners, corners[1:] + corners[:1]))

    @staticmethod
    def texture_at(p):
        return (0.45 * (p[0] + 0.31 * p[2]), 0.45 * (p[1] + 0.83 * p[2]))

    def tube(self, path, radius, rows, sides=8):
        """A tube around a path(u) that is not along y."""
        def at(u, v):
            p, q = path(u), path(u + 1e-3)
            t = [b - a for a, b in zip(p, q)]
            length = math.sqrt(sum(x * x for x in t))
            t = [x / length for x in t]
            helper = (0.0, 1.0, 0.0) if abs(t[1]) < 0.9 else (1.0, 0.0, 0.0)
            s = [t[1] * helper[2] - t[2] * helper[1], t[2] * helper[0] - t[0] * helper[2],
                 t[0] * helper[1] - t[1] * helper[0]]
            length = math.sqrt(sum(x * x for x in s))
            s = [x / length for x in s]
            w = [s[1] * t[2] - s[2] * t[1], s[2] * t[0] - s[0] * t[2], s[0] * t[1] - s[1] * t[0]]
            c, d = radius * math.cos(2 * math.pi * v), radius * math.sin(2 * math.pi * v)
            return [a + c * b + d * e for a, b, e in zip(p, s, w)]
        self.surface(rows, sides, at)


def heeled(x, y, z):
    """From the hull's axes to the seabed's."""
    c, s = math.cos(HEEL), math.sin(HEEL)
    return [x, 0.05 + c * y + s * z + 0.25, -s * y + c * z]


def section(x, t, side):
    """The hull's skin at x, from keel (t = 0) to gunwale (1)."""
    s = abs(2 * x / LENGTH)
    half = BEAM / 2 * max(0.0, 1 - s ** 2.4) ** 0.7
    return heeled(x, DEPTH * (t ** 1.4) * (1 + 0.25 * s * s), side * half * t ** 0.45)


def seabed_height(x, z):
    ripple = 0.02 * math.sin(9 * x + 2.5 * math.sin(1.3 * z))
    dunes = 0.5 * smooth_noise(0.7 * x + 20, 0.7 * z + 20, 1) - 0.25
    scour = -0.12 * math.exp(-(x * x / 9 + z * z / 2))
    return dunes * 0.6 + ripple + scour + 0.05 * smooth_noise(4 * x + 20, 4 * z + 20, 2)


def make_parts():
    sand, plating, ribs, fittings = Mesh(), Mesh(), Mesh(), Mesh()

    def ground(u, v):
        x, z = 22 * (v - 0.5), 16 * (u - 0.5)
        return [x, seabed_height(x, z), z]
    sand.surface(60, 84, ground)

    for side in (-1, 1):
        def skin(u, v, side=side):
            return section(LENGTH * 0.96 * (v - 0.5), 0.04 + 0.96 * u, side)

        def kept(i, j, side=side):
            # Plates of 2 x 3 quads are gone, more of them at the top and amidships.
            lost = 0.16 + 0.3 * (i / 18) + 0.25 * math.exp(-((j - 30) / 9) ** 2)
            return noise(i // 2, j // 3, side + 5) > lost
        plating.surface(18, 60, skin, kept)

    for k in range(13):
        x = LENGTH * 0.9 * (k / 12 - 0.5)
        for side in (-1, 1):
            top = 0.75 + 0.3 * noise(k, side + 9)
            ribs.tube(lambda u, x=x, side=side, top=top:
                      section(x, 0.03 + (top - 0.03) * max(u, 0.0), side), 0.045, 14, 6)
        if noise(k, 77) > 0.4:
            ribs.tube(lambda u, x=x: [a + (b - a) * u for a, b in zip(
                section(x, 0.9, -1), section(x, 0.9, 1))], 0.035, 6, 6)
    ribs.tube(lambda u: heeled(LENGTH * 1.04 * (u - 0.5), -0.03, 0.0), 0.09, 30, 8)

    fittings.tube(lambda u: heeled(-0.75 + 1.5 * u, 0.62, 0.05), 0.38, 16, 24)   # the boiler
    for end in (-0.76, 0.76):
        fittings.surface(6, 24, lambda u, v, end=end: heeled(
            end, 0.62 + 0.38 * u * math.cos(2 * math.pi * v),
            0.05 + 0.38 * u * math.sin(2 * math.pi * v)))
    def mast(u):
        return [0.9 + 2.6 * u, 1.25 - 1.15 * u, 0.15 + 1.15 * u]
    fittings.tube(mast, 0.07, 20, 10)
    for end in (0.0, 1.0):
        centre = mast(end)
        fittings.surface(2, 10, lambda u, v, c=centre: [
            c[0], c[1] + 0.07 * u * math.cos(2 * math.pi * v),
            c[2] + 0.07 * u * math.sin(2 * math.pi * v)])
    for k in range(4):  # its spars
        x, y, z = mast(0.25 + 0.2 * k)
        fittings.tube(lambda w, x=x, y=y, z=z: [x + 0.4 * (w - 0.5), y + 0.06,
                                                z - 0.9 * (w - 0.5)], 0.025, 4, 6)
    for k in range(26):  # stones
        x, z = 13 * (noise(k, 31) - 0.5), 9 * (noise(k, 32) - 0.5)
        r = 0.06 + 0.16 * noise(k, 33)
        y = seabed_height(x, z) + 0.3 * r

        def stone(u, v, x=x, y=y, z=z, r=r, k=k):
            a, b = math.pi * u, 2 * math.pi * v
            d = r * (0.85 + 0.15 * math.sin(3 * a + k) * math.cos(2 * b))
            return [x + d * math.sin(a) * math.cos(b), y + 0.7 * d * math.cos(a),
                    z - d * math.sin(a) * math.sin(b)]
        fittings.surface(8, 12, stone)
    return [("Seabed", sand, (170, 150, 110), (235, 215, 170), 1),
            ("Plating", plating, (60, 30, 20), (190, 110, 60), 2),
            ("Ribs", ribs, (50, 45, 40), (150, 120, 90), 3),
            ("Fittings", fittings, (40, 50, 45), (170, 175, 150), 4)]


def main():
    out = pathlib.Path(sys.argv[1] if len(sys.argv) > 1
                       else pathlib.Path(__file__).with_name("wreck.glb"))
    blob, views, accessors = bytearray(), [], []

    def add(data, **extra):
        while len(blob) % 4:
            blob.append(0)
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": len(data)})
        blob.extend(data)
        if extra:
            accessors.append({"bufferView": len(views) - 1, **extra})
        return len(accessors) - 1

    gltf = {"asset": {"version": "2.0", "generator": "make_wreck.py"}, "scene": 0,
            "scenes": [{"nodes": []}], "nodes": [], "meshes": [], "materials": [], "textures": [],
            "images": [], "samplers": [{"wrapS": 10497, "wrapT": 10497}]}
    for index, (name, mesh, dark, light, seed) in enumerate(make_parts()):
        floats = [struct.pack("<" + "f" * n, *(x for v in mesh.vertices for x in v[k]))
                  for k, n in ((0, 3 * len(mesh.vertices)), (1, 3 * len(mesh.vertices)),
                               (2, 2 * len(mesh.vertices)))]
        columns = list(zip(*(v[0] for v in mesh.vertices)))
        count = len(mesh.vertices)
        as_float = [struct.unpack("<f", struct.pack("<f", x))[0]
                    for x in [min(c) for c in columns] + [max(c) for c in columns]]
        position = add(floats[0], componentType=5126, count=count, type="VEC3",
                       min=as_float[:3], max=as_float[3:])
        normal = add(floats[1], componentType=5126, count=count, type="VEC3")
        texture = add(floats[2], componentType=5126, count=count, type="VEC2")
        flat = [k for t in mesh.triangles for k in t]
        indices = add(struct.pack(f"<{len(flat)}{'H' if count < 65536 else 'I'}", *flat),
                      componentType=5123 if count < 65536 else 5125, count=len(flat),
                      type="SCALAR")
        add(blotches(128, dark, light, seed))
        gltf["images"].append({"bufferView": len(views) - 1, "mimeType": "image/png"})
        gltf["textures"].append({"source": index, "sampler": 0})
        gltf["materials"].append({"name": name, "doubleSided": True, "pbrMetallicRoughness": {
            "baseColorTexture": {"index": index}, "metallicFactor": 0, "roughnessFactor": 1}})
        gltf["meshes"].append({"name": name, "primitives": [{
            "attributes": {"POSITION": position, "NORMAL": normal, "TEXCOORD_0": texture},
            "indices": indices, "material": index}]})
        gltf["nodes"].append({"name": name, "mesh": index})
        gltf["scenes"][0]["nodes"].append(index)
    while len(blob) % 4:
        blob.append(0)
    gltf.update(bufferViews=views, accessors=accessors, buffers=[{"byteLength": len(blob)}])
    text = json.dumps(gltf, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    out.write_bytes(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(blob))
                    + struct.pack("<I4s", len(text), b"JSON") + text
                    + struct.pack("<I4s", len(blob), b"BIN\0") + bytes(blob))
    print(f"{out}: {sum(len(m.triangles) for _, m, *_ in make_parts())} triangles, "
          f"{out.stat().st_size} bytes")


if __name__ == "__main__":
    main()
