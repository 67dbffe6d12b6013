"""Exports Blender scenes to Abbe: an add-on (File > Export > Abbe), and a script for the background, `blender -b scene.blend -P abbe_export.py -- scene.json`.

Meshes and images go to a folder next to the scene file, scene_files. Standard output and the head of the scene file list what is approximated or
dropped, each once with the number of occurrences. docs/reference/importers.md of Abbe describes the mapping.
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

# Lumens per watt of D65 on 300-1100 nm; weights of the linear Rec.709 components in Y; and quadratics in x = (nm - 580)/200. The exponentials of these,
# divided by their sum plus 1, are the spectra of red and blue [Mallett2019]. Tests compare them with Abbe's measurements and spectra of colours.
LUMENS_PER_WATT = 176.799762
LUMINANCE_WEIGHTS = (0.212663651, 0.715178325, 0.072158024)
RED, BLUE = (-1.83692275, 27.93408994, 51.38553635), (-3.54247104, 8.85485252, 35.69893127)
MAX_ROUGHNESS = 0.7767  # of diffuse surfaces, for slopes that deviate by 90 degrees
PINHOLE_F_NUMBER = 4  # Abbe's default for the exposure of a pinhole
MIN_F_NUMBER = 0.5  # of a lens in air, whose cone of light then fills the hemisphere
PHOTOMETRIC = {"radiant_flux_W": "luminous_flux_lm", "radiance": "luminance", "intensity": "luminous_intensity", "irradiance": "illuminance"}
DROPPED = {"VOLUME": "volumes", "GPENCIL": "grease pencil", "CURVES": "hair", "POINTCLOUD": "point clouds"}
BLACK = np.zeros(3)


class ExportError(Exception):
    """An error message with the exit code of the command: 3 for a scene, 4 for a file that it names."""

    def __init__(self, text, code=3):
        super().__init__(text)
        self.code = code


class Notes:
    """Notes on what is approximated or dropped: each text once, with its first location and the number of occurrences."""

    def __init__(self):
        self.found = {}

    def add(self, where, text, given=True):
        if given:
            first, count = self.found.get(text, (where, 0))
            self.found[text] = (first, count + 1)

    def add_colour(self, where):
        self.add(where, "a colour has no spectrum: replaced by a smooth one of that colour under D65; name a measured spectrum for accuracy")

    def lines(self):
        return [f"{where}: warning: {text}" + (f" ({count} times)" if count > 1 else "") for text, (where, count) in self.found.items()]


def tidy(value):
    """A number, or numbers, rounded to the digits of single precision."""
    return [tidy(item) for item in value] if hasattr(value, "__len__") else float(f"{value:.7g}")


def is_grey(rgb):
    return rgb[0] == rgb[1] == rgb[2]


def spectrum_of(rgb):
    """The curve of a colour: a number for a grey, otherwise a mixture of three smooth spectra."""
    if is_grey(rgb):
        return tidy(rgb[0])
    nm = np.arange(380, 781, 5)
    parts = np.array([np.exp(np.polyval(RED[::-1], (nm - 580) / 200)), np.ones(nm.size), np.exp(np.polyval(BLUE[::-1], (nm - 580) / 200))])
    values = np.array(rgb) @ (parts / parts.sum(axis=0))
    return {"table": {"wavelength_nm": nm.tolist(), "values": [round(float(v), 6) for v in values], "outside": "clamp"}}


def slopes_of(roughness):
    """The standard deviation of slopes [degrees] for which Abbe's rough diffuse surface has Blender's roughness, up to MAX_ROUGHNESS.

    Both use Fujii's model, with B = roughness A. The squared deviation x solves 0.45 x/(x + 0.09) = roughness (1 - 0.5 x/(x + 0.33)). [OrenNayar1994]
    """
    a, b, c = 0.45 - 0.5 * roughness, 0.45 * 0.33 - (0.5 * 0.09 + 0.33) * roughness, 0.09 * 0.33 * roughness
    return math.degrees(math.sqrt(2 * c / (b + math.sqrt(b * b + 4 * a * c))))


def emission_of(rgb, kind, amount, where, notes):
    """An emission. `amount` is the radiometric quantity on 300-1100 nm for white, which is D65; a colour reduces it by its spectrum."""
    if is_grey(rgb):
        return {"illuminant": "D65", kind: tidy(amount * rgb[0])}
    notes.add_colour(where)
    luminous = amount * LUMENS_PER_WATT * float(np.dot(LUMINANCE_WEIGHTS, rgb))
    return {"spectrum": {"product": ["D65", spectrum_of([component / max(rgb) for component in rgb])]}, PHOTOMETRIC[kind]: tidy(luminous)}


def file_name(name):
    return re.sub(r"[^\w.-]", "_", name)


# The name with its extension, or with the first number from 2 on that makes it unlike those in `taken`.
def free_name(name, taken, extension=""):
    candidate, number = name + extension, 2
    while candidate in taken:
        candidate, number = f"{name}_{number}{extension}", number + 1
    return candidate


def source(socket):
    """The output that an input is linked to, or None, and the type of its node."""
    while socket is not None and socket.is_linked:
        output = socket.links[0].from_socket
        if output.node.type != "REROUTE":
            return output, output.node.type
        socket = output.node.inputs[0]
    return None, None


def is_medium(material):
    return "dielectric" in material or "medium" in material


class Shading:
    """Materials by name, converted from Blender's nodes. A surface is a pair: its parts as (weight, material), and its emitted radiance [W/(m2 sr)]."""

    def __init__(self, folder, scale, notes):
        self.folder, self.scale, self.notes = folder, scale, notes
        self.images, self.materials, self.emissions, self.where = {}, {}, {}, ""

    def note(self, text, given=True):
        self.notes.add(self.where, text, given)

    def add(self, material):
        """The name of a Blender material, or of the default for None; None if it has no surface."""
        name = material.name_full if material else "default"
        if name not in self.emissions:
            self.where = f'material "{name}"'
            user_material = self.user_material(material)
            nodes = self if user_material is None else Shading(self.folder, self.scale, Notes())  # then only the emission of the nodes counts
            nodes.where = self.where
            parts, self.emissions[name] = nodes.surface_of(material)
            if user_material is not None or parts is not None:
                self.materials[name] = self.joined(parts, name) if user_material is None else user_material
            self.note("materials without a surface, such as volumes, are not supported: dropped", name not in self.materials)
        return name if name in self.materials else None

    def user_material(self, material):
        """The material in the property `abbe`, in the format of scene files or as the name of a glass; None without the property."""
        value = material.get("abbe") if material else None
        if value is None or hasattr(value, "to_dict"):
            return value and value.to_dict()
        if not str(value).lstrip().startswith("{"):
            return {"dielectric": {"ior": str(value)}}
        try:
            return json.loads(value)
        except ValueError as error:
            raise ExportError(f"{self.where}: the property abbe is not JSON ({error}; expected a material or the name of a glass).")

    # The material of a surface: its only part, a mixture of its parts, or black without any.
    def joined(self, parts, name):
        if not parts or parts[0][0] == 1:
            return parts[0][1] if parts else {"diffuse": {"reflectance": 0}}
        if any(is_medium(part) for _, part in parts):
            self.note("materials that transmit light cannot be mixed: replaced by the part with the largest weight")
            return max(parts, key=lambda part: part[0])[1]
        names = [free_name(f"{name} part {number}", self.materials) for number in range(1, len(parts) + 1)]
        self.materials.update({part_name: part for part_name, (_, part) in zip(names, parts)})
        return {"mixture": [{"material": part_name, "weight": tidy(weight)} for part_name, (weight, _) in zip(names, parts)]}

    # The parts of a material's surface, None without one, and its emitted radiance.
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
            self.note("volumes inside a surface are supported only as absorption in glass: dropped", inside)
        self.note("displacement by a material is not supported: dropped", output.inputs["Displacement"].is_linked)
        return parts, emission

    # The parts and the emitted radiance of a shader node; the methods for each kind of node return the same.
    def shader(self, node):
        make = {"BSDF_PRINCIPLED": self.principled, "BSDF_GLASS": self.glass, "BSDF_DIFFUSE": self.diffuse, "BSDF_GLOSSY": self.glossy,
                "EMISSION": self.emitter, "MIX_SHADER": self.mix}.get(node.type)
        if make:
            return make(node)
        self.note(f"the node {node.bl_label} is not supported: replaced by a diffuse surface")
        return [(1, {"diffuse": {"reflectance": self.reflectance(node, "Color") if "Color" in node.inputs else 0.8}})], BLACK

    def principled(self, node):
        emission = np.array(self.value(node, "Emission")) * self.value(node, "Emission Strength")
        for name in ["Subsurface", "Specular Tint", "Anisotropic", "Transmission Roughness"] + ["Sheen Tint"] * (self.value(node, "Sheen") > 0):
            self.note(f"{name} of a Principled BSDF is not supported: dropped", self.value(node, name) != 0)
        self.note("transparency by alpha is not supported: alpha is dropped", node.inputs["Alpha"].is_linked or node.inputs["Alpha"].default_value != 1)
        metallic, transmission = (min(max(self.value(node, name), 0), 1) for name in ("Metallic", "Transmission"))
        weight = transmission * (1 - metallic)  # as in Cycles, with (1 - transmission)(1 - metallic) for the diffuse surface and its sheen
        if weight > 0:
            self.note("partial transmission is not supported: full transmission", weight != 1)
            dropped = {"Metallic": metallic, "Sheen": (1 - transmission) * self.value(node, "Sheen"), "Clearcoat": self.value(node, "Clearcoat")}
            for name, weight_dropped in dropped.items():
                self.note(f"{name} of a Principled BSDF that transmits is not supported: dropped", weight_dropped > 0)
            return self.glass(node, "Base Color", "GGX")[0], emission
        self.note("a reflectance at normal incidence above 0.08 is clamped to that", self.value(node, "Specular") > 1)
        model = {"metallic": tidy(metallic)}
        model.update({key: tidy(min(self.value(node, key.capitalize()), 1)) for key in ("roughness", "specular", "sheen", "clearcoat")})
        if model["clearcoat"] > 0:
            width = self.value(node, "Clearcoat Roughness") ** 2
            self.note("a facet width of a clear coat above 0.1 is clamped to that", width > 0.1)
            model["clearcoat_gloss"] = tidy(min(max((0.1 - width) / 0.099, 0), 1))
        return self.in_relief(node, {"principled": {"base_color": self.reflectance(node, "Base Color"), **model}}), emission

    def glass(self, node, colour="Color", distribution=None):
        self.note("the colour of a clear surface is not supported: dropped", node.inputs[colour].is_linked or self.value(node, colour) != [1, 1, 1])
        model = {"ior": tidy(self.value(node, "IOR")), **self.facets(node, distribution or node.distribution)}
        return self.in_relief(node, {"dielectric": model}), BLACK

    def facets(self, node, distribution):
        self.note("the Ashikhmin-Shirley facet distribution is not supported: replaced by GGX", distribution == "ASHIKHMIN_SHIRLEY")
        alpha = 0 if distribution == "SHARP" else tidy(self.value(node, "Roughness") ** 2)
        return {"roughness": {"alpha": alpha, "distribution": "beckmann" if distribution == "BECKMANN" else "ggx"}} if alpha > 0 else {}

    def diffuse(self, node):
        reflectance, roughness = self.reflectance(node, "Color"), self.value(node, "Roughness")
        if roughness == 0:
            return self.in_relief(node, {"diffuse": {"reflectance": reflectance}}), BLACK
        self.note("interreflections between the facets of a rough diffuse surface are included here, unlike in Blender")
        self.note(f"a roughness of a diffuse surface above {MAX_ROUGHNESS} is clamped to that", roughness > MAX_ROUGHNESS)
        return self.in_relief(node, {"oren_nayar": {"reflectance": reflectance, "sigma_deg": tidy(slopes_of(min(roughness, MAX_ROUGHNESS)))}}), BLACK

    def glossy(self, node):
        facets = self.facets(node, node.distribution)
        if not facets:
            return self.in_relief(node, {"mirror": {"reflectance": self.reflectance(node, "Color")}}), BLACK
        self.note("a metal's colour has no refractive index: replaced by n = 1 with a k that gives the colour at normal incidence")
        reflectance = self.curve(self.value(node, "Color"), 0.9996)  # the reflectance for the maximum extinction of 100
        nm = [] if isinstance(reflectance, float) else reflectance["table"]["wavelength_nm"]
        extinction = [tidy(2 * math.sqrt(r / (1 - r))) for r in (reflectance["table"]["values"] if nm else [reflectance])]
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
        """The material as the only part of a surface, with the node's normal map."""
        relief, kind = source(node.inputs["Normal"])
        image, image_kind = source(relief.node.inputs["Color"]) if kind == "NORMAL_MAP" else (None, None)
        if image_kind == "TEX_IMAGE" and image.node.image and relief.node.space == "TANGENT":
            self.note("the strength of a normal map is not supported: 1", self.value(relief.node, "Strength") != 1)
            return [(1, {**material, "normal_map": self.texture(image.node)})]
        self.note("normals can be changed only by tangent-space normal maps from images: dropped", relief)
        return [(1, material)]

    def value(self, node, name):
        """The number or colour of an input."""
        output, kind = source(node.inputs[name])
        self.note(f"{name} cannot vary over a surface: replaced by the value of its socket", kind not in (None, "VALUE", "RGB"))
        value = (output if kind in ("VALUE", "RGB") else node.inputs[name]).default_value
        return value if isinstance(value, (float, int)) else list(value)[:3]

    def reflectance(self, node, name):
        image, kind = source(node.inputs[name])
        if kind != "TEX_IMAGE" or image.node.image is None:
            return self.curve(self.value(node, name), 1)
        self.notes.add_colour(self.where)
        settings = image.node.image.colorspace_settings.name
        self.note("image colours are sRGB in integer files, otherwise linear", settings != ("Linear" if image.node.image.is_float else "sRGB"))
        return {**self.texture(image.node), "rgb": True}

    # The curve of a colour with its components limited to [0, maximum].
    def curve(self, rgb, maximum=math.inf):
        rgb = [min(max(component, 0), maximum) for component in rgb]
        if not is_grey(rgb):
            self.notes.add_colour(self.where)
        return spectrum_of(rgb)

    def texture(self, node):
        """An image texture with its mapping."""
        spec = {"image": self.image(node.image), "filter": "nearest" if node.interpolation == "Closest" else "bilinear",
                "wrap": "repeat" if node.extension == "REPEAT" else "clamp"}
        mapping, kind = source(node.inputs["Vector"])
        if kind == "MAPPING":
            location, turn, scale = (tidy(mapping.node.inputs[name].default_value) for name in ("Location", "Rotation", "Scale"))
            self.note("rotated image textures are not supported", mapping.node.vector_type != "POINT" or any(turn))
            spec.update(scale=scale[:2], offset=location[:2])
            mapping, kind = source(mapping.node.inputs["Vector"])
        self.note("image textures are mapped by UV only", node.projection != "FLAT" or (mapping and kind != "UVMAP" and mapping.name != "UV"))
        self.note("outside its edges an image can only be repeated or extended", node.extension not in ("REPEAT", "EXTEND"))
        return spec

    def image(self, image):
        """The path of an image relative to the scene. Raises ExportError if the image cannot be read."""
        path = bpy.path.abspath(image.filepath, library=image.library)
        if image.source != "FILE" or image.size[0] == 0:  # reading the size loads the image
            raise ExportError(f'{self.where}: the image "{image.name}" cannot be read (got "{path}", expected a file or a packed image).', 4)
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
    """The triangles of each material slot: positions, normals and texture coordinates of corners, and True if any triangle is smooth."""
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
    """The surface transformed by the matrix, in metres. Its front remains its front if the matrix mirrors."""
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
    """Writes binary PLY, or OBJ for surfaces with texture coordinates."""
    positions, normals, uv = surface
    shaded = normals is not None
    rows = np.hstack([positions] + [normals] * shaded + [uv] * (path.suffix == ".obj"))
    order = np.lexsort(rows.T)  # equal corners become one vertex; np.unique takes ten times as long
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
    """Converts an evaluated depsgraph to a scene in metres: its description `spec`, and the `files` of its meshes."""

    def __init__(self, depsgraph, folder):
        self.depsgraph, self.scene, self.folder = depsgraph, depsgraph.scene, folder
        self.scale = self.scene.unit_settings.scale_length
        self.notes = Notes()
        self.shading = Shading(folder, self.scale, self.notes)
        self.files = {}
        self.spec = {"abbe": 1, "units": "m", **self.view(), "materials": self.shading.materials, "objects": {}, "shapes": [], "lights": []}
        self.walk()
        self.add_world()
        if not self.spec["shapes"]:
            raise ExportError("the scene has no surface to render (got none, expected a mesh with faces and a material).")
        self.notes.add("scene", "motion blur is not supported: dropped", self.scene.render.use_motion_blur)
        self.notes.add("scene", "render borders are not supported: dropped", self.scene.render.use_border)
        has_light = self.spec["lights"] or any("emission" in shape for shape in self.spec["shapes"])
        self.notes.add("scene", "the scene has no light", not has_light)

    def view(self):
        """Camera, sensor, and the exposure shown as white. For a plain view in Blender it is the same: a radiance of 1 divided by 2^exposure."""
        instance, render, look = self.scene.camera.evaluated_get(self.depsgraph), self.scene.render, self.scene.view_settings
        camera, at, axes = instance.data, instance.matrix_world.translation, instance.matrix_world.to_3x3().normalized()
        where = f'camera "{instance.name}"'
        self.notes.add(where, "only perspective cameras are supported: perspective", camera.type != "PERSP")
        self.notes.add(where, "lens shift is not supported: the axis passes through the center of the picture", camera.shift_x or camera.shift_y)
        self.notes.add(where, "only square pixels are supported", render.pixel_aspect_x != render.pixel_aspect_y)
        resolution = [max(int(size * render.resolution_percentage / 100), 1) for size in (render.resolution_x, render.resolution_y)]
        upright = camera.sensor_fit == "VERTICAL" or (camera.sensor_fit == "AUTO" and resolution[1] > resolution[0])
        pitch_mm = (camera.sensor_height if camera.sensor_fit == "VERTICAL" else camera.sensor_width) / resolution[upright]
        focal_length, kind, aperture = camera.lens / 1000, "pinhole", 1 / PINHOLE_F_NUMBER  # as seen from the film
        lens = {"focal_length": tidy(focal_length)}
        if camera.dof.use_dof:
            target = camera.dof.focus_object and camera.dof.focus_object.evaluated_get(self.depsgraph).matrix_world.translation
            distance = (abs(axes.col[2].dot(target - at)) if target else camera.dof.focus_distance) * self.scale
            self.notes.add(where, "aperture blades and ratio are not supported: round", camera.dof.aperture_blades > 2 or camera.dof.aperture_ratio != 1)
            self.notes.add(where, "a lens cannot focus within its focal length: replaced by a pinhole", distance <= focal_length)
            self.notes.add(where, "a lens in air cannot be faster than f/0.5: clamped to that", camera.dof.aperture_fstop < MIN_F_NUMBER)
            if distance > focal_length:
                f_number = max(camera.dof.aperture_fstop, MIN_F_NUMBER)
                extension = distance / (distance - focal_length)  # of the image distance, and therefore of a film with Blender's field of view
                kind, pitch_mm, aperture = "thin_lens", pitch_mm * extension, 1 / (f_number * extension)
                lens.update(f_number=tidy(f_number), focus_distance=tidy(distance))
        is_plain = look.view_transform == "Standard" and look.look == "None" and look.gamma == 1 and not look.use_curve_mapping
        self.notes.add("scene", f'the view "{look.view_transform}" is not supported: the white of the picture is chosen from its content', not is_plain)
        white = math.pi / 4 * aperture**2 * LUMENS_PER_WATT / 2**look.exposure
        at = at * self.scale
        return {"camera": {kind: lens, "from": tidy(at), "to": tidy(at - axes.col[2]), "up": tidy(axes.col[1])},
                "sensor": {"resolution": resolution, "pixel_pitch_um": tidy(pitch_mm * 1000), "observer": "1931"},
                "output": {"exposure": tidy(white)} if is_plain else {}}

    def walk(self):
        """Adds all lights and shapes; a mesh that several objects or instances share is read once."""
        meshes = {}
        for instance in self.depsgraph.object_instances:
            obj, matrix = instance.object, instance.matrix_world.copy()
            where = f'object "{obj.name}"'
            if instance.show_self and obj.type == "LIGHT":
                self.add_light(obj, matrix)
            elif instance.show_self and obj.type == "MESH":
                visible = obj.visible_camera, obj.visible_diffuse, obj.visible_glossy, obj.visible_transmission, obj.visible_shadow
                self.notes.add(where, "visibility to only some kinds of rays is not supported: visible to all", not all(visible))
                self.notes.add(where, "holdouts and shadow catchers are not supported: plain shapes", obj.is_holdout or obj.is_shadow_catcher)
                slots = [slot.material for slot in obj.material_slots] or list(obj.data.materials) or [None]
                key = (obj.data.as_pointer(), *(slot.name_full if slot else None for slot in slots))
                if key not in meshes:
                    meshes[key] = (self.parts_of(obj.data, slots, where), [])
                meshes[key][1].append((obj.name, matrix))
            self.notes.add(where, f"{DROPPED.get(obj.type)} have no counterpart here: dropped", obj.type in DROPPED)
            hair = [system for system in obj.particle_systems if system.settings.type == "HAIR" and system.settings.render_type == "PATH"]
            self.notes.add(where, "hair is not supported: dropped", hair)
        for parts, instances in meshes.values():
            self.add_shapes(parts, instances)

    def parts_of(self, mesh, slots, where):
        """Material, file format and surface of each slot that has triangles."""
        parts = []
        self.notes.add(where, "points and lines have no surface: dropped", len(mesh.vertices) > 0 and len(mesh.polygons) == 0)
        for slot, (positions, normals, uv), smooth in surfaces_of(mesh):
            name = self.shading.add(slots[min(slot, len(slots) - 1)])
            if name is None:
                continue
            material = self.shading.materials[name]
            self.notes.add(where, "light refracts at the flat triangles of a smooth body: use a fine mesh", smooth and is_medium(material))
            text = json.dumps([material] + [self.shading.materials.get(part.get("material")) for part in material.get("mixture", [])])
            parts.append((name, ".obj" if '"image"' in text else ".ply", [positions, normals if smooth and not is_medium(material) else None, uv]))
        return parts

    def add_shapes(self, parts, instances):
        """Adds parts that occur once or emit as shapes of their own, and the others as an object with instances."""
        shared, first = [], instances[0][0]
        for material, extension, surface in parts:
            radiance = self.shading.emissions[material]
            part = "" if len(parts) == 1 else f"/{material}"
            if len(instances) > 1 and not radiance.any():
                mesh = self.add_mesh(first + part, extension, [surface[0] * self.scale, *surface[1:]])
                shared.append({"name": first + part, "mesh": mesh, "material": material})
                continue
            for name, matrix in instances:
                spec = {"name": name + part, "mesh": self.add_mesh(name + part, extension, moved(surface, matrix, self.scale)), "material": material}
                if radiance.any():
                    spec.update(emission=emission_of(list(radiance), "radiance", 1, f'material "{material}"', self.notes), two_sided=True)
                self.spec["shapes"].append(spec)
        if shared:
            of = free_name(first, self.spec["objects"])
            self.spec["objects"][of] = {"shapes": shared}
            for name, matrix in instances:
                matrix.translation *= self.scale
                rows = [number for row in matrix[:3] for number in row]
                self.spec["shapes"].append({"name": name, "instance": {"of": of, "transform": {"matrix": tidy(rows)}}})

    # Adds the file of a mesh and returns its path relative to the scene.
    def add_mesh(self, name, extension, surface):
        name = free_name(file_name(name), self.files, extension)
        self.files[name] = surface
        return f"{self.folder}/{name}"

    def add_light(self, obj, matrix):
        light, where, power = obj.data, f'light "{obj.name}"', obj.data.energy
        at, towards = tidy(matrix.translation * self.scale), matrix.to_3x3().col[2].normalized()
        self.notes.add(where, "nodes of lights are not supported: power and colour are those of the light itself", light.use_nodes)
        self.notes.add(where, "lights always cast shadows", not light.use_shadow)
        self.notes.add(where, "lights of negative power are not supported: dropped", power < 0)
        self.notes.add(where, "power in watts refers to lengths in metres: its ratio to sun and world differs from Blender's",
                       self.scale != 1 and light.type != "SUN")
        if power <= 0 or not any(light.color):
            return
        kind, amount = "radiant_flux_W", power
        if light.type == "SUN":
            degrees, kind = math.degrees(light.angle), "irradiance"
            body = {"sun": {"angular_diameter_deg": tidy(min(degrees, 60))}} if degrees >= 0.01 else {"directional": {}}
            next(iter(body.values()))["towards"] = tidy(towards)
        elif light.type == "AREA":
            body, area = self.area(light, matrix, where)
            kind, amount = "radiance", power / (4 * area)
        elif light.type == "SPOT":
            edge, kind, amount = math.cos(light.spot_size / 2), "intensity", power / (4 * math.pi)
            self.notes.add(where, "a spot emits uniformly within its cone, as on its axis, and from a point")
            self.notes.add(where, "a spot's soft edge becomes a hard one with the same power", light.spot_blend > 0)
            half_angle = math.acos(edge + (1 - edge) * light.spot_blend / 2)  # mean of the cosines that bound Blender's soft edge
            body = {"spot": {"at": at, "direction": tidy(-towards), "half_angle_deg": tidy(math.degrees(half_angle))}}
        elif light.shadow_soft_size > 0:
            body = {"sphere": {"center": at, "radius": tidy(light.shadow_soft_size * self.scale)}}
        else:
            body = {"point": {"at": at}}
        self.notes.add(where, "the camera also sees the surface of the light", not {"point", "spot", "directional"} & body.keys())
        self.spec["lights"].append({"name": obj.name, **body, "emission": emission_of(list(light.color), kind, amount, where, self.notes)})

    def area(self, light, matrix, where):
        """A quad or disc that faces -z, and its area."""
        at, linear = matrix.translation * self.scale, matrix.to_3x3() * self.scale
        u, v = linear.col[0] * light.size, -linear.col[1] * (light.size_y if light.shape in ("RECTANGLE", "ELLIPSE") else light.size)
        area = u.cross(v).length
        self.notes.add(where, "the spread of an area light is not supported: it emits in all directions", light.spread < 3.1415)
        if light.shape in ("SQUARE", "RECTANGLE"):
            return {"quad": {"corner": tidy(at - (u + v) / 2), "edge_u": tidy(u), "edge_v": tidy(v)}}, area
        self.notes.add(where, "an elliptic light becomes a round one of the same area", abs(u.length - v.length) > 1e-6 * u.length)
        return {"disc": {"center": tidy(at), "normal": tidy(u.cross(v).normalized()), "radius": tidy(math.sqrt(area) / 2)}}, math.pi / 4 * area

    def add_world(self):
        world, shading = self.scene.world, self.shading
        where = shading.where = f'world "{world.name if world else ""}"'
        output = world.node_tree.get_output_node("CYCLES") if world and world.use_nodes else None
        if output is None:
            rgb, strength, body = list(world.color) if world and not world.use_nodes else [0, 0, 0], 1, {}
        else:
            shader, kind = source(output.inputs["Surface"])
            self.notes.add(where, "the world's volume is not supported: dropped", output.inputs["Volume"].is_linked)
            self.notes.add(where, "only background shaders are supported for the world: it is black", shader and kind != "BACKGROUND")
            if kind != "BACKGROUND":
                return
            strength = shading.value(shader.node, "Strength")
            image, kind = source(shader.node.inputs["Color"])
            if kind == "TEX_ENVIRONMENT" and image.node.image:
                rgb, body = [1, 1, 1], self.panorama(image.node, where)
            else:
                rgb, body = shading.value(shader.node, "Color"), {}
        if strength > 0 and any(rgb):
            self.spec["lights"].append({"name": world.name, "environment": body, "emission": emission_of(rgb, "radiance", strength, where, self.notes)})

    def panorama(self, node, where):
        """The image and its rotation. Its center column looks along +x in Blender, and along +y made horizontal in Abbe."""
        self.notes.add(where, "only equirectangular environments are supported", node.projection != "EQUIRECTANGULAR")
        image = self.shading.image(node.image)
        if pathlib.Path(image).suffix.lower() not in (".exr", ".hdr"):
            raise ExportError(f'{where}: its image is not an environment (got "{node.image.name}", expected an .exr or .hdr file).', 4)
        mapping, kind = source(node.inputs["Vector"])
        up, center = Vector((0, 0, 1)), Vector((1, 0, 0))
        if kind == "MAPPING":
            inputs = mapping.node.inputs
            turn = inputs["Rotation"].default_value.to_matrix()
            turn = turn if mapping.node.vector_type == "TEXTURE" else turn.transposed()
            up, center = turn @ up, turn @ center
            self.notes.add(where, "the scale of an environment is not supported: dropped", tidy(inputs["Scale"].default_value) != [1, 1, 1])
        forward = Vector((1, 0, 0)) if abs(up.y) > 0.999999 else Vector((0, 1, 0))
        forward = (forward - up * forward.dot(up)).normalized()
        degrees = math.degrees(math.atan2(up.dot(forward.cross(center)), forward.dot(center)))
        return {"image": image, "up": tidy(up), "rotate_deg": tidy(degrees)}


