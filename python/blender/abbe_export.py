"""Exports Blender scenes to Abbe: an add-on (File > Export > Abbe), and a script for the background, `blender -b scene.blend -P abbe_export.py -- scene.json`.

The scene file gets a folder of meshes and images beside it, scene_files. What is approximated or dropped is told on standard output, each once with
how often it occurs, and at the head of the scene file. docs/doors.md of Abbe has the mapping.
"""
import json
import math
import os
import pathlib
import re
import shutil
import sys
import traceback

import bpy
import numpy as np
from bpy_extras.io_utils import ExportHelper
from mathutils import Vector

bl_info = {"name": "Abbe scene", "description": "Exports scenes to the spectral renderer Abbe", "version": (0, 1, 0), "blender": (3, 4, 0),
           "location": "File > Export > Abbe (.json)", "category": "Import-Export"}

# Lumens of a watt of D65 on 300-1100 nm; shares of the linear Rec.709 colours in Y; and the quadratics in x = (nm - 580)/200 whose exponentials, over
# their sum with 1, are the spectra that stand for red and blue [Mallett2019]. Tests compare them with what Abbe measures, and writes of colours.
LUMENS_PER_WATT = 176.799762
SHARES_OF_Y = (0.212663651, 0.715178325, 0.072158024)
RED, BLUE = (-1.83692275, 27.93408994, 51.38553635), (-3.54247104, 8.85485252, 35.69893127)
ROUGHEST = 0.7767  # of diffuse surfaces: what slopes that deviate by 90 degrees have
PINHOLE_F_NUMBER = 4  # by which Abbe exposes a pinhole that says none
FASTEST_F_NUMBER = 0.5  # of a lens in air, whose cone of light then fills the hemisphere
PHOTOMETRIC = {"radiant_flux_W": "luminous_flux_lm", "radiance": "luminance", "intensity": "luminous_intensity", "irradiance": "illuminance"}
DROPPED = {"VOLUME": "volumes", "GPENCIL": "grease pencil", "CURVES": "hair", "POINTCLOUD": "clouds of points"}
BLACK = np.zeros(3)


class ExportError(Exception):
    """What is wrong, in a sentence, with the exit code of a command: 3 of a scene, 4 of a file it names."""

    def __init__(self, text, code=3):
        super().__init__(text)
        self.code = code


class Notes:
    """What is approximated or dropped: each text once, with where it occurred first and how often."""

    def __init__(self):
        self.found = {}

    def add(self, where, text, given=True):
        if given:
            first, count = self.found.get(text, (where, 0))
            self.found[text] = (first, count + 1)

    def add_colour(self, where):
        self.add(where, "a colour has no spectrum: the smooth one that looks so under D65 stands in; name a measured one")

    def lines(self):
        return [f"{where}: warning: {text}" + (f" ({count} times)" if count > 1 else "") for text, (where, count) in self.found.items()]


def tidy(value):
    """The number, or numbers, without the digits that single precision only seems to have."""
    return [tidy(item) for item in value] if hasattr(value, "__len__") else float(f"{value:.7g}")


def is_grey(rgb):
    return rgb[0] == rgb[1] == rgb[2]


def spectrum_of(rgb):
    """The curve of a colour: a number of a grey, else the mixture of three smooth spectra."""
    if is_grey(rgb):
        return tidy(rgb[0])
    nm = np.arange(380, 781, 5)
    parts = np.array([np.exp(np.polyval(RED[::-1], (nm - 580) / 200)), np.ones(nm.size), np.exp(np.polyval(BLUE[::-1], (nm - 580) / 200))])
    values = np.array(rgb) @ (parts / parts.sum(axis=0))
    return {"table": {"wavelength_nm": nm.tolist(), "values": [round(float(v), 6) for v in values], "outside": "clamp"}}


def slopes_of(roughness):
    """The deviation [degrees] of slopes for which Abbe's rough diffuse surface has Blender's roughness, up to ROUGHEST. Both have Fujii's model, of
    B = roughness A; here x, the deviation squared, tells it by 0.45 x/(x + 0.09) = roughness (1 - 0.5 x/(x + 0.33)), which is solved. [OrenNayar1994]"""
    a, b, c = 0.45 - 0.5 * roughness, 0.45 * 0.33 - (0.5 * 0.09 + 0.33) * roughness, 0.09 * 0.33 * roughness
    return math.degrees(math.sqrt(2 * c / (b + math.sqrt(b * b + 4 * a * c))))


def emission_of(rgb, kind, amount, where, notes):
    """An emission of so many W or W per unit on 300-1100 nm for white, which is D65; a colour takes its share of that through its spectrum."""
    if is_grey(rgb):
        return {"illuminant": "D65", kind: tidy(amount * rgb[0])}
    notes.add_colour(where)
    luminous = amount * LUMENS_PER_WATT * float(np.dot(SHARES_OF_Y, rgb))
    return {"spectrum": {"product": ["D65", spectrum_of([component / max(rgb) for component in rgb])]}, PHOTOMETRIC[kind]: tidy(luminous)}


def file_name(name):
    return re.sub(r"[^\w.-]", "_", name)


