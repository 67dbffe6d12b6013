"""Scenes for blender_test.py, made and exported in Blender: `blender -b -P scenes.py -- EXPORTER CASE FOLDER`. What Blender says of them goes to facts.json."""
import importlib.util
import json
import math
import pathlib
import sys

import bpy
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Matrix, Vector

EXPORTER, CASE, FOLDER = sys.argv[-3:]
FOLDER = pathlib.Path(FOLDER)
spec = importlib.util.spec_from_file_location("abbe_export", EXPORTER)
exporter = importlib.util.module_from_spec(spec)
spec.loader.exec_module(exporter)
facts = {}


def empty():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = 96, 72
    scene.view_settings.view_transform = "Standard"
    return scene


def add(name, data, matrix=None, **properties):
    made = bpy.data.objects.new(name, data)
    made.matrix_world = matrix or Matrix()
    bpy.context.scene.collection.objects.link(made)
    for key, value in properties.items():
        setattr(made, key, value)
    return made


def camera(at=(0, 0, 5), turn=(0, 0, 0), **properties):
    data = bpy.data.cameras.new("camera")
    for key, value in properties.items():
        setattr(data, key, value)
    bpy.context.scene.camera = add("camera", data, location=at, rotation_euler=turn)
    return bpy.context.scene.camera


def lamp(kind, at, **properties):
    data = bpy.data.lights.new(kind.lower(), kind)
    turn = properties.pop("turn", (0, 0, 0))
    for key, value in properties.items():
        setattr(data, key, value)
    return add(kind.lower(), data, location=at, rotation_euler=turn)


def nodes(name, kind="ShaderNodeBsdfPrincipled", **inputs):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    node, output = tree.nodes.new(kind), tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(node.outputs[0], output.inputs[0])
    for key, value in inputs.items():
        node.inputs[key.replace("_", " ")].default_value = value
    return material


def mesh(name, vertices, faces, *materials):
    data = bpy.data.meshes.new(name)
    data.from_pydata(vertices, [], faces)
    for material in materials:
        data.materials.append(material)
    return data


def square(name, half, *materials):
    return mesh(name, [(-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0)], [(0, 1, 2, 3)], *materials)


def cube(name, *materials):
    corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    return mesh(name, corners, [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)], *materials)


