"""Shows the outputs of operations in Blender."""

import copy
import csv
import io
import pathlib
import re
import tempfile

import bpy
import numpy as np

from . import colors, keying, mimetra, sources

_MODIFIER = "mimetra"
_GROUP = "mimetra region"
_LONGEST_NAME = 63  # bytes
_OF_ANY_MESH = {"material_index", "position"}  # attributes of every mesh


class Frames:
    """Times of results, and the folder of their caches. Frames are counted in animation time, which
    differs from the scene's frames under Time Stretching."""

    def __init__(self, scene, frames, cache_format, cache_folder):
        render = scene.render
        stretch = render.frame_map_old / render.frame_map_new
        self.rate = stretch * render.fps / render.fps_base
        self.start = stretch * frames[0]
        self.step = stretch * (frames[1] - frames[0] if len(frames) > 1 else 1)
        self.offsets = None
        self.cache_format = cache_format
        self.folder = cache_folder
        self.notes = []  # for the user

    def of(self, times):
        """Frames for poses at `times` in seconds; the first pose is at the start."""
        if len(times) < 2:
            return self
        made = copy.copy(self)
        # Rounding keeps frames that came from the scene exact.
        made.offsets = np.round((times - times[0]) * self.rate, 4)
        made.step = made.offsets[-1] / (len(times) - 1)
        return made

    def at(self, count):
        """Frames of `count` poses."""
        return self.start + (self.step * np.arange(count) if self.offsets is None
                             else self.offsets)


def _cache_folder(frames):
    """Folder of caches, or a temporary one if the file has not been saved."""
    if frames.folder.startswith("//") and not bpy.data.filepath:
        frames.notes.append("The file has not been saved: its mesh cache goes when Blender ends;"
                            " save the file, then run again")
        return pathlib.Path(tempfile.mkdtemp(prefix="mimetra_", dir=bpy.app.tempdir or None))
    return pathlib.Path(bpy.path.abspath(frames.folder))


def _cache_path(folder, name, extension):
    """Path in a folder that no file has yet. An older cache stays, because undo may bring back its
    object."""
    stem = bpy.path.clean_name(name)
    path, number = folder / f"{stem}.{extension}", 1
    while path.exists():
        number += 1
        path = folder / f"{stem}.{number:03}.{extension}"
    return path


def write_mesh_cache(value, frames, name):
    """Writes a value's poses to a file for play_mesh_cache(), and returns its path."""
    times = frames.at(len(value["positions"])) / frames.rate
    poses = mimetra.Sequence(value["positions"], value.faces, times=times)
    folder = _cache_folder(frames)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        path = _cache_path(folder, name, frames.cache_format.lower())
        # Blender has the faces, so files beside the cache are deleted with this folder.
        with tempfile.TemporaryDirectory(prefix=".mimetra_", dir=folder) as scratch:
            poses.save(pathlib.Path(scratch) / path.name)
            (pathlib.Path(scratch) / path.name).rename(path)
    except (OSError, mimetra.OutputError) as error:
        reason = getattr(error, "strerror", None) or error
        raise mimetra.OutputError(f"{folder}: cannot write the mesh cache: {reason}; choose"
                                  " another folder") from None
    return path


def play_mesh_cache(subject, path, frames):
    """Makes an object follow the poses of a file with a Mesh Cache modifier."""
    modifier = subject.modifiers.get(_MODIFIER)
    if modifier is None:
        modifier = subject.modifiers.new(_MODIFIER, "MESH_CACHE")
        with bpy.context.temp_override(object=subject, active_object=subject):
            bpy.ops.object.modifier_move_to_index(modifier=modifier.name, index=0)
    saved = bpy.data.filepath and frames.folder.startswith("//")
    modifier.cache_format = frames.cache_format
    modifier.filepath = bpy.path.relpath(str(path)) if saved else str(path)
    modifier.time_mode, modifier.play_mode = "FRAME", "SCENE"
    # Blender subtracts the start after scaling.
    modifier.frame_scale = 1 / frames.step
    modifier.frame_start = frames.start / frames.step
    modifier.forward_axis, modifier.up_axis = "POS_Y", "POS_Z"


def remove_mesh_cache(subject):
    modifier = subject.modifiers.get(_MODIFIER)
    if modifier and modifier.type == "MESH_CACHE":
        subject.modifiers.remove(modifier)


def _new_object(context, name, vertices, faces, beside=None):
    """Adds an object with a new mesh: upright, because files have y up, or beside another
    object."""
    mesh = bpy.data.meshes.new(name)
    ends = np.cumsum(faces.sizes)
    polygons = [part.tolist() for part in np.split(faces.corners, ends[:-1])]
    mesh.from_pydata(np.asarray(vertices).tolist(), [], polygons)
    made = bpy.data.objects.new(name, mesh)
    context.collection.objects.link(made)
    mesh.polygons.foreach_set("use_smooth", [True] * len(polygons))
    made.rotation_euler.x = np.pi / 2
    if beside:
        made.matrix_world = beside.matrix_world
        made.location.x += 1.2 * beside.dimensions.x
    return made