def free_name(name, taken, extension=""):
    candidate, number = name + extension, 2
    while candidate in taken:
        candidate, number = f"{name}_{number}{extension}", number + 1
    return candidate


def source(socket):
    """The output that an input is linked to, or nothing, and the type of its node."""
    while socket is not None and socket.is_linked:
        output = socket.links[0].from_socket
        if output.node.type != "REROUTE":
            return output, output.node.type
        socket = output.node.inputs[0]
    return None, None


def is_matter(material):
    return "dielectric" in material or "medium" in material


class Shading:
    """Materials by name, made of Blender's nodes. A surface is a pair: its parts, as (weight, material), and the radiance it sends out [W/(m2 sr)]."""

    def __init__(self, folder, scale, notes):
        self.folder, self.scale, self.notes = folder, scale, notes
        self.images, self.materials, self.emissions, self.where = {}, {}, {}, ""

    def note(self, text, given=True):
        self.notes.add(self.where, text, given)

    def add(self, material):
        """The name of a material, of Blender's or None; nothing where it has no surface."""
        name = material.name_full if material else "default"
        if name not in self.emissions:
            self.where = f'material "{name}"'
            said = self.said_by_user(material)
            nodes = self if said is None else Shading(self.folder, self.scale, Notes())  # of which only what shines counts then
            nodes.where = self.where
            parts, self.emissions[name] = nodes.surface_of(material)
            if said is not None or parts is not None:
                self.materials[name] = self.joined(parts, name) if said is None else said
            self.note("what has no surface, such as a volume, has no counterpart here: dropped", name not in self.materials)
        return name if name in self.materials else None

    def said_by_user(self, material):
        """What the property `abbe` says: a material as scene files have it, or the name of a glass."""
        said = material.get("abbe") if material else None
        if said is None or hasattr(said, "to_dict"):
            return said and said.to_dict()
        if not str(said).lstrip().startswith("{"):
            return {"dielectric": {"ior": str(said)}}
        try:
            return json.loads(said)
        except ValueError as error:
            raise ExportError(f"{self.where}: its property abbe is no JSON ({error}; expected a material or the name of a glass).")

    def joined(self, parts, name):
        if not parts or parts[0][0] == 1:
            return parts[0][1] if parts else {"diffuse": {"reflectance": 0}}
        if any(is_matter(part) for _, part in parts):
            self.note("what light enters is not mixed here: the part with the most weight")
            return max(parts, key=lambda part: part[0])[1]
        names = [free_name(f"{name} part {number}", self.materials) for number in range(1, len(parts) + 1)]
        self.materials.update({part_name: part for part_name, (_, part) in zip(names, parts)})
        return {"mixture": [{"material": part_name, "weight": tidy(weight)} for part_name, (weight, _) in zip(names, parts)]}

    def surface_of(self, material):
        if material is None:
            return [(1, {"diffuse": {"reflectance": 0.8}})], BLACK
        if not material.use_nodes:
            model = {"base_color": self.curve(material.diffuse_color[:3], 1), "metallic": tidy(material.metallic), "roughness": tidy(material.roughness)}
            return [(1, {"principled": model})], BLACK
        output = material.node_tree.get_output_node("CYCLES")
        shader, _ = source(output.inputs["Surface"]) if output else (None, None)
        if shader is None:
            return None, BLACK
        parts, emission = self.shader(shader.node)
        inside, kind = source(output.inputs["Volume"])
        glass = [part["dielectric"] for _, part in parts if "dielectric" in part]
        if kind == "VOLUME_ABSORPTION" and glass:
            density = self.value(inside.node, "Density") / self.scale
            glass[0]["absorption_per_m"] = self.curve([density * (1 - component) for component in self.value(inside.node, "Color")])
        else:
            self.note("a volume within a surface has no counterpart here, but absorption within glass: dropped", inside)
        self.note("displacement by a material has no counterpart here: dropped", output.inputs["Displacement"].is_linked)
        return parts, emission

    def shader(self, node):
        make = {"BSDF_PRINCIPLED": self.principled, "BSDF_GLASS": self.glass, "BSDF_DIFFUSE": self.diffuse, "BSDF_GLOSSY": self.glossy,
                "EMISSION": self.emitter, "MIX_SHADER": self.mix}.get(node.type)
        if make:
            return make(node)
        self.note(f"the node {node.bl_label} has no counterpart here: a diffuse surface")
        return [(1, {"diffuse": {"reflectance": self.reflectance(node, "Color") if "Color" in node.inputs else 0.8}})], BLACK

    def principled(self, node):
        emission = np.array(self.value(node, "Emission")) * self.value(node, "Emission Strength")
        for name in ["Subsurface", "Specular Tint", "Anisotropic", "Transmission Roughness"] + ["Sheen Tint"] * (self.value(node, "Sheen") > 0):
            self.note(f"{name} of a Principled BSDF has no counterpart here: dropped", self.value(node, name) != 0)
        self.note("surfaces have no holes here: alpha is dropped", node.inputs["Alpha"].is_linked or node.inputs["Alpha"].default_value != 1)
        metallic, transmission = (min(max(self.value(node, name), 0), 1) for name in ("Metallic", "Transmission"))
        share = transmission * (1 - metallic)  # as Cycles weighs them, with (1 - transmission)(1 - metallic) of the diffuse surface and its sheen
        if share > 0:
            self.note("what transmits in part transmits all here", share != 1)
            dropped = {"Metallic": metallic, "Sheen": (1 - transmission) * self.value(node, "Sheen"), "Clearcoat": self.value(node, "Clearcoat")}
            for name, weight in dropped.items():
                self.note(f"{name} of a Principled BSDF that transmits has no counterpart here: dropped", weight > 0)
            return self.glass(node, "Base Color", "GGX")[0], emission
        self.note("a reflectance along the normal above 0.08 is cut to that", self.value(node, "Specular") > 1)
        model = {"metallic": tidy(metallic)}
        model.update({key: tidy(min(self.value(node, key.capitalize()), 1)) for key in ("roughness", "specular", "sheen", "clearcoat")})
        if model["clearcoat"] > 0:
            width = self.value(node, "Clearcoat Roughness") ** 2
            self.note("a width of a clear coat's facets above 0.1 is cut to that", width > 0.1)
            model["clearcoat_gloss"] = tidy(min(max((0.1 - width) / 0.099, 0), 1))
        return self.in_relief(node, {"principled": {"base_color": self.reflectance(node, "Base Color"), **model}}), emission

    def glass(self, node, colour="Color", distribution=None):
        self.note("the colour of a clear surface has no counterpart here: dropped", node.inputs[colour].is_linked or self.value(node, colour) != [1, 1, 1])
        model = {"ior": tidy(self.value(node, "IOR")), **self.facets(node, distribution or node.distribution)}
        return self.in_relief(node, {"dielectric": model}), BLACK

    def facets(self, node, distribution):
        self.note("facets as of Ashikhmin and Shirley have no counterpart here: GGX", distribution == "ASHIKHMIN_SHIRLEY")
        alpha = 0 if distribution == "SHARP" else tidy(self.value(node, "Roughness") ** 2)
        return {"roughness": {"alpha": alpha, "distribution": "beckmann" if distribution == "BECKMANN" else "ggx"}} if alpha > 0 else {}

    def diffuse(self, node):
        reflectance, roughness = self.reflectance(node, "Color"), self.value(node, "Roughness")
        if roughness == 0:
            return self.in_relief(node, {"diffuse": {"reflectance": reflectance}}), BLACK
        self.note("light that a rough diffuse surface scatters on among its facets is sent back here, and lost there")
        self.note(f"a roughness of a diffuse surface above {ROUGHEST} is cut to that", roughness > ROUGHEST)
        return self.in_relief(node, {"oren_nayar": {"reflectance": reflectance, "sigma_deg": tidy(slopes_of(min(roughness, ROUGHEST)))}}), BLACK

    def glossy(self, node):
        facets = self.facets(node, node.distribution)
        if not facets:
            return self.in_relief(node, {"mirror": {"reflectance": self.reflectance(node, "Color")}}), BLACK
        self.note("a metal's colour has no index: one with n = 1 that reflects it along the normal")
        kept = self.curve(self.value(node, "Color"), 0.9996)  # what an extinction of 100 reflects, the most there is
        nm = [] if isinstance(kept, float) else kept["table"]["wavelength_nm"]
        extinction = [tidy(2 * math.sqrt(r / (1 - r))) for r in (kept["table"]["values"] if nm else [kept])]
        index = {"wavelength_nm": nm, "n": [1] * len(nm), "k": extinction} if nm else {"n": 1, "k": extinction[0]}
        return self.in_relief(node, {"conductor": {"ior": index, **facets}}), BLACK

    def emitter(self, node):
        return [], np.array(self.value(node, "Color")) * self.value(node, "Strength")

    def mix(self, node):
        factor, all_parts, all_emission = min(max(self.value(node, "Fac"), 0), 1), [], BLACK
        for weight, socket in ((1 - factor, node.inputs[1]), (factor, node.inputs[2])):
            shader, _ = source(socket)
            if shader is not None and weight > 0:
                parts, emission = self.shader(shader.node)
                all_parts, all_emission = all_parts + [(weight * w, part) for w, part in parts], all_emission + weight * emission
        return all_parts, all_emission

    def in_relief(self, node, material):
        """The material as the one part of a surface, with the normal map that the node has."""
        relief, kind = source(node.inputs["Normal"])
        image, image_kind = source(relief.node.inputs["Color"]) if kind == "NORMAL_MAP" else (None, None)
        if image_kind == "TEX_IMAGE" and image.node.image and relief.node.space == "TANGENT":
            self.note("the strength of a normal map has no counterpart here: 1", self.value(relief.node, "Strength") != 1)
            return [(1, {**material, "normal_map": self.texture(image.node)})]
        self.note("what turns normals has no counterpart here, but a normal map by an image of tangent space: dropped", relief)
        return [(1, material)]

    def value(self, node, name):
        """The number or colour of an input."""
        output, kind = source(node.inputs[name])
        self.note(f"{name} does not vary over a surface here: the value of its socket", kind not in (None, "VALUE", "RGB"))
        value = (output if kind in ("VALUE", "RGB") else node.inputs[name]).default_value
        return value if isinstance(value, (float, int)) else list(value)[:3]

    def reflectance(self, node, name):
        image, kind = source(node.inputs[name])
        if kind != "TEX_IMAGE" or image.node.image is None:
            return self.curve(self.value(node, name), 1)
        self.notes.add_colour(self.where)
        settings = image.node.image.colorspace_settings.name
        self.note("the colours of an image are sRGB in files of integers, else linear, here", settings != ("Linear" if image.node.image.is_float else "sRGB"))
        return {**self.texture(image.node), "rgb": True}

    def curve(self, rgb, most=math.inf):
        rgb = [min(max(component, 0), most) for component in rgb]
        if not is_grey(rgb):
            self.notes.add_colour(self.where)
        return spectrum_of(rgb)

    def texture(self, node):
        """An image as it lies on surfaces."""
        said = {"image": self.image(node.image), "filter": "nearest" if node.interpolation == "Closest" else "bilinear",
                "wrap": "repeat" if node.extension == "REPEAT" else "clamp"}
        place, kind = source(node.inputs["Vector"])
        if kind == "MAPPING":
            location, turn, scale = (tidy(place.node.inputs[name].default_value) for name in ("Location", "Rotation", "Scale"))
            self.note("an image is not turned on a surface here", place.node.vector_type != "POINT" or any(turn))
            said.update(scale=scale[:2], offset=location[:2])
            place, kind = source(place.node.inputs["Vector"])
        self.note("an image lies on a surface by UV here", node.projection != "FLAT" or (place and kind != "UVMAP" and place.name != "UV"))
        self.note("beyond its edges an image is repeated or held here", node.extension not in ("REPEAT", "EXTEND"))
        return said

    def image(self, image):
        """The path of an image beside the scene; an error where it cannot be read."""
        path = bpy.path.abspath(image.filepath, library=image.library)
        if image.source != "FILE" or image.size[0] == 0:  # which has it read
            raise ExportError(f'{self.where}: the image "{image.name}" cannot be read (got "{path}", expected a file, or one that is packed).', 4)
        others = [name for name, known in self.images.items() if known != image]
        name = free_name(file_name(pathlib.Path(image.name).stem), others, pathlib.Path(path).suffix)
        self.images[name] = image
        return f"{self.folder}/{name}"