def ball(name, segments, material):
    import bmesh
    made, data = bmesh.new(), bpy.data.meshes.new(name)
    bmesh.ops.create_uvsphere(made, u_segments=segments, v_segments=segments // 2, radius=1)
    made.to_mesh(data)
    made.free()
    data.materials.append(material)
    data.polygons.foreach_set("use_smooth", [True] * len(data.polygons))
    return data


def export(name):
    facts[name] = {"notes": exporter.export(bpy.context, FOLDER / f"{name}.json")}
    return facts[name]


def view():
    """A grid of small patches that face the camera, seen in frames of several fits, and where Blender says they are."""
    frames = {"landscape": (160, 96, "AUTO", {}), "portrait": (96, 160, "AUTO", {}), "vertical": (160, 96, "VERTICAL", {"sensor_height": 20}),
              "horizontal": (96, 160, "HORIZONTAL", {}), "shifted": (160, 96, "AUTO", {"shift_x": 0.1}), "lens": (160, 96, "AUTO", {})}
    for name, (width, height, fit, properties) in frames.items():
        scene = empty()
        scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 2 * width, 2 * height, 50
        eye = camera((1, -2, 0.5), (1.1, 0.3, -0.4), lens=40, sensor_fit=fit, **properties)
        bpy.context.view_layer.update()
        eye.data.dof.use_dof, eye.data.dof.aperture_fstop = name == "lens", 8
        eye.data.dof.focus_object = add("focus", None, location=eye.matrix_world @ Vector((0.3, -0.2, -0.5)))
        glow, where = nodes("glow", "ShaderNodeEmission"), []
        for i in range(5):
            for j in range(5):
                depth = 0.5 if name == "lens" else 2 + 0.2 * i + 0.1 * j
                at = eye.matrix_world @ Vector((0.1 * (i - 2) * depth, 0.1 * (j - 2) * depth, -depth))
                add("patch", square("patch", 0.008 * depth, glow), Matrix.Translation(at) @ eye.matrix_world.to_3x3().to_4x4())
                seen = world_to_camera_view(scene, eye, at)
                where.append((seen.x * width, (1 - seen.y) * height))
        export(name)["pixels"] = where


def lamps():
    """Each kind of lamp alone above the origin, where the test measures the irradiance."""
    def alone(name, make, unit=1):
        scene = empty()
        scene.unit_settings.scale_length = unit
        camera()
        add("below", square("below", 0.1, nodes("black", "ShaderNodeBsdfDiffuse", Color=(0, 0, 0, 1))), location=(0, 0, -1))
        make()
        export(name)

    alone("point", lambda: lamp("POINT", (0, 0, 2), energy=100, shadow_soft_size=0))
    alone("sphere", lambda: lamp("POINT", (0, 0, 2), energy=100, shadow_soft_size=0.2))
    alone("coloured", lambda: lamp("POINT", (0, 0, 2), energy=100, shadow_soft_size=0, color=(1, 0.5, 0.2)))
    alone("centimetres", lambda: lamp("POINT", (0, 0, 200), energy=100, shadow_soft_size=0), 0.01)
    alone("spot", lambda: lamp("SPOT", (0, 0, 2), energy=100, shadow_soft_size=0, spot_size=1, spot_blend=0.5))
    alone("spot_inside", lambda: lamp("SPOT", (0, 0, 2), energy=100, shadow_soft_size=0, spot_size=1, spot_blend=0.5, turn=(0.39, 0, 0)))
    alone("spot_outside", lambda: lamp("SPOT", (0, 0, 2), energy=100, shadow_soft_size=0, spot_size=1, spot_blend=0.5, turn=(0.46, 0, 0)))
    alone("sun", lambda: lamp("SUN", (0, 0, 2), energy=3, angle=0.01, turn=(0.6, 0, 0)))
    alone("parallel", lambda: lamp("SUN", (0, 0, 2), energy=3, angle=0, turn=(0.6, 0, 0)))
    alone("square", lambda: lamp("AREA", (0, 0, 1), energy=100, shape="SQUARE", size=0.5))
    alone("rectangle", lambda: setattr(lamp("AREA", (0, 0, 1), energy=100, shape="RECTANGLE", size=0.5, size_y=0.25), "scale", (2, 2, 2)))
    alone("disk", lambda: lamp("AREA", (0, 0, 1), energy=100, shape="DISK", size=0.5))
    alone("turned_away", lambda: lamp("AREA", (0, 0, 1), energy=100, shape="DISK", size=0.5, turn=(math.pi, 0, 0)))
    alone("patch", lambda: add("patch", square("patch", 0.25, nodes("glow", "ShaderNodeEmission", Strength=20)), location=(0, 0, 1)))
    alone("world", lambda: sky(0.5, None))


def sky(strength, image, turn=0):
    world = bpy.data.worlds.new("sky")
    bpy.context.scene.world = world
    world.use_nodes = True
    tree, background = world.node_tree, world.node_tree.nodes["Background"]
    background.inputs["Strength"].default_value = strength
    background.inputs["Color"].default_value = (1, 1, 1, 1)
    if image is None:
        return
    node, mapping, place = (tree.nodes.new(kind) for kind in ("ShaderNodeTexEnvironment", "ShaderNodeMapping", "ShaderNodeTexCoord"))
    node.image = image
    mapping.inputs["Rotation"].default_value[2] = turn
    tree.links.new(node.outputs["Color"], background.inputs["Color"])
    tree.links.new(mapping.outputs[0], node.inputs["Vector"])
    tree.links.new(place.outputs["Generated"], mapping.inputs["Vector"])


def panorama():
    """A bright texel of a panorama, looked at where Blender has it: the middle of column i is at the longitude pi - (i + 0.5) 2 pi/64, less the turn."""
    empty()
    image = bpy.data.images.new("dot", 64, 32, float_buffer=True)
    pixels = [0.0] * (64 * 32 * 4)
    column, row, turn = 20, 19, 0.7
    pixels[4 * (64 * row + column):4 * (64 * row + column) + 3] = [1, 1, 1]
    image.pixels[:] = pixels
    image.filepath_raw, image.file_format = str(FOLDER / "dot.exr"), "OPEN_EXR"
    image.save()
    sky(2, image, turn)
    longitude, latitude = math.pi - (column + 0.5) * 2 * math.pi / 64 - turn, (row + 0.5) * math.pi / 32 - math.pi / 2
    towards = Vector((math.cos(latitude) * math.cos(longitude), math.cos(latitude) * math.sin(longitude), math.sin(latitude)))
    camera((0, 0, 0), towards.to_track_quat("-Z", "Y").to_euler(), lens=500)
    add("below", square("below", 0.1), location=(0, 0, -9))
    export("panorama")


def placed():
    """A cube placed four times, mirrored and in a collection too, one with two materials, arrays, a subdivided one, a ball that is stretched, turned and mirrored, and a text."""
    empty()
    camera()
    shared, grey, red = cube("shared"), nodes("grey"), nodes("red", Base_Color=(0.8, 0.1, 0.1, 1))
    shared.materials.append(grey)
    add("first", shared)
    add("second", shared, Matrix.Translation((5, 0, 0)) @ Matrix.Diagonal((1, 1, -2, 1)))
    group = bpy.data.collections.new("group")
    inner = bpy.data.objects.new("inner", shared)
    group.objects.link(inner)
    for x in (10, 15):
        add("instance", None, location=(x, 0, 0), instance_type="COLLECTION", instance_collection=group)
    add("hidden", shared, location=(0, 50, 0), hide_render=True)
    slots = add("slots", cube("slots", grey, red), Matrix.Translation((0, 5, 0)) @ Matrix.Diagonal((-1, 1, 1, 1)))
    slots.data.polygons[0].material_index = 1
    array = add("array", cube("array", grey), location=(0, 10, 0)).modifiers.new("array", "ARRAY")
    array.count, array.relative_offset_displace = 3, (2, 0, 0)
    soft = add("soft", cube("soft", grey), location=(0, 20, 0)).modifiers.new("soft", "SUBSURF")
    soft.levels, soft.render_levels = 0, 3
    oblique = Matrix.Rotation(0.7, 3, (1, 2, 3)) @ Matrix.Diagonal((-1, 2, 0.5))
    add("oblique", ball("oblique", 32, grey), Matrix.Translation((0, 40, 0)) @ oblique.to_4x4())
    add("text", bpy.data.curves.new("text", "FONT"), location=(0, 30, 0)).data.body = "Abbe"
    export("placed")
    soft.levels = 3
    facts["oblique"] = [list(row) for row in oblique]
    evaluated = bpy.context.evaluated_depsgraph_get()
    for name in ("soft", "text"):
        whole = bpy.data.objects[name].evaluated_get(evaluated).to_mesh()
        facts[name] = {"area": sum(face.area for face in whole.polygons), "vertices": len(whole.vertices)}


def glass():
    """A ball that the property abbe makes of N-BK7 on a floor, under a lamp."""
    empty()
    camera((0, -6, 2), (math.radians(75), 0, 0), lens=50)
    crown = nodes("crown", "ShaderNodeBsdfGlass")
    crown["abbe"] = "N-BK7"
    add("ball", ball("ball", 512, crown), location=(0, 0, 1.2))
    add("floor", square("floor", 4, nodes("card", "ShaderNodeBsdfDiffuse", Color=(0.6, 0.6, 0.6, 1))))
    lamp("AREA", (1, -1, 5), energy=200, size=2)
    export("glass")


def plain():
    """Principled balls under lamps that glTF has too, with a texture, also as Blender's own exporter writes them."""
    empty()
    camera((0, -8, 3), (math.radians(72), 0, 0), lens=45)
    image = bpy.data.images.new("tiles", 8, 8)
    image.pixels[:] = [c for j in range(8) for i in range(8) for c in ((0.9, 0.5, 0.2, 1) if (i + j) % 2 else (0.2, 0.5, 0.3, 1))]
    image.filepath_raw, image.file_format = str(FOLDER / "tiles.png"), "PNG"
    image.save()
    floor = nodes("floor", Roughness=0.9)
    tile = floor.node_tree.nodes.new("ShaderNodeTexImage")
    tile.image, tile.interpolation = image, "Closest"
    floor.node_tree.links.new(tile.outputs[0], floor.node_tree.nodes["Principled BSDF"].inputs["Base Color"])
    ground = square("floor", 4, floor)
    ground.uv_layers.new(name="uv").data.foreach_set("uv", [0, 0, 2, 0, 2, 2, 0, 2])
    add("floor", ground)
    looks = [dict(Base_Color=(0.8, 0.2, 0.1, 1), Roughness=0.4), dict(Metallic=1, Base_Color=(0.9, 0.7, 0.3, 1), Roughness=0.3),
             dict(Base_Color=(0.1, 0.3, 0.7, 1), Roughness=0.7, Clearcoat=1, Clearcoat_Roughness=0.2), dict(Base_Color=(0.5, 0.5, 0.5, 1), Metallic=0.4)]
    for i, look in enumerate(looks):
        add(f"ball{i}", ball(f"ball{i}", 64, nodes(f"look{i}", **look)), location=(2.2 * i - 3.3, 0, 1))
    lamp("POINT", (-2, -4, 5), energy=500, shadow_soft_size=0)
    lamp("SUN", (0, 0, 9), energy=2, angle=0, turn=(0.5, 0.3, 0))
    export("plain")
    bpy.ops.export_scene.gltf(filepath=str(FOLDER / "plain.gltf"), export_format="GLTF_SEPARATE", export_lights=True, export_cameras=True, export_yup=True)


def kinds():
    """A square of each material that is mapped in a way of its own, and things that have no counterpart."""
    scene = empty()
    scene.view_settings.view_transform = "Filmic"
    camera((0, 0, 20))
    texel = bpy.data.images.new("texel", 2, 2)
    texel.filepath_raw, texel.file_format = str(FOLDER / "texel.png"), "PNG"
    texel.pixels[:] = [0.5, 0.5, 1, 1] * 4
    texel.save()
    texel.pack()
    relief = nodes("relief", Base_Color=(0.5, 0.5, 0.5, 1))
    tree = relief.node_tree
    image, turned, place = (tree.nodes.new(kind) for kind in ("ShaderNodeTexImage", "ShaderNodeNormalMap", "ShaderNodeMapping"))
    image.image, image.extension, place.inputs["Scale"].default_value[0] = texel, "EXTEND", 3
    for one, other in ((place.outputs[0], image.inputs[0]), (image.outputs[0], turned.inputs["Color"]),
                       (turned.outputs[0], tree.nodes["Principled BSDF"].inputs["Normal"])):
        tree.links.new(one, other)
    mixed = nodes("mixed", "ShaderNodeMixShader", Fac=0.25)
    for socket, kind in ((1, "ShaderNodeBsdfDiffuse"), (2, "ShaderNodeEmission")):
        mixed.node_tree.links.new(mixed.node_tree.nodes.new(kind).outputs[0], mixed.node_tree.nodes["Mix Shader"].inputs[socket])
    tinted = nodes("tinted", "ShaderNodeBsdfGlass", Color=(1, 1, 1, 1), Roughness=0.5)
    volume = tinted.node_tree.nodes.new("ShaderNodeVolumeAbsorption")
    volume.inputs["Color"].default_value, volume.inputs["Density"].default_value = (0.5, 0.5, 0.5, 1), 4
    tinted.node_tree.links.new(volume.outputs[0], tinted.node_tree.nodes["Material Output"].inputs["Volume"])
    metal = nodes("metal", Anisotropic=0.5)
    metal["abbe"] = '{"conductor": {"ior": "Al_Rakic"}}'
    made = [relief, mixed, tinted, metal, nodes("mirror", "ShaderNodeBsdfGlossy", Color=(0.9, 0.9, 0.9, 1), Roughness=0),
            nodes("glossy", "ShaderNodeBsdfGlossy", Color=(0.5, 0.5, 0.5, 1), Roughness=0.5), nodes("clay", "ShaderNodeBsdfDiffuse", Roughness=0.5),
            nodes("wax", Subsurface=0.5, Alpha=0.5), nodes("fluid", Transmission=1, IOR=1.33, Roughness=0), nodes("velvet", "ShaderNodeBsdfVelvet"),
            nodes("light", Emission_Strength=2, Emission=(1, 0.5, 0.5, 1)), None,
            nodes("chrome", Transmission=1, Metallic=1, Base_Color=(0.5, 0.5, 0.5, 1), Roughness=0.25),
            nodes("bottle", Transmission=1, Sheen=1, Sheen_Tint=0, Clearcoat=0.5, Base_Color=(1, 1, 1, 1), Roughness=0),
            nodes("chalk", "ShaderNodeBsdfDiffuse", Roughness=1)]
    for i, material in enumerate(made):
        add(f"shape{i}", ball(f"ball{i}", 16, material), location=(3 * i, 0, 0))
    add("fog", bpy.data.volumes.new("fog"))
    add("line", mesh("line", [(0, 0, 0), (1, 0, 0)], []))
    lamp("AREA", (0, 0, 5), shape="ELLIPSE", size=1, size_y=2, energy=10)
    export("kinds")


def faults():
    """Scenes that cannot be exported, as files."""
    def save(name):
        bpy.ops.wm.save_as_mainfile(filepath=str(FOLDER / f"{name}.blend"))

    empty()
    add("floor", square("floor", 1))
    save("no_camera")
    camera()
    bpy.data.objects["floor"].data = mesh("empty", [(0, 0, 0), (1, 0, 0)], [])
    save("empty_mesh")
    wrong = nodes("wrong")
    wrong["abbe"] = "{ior: 2"
    bpy.data.objects["floor"].data = square("floor", 1, wrong)
    save("wrong_property")
    lost = nodes("lost")
    node = lost.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = bpy.data.images.new("lost.png", 4, 4)
    node.image.source, node.image.filepath = "FILE", str(FOLDER / "lost.png")
    lost.node_tree.links.new(node.outputs[0], lost.node_tree.nodes["Principled BSDF"].inputs["Base Color"])
    bpy.data.objects["floor"].data = square("lost", 1, lost)
    save("lost_image")


{"view": view, "lamps": lamps, "panorama": panorama, "placed": placed, "glass": glass, "plain": plain, "kinds": kinds, "faults": faults}[CASE]()
(FOLDER / "facts.json").write_text(json.dumps(facts))
