"""A wall of light behind plumes, and the comparison of the shadows that both engines show."""

from support import *


def wall_scene(width=120, height=90):
    scene = empty_scene(width, height)
    shining = material("Shining", (1, 1, 1), "ShaderNodeEmission")[0]
    square(size=60, location=(0, 12, 0), rotation=(math.pi / 2, 0, 0)).data.materials.append(shining)
    return scene


def absorbing(thing, density=1.0):
    made = bpy.data.materials.new("Absorbing")
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    nodes.clear()
    node = nodes.new("ShaderNodeVolumePrincipled")
    node.inputs["Color"].default_value = (0, 0, 0, 1)
    node.inputs["Density"].default_value = density
    links.new(node.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Volume"])
    thing.data.materials.clear()
    thing.data.materials.append(made)
    return node


def shadows_agree(what, frame=None):
    """Optical depths by both engines, as images: their centroids in pixels, their widths, and what they
    differ by. How much a unit of density takes differs by one factor, which is fitted."""
    scene = bpy.context.scene
    scene.cycles.volume_step_rate, scene.cycles.volume_max_steps = 0.1, 4096
    ours = render(frame=frame)["Combined"][..., 1]
    theirs = render("CYCLES", frame=frame, samples=128)["Combined"][..., 1]
    found, wanted = -numpy.log(ours / ours.max()), -numpy.log(theirs / theirs.max())
    assert 0.2 < wanted.max() < 6 and 0.05 < found.max() < 6, (found.max(), wanted.max())
    rows, columns = numpy.mgrid[0:wanted.shape[0], 0:wanted.shape[1]]

    def moments(depth):
        weight = depth / depth.sum()
        y, x = (rows * weight).sum(), (columns * weight).sum()
        return y, x, math.sqrt((((rows - y)**2 + (columns - x)**2) * weight).sum())

    apart = [a - b for a, b in zip(moments(found), moments(wanted))]
    factor = (found * wanted).sum() / (found * found).sum()
    off = numpy.abs(found * factor - wanted)
    rms = math.sqrt((off**2).mean() / (wanted[wanted > 0.05 * wanted.max()]**2).mean())
    print(f"    {what}: centroid {apart[0]:+.3f}, {apart[1]:+.3f} pixels, width {apart[2]:+.3f}, rms of "
          f"the depth {rms:.1%}, factor {factor:.4g}, depth {wanted.max():.2f}")
    assert max(map(abs, apart)) < 0.05, f"{what}: the plume is {apart} pixels from Cycles'"
    assert rms < 0.01, f"{what}: optical depths differ by {rms:.1%}"


def volume_object(path, **place):
    data = bpy.data.volumes.new("Plume")
    data.filepath = str(path)
    thing = add("Plume", data, **place)
    grid = thing.uwvdb.grids.add()
    grid.name, grid.small, grid.large = "density", 3, 0
    return thing