def write_images(images, folder):
    for name, image in images.items():
        path = bpy.path.abspath(image.filepath, library=image.library)
        if image.packed_file:
            (folder / name).write_bytes(image.packed_file.data)
        elif not (folder / name).exists() or not os.path.samefile(path, folder / name):
            shutil.copyfile(path, folder / name)


def surfaces_of(mesh):
    """The triangles of each material slot: corners' positions, normals where any is smooth, and texture coordinates."""
    mesh.calc_loop_triangles()
    mesh.calc_normals_split()

    def read(items, name, width, kind=np.float32):
        values = np.empty(len(items) * width, kind)
        items.foreach_get(name, values)
        return values.reshape(-1, width)

    corners, slots = read(mesh.loop_triangles, "loops", 3, np.int32), read(mesh.loop_triangles, "material_index", 1, np.int32)[:, 0]
    smooth = read(mesh.loop_triangles, "use_smooth", 1, bool)[:, 0]
    positions, normals = read(mesh.vertices, "co", 3)[read(mesh.loops, "vertex_index", 1, np.int32)[:, 0]], read(mesh.loops, "normal", 3)
    layer = next((layer for layer in mesh.uv_layers if layer.active_render), None)
    uv = read(layer.data, "uv", 2) if layer else np.zeros((len(mesh.loops), 2), np.float32)
    for slot in np.unique(slots):
        loops = corners[slots == slot].ravel()
        yield int(slot), [array[loops].astype(float) for array in (positions, normals, uv)], smooth[slots == slot].any()


