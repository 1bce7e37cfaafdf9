"""UV maps for bakes, on which no two faces share a place."""

import bpy
import numpy

UVS = "uwvdb bake"
ISLAND_ANGLE = 1.15192  # 66 degrees, as Blender's own default
GRID = 512  # points a side, at which overlaps are looked for


def unwrap(thing, own):
    """Makes and returns the UV map of a bake: a copy of the mesh's own where each point of that belongs to one face
    alone, else one by Smart UV Project. The thing is the active object."""
    mesh = thing.data
    if own and own in mesh.uv_layers:
        mesh.uv_layers.active = mesh.uv_layers[own]
    mesh.uv_layers.active = mesh.uv_layers.new(name=UVS, do_init=True)  # a copy of the active one
    if own and is_unique(mesh, mesh.uv_layers[UVS]):
        return mesh.uv_layers[UVS]
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.smart_project(angle_limit=ISLAND_ANGLE, island_margin=0.01, area_weight=0.0)
    bpy.ops.object.mode_set(mode="OBJECT")
    return mesh.uv_layers[UVS]


def is_unique(mesh, layer):
    """Whether a UV map lies within its square, covers a good part of it, and no faces share a place on it."""
    values = numpy.empty((len(mesh.loops), 2), numpy.float32)
    layer.data.foreach_get("uv", values.reshape(-1))
    if values.min() < -1e-5 or values.max() > 1 + 1e-5:
        return False
    mesh.calc_loop_triangles()
    triangles = numpy.empty((len(mesh.loop_triangles), 3), numpy.int32)
    mesh.loop_triangles.foreach_get("loops", triangles.reshape(-1))
    a, b, c = (values[triangles[:, at]].astype(float) for at in range(3))
    areas = numpy.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2
    if not 0.1 < areas.sum() < 1.001 or (areas < 1e-12).any():
        return False
    return not overlap(a, b, c)


def overlap(a, b, c, points=64):
    """Whether triangles cover more points of a grid twice than their borders may, by rounding."""
    a, b, c = (corner * GRID for corner in (a, b, c))
    low = numpy.floor(numpy.minimum(numpy.minimum(a, b), c)).astype(int).clip(0, GRID - 1)
    high = numpy.ceil(numpy.maximum(numpy.maximum(a, b), c)).astype(int).clip(0, GRID - 1)
    extent = (high - low).max(axis=1) + 1
    counts = numpy.zeros((GRID, GRID), numpy.int32)
    for least, most in ((0, 4), (4, 16)):  # small ones all at once, point by point
        some = numpy.flatnonzero((extent > least) & (extent <= most))
        for dx in range(most):
            for dy in range(most):
                at = low[some] + (dx, dy)
                inside = _inside(a[some], b[some], c[some], at[:, 0], at[:, 1]) & (at < GRID).all(axis=1)
                numpy.add.at(counts, (at[inside, 1], at[inside, 0]), 1)
    for number in numpy.flatnonzero(extent > 16):  # of which there are few without overlaps
        (x0, y0), (x1, y1) = low[number], high[number]
        x, y = numpy.meshgrid(numpy.arange(x0, x1 + 1), numpy.arange(y0, y1 + 1))
        corners = (corner[number][None, None] for corner in (a, b, c))
        counts[y0:y1 + 1, x0:x1 + 1] += _inside(*corners, x, y)
        if (counts > 1).sum() > points:
            return True
    return int((counts > 1).sum()) > points


def _inside(a, b, c, x, y):
    """Whether triangles have points of the grid, a little beside their corners, within."""
    x, y = x + 0.5003, y + 0.5007
    sides = [(q[..., 0] - p[..., 0]) * (y - p[..., 1]) - (q[..., 1] - p[..., 1]) * (x - p[..., 0])
             for p, q in ((a, b), (b, c), (c, a))]
    return ((sides[0] > 0) & (sides[1] > 0) & (sides[2] > 0)) | ((sides[0] < 0) & (sides[1] < 0) & (sides[2] < 0))
