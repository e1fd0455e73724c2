"""Values of the toolkit from Blender's objects."""

import contextlib
import logging

import numpy as np

from . import mimetra

# Modifiers that add or remove vertices. They are switched off, so that results fit the mesh.
_REBUILDING = {"ARRAY", "BEVEL", "BOOLEAN", "BUILD", "DECIMATE", "EDGE_SPLIT", "MASK", "MIRROR",
               "MULTIRES", "REMESH", "SCREW", "SKIN", "SOLIDIFY", "SUBSURF", "VOLUME_TO_MESH",
               "WELD", "WIREFRAME"}


def coordinates(points):
    """Coordinates (N x 3) of vertices or of a shape key's points, in Blender's single precision."""
    values = np.empty(3 * len(points), np.float32)
    points.foreach_get("co", values)
    return values.reshape(-1, 3)


def faces_of(mesh):
    """Polygons of a mesh."""
    sizes = np.empty(len(mesh.polygons), np.int32)
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.polygons.foreach_get("loop_total", sizes)
    mesh.loops.foreach_get("vertex_index", corners)
    if not len(sizes):
        raise mimetra.BadInput(f"{mesh.name}: has no faces")
    return mimetra.Faces(sizes, corners)


def rest_of(mesh):
    """Coordinates of a mesh without shape keys and modifiers."""
    keys = mesh.shape_keys
    return coordinates(keys.reference_key.data if keys else mesh.vertices)


def _is_bound(modifier):
    """Returns whether a modifier moves only the vertices that it was bound to, or that its file
    contains."""
    if modifier.type == "MESH_CACHE":
        return True
    bound = getattr(modifier, "is_bound", False) or getattr(modifier, "is_bind", False)
    return bound and getattr(modifier, "rest_source", "BIND") == "BIND"


def _warn_of_bound(subject, hidden):
    """Warns of modifiers that are bound to vertices which hidden modifiers would make."""
    rebuilding = None
    for modifier in subject.modifiers:
        if modifier in hidden:
            rebuilding = modifier
        elif rebuilding and modifier.show_viewport and _is_bound(modifier):
            logging.getLogger("mimetra").warning(
                "%s: the motion of the modifier '%s' is missing: it is bound to the vertices that"
                " '%s' makes, which is off where the object is read; move '%s' before it, bound or"
                " recorded again, or apply '%s'", subject.name, modifier.name, rebuilding.name,
                modifier.name, rebuilding.name)


@contextlib.contextmanager
def _own_vertices(subject):
    """Switches off modifiers that rebuild the mesh while the block runs."""
    hidden = [each for each in subject.modifiers
              if each.type in _REBUILDING and each.show_viewport]
    _warn_of_bound(subject, hidden)
    for modifier in hidden:
        modifier.show_viewport = False
    try:
        yield
    finally:
        for modifier in hidden:
            modifier.show_viewport = True


def _pose(context, subject, frame):
    """Coordinates of an object's vertices at a frame."""
    context.scene.frame_set(frame)
    evaluated = subject.evaluated_get(context.evaluated_depsgraph_get())
    if not evaluated.is_evaluated:
        raise mimetra.BadInput(f"{subject.name}: is disabled in viewports, where it does not move;"
                               " switch it on, and the collection that it is in")
    mesh = evaluated.to_mesh()
    try:
        found, expected = len(mesh.vertices), len(subject.data.vertices)
        if found != expected:
            raise mimetra.Mismatch(
                f"{subject.name}: {found} vertices in frame {frame}, expected {expected} as in its"
                " mesh; turn off the modifier that changes them")
        return coordinates(mesh.vertices)
    finally:
        evaluated.to_mesh_clear()


def sequence(context, subject, frames, *, groups=()):
    """Yields the share done. Returns an object's evaluated poses at frames, with the weights of the
    vertex groups `groups` as fields."""
    scene = context.scene
    if subject.show_only_shape_key and subject.data.shape_keys:
        raise mimetra.BadInput(f"{subject.name}: shows only the shape key"
                               f" '{subject.active_shape_key.name}'; switch off Shape Key Lock")
    before = scene.frame_current
    poses = []
    try:
        with _own_vertices(subject):
            for frame in frames:
                poses.append(_pose(context, subject, frame))
                yield len(poses) / len(frames)
    finally:
        scene.frame_set(before)
    rate = scene.render.fps / scene.render.fps_base
    return mimetra.Sequence(np.stack(poses), faces_of(subject.data),
                            times=np.array(frames) / rate, rest=rest_of(subject.data),
                            on_vertices=_group_weights(subject, groups),
                            name=subject.name)


def _group_weights(subject, names):
    """Weights of vertex groups by their names, 0 outside."""
    if not names:
        return {}
    groups = {group.index: group.name for group in subject.vertex_groups if group.name in names}
    weights = {name: np.zeros(len(subject.data.vertices)) for name in groups.values()}
    for vertex in subject.data.vertices:
        for group in vertex.groups:
            if group.group in groups:
                weights[groups[group.group]][vertex.index] = group.weight
    return weights


def _displacement(subject, key):
    """Displacement that a shape key adds at value 1."""
    moved = coordinates(key.data).astype(float) - coordinates(key.relative_key.data)
    if key.vertex_group in subject.vertex_groups:
        moved *= _group_weights(subject, [key.vertex_group])[key.vertex_group][:, None]
    return moved


def expression_keys(subject):
    """Shape keys that can move an object."""
    keys = subject.data.shape_keys
    if not keys:
        return []
    if not keys.use_relative:
        raise mimetra.BadInput(f"{subject.name}: expected relative shape keys, found absolute ones")
    return [key for key in keys.key_blocks if key != keys.reference_key and not key.mute]


def model(subject):
    """Model of an object at rest, with its shape keys as expressions."""
    keys = expression_keys(subject)
    shapes = np.stack([_displacement(subject, key) for key in keys]) if keys else None
    return mimetra.Model(rest_of(subject.data), faces_of(subject.data), shapes,
                         [key.name for key in keys] if keys else None, name=subject.name)


def regions(subject, prefix):
    """Regions from the vertex groups whose names begin with a prefix."""
    names = [group.name for group in subject.vertex_groups if group.name.startswith(prefix)]
    if not names:
        raise mimetra.BadInput(f"{subject.name}: no vertex group begins with '{prefix}', and there"
                               " is no such file")
    weights = _group_weights(subject, names)
    masks = np.stack([weights[name] > 0 for name in names])
    return mimetra.Regions(masks, faces_of(subject.data), name=prefix)
