"""Point caches that Blender's Mesh Cache modifier plays."""

import struct

import numpy as np


def pc2(positions, first_frame):
    """PC2: positions F x N x 3 in single precision, little-endian."""
    frames, vertices = positions.shape[:2]
    head = struct.pack("<12siiffi", b"POINTCACHE2\0", 1, vertices, first_frame, 1.0, frames)
    return head + np.ascontiguousarray(positions, "<f4").tobytes()


def mdd(positions, times):
    """MDD: times F in seconds, positions F x N x 3, in single precision, big-endian."""
    frames, vertices = positions.shape[:2]
    head = struct.pack(">ii", frames, vertices)
    return head + np.asarray(times, ">f4").tobytes() + np.asarray(positions, ">f4").tobytes()
