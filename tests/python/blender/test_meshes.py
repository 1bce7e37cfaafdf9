# ctest labels: metamorphic
"""What is read of meshes: against Blender's own triangles and normals, and in parts against all at once."""

import json
import struct

from support import *

SHAPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


def modules():
    return sys.modules["uwvdb_blender.meshes"], sys.modules["uwvdb_blender.notes"]


def read_glb(path):
    """(its JSON, a function that returns the rows of an accessor)."""
    data = pathlib.Path(path).read_bytes()
    length, = struct.unpack_from("<I", data, 12)
    content = json.loads(data[20:20 + length])

    def rows(accessor):
        found = content["accessors"][accessor]
        view = content["bufferViews"][found["bufferView"]]
        width = {name: width for width, name in SHAPES.items()}[found["type"]]
        kind = "<u4" if found["componentType"] == 5125 else "<f4"
        begin = 28 + length + view["byteOffset"]
        return numpy.frombuffer(data[begin:begin + view["byteLength"]], kind).reshape(-1, width)

    return content, rows


def rough(name, sides, random, location):
    """A grid whose faces are neither flat nor convex, of triangles, quads or faces of five corners."""
    points = numpy.stack([*numpy.meshgrid(range(9), range(9), indexing="ij"), numpy.zeros((9, 9))], axis=-1)
    points = (points + random.uniform(-0.7, 0.7, points.shape)).reshape(-1, 3)
    faces = []
    for i in range(8):
        for j in range(8):
            a, b, c, d = 9 * i + j, 9 * i + j + 1, 9 * i + j + 10, 9 * i + j + 9
            kind = sides[(3 * i + j) % len(sides)]
            if kind == 5 and j < 7:
                faces.append((a, b, b + 1, c, d))
            elif kind == 3:
                faces += [(a, b, c), (a, c, d)]
            else:
                faces.append((a, b, c, d))
    thing = mesh(name, points.tolist(), faces, location=location)
    for name in ("One", "Other"):
        thing.data.materials.append(material(name)[0])
    thing.data.polygons.foreach_set("material_index", random.integers(0, 2, len(thing.data.polygons)))
    return thing


def rough_scene():
    scene, random = empty_scene(), numpy.random.default_rng(5)
    things = [rough(str(sides), sides, random, (3 * at, 9, 0)) for at, sides in enumerate(
        ((3,), (4,), (3, 4), (3, 4, 5)))]
    for at, thing in enumerate(things):
        smooth = [[False], [True], [True, False, False]][at % 3]
        thing.data.polygons.foreach_set("use_smooth", numpy.resize(smooth, len(thing.data.polygons)))
    # Corners' own normals, and a mesh that is used twice.
    turned = rough("turned", (4,), random, (0, 20, 0))
    if hasattr(turned.data, "use_auto_smooth"):
        turned.data.use_auto_smooth = True
    normals = random.normal(size=(len(turned.data.loops), 3)) * 0.1 + (0, 0, 1)
    turned.data.normals_split_custom_set((normals / numpy.linalg.norm(normals, axis=1)[:, None]).tolist())
    add("twin", turned.data, (0, 30, 0))
    things[1].modifiers.new("More", "SUBSURF").levels = 1
    return scene


def write_all(path):
    meshes, notes = modules()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    made = meshes.MeshFile(notes.Notes())
    made.add_all(depsgraph, Matrix(), None)
    made.glb.write(path)
    return depsgraph


def test_triangles_and_normals_are_blenders():
    rough_scene()
    with tempfile.TemporaryDirectory() as folder:
        depsgraph = write_all(f"{folder}/all.glb")
        content, rows = read_glb(f"{folder}/all.glb")
    assert len(content["nodes"]) == 6 and len(content["meshes"]) == 5
    flipped = 0
    for node in content["nodes"]:
        shown = bpy.data.objects[node["name"]].evaluated_get(depsgraph)
        data = shown.to_mesh()
        data.calc_loop_triangles()
        is_split = hasattr(data, "calc_normals_split")  # until Blender 4.0
        if is_split:
            data.calc_normals_split()
        for primitive in content["meshes"][node["mesh"]]["primitives"]:
            name = content["materials"][primitive["material"]]["name"]
            corners = rows(primitive["indices"]).reshape(-1)
            found = [rows(primitive["attributes"][key])[corners] for key in ("POSITION", "NORMAL")]
            wanted = [[], []]
            for triangle in data.loop_triangles:
                if shown.material_slots[triangle.material_index].material.name != name:
                    continue
                flipped += tuple(numpy.diff(triangle.loops)) in ((1, 2), (2, 1)) and triangle.loops[1] % 4 == 1
                for corner in triangle.loops:
                    wanted[0].append(data.vertices[data.loops[corner].vertex_index].co[:])
                    wanted[1].append((data.loops[corner].normal if is_split
                                      else data.corner_normals[corner].vector)[:])
            assert (found[0] == numpy.array(wanted[0], numpy.float32)).all(), (node["name"], name)
            close(found[1], wanted[1], 1e-5, f"normals of {node['name']}, {name}")
        shown.to_mesh_clear()
    print(f"    {flipped} faces divided the other way")
    assert flipped > 5