class ExportEngine(bpy.types.RenderEngine):
    """A render engine that only exports. Blender gives the scene evaluated for renders, with their modifiers, to render engines alone."""

    bl_idname, bl_label, folder, made = "ABBE_EXPORT", "Abbe export", None, None

    def render(self, depsgraph):
        try:
            ExportEngine.made = Exporter(depsgraph, ExportEngine.folder)
        except Exception as error:  # Blender would print and discard it
            ExportEngine.made = error


def exported(context, folder):
    """Exports the context's scene in memory; `folder` is the name of its folder of files. Returns the Exporter. Raises ExportError."""
    if bpy.app.version >= (4, 0, 0):  # its Principled BSDF has other inputs
        raise ExportError(f"this exporter is for Blender 3 (got {bpy.app.version_string}, expected 3.4 to 3.6).")
    if context.scene.camera is None:  # Blender evaluates nothing without one
        raise ExportError("the scene has no camera (got none, expected an object as the scene's Camera).")
    render = context.scene.render
    saved = {name: getattr(render, name) for name in ("engine", "use_compositing", "use_sequencer")}
    ExportEngine.folder, ExportEngine.made = folder, None
    bpy.utils.register_class(ExportEngine)
    try:
        render.engine, render.use_compositing, render.use_sequencer = ExportEngine.bl_idname, False, False
        bpy.ops.render.render(scene=context.scene.name, layer=context.view_layer.name)
    finally:
        for name, value in saved.items():
            setattr(render, name, value)
        bpy.utils.unregister_class(ExportEngine)
    if isinstance(ExportEngine.made, Exception):
        raise ExportEngine.made
    return ExportEngine.made


