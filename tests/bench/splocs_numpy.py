"""Sparse localized deformation components in plain NumPy, as the paper writes them.

usage: splocs_numpy.py FOLDER K D_MIN D_MAX REPETITIONS

FOLDER holds frames.npy (F x N x 3), rest.npy, and the distances (distances.npy, S x N) from the
vertices sources.npy. Writes seconds, the final energy and the BLAS as JSON.

Neumann et al. Sparse Localized Deformation Components. ACM TOG 32(6), 2013, section 4
"""

import json
import os
import sys
import time

import numpy as np

SPARSITY, RHO = 2.0, 10.0
ITERATIONS, ADMM_ITERATIONS = 10, 10
NEAR_TIE = 1e-9  # of what ties but for rounding


def feasible(w):
    """w >= 0 with the largest weight 1 (eq. 3)."""
    w = np.maximum(w, 0)
    largest = w.max()
    return w / largest if largest > 0 else w


def largest(values):
    """The first of those that tie with the largest one but for rounding."""
    return int(np.argmax(values >= (1 - NEAR_TIE) * values.max()))


def start(X, count, support):
    """Deflation: one component after the other from what is left (section 4.2)."""
    frames, vertices, _ = X.shape
    R = X.copy()
    W = np.empty((frames, count))
    C = np.empty((count, vertices, 3))
    for k in range(count):
        center = largest((R**2).sum(axis=(0, 2)))
        U, s, _ = np.linalg.svd(R[:, center, :], full_matrices=False)
        plus, minus = feasible(s[0] * U[:, 0]), feasible(-s[0] * U[:, 0])
        w = plus if np.linalg.norm(plus) > np.linalg.norm(minus) else minus
        c = np.tensordot(w, R, (0, 0)) / w.dot(w)
        c *= (1 - support(center))[:, np.newaxis]
        R -= np.multiply.outer(w, c)
        W[:, k], C[k] = w, c
    return W, C


def update_weights(X, W, C):
    """Each column of W in turn, for the residual without its component (eq. 6)."""
    R = X - np.tensordot(W, C, (1, 0))
    for k in range(len(C)):
        energy = (C[k] ** 2).sum()
        if energy <= 1e-8:
            W[:, k] = 0
            continue
        R += np.multiply.outer(W[:, k], C[k])
        W[:, k] = feasible(np.tensordot(R, C[k], ((1, 2), (0, 1))) / energy)
        R -= np.multiply.outer(W[:, k], C[k])


def update_components(X, W, C, U, Lambda):
    """ADMM (eq. 7 to 9)."""
    G = W.T @ W + RHO * np.eye(len(C))
    inverse = np.linalg.inv(G)
    projected = np.tensordot(W, X, (0, 0))
    Z = C
    for _ in range(ADMM_ITERATIONS):
        C = np.tensordot(inverse, projected + RHO * (Z - U), (1, 0))
        V = C + U
        lengths = np.sqrt((V**2).sum(axis=2))
        with np.errstate(divide="ignore", invalid="ignore"):
            kept = np.where(lengths > 0, np.maximum(0, 1 - Lambda / (RHO * lengths)), 0)
        Z = kept[:, :, np.newaxis] * V
        U = U + C - Z
    return Z, U


def energy(X, W, C, Lambda):
    R = X - np.tensordot(W, C, (1, 0))
    return (R**2).sum() + (Lambda * np.sqrt((C**2).sum(axis=2))).sum()


def decompose(frames, rest, count, support):
    X = frames - rest
    X /= np.sqrt((X**2).mean())
    W, C = start(X, count, support)
    U = np.zeros_like(C)
    Lambda = np.empty(C.shape[:2])
    for _ in range(ITERATIONS):
        update_weights(X, W, C)
        for k in range(count):
            Lambda[k] = SPARSITY * support(largest((C[k] ** 2).sum(axis=1)))
        C, U = update_components(X, W, C, U, Lambda)
        last_energy = energy(X, W, C, Lambda)
    return last_energy


def loaded_blas():
    with open("/proc/self/maps") as maps:
        paths = {line.split()[-1] for line in maps if "blas" in line.lower()}
    libraries = sorted({os.path.realpath(path) for path in paths if "/libblas" in path or "openblas" in path})
    return ", ".join(libraries) or "that it was built with"


def main():
    folder, count = sys.argv[1], int(sys.argv[2])
    d_min, d_max, repetitions = float(sys.argv[3]), float(sys.argv[4]), int(sys.argv[5])
    frames = np.load(os.path.join(folder, "frames.npy"))
    rest = np.load(os.path.join(folder, "rest.npy"))[0]
    sources = np.load(os.path.join(folder, "sources.npy"))[:, 0, 0].astype(int)
    distances = np.load(os.path.join(folder, "distances.npy"))[:, :, 0]
    row_of = {source: row for row, source in enumerate(sources)}

    def support(vertex):
        return np.clip((distances[row_of[vertex]] - d_min) / (d_max - d_min), 0, 1)

    seconds = []
    for _ in range(repetitions):
        begin = time.perf_counter()
        final = decompose(frames, rest, count, support)
        seconds.append(time.perf_counter() - begin)
    print(json.dumps({"seconds": seconds, "energy": float(final), "numpy": np.__version__,
                      "blas": loaded_blas()}))


main()