def _copied_object(subject, name, rest):
    """Adds a copy of an object beside it, with other positions and without modifiers and shape
    keys."""
    made = subject.copy()
    made.name = name
    made.data = subject.data.copy()
    made.data.name = name
    made.modifiers.clear()
    if made.data.shape_keys:
        made.shape_key_clear()
    made.data.vertices.foreach_set("co", rest.astype(np.float32).ravel())
    for collection in subject.users_collection:
        collection.objects.link(made)
    made.delta_location.x += 1.2 * subject.dimensions.x
    return made


def _layers_of(subject):
    """Names of an object's data on vertices, corners and faces."""
    mesh = subject.data
    others = {*_OF_ANY_MESH, *mesh.uv_layers.keys()}
    kinds = {"UV maps": mesh.uv_layers.keys(),
             "materials": [slot.name for slot in subject.material_slots if slot.material],
             "vertex groups": subject.vertex_groups.keys(),
             "attributes": [each.name for each in mesh.attributes
                            if not each.is_internal and each.name not in others]}
    return "; ".join(f"{kind} {', '.join(names)}" for kind, names in kinds.items() if names)


def has_faces_of(subject, value):
    """Returns whether a value has an object's polygons."""
    faces = sources.faces_of(subject.data)
    return (np.array_equal(value["face_sizes"], faces.sizes)
            and np.array_equal(value["corners"], faces.corners))


def show_sequence(context, value, subject, frames, name):
    """Shows a sequence and its fields as an object with a mesh cache. The object is a copy of
    `subject` if both have the same polygons."""
    frames = frames.of(value["times"])
    path = write_mesh_cache(value, frames, name)
    rest = value["rest"] if "rest" in value else value["positions"][0]
    if subject and has_faces_of(subject, value):
        made = _copied_object(subject, name, rest)
    else:
        made = _new_object(context, name, rest, value.faces, subject)
        layers = _layers_of(subject) if subject else ""
        if layers:
            frames.notes.append(f"{made.name}: has other faces than {subject.name}, of which are"
                                f" left out: {layers}; bring them over with Object > Link/Transfer"
                                " Data")
    play_mesh_cache(made, path, frames)
    show_fields(value, made)
    return made


def _show_shapes(context, name, neutral, faces, shapes, weights, frames, beside=None):
    """Adds an object with shape keys, {name: N x 3}, keyed by weights, {name: F}."""
    made = _new_object(context, name, neutral, faces, beside)
    made.shape_key_add(name="Basis", from_mix=False)
    keyed = {}
    for shape, displacement in shapes.items():
        key = made.shape_key_add(name=shape, from_mix=False)
        key.data.foreach_set("co", (neutral + displacement).astype(np.float32).ravel())
        if shape in weights:
            keyed[key.name] = weights[shape]  # Blender shortens long names
    if keyed:
        keying.set_keys(made, keyed, frames)
    made.data.update()
    return made


def show_model(context, value, frames, name):
    """Shows a model, with its performance if it has one. Each identity becomes an object with the
    same shape keys."""
    frames = frames.of(value["times"]) if "times" in value else frames
    shapes, weights = {}, {}
    if "expressions" in value:
        shapes = dict(zip(value["expression_names"], value["expressions"]))
    if "weights" in value:
        columns = zip(value["weight_names"], value["weights"].T)
        weights = {each: column for each, column in columns if each in shapes}
    made = [_show_shapes(context, name, value["neutral"], value.faces, shapes, weights, frames)]
    context.view_layer.update()
    if "identities" in value:
        for identity, shape in zip(value["identity_names"], value["identities"]):
            made.append(_show_shapes(context, f"{name} {identity}", value["neutral"] + shape,
                                     value.faces, shapes, {}, frames, made[-1]))
            context.view_layer.update()
    return made[0]


def show_components(context, value, subject, frames, name):
    """Shows components as shape keys with their weights over time."""
    shapes = {f"component {index:02}": displacement
              for index, displacement in enumerate(value["displacements"])}
    weights = dict(zip(shapes, value["weights"].T)) if "weights" in value else {}
    faces = sources.faces_of(subject.data) if subject else mimetra.Faces(
        np.full(len(value["triangles"]), 3), value["triangles"].ravel())
    return _show_shapes(context, name, value["rest"], faces, shapes, weights, frames, subject)


def _shown_fields(value):
    """Names of fields on vertices, and of fields on triangles if the polygons are known."""
    places = {"vertices", "triangles"} if "face_of_triangle" in value else {"vertices"}
    return [name for name in value if value.location(name) in places]