def moved(surface, matrix, scale):
    """The surface where the matrix puts it, in metres; its front stays its front in a mirror."""
    positions, normals, uv = surface
    linear = np.array(matrix.to_3x3())
    positions = (positions @ linear.T + np.array(matrix.translation)) * scale
    if normals is not None:
        normals = normals @ np.linalg.pinv(linear)
        lengths = np.linalg.norm(normals, axis=1, keepdims=True)
        normals = np.where(lengths > 0, normals / np.where(lengths > 0, lengths, 1), [0, 0, 1])
    order = np.arange(len(positions)).reshape(-1, 3)[:, ::-1 if np.linalg.det(linear) < 0 else 1].ravel()
    return [array if array is None else array[order] for array in (positions, normals, uv)]


def write_mesh(path, surface):
    """Binary PLY; or OBJ, which has texture coordinates here."""
    positions, normals, uv = surface
    shaded = normals is not None
    rows = np.hstack([positions] + [normals] * shaded + [uv] * (path.suffix == ".obj"))
    order = np.lexsort(rows.T)  # corners that are alike are one vertex; np.unique takes ten times as long
    is_new = np.concatenate([[True], (rows[order][1:] != rows[order][:-1]).any(axis=1)])
    faces = np.empty(len(rows), np.int64)
    faces[order] = np.cumsum(is_new) - 1
    rows, faces = rows[order][is_new], faces.reshape(-1, 3)
    if path.suffix == ".obj":
        with path.open("w") as file:
            for key, values in (("v", rows[:, :3]), ("vn", rows[:, 3:6 if shaded else 3]), ("vt", rows[:, -2:])):
                if values.size:
                    np.savetxt(file, values, key + " %.9g" * values.shape[1])
            np.savetxt(file, np.repeat(faces + 1, 3 if shaded else 2, axis=1), "f" + (" %d/%d/%d" if shaded else " %d/%d") * 3)
        return
    names = ["x", "y", "z"] + ["nx", "ny", "nz"] * shaded
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(rows)}", *(f"property double {name}" for name in names),
              f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header", ""]
    records = np.empty(len(faces), [("count", "u1"), ("corners", "<i4", 3)])
    records["count"], records["corners"] = 3, faces
    path.write_bytes("\n".join(header).encode() + rows.astype("<f8").tobytes() + records.tobytes())


