"""Weights over time as keyed values of shape keys."""

import bpy
import numpy as np

from . import mimetra, sources

_LARGEST_KEY = 10  # limit of the sliders of shape keys


def _own_action(keys):
    """Returns an action that only these shape keys use."""
    animation = keys.animation_data_create()
    if animation.action is None:
        animation.action = bpy.data.actions.new(keys.name)
    elif animation.action.users > 1:
        animation.action = animation.action.copy()
    return animation.action


def _path_of(key):
    """Data path of a shape key's value."""
    return f'key_blocks["{bpy.utils.escape_identifier(key)}"].value'


def check_can_be_keyed(subject):
    """Throws Mismatch if a driver controls a shape key that would be keyed, or if an NLA strip of
    the shape keys is being edited."""
    animation = subject.data.shape_keys.animation_data
    if not animation:
        return
    if animation.use_tweak_mode:
        raise mimetra.Mismatch(f"{subject.name}: an NLA strip of its shape keys is being edited;"
                               " leave Tweak Mode")
    driven = {curve.data_path for curve in animation.drivers}
    for key in sources.expression_keys(subject):
        if _path_of(key.name) in driven:
            raise mimetra.Mismatch(f"{subject.name}: the shape key '{key.name}' is driven; remove"
                                   " its driver, mute it, or transfer with the space 'vertex'")


def set_keys(subject, weights, frames):
    """Keys the values of an object's shape keys, {name: F}. Keys outside the range of the frames
    stay, and so do other curves."""
    keys = subject.data.shape_keys
    action = _own_action(keys)
    curves = {}
    for name, values in weights.items():
        # Blender limits values to the range of their slider.
        key = keys.key_blocks[name]
        key.slider_min = min(key.slider_min, values.min())
        key.slider_max = max(key.slider_max, values.max())
        if np.abs(values).max() > _LARGEST_KEY:
            frames.notes.append(f"The shape key '{name}' reaches {np.abs(values).max():.3g};"
                                f" Blender keeps values from -{_LARGEST_KEY} to {_LARGEST_KEY}")
        path = _path_of(name)
        curves[name] = action.fcurves.find(path) or action.fcurves.new(path)
        _set_points(curves[name], frames.at(len(values)), values)
    frames.notes += _why_unseen(subject, curves)


def _set_points(curve, frames, values):
    """Sets points at frames, and removes older points between the first and the last frame."""
    made = np.column_stack([frames, values]).astype(np.float32)
    first, last = made[0, 0], made[-1, 0]
    points = curve.keyframe_points
    for index in reversed(range(len(points))):
        if first <= points[index].co.x <= last:
            points.remove(points[index], fast=True)
    kept = len(points)
    points.add(len(made))
    together = np.empty((len(points), 2), np.float32)
    points.foreach_get("co", together.ravel())
    together[kept:] = made
    points.foreach_set("co", together.ravel())
    for point in points[kept:]:
        point.interpolation = "LINEAR"
    curve.update()


def _why_unseen(subject, curves):
    """Reasons why an object does not show the values keyed on these curves, {name: curve}."""
    reasons = []
    altered = [name for name, curve in curves.items()
               if curve.mute or curve.group and curve.group.mute
               or any(not modifier.mute for modifier in curve.modifiers)]
    if altered:
        reasons.append(f"{subject.name}: the curves of the shape keys {', '.join(altered)} are"
                       " muted or have modifiers, so that other values are shown than are keyed;"
                       " unmute them and remove their modifiers")
    animation = subject.data.shape_keys.animation_data
    if not animation.use_nla:
        return reasons
    solo = next((track for track in animation.nla_tracks if track.is_solo), None)
    paths = {curve.data_path for curve in curves.values()}
    below = [track.name for track in animation.nla_tracks
             if not track.mute and _moves_any(track, paths)]
    if solo:
        reasons.append(f"{subject.name}: the NLA track '{solo.name}' of its shape keys plays alone,"
                       " so that the keys are not shown; switch off its star (solo)")
    elif below and (animation.action_blend_type != "REPLACE" or animation.action_influence < 1):
        reasons.append(f"{subject.name}: the keys are shown blended with the NLA track"
                       f" '{below[-1]}' ({animation.action_blend_type.capitalize()}, influence"
                       f" {animation.action_influence:.3g}); mute the track, or set the blending of"
                       " the shape keys' action to Replace and its influence to 1")
    return reasons


def _moves_any(track, paths):
    """Returns whether a strip of a track animates one of these data paths."""
    return any(not strip.mute and strip.action
               and any(curve.data_path in paths for curve in strip.action.fcurves)
               for strip in track.strips)


def keyed_weights(subject, table):
    """Columns of a table that are an object's shape keys, {name: F}. None if a column is unknown or
    there are no columns."""
    names = {key.name for key in sources.expression_keys(subject)}
    columns = {name: table[name] for name in table if name not in ("time", "frame")}
    return columns if columns and set(columns) <= names else None


def holds(model, weights, positions):
    """Returns whether shape keys with these weights give the poses. Shape keys do not include the
    motion of the head."""
    names = model["expression_names"]
    beta = np.column_stack([weights.get(name, np.zeros(len(positions))) for name in names])
    poses = model["neutral"] + np.tensordot(beta, model["expressions"], 1)
    extent = np.ptp(model["neutral"], axis=0).max()
    return np.abs(poses - positions).max() <= 1e-5 * extent