def scene_text(spec):
    """The scene as JSON with one list entry per line."""
    blocks = []
    for key, value in spec.items():
        entries = [("", item) for item in value] if isinstance(value, list) else [(json.dumps(name) + ": ", item) for name, item in value.items()] \
            if key in ("materials", "objects") else []
        text = ",".join("\n    " + name + json.dumps(item) for name, item in entries)
        blocks.append(f"  {json.dumps(key)}: " + (json.dumps(value) if not entries else f"[{text}\n  ]" if isinstance(value, list) else f"{{{text}\n  }}"))
    return "{\n" + ",\n".join(blocks) + "\n}\n"


def export(context, path):
    """Writes the context's scene to a file and returns the notes on what was approximated or dropped. Raises ExportError and OSError."""
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
    scene.spec["output"].update(image=path.stem + ".exr", display=path.stem + ".png")
    unfinished = path.with_name(path.name + ".new")
    unfinished.write_text(head + scene_text(scene.spec), "utf-8")
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
    """Exports in the background and returns an exit code like those of Abbe's commands."""
    text, code = "", 0
    if len(arguments) != 1 or not arguments[0].endswith(".json"):
        text, code = f"exactly one argument follows -- (got {' '.join(arguments) or 'none'}, expected OUT.json).", 2
    else:
        try:
            print("".join(line + "\n" for line in export(bpy.context, os.path.abspath(arguments[0]))), end="", flush=True)
        except ExportError as error:
            text, code = error, error.code
        except OSError as error:
            text, code = f"{error.filename}: {error.strerror} (expected a file that can be written).", 5
        except Exception as error:  # otherwise Blender would end successfully
            traceback.print_exc()
            text, code = f"internal error of the exporter ({type(error).__name__}: {error}).", 70
    if code:
        print(f"abbe_export: {text}", file=sys.stderr)
    return code


if __name__ == "__main__" and "--" in sys.argv:
    sys.exit(main(sys.argv[sys.argv.index("--") + 1:]))
elif __name__ == "__main__":
    register()