class Exporter:
    """Makes a scene of what a depsgraph evaluates, in metres: `said`, and the `files` of its meshes."""

    def __init__(self, depsgraph, folder):
        self.depsgraph, self.scene, self.folder = depsgraph, depsgraph.scene, folder
        self.scale = self.scene.unit_settings.scale_length
        self.notes = Notes()
        self.shading = Shading(folder, self.scale, self.notes)
        self.files = {}
        self.said = {"abbe": 1, "units": "m", **self.view(), "materials": self.shading.materials, "objects": {}, "shapes": [], "lights": []}
        self.walk()
        self.add_world()
        if not self.said["shapes"]:
            raise ExportError("the scene has no surface to render (got none, expected a mesh with faces and a material).")
        self.notes.add("scene", "nothing moves during an exposure here: motion blur is dropped", self.scene.render.use_motion_blur)
        self.notes.add("scene", "the whole picture is rendered here: its border is dropped", self.scene.render.use_border)
        lit = self.said["lights"] or any("emission" in shape for shape in self.said["shapes"])
        self.notes.add("scene", "nothing shines in this scene", not lit)

    def view(self):
        """Camera, sensor and what is shown as white: where Blender's view is a plain one, as there, a radiance of 1 over 2^exposure."""
        seen, render, look = self.scene.camera.evaluated_get(self.depsgraph), self.scene.render, self.scene.view_settings
        camera, at, axes, where = seen.data, seen.matrix_world.translation, seen.matrix_world.to_3x3().normalized(), f'camera "{seen.name}"'
        self.notes.add(where, "a camera that is not perspective has no counterpart here: perspective", camera.type != "PERSP")
        self.notes.add(where, "the shift of a lens has no counterpart here: its axis meets the middle of the picture", camera.shift_x or camera.shift_y)
        self.notes.add(where, "pixels are square here", render.pixel_aspect_x != render.pixel_aspect_y)
        resolution = [max(int(size * render.resolution_percentage / 100), 1) for size in (render.resolution_x, render.resolution_y)]
        upright = camera.sensor_fit == "VERTICAL" or (camera.sensor_fit == "AUTO" and resolution[1] > resolution[0])
        pitch_mm = (camera.sensor_height if camera.sensor_fit == "VERTICAL" else camera.sensor_width) / resolution[upright]
        focal_length, kind, aperture = camera.lens / 1000, "pinhole", 1 / PINHOLE_F_NUMBER  # seen from the film
        lens = {"focal_length": tidy(focal_length)}
        if camera.dof.use_dof:
            target = camera.dof.focus_object and camera.dof.focus_object.evaluated_get(self.depsgraph).matrix_world.translation
            distance = (abs(axes.col[2].dot(target - at)) if target else camera.dof.focus_distance) * self.scale
            self.notes.add(where, "the blades and the ratio of an opening are left out: it is round", camera.dof.aperture_blades > 2 or camera.dof.aperture_ratio != 1)
            self.notes.add(where, "no lens is in focus within its focal length: a pinhole", distance <= focal_length)
            self.notes.add(where, "no lens in air is faster than f/0.5: f/0.5", camera.dof.aperture_fstop < FASTEST_F_NUMBER)
            if distance > focal_length:
                f_number = max(camera.dof.aperture_fstop, FASTEST_F_NUMBER)
                extension = distance / (distance - focal_length)  # of the film's distance, and so of the film that has Blender's view
                kind, pitch_mm, aperture = "thin_lens", pitch_mm * extension, 1 / (f_number * extension)
                lens.update(f_number=tidy(f_number), focus_distance=tidy(distance))
        is_plain = look.view_transform == "Standard" and look.look == "None" and look.gamma == 1 and not look.use_curve_mapping
        self.notes.add("scene", f'the view "{look.view_transform}" has no counterpart here: the picture\'s white is chosen from it', not is_plain)
        white = math.pi / 4 * aperture**2 * LUMENS_PER_WATT / 2**look.exposure
        at = at * self.scale
        return {"camera": {kind: lens, "from": tidy(at), "to": tidy(at - axes.col[2]), "up": tidy(axes.col[1])},
                "sensor": {"resolution": resolution, "pixel_pitch_um": tidy(pitch_mm * 1000), "observer": "1931"},
                "output": {"exposure": tidy(white)} if is_plain else {}}

    def walk(self):
        """Adds all lamps and shapes; meshes that several objects or instances show are read once."""
        shown = {}
        for instance in self.depsgraph.object_instances:
            seen, matrix = instance.object, instance.matrix_world.copy()
            where = f'object "{seen.name}"'
            if instance.show_self and seen.type == "LIGHT":
                self.add_light(seen, matrix)
            elif instance.show_self and seen.type == "MESH":
                visible = seen.visible_camera, seen.visible_diffuse, seen.visible_glossy, seen.visible_transmission, seen.visible_shadow
                self.notes.add(where, "what some rays do not see is seen by all here", not all(visible))
                self.notes.add(where, "holdouts and shadow catchers are plain shapes here", seen.is_holdout or seen.is_shadow_catcher)
                slots = [slot.material for slot in seen.material_slots] or list(seen.data.materials) or [None]
                key = (seen.data.as_pointer(), *(slot.name_full if slot else None for slot in slots))
                if key not in shown:
                    shown[key] = (self.parts_of(seen.data, slots, where), [])
                shown[key][1].append((seen.name, matrix))
            self.notes.add(where, f"{DROPPED.get(seen.type)} have no counterpart here: dropped", seen.type in DROPPED)
            hair = [system for system in seen.particle_systems if system.settings.type == "HAIR" and system.settings.render_type == "PATH"]
            self.notes.add(where, "hair has no counterpart here: dropped", hair)
        for parts, places in shown.values():
            self.add_shapes(parts, places)

    def parts_of(self, mesh, slots, where):
        """Material, format of the file and surface of each slot that has triangles."""
        parts = []
        self.notes.add(where, "points and lines have no surface: dropped", len(mesh.vertices) > 0 and len(mesh.polygons) == 0)
        for slot, (positions, normals, uv), smooth in surfaces_of(mesh):
            name = self.shading.add(slots[min(slot, len(slots) - 1)])
            if name is None:
                continue
            material = self.shading.materials[name]
            self.notes.add(where, "light is refracted by the triangles of a smooth body as they are: it needs many", smooth and is_matter(material))
            text = json.dumps([material] + [self.shading.materials.get(part.get("material")) for part in material.get("mixture", [])])
            parts.append((name, ".obj" if '"image"' in text else ".ply", [positions, normals if smooth and not is_matter(material) else None, uv]))
        return parts

    def add_shapes(self, parts, places):
        """Parts that stand once or emit become shapes of their own; the others an object that instances place."""
        shared, first = [], places[0][0]
        for material, extension, surface in parts:
            radiance = self.shading.emissions[material]
            part = "" if len(parts) == 1 else f"/{material}"
            if len(places) > 1 and not radiance.any():
                mesh = self.add_mesh(first + part, extension, [surface[0] * self.scale, *surface[1:]])
                shared.append({"name": first + part, "mesh": mesh, "material": material})
                continue
            for name, matrix in places:
                said = {"name": name + part, "mesh": self.add_mesh(name + part, extension, moved(surface, matrix, self.scale)), "material": material}
                if radiance.any():
                    said.update(emission=emission_of(list(radiance), "radiance", 1, f'material "{material}"', self.notes), two_sided=True)
                self.said["shapes"].append(said)
        if shared:
            of = free_name(first, self.said["objects"])
            self.said["objects"][of] = {"shapes": shared}
            for name, matrix in places:
                matrix.translation *= self.scale
                rows = [number for row in matrix[:3] for number in row]
                self.said["shapes"].append({"name": name, "instance": {"of": of, "transform": {"matrix": tidy(rows)}}})

    def add_mesh(self, name, extension, surface):
        name = free_name(file_name(name), self.files, extension)
        self.files[name] = surface
        return f"{self.folder}/{name}"

    def add_light(self, seen, matrix):
        lamp, where, power = seen.data, f'light "{seen.name}"', seen.data.energy
        at, towards = tidy(matrix.translation * self.scale), matrix.to_3x3().col[2].normalized()
        self.notes.add(where, "nodes of lamps are not read here: power and colour are the lamp's own", lamp.use_nodes)
        self.notes.add(where, "lamps have shadows here", not lamp.use_shadow)
        self.notes.add(where, "a lamp that takes light away has no counterpart here: dropped", power < 0)
        self.notes.add(where, "watts are those of lengths in metres: next to sun and world they give another brightness than in Blender",
                       self.scale != 1 and lamp.type != "SUN")
        if power <= 0 or not any(lamp.color):
            return
        kind, amount = "radiant_flux_W", power
        if lamp.type == "SUN":
            degrees, kind = math.degrees(lamp.angle), "irradiance"
            body = {"sun": {"angular_diameter_deg": tidy(min(degrees, 60))}} if degrees >= 0.01 else {"directional": {}}
            next(iter(body.values()))["towards"] = tidy(towards)
        elif lamp.type == "AREA":
            body, area = self.area(lamp, matrix, where)
            kind, amount = "radiance", power / (4 * area)
        elif lamp.type == "SPOT":
            edge, kind, amount = math.cos(lamp.spot_size / 2), "intensity", power / (4 * math.pi)
            self.notes.add(where, "a spot shines evenly within its cone, as on its axis, and from a point")
            self.notes.add(where, "a spot's soft edge becomes a hard one that sends out as much", lamp.spot_blend > 0)
            middle = math.acos(edge + (1 - edge) * lamp.spot_blend / 2)  # of the cosines between which Blender's edge is soft
            body = {"spot": {"at": at, "direction": tidy(-towards), "half_angle_deg": tidy(math.degrees(middle))}}
        elif lamp.shadow_soft_size > 0:
            body = {"sphere": {"center": at, "radius": tidy(lamp.shadow_soft_size * self.scale)}}
        else:
            body = {"point": {"at": at}}
        self.notes.add(where, "what a lamp's surface sends out is seen by the camera too", not {"point", "spot", "directional"} & body.keys())
        self.said["lights"].append({"name": seen.name, **body, "emission": emission_of(list(lamp.color), kind, amount, where, self.notes)})

    def area(self, lamp, matrix, where):
        """A quad or disc that faces -z, and its area."""
        at, linear = matrix.translation * self.scale, matrix.to_3x3() * self.scale
        u, v = linear.col[0] * lamp.size, -linear.col[1] * (lamp.size_y if lamp.shape in ("RECTANGLE", "ELLIPSE") else lamp.size)
        area = u.cross(v).length
        self.notes.add(where, "the spread of an area lamp has no counterpart here: it shines in all directions", lamp.spread < 3.1415)
        if lamp.shape in ("SQUARE", "RECTANGLE"):
            return {"quad": {"corner": tidy(at - (u + v) / 2), "edge_u": tidy(u), "edge_v": tidy(v)}}, area
        self.notes.add(where, "an elliptic lamp becomes a round one of the same area", abs(u.length - v.length) > 1e-6 * u.length)
        return {"disc": {"center": tidy(at), "normal": tidy(u.cross(v).normalized()), "radius": tidy(math.sqrt(area) / 2)}}, math.pi / 4 * area

    def add_world(self):
        world, shading = self.scene.world, self.shading
        where = shading.where = f'world "{world.name if world else ""}"'
        output = world.node_tree.get_output_node("CYCLES") if world and world.use_nodes else None
        if output is None:
            rgb, strength, body = list(world.color) if world and not world.use_nodes else [0, 0, 0], 1, {}
        else:
            shader, kind = source(output.inputs["Surface"])
            self.notes.add(where, "the world's volume has no counterpart here: dropped", output.inputs["Volume"].is_linked)
            self.notes.add(where, "a world has nothing but a background here: it is black", shader and kind != "BACKGROUND")
            if kind != "BACKGROUND":
                return
            strength = shading.value(shader.node, "Strength")
            image, kind = source(shader.node.inputs["Color"])
            if kind == "TEX_ENVIRONMENT" and image.node.image:
                rgb, body = [1, 1, 1], self.panorama(image.node, where)
            else:
                rgb, body = shading.value(shader.node, "Color"), {}
        if strength > 0 and any(rgb):
            self.said["lights"].append({"name": world.name, "environment": body, "emission": emission_of(rgb, "radiance", strength, where, self.notes)})

    def panorama(self, node, where):
        """The image and how it is turned: its middle column looks along +x there, along +y made horizontal here."""
        self.notes.add(where, "an environment is equirectangular here", node.projection != "EQUIRECTANGULAR")
        image = self.shading.image(node.image)
        if pathlib.Path(image).suffix.lower() not in (".exr", ".hdr"):
            raise ExportError(f'{where}: its image is no environment (got "{node.image.name}", expected an .exr or .hdr file).', 4)
        mapping, kind = source(node.inputs["Vector"])
        up, middle = Vector((0, 0, 1)), Vector((1, 0, 0))
        if kind == "MAPPING":
            inputs = mapping.node.inputs
            turn = inputs["Rotation"].default_value.to_matrix()
            turn = turn if mapping.node.vector_type == "TEXTURE" else turn.transposed()
            up, middle = turn @ up, turn @ middle
            self.notes.add(where, "the scale of an environment has no counterpart here: dropped", tidy(inputs["Scale"].default_value) != [1, 1, 1])
        forward = Vector((1, 0, 0)) if abs(up.y) > 0.999999 else Vector((0, 1, 0))
        forward = (forward - up * forward.dot(up)).normalized()
        degrees = math.degrees(math.atan2(up.dot(forward.cross(middle)), forward.dot(middle)))
        return {"image": image, "up": tidy(up), "rotate_deg": tidy(degrees)}