def check_fits(value, subject):
    """Throws Mismatch if regions or fields belong to a mesh other than an object's."""
    name = value.name or "the result"
    is_regions = isinstance(value, mimetra.Regions)
    count = value["masks"].shape[1] if is_regions else value["positions"].shape[1]
    if count != len(subject.data.vertices):
        raise mimetra.Mismatch(f"{subject.name}: {len(subject.data.vertices)} vertices, expected"
                               f" {count} as in {name}")
    on_faces = any(value.location(each) == "triangles" for each in _shown_fields(value))
    if on_faces and not has_faces_of(subject, value):
        raise mimetra.Mismatch(f"{subject.name}: {len(subject.data.polygons)} faces, expected the"
                               f" {len(value['face_sizes'])} of {name}")


def show_regions(value, subject):
    """Shows regions as vertex groups, and their fields."""
    masks = value["masks"]
    earlier = re.compile(f"{_GROUP} [0-9]+")
    for group in [each for each in subject.vertex_groups if earlier.fullmatch(each.name)]:
        subject.vertex_groups.remove(group)
    for index, mask in enumerate(masks):
        group = subject.vertex_groups.new(name=f"{_GROUP} {index:02}")
        group.add(np.flatnonzero(mask).tolist(), 1, "REPLACE")
    show_fields(value, subject)


def show_fields(value, subject):
    """Shows fields as attributes with their values, and numbers on vertices as colours too."""
    mesh = subject.data
    names = _shown_fields(value)
    shown = [name for name in names
             if value.location(name) == "vertices" and value[name].ndim == 1]
    for name in names:
        _show_attribute(mesh, value, name)
    for name in shown:
        is_region = name == "region" and "colors" in value
        made = _replace(mesh, f"mimetra {name} color", "FLOAT_COLOR",
                        "CORNER" if is_region else "POINT")
        shades = (colors.of_regions(value[name], value["colors"], sources.faces_of(mesh))
                  if is_region else colors.of_field(value[name]))
        made.data.foreach_set("color", shades.ravel())
    if shown:
        first = _attribute_name(f"mimetra {shown[0]} color")
        mesh.color_attributes.active_color = mesh.color_attributes[first]
    mesh.update()


def _attribute_name(name):
    """Name as Blender stores it."""
    return name.encode()[:_LONGEST_NAME].decode(errors="ignore")


def _replace(mesh, name, type, domain):
    """Adds an attribute, and removes an older one of the same name."""
    name = _attribute_name(name)
    old = mesh.attributes.get(name)
    if old:
        mesh.attributes.remove(old)
    return mesh.attributes.new(name, type, domain)


def _show_attribute(mesh, value, name):
    """Shows a field as an attribute. A polygon gets the largest value of its triangles."""
    values = np.asarray(value[name])
    domain = "POINT"
    if value.location(name) == "triangles":
        least = np.iinfo(values.dtype).min if values.dtype.kind in "iu" else np.nan
        of_polygons = np.full((len(mesh.polygons), *values.shape[1:]), least, values.dtype)
        # fmax ignores NaN if any triangle has a number.
        np.fmax.at(of_polygons, value["face_of_triangle"], values)
        values, domain = of_polygons, "FACE"
    integer = values.dtype == np.int32
    if values.ndim == 2 and values.shape[1] == 3:
        attribute, key = _replace(mesh, f"mimetra {name}", "FLOAT_VECTOR", domain), "vector"
    elif values.ndim == 1:
        type = "INT" if integer else "FLOAT"
        attribute, key = _replace(mesh, f"mimetra {name}", type, domain), "value"
    else:
        return
    attribute.data.foreach_set(key, values.astype(np.int32 if integer else np.float32).ravel())


def show_pictures(name, value):
    """Shows pictures as images of the file. Several pictures have numbers after the name."""
    for array in value:
        _, _, number = array.partition("_")
        _show_picture(f"{name} {int(number):04}" if number else name, value[array])


def _show_picture(name, pixels):
    """Adds an image to the file, and removes an older one of the same name."""
    old = bpy.data.images.get(name)
    if old:
        bpy.data.images.remove(old)
    image = bpy.data.images.new(name, pixels.shape[1], pixels.shape[0])
    # Blender's pixels start at the bottom left and have alpha.
    shown = np.ones((*pixels.shape[:2], 4), np.float32)
    shown[..., :3] = pixels[::-1] / 255
    image.pixels.foreach_set(shown.ravel())
    image.pack()


def show_text(name, text):
    """Writes text to a text block, and replaces older text of the same name."""
    block = bpy.data.texts.get(name) or bpy.data.texts.new(name)
    block.clear()
    block.write(text)


def csv_of(table):
    """CSV text of a table."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(table)
    for row in zip(*(table[name] for name in table)):
        writer.writerow(_text_of(cell) for cell in row)
    return text.getvalue()


def _text_of(cell):
    """Text of a cell: a word or a number, empty for NaN."""
    if isinstance(cell, str):
        return cell
    return "" if np.isnan(cell) else repr(float(cell))