def test_in_parts_is_as_all_at_once():
    rough_scene()
    meshes, notes = modules()
    with tempfile.TemporaryDirectory() as folder:
        depsgraph = write_all(f"{folder}/all.glb")
        made = meshes.MeshFile(notes.Notes(), {})
        parts = 1
        while not made.read_some(depsgraph, -1):
            parts += 1
        made.add_all(depsgraph, Matrix(), None)
        made.glb.write(f"{folder}/parts.glb")
        print(f"    {parts} parts")
        assert parts > 10
        assert pathlib.Path(f"{folder}/all.glb").read_bytes() == pathlib.Path(f"{folder}/parts.glb").read_bytes()


def test_a_mesh_that_changes_meanwhile_is_read_anew():
    rough_scene()
    meshes, notes = modules()
    with tempfile.TemporaryDirectory() as folder:
        made = meshes.MeshFile(notes.Notes(), {})
        made.read_some(bpy.context.evaluated_depsgraph_get(), -1)
        first = bpy.data.objects["(3,)"].data
        first.clear_geometry()
        first.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [], [(0, 1, 2)])
        first.update()
        depsgraph = write_all(f"{folder}/all.glb")
        while not made.read_some(depsgraph, -1):
            pass
        made.add_all(depsgraph, Matrix(), None)
        made.glb.write(f"{folder}/parts.glb")
        assert pathlib.Path(f"{folder}/all.glb").read_bytes() == pathlib.Path(f"{folder}/parts.glb").read_bytes()


def test_only_what_changed_is_read():
    """As the 3D view does, after each change of the scene."""
    scene = rough_scene()
    scene.world.uwvdb.kind = "NONE"
    meshes, _ = modules()
    viewport = sys.modules["uwvdb_blender.viewport"]
    read, kept = [], meshes.Corners._read_vertices
    with tempfile.TemporaryDirectory() as folder:
        session = type("Session", (), {"folder": folder})
        surroundings = viewport.Surroundings(session, PROGRAM)

        def look(_, depsgraph):
            surroundings.update(depsgraph)
            while surroundings.is_reading:
                surroundings.read_on(depsgraph)

        def count(self, data):
            read.append(data)
            kept(self, data)

        def changed(what, change, number):
            read.clear()
            change()
            bpy.context.view_layer.update()
            assert len(read) == number, f"{what}: {len(read)} meshes read instead of {number}"
            write_all(f"{folder}/all.glb")
            surroundings.meshes[1].write(f"{folder}/known.glb")
            wanted, found = (read_glb(f"{folder}/{name}.glb") for name in ("all", "known"))
            assert [n["name"] for n in wanted[0]["nodes"]] == [n["name"] for n in found[0]["nodes"]]
            assert (pathlib.Path(f"{folder}/all.glb").read_bytes()
                    == pathlib.Path(f"{folder}/known.glb").read_bytes()), what

        def edit():
            bpy.data.objects["(4,)"].data.vertices[7].co.z += 0.5
            bpy.data.objects["(4,)"].data.update()

        def paint():
            bpy.data.materials["One"].node_tree.nodes[0].inputs[0].default_value = (0.1, 0.2, 0.3, 1)

        def reduce():
            bpy.data.objects["(4,)"].modifiers[0].levels = 0

        def slot():
            bpy.data.objects["(3,)"].data.materials.pop()

        meshes.Corners._read_vertices = count
        bpy.app.handlers.depsgraph_update_post.append(look)
        try:
            changed("nothing", lambda: scene.camera.data.update_tag(), 5)
            changed("a vertex", edit, 1)
            changed("a material", paint, 0)
            changed("a modifier", reduce, 1)
            changed("a removed slot", slot, 1)
            changed("a removed object", lambda: bpy.data.objects.remove(bpy.data.objects["turned"]), 1)
            changed("a new object", lambda: box(location=(1, 5, 1)), 1)
            changed("a twin's name", lambda: setattr(bpy.data.objects["twin"], "name", "Twin"), 1)
        finally:
            bpy.app.handlers.depsgraph_update_post.remove(look)
            meshes.Corners._read_vertices = kept