class ExportEngine(bpy.types.RenderEngine):
    """Renders nothing: Blender gives what it evaluates for renders, with the modifiers of those, to render engines alone."""

    bl_idname, bl_label, folder, made = "ABBE_EXPORT", "Abbe export", None, None

    def render(self, depsgraph):
        try:
            ExportEngine.made = Exporter(depsgraph, ExportEngine.folder)
        except Exception as error:  # which Blender would print and forget
            ExportEngine.made = error


def exported(context, folder):
    """What the context's scene becomes."""
    if bpy.app.version >= (4, 0, 0):  # whose Principled BSDF says other things
        raise ExportError(f"this exporter is for Blender 3 (got {bpy.app.version_string}, expected 3.4 to 3.6).")
    if context.scene.camera is None:  # without one nothing is evaluated
        raise ExportError("the scene has no camera (got none, expected an object as the scene's Camera).")
    render = context.scene.render
    kept = {name: getattr(render, name) for name in ("engine", "use_compositing", "use_sequencer")}
    ExportEngine.folder, ExportEngine.made = folder, None
    bpy.utils.register_class(ExportEngine)
    try:
        render.engine, render.use_compositing, render.use_sequencer = ExportEngine.bl_idname, False, False
        bpy.ops.render.render(scene=context.scene.name, layer=context.view_layer.name)
    finally:
        for name, value in kept.items():
            setattr(render, name, value)
        bpy.utils.unregister_class(ExportEngine)
    if isinstance(ExportEngine.made, Exception):
        raise ExportEngine.made
    return ExportEngine.made


def scene_text(said):
    """The scene as JSON, an entry of its lists in each line."""
    blocks = []
    for key, value in said.items():
        entries = [("", item) for item in value] if isinstance(value, list) else [(json.dumps(name) + ": ", item) for name, item in value.items()] \
            if key in ("materials", "objects") else []
        text = ",".join("\n    " + name + json.dumps(item) for name, item in entries)
        blocks.append(f"  {json.dumps(key)}: " + (json.dumps(value) if not entries else f"[{text}\n  ]" if isinstance(value, list) else f"{{{text}\n  }}"))
    return "{\n" + ",\n".join(blocks) + "\n}\n"


def export(context, path):
    """Writes the context's scene to that file and gives the lines that tell what was approximated or dropped. Raises ExportError and OSError."""
    path = pathlib.Path(path)
    folder = path.with_name(path.stem + "_files")
    scene = exported(context, folder.name)
    folder.mkdir(parents=True, exist_ok=True)
    for name, surface in scene.files.items():
        write_mesh(folder / name, surface)
    write_images(scene.shading.images, folder)
    lines = scene.notes.lines()
    head = f"// Exported from {pathlib.Path(bpy.data.filepath).name or 'a new scene'} by Blender {bpy.app.version_string}."
    head += (" Approximated or dropped:" if lines else "") + "".join("\n//   " + " ".join(line.split()) for line in lines) + "\n"
    scene.said["output"].update(image=path.stem + ".exr", display=path.stem + ".png")
    unfinished = path.with_name(path.name + ".new")
    unfinished.write_text(head + scene_text(scene.said), "utf-8")
    os.replace(unfinished, path)
    return lines


class ExportAbbe(bpy.types.Operator, ExportHelper):
    """Export the scene to Abbe"""

    bl_idname, bl_label, filename_ext = "export_scene.abbe", "Export Abbe", ".json"
    filter_glob: bpy.props.StringProperty(default="*.json", options={"HIDDEN"})

    def execute(self, context):
        try:
            for line in export(context, self.filepath):
                self.report({"WARNING"}, line.replace(": warning: ", ": "))
        except (ExportError, OSError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


def menu_entry(self, context):
    self.layout.operator(ExportAbbe.bl_idname, text="Abbe (.json)")


def register():
    bpy.utils.register_class(ExportAbbe)
    bpy.types.TOPBAR_MT_file_export.append(menu_entry)


def unregister():
    bpy.types.TOPBAR_MT_file_export.remove(menu_entry)
    bpy.utils.unregister_class(ExportAbbe)


def main(arguments):
    """Exports in the background and gives the exit code, as Abbe's commands have them."""
    text, code = "", 0
    if len(arguments) != 1 or not arguments[0].endswith(".json"):
        text, code = f"one argument stands behind -- (got {' '.join(arguments) or 'none'}, expected OUT.json).", 2
    else:
        try:
            print("".join(line + "\n" for line in export(bpy.context, os.path.abspath(arguments[0]))), end="", flush=True)
        except ExportError as error:
            text, code = error, error.code
        except OSError as error:
            text, code = f"{error.filename}: {error.strerror} (expected a file that can be written).", 5
        except Exception as error:  # without which Blender would end as if all were well
            traceback.print_exc()
            text, code = f"a fault of the exporter ({type(error).__name__}: {error}).", 70
    if code:
        print(f"abbe_export: {text}", file=sys.stderr)
    return code


if __name__ == "__main__" and "--" in sys.argv:
    sys.exit(main(sys.argv[sys.argv.index("--") + 1:]))
elif __name__ == "__main__":
    register()
